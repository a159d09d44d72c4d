/* Loops and correspondences of a pack as tables, with their limits. */
#include "preprocess/commands/inspect_examples.h"

#include "preprocess/examples/correspond.h"
#include "preprocess/examples/example_judge.h"

#include <stdio.h>

static bool walks_straight(const ff_pack_example *e)
{
    return e->gait == FF_GAIT_WALK && !(e->flags & FF_EXAMPLE_IDLE) && e->v_left == 0.0f &&
           e->turn_rate == 0.0f;
}

/* ---------------------------------------------------------------------------------------------------------- loops */

static bool loop_is_good(const ff_pack_example *e, const ff_pack_loop *loop)
{
    double most = walks_straight(e) ? FF_LOOP_MOVED_STRAIGHT : FF_LOOP_MOVED;
    bool smooth = (e->flags & FF_EXAMPLE_IDLE) || loop->cut_kick <= loop->contact_kick;
    return (double)loop->moved <= most && (double)loop->jump <= FF_LOOP_JUMP && smooth;
}

static void print_loops(const ff_pack *pack)
{
    double moved[2] = {0.0, 0.0}, jump = 0.0, kick = 0.0;
    uint32_t good = 0;
    printf("\nloops                                      seam  closing  jump  cut  velocities differ, cm/s\n"
           "                                             cm   cm      mm     at  at the cut  at a contact\n");
    for (uint32_t i = 0; i < pack->loop_count; ++i) {
        const ff_pack_example *e = &pack->examples[i];
        const ff_pack_loop *loop = &pack->loops[i];
        bool straight = walks_straight(e), fine = loop_is_good(e, loop);
        printf("  %-38.38s %6.1f %5.1f %8.2f %6.2f %8.1f %11.1f%s\n", ff_pack_string(pack, e->name),
               100.0 * (double)e->seam, 100.0 * (double)loop->moved, 1000.0 * (double)loop->jump,
               (double)loop->cut, 100.0 * (double)loop->cut_kick, 100.0 * (double)loop->contact_kick,
               fine ? "" : "  over the limits");
        good += fine;
        moved[straight] = ff_max(moved[straight], (double)loop->moved);
        jump = ff_max(jump, (double)loop->jump);
        if (loop->contact_kick > 0.0f)
            kick = ff_max(kick, (double)loop->cut_kick / (double)loop->contact_kick);
    }
    printf("%u of %u within the limits; at most: closing %.1f cm in straight walks (limit %.0f), %.1f cm "
           "elsewhere "
           "(limit %.0f);\n",
           good, pack->loop_count, 100.0 * moved[1], 100.0 * FF_LOOP_MOVED_STRAIGHT, 100.0 * moved[0],
           100.0 * FF_LOOP_MOVED);
    printf("jump %.3f mm (limit %.0f); velocities at the cut %.2f of those at a contact (limit 1)\n",
           1000.0 * jump, 1000.0 * FF_LOOP_JUMP, kick);
}

/* ------------------------------------------------------------------------------------------------ correspondences */

/* Of both straight walks, of the others, each with the semi-procedural clip apart. */
enum { STRAIGHT, OTHER, GAIT_STRAIGHT, GAIT_OTHER, KINDS };

typedef struct tally {
    uint32_t possible, found, pairs, keys;
    double worst, sum, wait;
} tally;

static void count_possible(const ff_pack *pack, tally *kinds)
{
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        bool straight = walks_straight(&pack->examples[i]);
        for (uint32_t k = i + 1; k < pack->example_count; ++k)
            ++kinds[straight && walks_straight(&pack->examples[k]) ? STRAIGHT : OTHER].possible;
        if (pack->gait_count && pack->examples[i].gait == FF_GAIT_WALK)
            ++kinds[straight ? GAIT_STRAIGHT : GAIT_OTHER].possible;
    }
}

