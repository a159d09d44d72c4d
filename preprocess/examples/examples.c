#include "preprocess/examples/examples.h"

#include "preprocess/examples/derive.h"
#include "preprocess/examples/example_judge.h"
#include "preprocess/examples/example_kinds.h"
#include "preprocess/examples/examples_why.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define WANDER_COST 0.15 /* m per rad */
#define KNEE_SOFT (6.0 * FF_DEG)
#define KNEE_LOCKED (3.0 * FF_DEG)
#define KNEE_COST 0.2     /* m per rad */
#define TURN_COST 0.2     /* m, more than any seam */
#define STRANGER_COST 1.0 /* m, far more than any seam: others are taken where the base person has none */
static ff_vec3 point_of(const ff_example *e)
{
    return ff_v3((double)e->record.v_forward, (double)e->record.v_left,
                 FF_KIND_TURN_SCALE * (double)e->record.turn_rate);
}

static ff_vec3 mirror_point(ff_vec3 p)
{
    return ff_v3(p.x, -p.y, -p.z);
}

/* Nearer of the two sides' distances. */
static double distance(ff_vec3 p, ff_vec3 q)
{
    return ff_min(ff_length3(ff_sub3(p, q)), ff_length3(ff_sub3(p, mirror_point(q))));
}

/* -------------------------------------------------------------------------------------------------- choosing */

typedef struct candidate {
    ff_example *example;
    int subject, order;
    double cost;
} candidate;

static int by_cost(const void *x, const void *y)
{
    const candidate *a = x, *b = y;
    if (a->cost != b->cost) return a->cost < b->cost ? -1 : 1;
    return a->order - b->order;
}

/* Least knee flexion of the cycle (rad). */
static double straightest_knee(const ff_example *e)
{
    double least = FF_PI;
    for (int k = 0; k < e->frame_count; ++k)
        for (int r = FF_ROLE_KNEE_L; r <= FF_ROLE_KNEE_R; r += FF_ROLE_KNEE_R - FF_ROLE_KNEE_L)
            least = ff_min(least, ff_quat_angle(e->rotations[(size_t)k * FF_ROLE_JOINT_COUNT + (size_t)r]));
    return least;
}

/* Straight walks are chosen first: they are what people do most, and turns are kept away from them, not they from
 * turns. Cycles whose knees lock pop when a foot is held (synthesis study, section 3). */
static double cost_of(const ff_example *e)
{
    double knee = ff_max(0.0, KNEE_SOFT - straightest_knee(e));
    return (double)e->record.seam + WANDER_COST * e->wander + KNEE_COST * knee +
           (ff_example_is_straight(e) ? 0.0 : TURN_COST);
}

/* Take candidates in order of cost, each one that is spacing away from all taken before (a stranger a third
 * more). chosen receives their indices; subject < 0 = everybody's. */
static int choose(const candidate *list, int count, int subject, uint32_t gait, double spacing, int limit,
                  int *chosen)
{
    int taken = 0;
    for (int i = 0; i < count && taken < limit; ++i) {
        const ff_pack_example *record = &list[i].example->record;
        if (record->gait != gait || (record->flags & FF_EXAMPLE_IDLE) ||
            (subject >= 0 && list[i].subject != subject))
            continue;
        bool apart = true;
        for (int k = 0; k < taken && apart; ++k)
            apart = distance(point_of(list[i].example), point_of(list[chosen[k]].example)) >=
                    (list[i].cost >= STRANGER_COST ? 1.3 : 1.0) * spacing;
        if (apart) chosen[taken++] = i;
    }
    return taken;
}

/* The subject whose forward walks cover most rates; straight ones, which people walk most, count more, those whose
 * knees lock half. */
static int find_base(const ff_example_settings *set, const candidate *list, int count, int *chosen)
{
    int best = -1, most = 0;
    for (int i = 0; i < count; ++i) {
        bool seen = false;
        for (int k = 0; k < i && !seen; ++k)
            seen = list[k].subject == list[i].subject;
        if (seen) continue;
        int taken = choose(list, count, list[i].subject, FF_GAIT_WALK, set->walk_spacing, count, chosen),
            covered = 0;
        for (int k = 0; k < taken; ++k) {
            const ff_example *e = list[chosen[k]].example;
            int worth = (ff_example_is_straight(e) ? 4 : 3) / (straightest_knee(e) < KNEE_LOCKED ? 2 : 1);
            if (e->record.v_forward > 0.3f) covered += worth;
        }
        bool earlier = covered == most && list[i].subject < best;
        if (covered > most || earlier) most = covered, best = list[i].subject;
    }
    return best;
}

