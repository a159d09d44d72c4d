#include "preprocess/build/select_actions.h"

#include "preprocess/actions/successors.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Scales of the distance between actions (footstep study, section 1). */
static const double LANDING = 0.12, TURN = 12.0 * FF_DEG, DURATION = 0.08,
                    OTHER_MODE = 3.0; /* m, rad, s, - */
static const double PARTNER = 0.12;   /* m, pose distance up to which actions are partners */
static const int WALK_PARTNERS = 20, RUN_PARTNERS = 2;
static const double CLEAN = 0.65, SLIDE = 0.08; /* confidence of the plants; m that they slide */
static const int RUN_SHARE = 12;                /* one in so many may be a run: they go with nothing else */
enum { ROOM_FOR_PLATFORM = 40 };                /* actions: smaller sets have none of the jumps and ducks */
static const double COVER_SHARE =
    0.6; /* of what is left after the needed ones goes to covering, the rest to partners */

/* One action of all, and its mirror image. */
typedef struct candidate {
    ff_action *action, mirrored;
    int partners; /* that may follow it or its mirror image */
    bool fit, chosen;
    bool ordinary; /* a walking step */
    double away;   /* from the nearest chosen one */
} candidate;

typedef struct selection {
    const ff_successor_settings *settings;
    candidate *items;
    int count, chosen, wanted;
    unsigned char *follows; /* [count][count]: 1 + whether k may follow i, itself or mirrored */
} selection;

/* -------------------------------------------------------------------------------------------------------- partners */

static bool near(const ff_successor_settings *settings, const ff_action *a, const ff_action *b)
{
    const ff_action_joins p = {a->start, a->end}, q = {b->start, b->end};
    return ff_may_follow(settings, &a->record, &b->record) &&
           ff_join_distance(&a->record, &p, &b->record, &q, PARTNER) <= PARTNER;
}

static void find_partners(void *context, uint32_t index)
{
    selection *s = context;
    candidate *c = &s->items[index];
    for (int k = 0; k < s->count; ++k) {
        /* The mirror image of a pair is a pair. */
        bool follows = near(s->settings, c->action, s->items[k].action) ||
                       near(s->settings, c->action, &s->items[k].mirrored);
        s->follows[(size_t)index * (size_t)s->count + (size_t)k] = follows;
        c->partners += follows;
    }
}

/* ----------------------------------------------------------------------------------------------------------- choosing */

/* How different two actions are for a planner; swing sides do not matter, as each has its mirror image. */
static double between(const candidate *p, const candidate *q)
{
    const ff_pack_action *x = &p->action->record;
    const ff_pack_action *y = x->swing == q->action->record.swing ? &q->action->record : &q->mirrored.record;
    double a = ((double)x->land[0] - (double)y->land[0]) / LANDING,
           b = ((double)x->land[1] - (double)y->land[1]) / LANDING;
    double turn = ((double)x->theta - (double)y->theta) / TURN,
           time = ((double)x->duration - (double)y->duration) / DURATION;
    bool walks = x->mode <= FF_MODE_WALK_LONG && y->mode <= FF_MODE_WALK_LONG && x->mode && y->mode;
    double mode = x->mode == y->mode || walks ? 0.0 : OTHER_MODE;
    return sqrt(a * a + b * b + turn * turn + time * time + mode * mode);
}

static void choose(selection *s, int index)
{
    s->items[index].chosen = true;
    ++s->chosen;
    for (int k = 0; k < s->count; ++k)
        s->items[k].away = ff_min(s->items[k].away, between(&s->items[index], &s->items[k]));
}

/* What nobody can do without: one of each kind that begins or ends in standing, the one with the most partners. Kinds are
 * told apart by mode, direction and turn, in coarse steps. */
static int kind_of(const ff_pack_action *r)
{
    uint32_t ends = r->flags & (FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING);
    if (!ends) return -1;
    double turn = fabs((double)r->theta) / FF_DEG, alpha = fabs((double)r->alpha) / FF_DEG;
    int turned = turn < 12.0 ? 0 : (turn < 32.0 ? 1 : (turn < 65.0 ? 2 : (turn < 120.0 ? 3 : 4)));
    int way = alpha < 45.0 ? 0 : (alpha < 135.0 ? 1 : 2);
    if (r->mode == FF_MODE_IDLE) return 0;
    if (r->mode == FF_MODE_TURN && (r->flags & FF_ACTION_WHOLE)) return 10 + turned;
    if (r->mode == FF_MODE_JUMP || r->mode == FF_MODE_CROUCH || r->mode == FF_MODE_CLIMB) return -1;
    bool from = (ends & FF_ACTION_FROM_STANDING) != 0, to = (ends & FF_ACTION_TO_STANDING) != 0;
    return 20 + way + 3 * (from ? (to ? 2 : 0) : 1) + (turned > 1 ? 9 : 0);
}

/* The order in which kinds are taken when there is not room for all. */
static void choose_needed(selection *s)
{
    static const int first[] = {0, 20, 23, 12, 11, 13, 21, 24, 22, 25, 26, 27, 28, 14};
    enum { FIRST = sizeof first / sizeof first[0], KINDS = 40 };
    for (int round = 0; round < FIRST + KINDS; ++round) {
        int kind = round < FIRST ? first[round] : round - FIRST, best = -1;
        bool done = false;
        for (int i = 0; i < s->count; ++i) {
            const candidate *c = &s->items[i];
            if (kind_of(&c->action->record) != kind) continue;
            done = done || c->chosen;
            if (best < 0 || c->partners > s->items[best].partners) best = i;
        }
        /* Turns of one kind only, and half of the room for the rest at most. */
        if (best >= 0 && !done && (s->chosen < FIRST || 2 * s->chosen < s->wanted) && s->chosen < s->wanted)
            choose(s, best);
    }
}