static void print_correspondence(const ff_pack *pack, const ff_pack_correspondence *c, double worst)
{
    bool gait = c->to == FF_CORRESPOND_GAIT;
    const char *to = gait ? "semi-procedural clip" : ff_pack_string(pack, pack->examples[c->to].name);
    printf("  %-38.38s %-38.38s %2u%s %6.1f %6.1f  %5.2f %5.2f  ",
           ff_pack_string(pack, pack->examples[c->from].name), to, c->pair_count,
           c->flags & FF_CORRESPOND_KEYS ? "k" : " ", 100.0 * worst, 100.0 * (double)c->mean,
           (double)c->wait[0], (double)c->wait[1]);
    for (uint32_t k = 0; k < c->pair_count; ++k) {
        const ff_pack_pair *pair = &pack->pairs[c->first_pair + k];
        printf(" %.2f:%.2f", (double)pair->phase[0], (double)pair->phase[1]);
    }
    printf("\n");
}

static void print_correspondences(const ff_pack *pack)
{
    static const char *const names[KINDS] = {"straight walks", "others",
                                             "straight walk and semi-procedural clip",
                                             "others and semi-procedural clip"};
    tally kinds[KINDS] = {{0}};
    count_possible(pack, kinds);
    printf("\ncorrespondences                                                                pairs  worst   "
           "mean  "
           "longest wait  moments (k: of the keys)\n"
           "                                                                                  rms, cm     cm "
           " s\n");
    for (uint32_t i = 0; i < pack->correspondence_count; ++i) {
        const ff_pack_correspondence *c = &pack->correspondences[i];
        bool gait = c->to == FF_CORRESPOND_GAIT, straight = walks_straight(&pack->examples[c->from]);
        if (!gait) straight = straight && walks_straight(&pack->examples[c->to]);
        tally *kind = &kinds[gait ? (straight ? GAIT_STRAIGHT : GAIT_OTHER) : (straight ? STRAIGHT : OTHER)];
        double worst = 0.0;
        for (uint32_t k = 0; k < c->pair_count; ++k) {
            worst = ff_max(worst, (double)pack->pairs[c->first_pair + k].rms);
            kind->sum += (double)pack->pairs[c->first_pair + k].rms;
        }
        print_correspondence(pack, c, worst);
        ++kind->found;
        kind->keys += (c->flags & FF_CORRESPOND_KEYS) != 0;
        kind->pairs += c->pair_count;
        kind->worst = ff_max(kind->worst, worst);
        /* Who stands may go at any time: his loop has no moment of its own. */
        if (!(pack->examples[c->from].flags & FF_EXAMPLE_IDLE))
            kind->wait = ff_max(kind->wait, (double)ff_max((double)c->wait[0], (double)c->wait[1]));
    }
    for (int k = 0; k < KINDS; ++k) {
        if (kinds[k].found == 0) continue;
        printf("%s: %u of %u (%u by keys), %.1f pairs each, rms mean %.1f worst %.1f cm (limit %.0f), "
               "longest wait "
               "%.2f s\n",
               names[k], kinds[k].found, kinds[k].possible, kinds[k].keys,
               kinds[k].pairs / (double)kinds[k].found, 100.0 * kinds[k].sum / kinds[k].pairs,
               100.0 * kinds[k].worst,
               100.0 * (k == STRAIGHT || k == GAIT_STRAIGHT ? FF_PAIR_LIMIT_STRAIGHT : FF_PAIR_LIMIT),
               kinds[k].wait);
    }
}

void ff_inspect_examples(const ff_pack *pack)
{
    print_loops(pack);
    print_correspondences(pack);
}

json_t *ff_correspondences_json(const ff_pack *pack)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < pack->correspondence_count; ++i) {
        const ff_pack_correspondence *c = &pack->correspondences[i];
        json_t *pairs = json_array();
        for (uint32_t k = 0; k < c->pair_count; ++k) {
            const ff_pack_pair *pair = &pack->pairs[c->first_pair + k];
            json_array_append_new(pairs, json_pack("[f, f, f]", (double)pair->phase[0],
                                                   (double)pair->phase[1], (double)pair->rms));
        }
        json_array_append_new(list, json_pack("{s:i, s:i, s:b, s:[f, f], s:o}", "from", (int)c->from, "to",
                                              c->to == FF_CORRESPOND_GAIT ? -1 : (int)c->to, "by_keys",
                                              (c->flags & FF_CORRESPOND_KEYS) != 0, "wait",
                                              (double)c->wait[0], (double)c->wait[1], "pairs", pairs));
    }
    return list;
}