/* Usable? If not, the set remembers why, of each cycle once. */
static bool judge(const ff_example_settings *settings, const ff_rig *rig, ff_example *e, ff_example_set *set)
{
    bool half = (e->record.flags & FF_EXAMPLE_LOOSE) != 0;
    ff_left_out *out = &set->left_out[set->left_out_count];
    if (half && set->level < FF_LEVEL_HALF) return false;
    if (ff_example_judge(settings, rig, e, out->why, sizeof out->why)) return true;
    if (set->level == FF_LEVEL_LOOSE) {
        char why[sizeof out->why];
        if (!ff_example_judge_loosely(settings, rig, e, why, sizeof why)) return false;
        e->record.flags |= FF_EXAMPLE_LOOSE;
        return true;
    }
    if (set->level == FF_LEVEL_HALF && !half) return false; /* it was told */
    memcpy(out->name, e->name, sizeof out->name);
    ++set->left_out_count;
    return false;
}

/* The cycles that may be used at the set's level. */
static int list_candidates(const ff_example_settings *settings, const ff_rig *rig, ff_cycles *cycles,
                           const int *subject, int clip_count, candidate *list, ff_example_set *set)
{
    int count = 0;
    for (int c = 0; c < clip_count; ++c) {
        for (int i = 0; i < cycles[c].count; ++i) {
            ff_example *e = &cycles[c].items[i];
            if (!judge(settings, rig, e, set)) continue;
            list[count] = (candidate){e, subject[c], count, cost_of(e)};
            ++count;
        }
    }
    qsort(list, (size_t)count, sizeof *list, by_cost);
    return count;
}

/* Of those that close badly the best is enough: everything else is made from it. */
static int keep_best_loose(candidate *list, int count)
{
    int kept = 0;
    bool seen = false;
    for (int i = 0; i < count; ++i) {
        bool loose = (list[i].example->record.flags & FF_EXAMPLE_LOOSE) != 0;
        if (!loose || !seen) list[kept++] = list[i];
        seen = seen || loose;
    }
    return kept;
}

/* The first level at which there is a walk to make others from. Returns -1 when there is none at any. */
static int find_candidates(const ff_example_settings *settings, const ff_rig *rig, ff_cycles *cycles,
                           const int *subject, int clip_count, candidate *list, ff_example_set *set)
{
    for (set->level = FF_LEVEL_FIRM; set->level <= FF_LEVEL_LOOSE; ++set->level) {
        int count = list_candidates(settings, rig, cycles, subject, clip_count, list, set);
        if (set->level == FF_LEVEL_LOOSE) count = keep_best_loose(list, count);
        for (int i = 0; i < count; ++i)
            if (ff_example_is_model(list[i].example)) return count;
    }
    return -1;
}

/* ---------------------------------------------------------------------------------------------- the set itself */

static ff_example *add_slot(ff_example_set *set, int capacity)
{
    return set->count < capacity ? &set->items[set->count] : NULL;
}

/* Move an example into the set, with its mirror image unless it is its own. */
static ff_status add_example(const ff_rig *rig, ff_example_set *set, int capacity, ff_example *e,
                             ff_error *error)
{
    ff_example *slot = add_slot(set, capacity);
    if (!slot) return ff_fail(error, FF_ERR_RANGE, "more than %d examples", capacity);
    *slot = *e;
    memset(e, 0, sizeof *e);
    ++set->count;
    if (ff_example_is_straight(slot)) return FF_OK;
    ff_example *mirrored = add_slot(set, capacity);
    if (!mirrored) return ff_fail(error, FF_ERR_RANGE, "more than %d examples", capacity);
    ff_status status = ff_example_mirror(rig, slot, mirrored, error);
    if (status == FF_OK) ++set->count;
    return status;
}

/* Does the set have an example of a kind, captured or mirrored? */
static bool has_kind(const ff_example_set *set, const ff_example_kind *kind)
{
    for (int i = 0; i < set->count; ++i)
        for (double side = 1.0; side > -2.0; side -= 2.0)
            if (ff_kind_distance(kind, side, &set->items[i].record) < kind->within) return true;
    return false;
}