/* The most ordinary step: the one nearest to all others. */
static int medoid(const selection *s)
{
    int best = -1;
    double least = 0.0;
    for (int i = 0; i < s->count; ++i) {
        uint32_t mode = s->items[i].action->record.mode;
        if (!s->items[i].fit || (mode != FF_MODE_WALK_SHORT && mode != FF_MODE_WALK_LONG)) continue;
        double sum = 0.0;
        for (int k = 0; k < s->count; ++k)
            if (s->items[k].fit) sum += ff_min(between(&s->items[i], &s->items[k]), 10.0);
        if (best < 0 || sum < least) {
            best = i;
            least = sum;
        }
    }
    return best;
}

/* May this one still be taken for what it covers? Standing is there already; runs go with nothing but runs. */
static bool may_cover(const selection *s, int index)
{
    const candidate *c = &s->items[index];
    if (!c->fit || c->chosen || c->action->record.mode == FF_MODE_IDLE) return false;
    int runs = 0;
    for (int i = 0; i < s->count; ++i)
        runs += s->items[i].chosen && s->items[i].action->record.mode == FF_MODE_RUN;
    uint32_t mode = c->action->record.mode;
    bool platform = mode == FF_MODE_JUMP || mode == FF_MODE_CLIMB || mode == FF_MODE_CROUCH;
    if (platform && s->wanted < ROOM_FOR_PLATFORM) return false;
    return mode != FF_MODE_RUN || (runs + 1) * RUN_SHARE <= s->wanted;
}

static void choose_covering(selection *s, int up_to)
{
    int first = medoid(s);
    if (first >= 0 && !s->items[first].chosen && s->chosen < up_to) choose(s, first);
    while (s->chosen < up_to) {
        int best = -1;
        for (int i = 0; i < s->count; ++i)
            if (may_cover(s, i) && (best < 0 || s->items[i].away > s->items[best].away)) best = i;
        if (best < 0 || s->items[best].away < 0.2) return; /* all the rest is as good as there */
        choose(s, best);
    }
}

/* Steps that may follow chosen ones and be followed by them. */
static void choose_partners(selection *s)
{
    while (s->chosen < s->wanted) {
        int best = -1, most = -1;
        for (int i = 0; i < s->count; ++i) {
            if (s->items[i].chosen) continue;
            int gain = 0;
            for (int k = 0; k < s->count; ++k)
                if (s->items[k].chosen)
                    gain += s->follows[(size_t)i * (size_t)s->count + (size_t)k] +
                            s->follows[(size_t)k * (size_t)s->count + (size_t)i];
            if (s->items[i].fit && s->items[i].ordinary) gain += 2 * s->count;
            if (gain > most) {
                most = gain;
                best = i;
            }
        }
        if (best < 0) return;
        choose(s, best);
    }
}

/* -------------------------------------------------------------------------------------------------------------- whole */

static bool is_fit(const ff_build_clip *clip, const candidate *c)
{
    const ff_pack_action *r = &c->action->record;
    if (r->flags & FF_ACTION_DERIVED) return true;
    const ff_plant *plants[2] = {&clip->plants.items[r->support_plant], &clip->plants.items[r->swing_plant]};
    bool run = r->mode == FF_MODE_RUN;
    for (int i = 0; i < 2; ++i)
        if (plants[i]->confidence < (run ? 0.5 : CLEAN) || plants[i]->slide > SLIDE ||
            plants[i]->level != 0.0)
            return false;
    return c->partners > (run ? RUN_PARTNERS : WALK_PARTNERS);
}

static ff_status begin(selection *s, ff_build_clip *clips, int count, int wanted, ff_tasks *tasks,
                       ff_error *error)
{
    for (int i = 0; i < count; ++i)
        s->count += clips[i].actions.count;
    s->wanted = wanted < s->count ? wanted : s->count;
    s->items = ff_calloc((size_t)s->count, sizeof *s->items);
    s->follows = ff_calloc((size_t)s->count * (size_t)s->count, 1);
    if (!s->items || !s->follows)
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory to choose from %d actions", s->count);
    int n = 0;
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < clips[i].actions.count; ++k) {
            candidate *c = &s->items[n++];
            c->action = &clips[i].actions.items[k];
            c->away = 1e9;
            ff_action_mirror(c->action, &c->mirrored);
        }
    ff_tasks_for(tasks, (uint32_t)s->count, 4, find_partners, s);
    n = 0;
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < clips[i].actions.count; ++k, ++n) {
            uint32_t mode = s->items[n].action->record.mode;
            s->items[n].fit = is_fit(&clips[i], &s->items[n]);
            s->items[n].ordinary = mode == FF_MODE_WALK_SHORT || mode == FF_MODE_WALK_LONG;
        }
    return FF_OK;
}

ff_status ff_actions_select(const ff_successor_settings *settings, ff_build_clip *clips, int count,
                            int wanted, ff_tasks *tasks, ff_error *error)
{
    selection s = {.settings = settings};
    ff_status status = begin(&s, clips, count, wanted, tasks, error);
    if (status == FF_OK && s.wanted < s.count) {
        choose_needed(&s);
        choose_covering(&s, s.chosen + (int)(COVER_SHARE * (s.wanted - s.chosen) + 0.5));
        choose_partners(&s);
        int n = 0;
        for (int i = 0; i < count; ++i) {
            int kept = 0;
            for (int k = 0; k < clips[i].actions.count; ++k)
                if (s.items[n++].chosen) clips[i].actions.items[kept++] = clips[i].actions.items[k];
            clips[i].actions.count = kept;
        }
    }
    free(s.items);
    free(s.follows);
    return status;
}