static ff_status derive_kind(const ff_rig *rig, const ff_example *base, const ff_gait_fit *fit,
                             const ff_example_kind *kind, ff_example_set *set, int capacity, ff_error *error)
{
    ff_example made;
    double period = kind->period;
    /* A run takes its own time for a cycle; the cadence of walks is not its. */
    if (kind->gait == FF_GAIT_RUN) period = (double)base->record.period;
    const ff_derive_target target = {kind->name, kind->forward, kind->left, kind->turn, period};
    ff_status status = ff_derive_walk(rig, base, fit, &target, &made, error);
    if (status == FF_OK) status = add_example(rig, set, capacity, &made, error);
    ff_example_free(&made);
    return status;
}

/* The straight example of a gait to derive from: nearest to an easy speed. */
static const ff_example *find_model(const ff_example_set *set, uint32_t gait, float easy)
{
    const ff_example *best = NULL;
    for (int i = 0; i < set->count; ++i) {
        const ff_example *e = &set->items[i];
        if (e->record.gait != gait || !ff_example_is_straight(e) || e->record.v_forward < FF_MODEL_SLOWEST)
            continue;
        if (e->record.flags & FF_EXAMPLE_DERIVED) continue;
        if (!best || fabsf(e->record.v_forward - easy) < fabsf(best->record.v_forward - easy)) best = e;
    }
    return best;
}

/* What no clip shows. Runs are bent from a straight run, when there is one. */
static ff_status derive_kinds(const ff_rig *rig, const ff_example *walk, ff_example_set *set, int capacity,
                              ff_error *error)
{
    ff_gait_fit run_fit;
    const ff_example *run = find_model(set, FF_GAIT_RUN, 2.6f);
    if (run) ff_gait_fit_make(rig, run, NULL, 0, &run_fit);
    ff_status status = FF_OK;
    for (int i = 0; status == FF_OK && i < FF_EXAMPLE_KINDS; ++i) {
        const ff_example_kind *kind = &ff_example_kinds[i];
        bool runs = kind->gait == FF_GAIT_RUN;
        if (kind->idle || (runs && !run) || has_kind(set, kind)) continue;
        status =
            derive_kind(rig, runs ? run : walk, runs ? &run_fit : &set->gait, kind, set, capacity, error);
    }
    return status;
}

/* The semi-procedural clip is the model walk; its laws are fitted to the good straight walks of the same person, chosen
 * or not, as people differ more than speeds do. */
static ff_status fit_gait(const ff_rig *rig, const candidate *list, int count, const int *subject,
                          const ff_example *model, ff_example_set *set, ff_error *error)
{
    size_t room = (size_t)(count + set->count);
    const ff_example **walks = ff_calloc(room, sizeof(const ff_example *));
    if (!walks) return ff_fail(error, FF_ERR_NO_MEMORY, "the walks to fit a gait to");
    int used = 0, person = model->clip < 0 ? 0 : subject[model->clip];
    for (int i = 0; i < count; ++i)
        if (list[i].example->frame_count > 0 && list[i].subject == person) walks[used++] = list[i].example;
    for (int i = 0; i < set->count; ++i)
        if (set->items[i].clip >= 0 && subject[set->items[i].clip] == person) walks[used++] = &set->items[i];
    ff_gait_fit_make(rig, model, walks, used, &set->gait);
    free(walks);
    return FF_OK;
}

static ff_status add_idle(const ff_rig *rig, const candidate *list, int count, const ff_example *model,
                          ff_example_set *set, int capacity, ff_error *error)
{
    ff_example made;
    for (int i = 0; i < count; ++i)
        if (list[i].example->record.flags & FF_EXAMPLE_IDLE)
            return add_example(rig, set, capacity, list[i].example, error);
    ff_status status = ff_derive_idle(rig, model, &made, error);
    if (status == FF_OK) status = add_example(rig, set, capacity, &made, error);
    ff_example_free(&made);
    return status;
}

static int rank(const ff_example *e)
{
    if (e->record.flags & FF_EXAMPLE_IDLE) return 0;
    return e->record.gait == FF_GAIT_WALK ? 1 : 2;
}

static int by_rates(const void *x, const void *y)
{
    const ff_example *a = x, *b = y;
    if (rank(a) != rank(b)) return rank(a) - rank(b);
    ff_vec3 p = point_of(a), q = point_of(b);
    if (p.x != q.x) return p.x < q.x ? -1 : 1;
    if (p.y * p.y != q.y * q.y) return fabs(p.y) < fabs(q.y) ? -1 : 1;
    if (fabs(p.z) != fabs(q.z)) return fabs(p.z) < fabs(q.z) ? -1 : 1;
    if (p.z != q.z) return p.z > q.z ? -1 : 1;
    return p.y > q.y ? -1 : (p.y < q.y ? 1 : 0);
}

static ff_status fill_set(const ff_example_settings *settings, const ff_rig *rig, candidate *list, int count,
                          const int *subject, int *chosen, ff_example_set *out, ff_error *error)
{
    const int room = 2 * (FF_EXAMPLES_MAX_WALKS + FF_EXAMPLES_MAX_RUNS);
    out->candidates = count;
    out->base = find_base(settings, list, count, chosen);
    for (int i = 0; i < count; ++i)
        if (list[i].subject != out->base) list[i].cost += STRANGER_COST;
    qsort(list, (size_t)count, sizeof *list, by_cost);
    ff_status status = FF_OK;
    for (uint32_t gait = FF_GAIT_WALK; gait <= FF_GAIT_RUN; ++gait) {
        /* Half of the room: the rest is for mirror images and what has to be made up. */
        int limit = (gait == FF_GAIT_WALK ? FF_EXAMPLES_MAX_WALKS - 12 : FF_EXAMPLES_MAX_RUNS) / 2;
        double spacing = gait == FF_GAIT_WALK ? settings->walk_spacing : settings->run_spacing;
        int taken = choose(list, count, -1, gait, spacing, limit, chosen);
        for (int i = 0; i < taken && status == FF_OK; ++i)
            status = add_example(rig, out, room, list[chosen[i]].example, error);
    }
    const ff_example *model = find_model(out, FF_GAIT_WALK, 1.15f);
    if (status == FF_OK && !model)
        return ff_fail(
            error, FF_ERR_NO_DATA,
            "no straight walk to build on is left: slower ones of nearly the same speed close better");
    char name[sizeof model->name] = "";
    if (status == FF_OK) memcpy(name, model->name, sizeof name);
    if (status == FF_OK) status = fit_gait(rig, list, count, subject, model, out, error);
    if (status == FF_OK) status = derive_kinds(rig, model, out, room, error);
    if (status == FF_OK) status = add_idle(rig, list, count, model, out, room, error);
    if (status == FF_OK) qsort(out->items, (size_t)out->count, sizeof *out->items, by_rates);
    for (int i = 0; i < out->count; ++i)
        if (strcmp(out->items[i].name, name) == 0) out->gait.gait.example = (uint32_t)i;
    return status;
}

ff_status ff_examples_select(const ff_example_settings *settings, const ff_rig *rig, ff_cycles *cycles,
                             const int *subject, int clip_count, ff_example_set *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    size_t all = 0;
    for (int c = 0; c < clip_count; ++c)
        all += (size_t)cycles[c].count;
    candidate *list = ff_calloc(all, sizeof *list);
    int *chosen = ff_calloc(all, sizeof *chosen);
    out->items = ff_calloc(2 * (FF_EXAMPLES_MAX_WALKS + FF_EXAMPLES_MAX_RUNS), sizeof *out->items);
    out->left_out = ff_calloc(all + 1, sizeof *out->left_out);
    ff_status status;
    if (list && chosen && out->items && out->left_out) {
        int count = find_candidates(settings, rig, cycles, subject, clip_count, list, out);
        status = count < 0 ? ff_examples_fail(settings, rig, cycles, clip_count, error)
                           : fill_set(settings, rig, list, count, subject, chosen, out, error);
    } else {
        status = ff_fail(error, FF_ERR_NO_MEMORY, "choosing among %zu gait cycles", all);
    }
    free(list);
    free(chosen);
    if (status != FF_OK) ff_example_set_free(out);
    return status;
}

void ff_example_set_free(ff_example_set *set)
{
    for (int i = 0; i < set->count; ++i)
        ff_example_free(&set->items[i]);
    free(set->items);
    free(set->left_out);
    memset(set, 0, sizeof *set);
}
