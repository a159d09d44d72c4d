#include "preprocess/actions/successors.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

/* The cost of a joint is the footstep study's (section 4.5), the limits of changes are those of algorithms A.13. */
static const double FEW = 28.0, MANY = 100.0; /* actions */
static const double TURN_BEFORE = 0.6;        /* m/s */
static const double ANYTHING = 1e6;           /* m */

/* Feet count double, the rest of the legs one and a half times (algorithms A.12). */
static double weight(int joint)
{
    if (joint == FF_ROLE_ANKLE_L || joint == FF_ROLE_ANKLE_R || joint == FF_ROLE_BALL_L ||
        joint == FF_ROLE_BALL_R)
        return 2.0;
    return joint >= FF_ROLE_HIP_L ? 1.5 : 1.0;
}

double ff_join_limit(const ff_successor_settings *settings, int actions)
{
    return ff_lerp(settings->few, settings->many, ff_clamp((actions - FEW) / (MANY - FEW), 0.0, 1.0));
}

static bool stands_between(const ff_pack_action *action, const ff_pack_action *next)
{
    return (action->flags & FF_ACTION_TO_STANDING) && (next->flags & FF_ACTION_FROM_STANDING);
}

/* Does next stand on the foot that has landed, or on either where both stand? */
static bool feet_agree(const ff_pack_action *action, const ff_pack_action *next)
{
    bool stays =
        !(action->flags & FF_ACTION_WHOLE); /* else the record does not say where the other foot is */
    return next->support == action->swing || (stays && stands_between(action, next));
}

bool ff_may_follow(const ff_successor_settings *settings, const ff_pack_action *action,
                   const ff_pack_action *next)
{
    if (!feet_agree(action, next)) return false;
    bool run = action->mode == FF_MODE_RUN || next->mode == FF_MODE_RUN;
    if (next->mode == FF_MODE_RUN && action->mode == FF_MODE_IDLE) return false;
    if (stands_between(action, next)) return true; /* speeds and turns of both are over and done with */
    if (next->mode == FF_MODE_TURN && (double)action->speed >= TURN_BEFORE) return false;
    double faster = fabs((double)next->speed - (double)action->speed);
    double turned = fabs((double)next->theta - (double)action->theta);
    return faster <= (run ? settings->run_change : settings->walk_change) &&
           turned <= settings->turn_change * FF_DEG;
}

/* Where the foot that next stands on is, seen from the end of action: nowhere else but where that one's foot landed,
 * unless both stand and next stands on the other one. */
static ff_vec2 anchor(const ff_pack_action *action, const ff_pack_action *next)
{
    if (next->support == action->swing) return ff_v2(0.0, 0.0);
    ff_vec2 landed = ff_v2((double)action->land[0], (double)action->land[1]);
    return ff_scale2(ff_to_frame2(ff_fwd2((double)action->theta), landed), -1.0);
}

double ff_join_distance(const ff_pack_action *action, const ff_action_joins *joins,
                        const ff_pack_action *next, const ff_action_joins *next_joins, double limit)
{
    double all = 0.0, sum = 0.0;
    for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j)
        all += FF_JOIN_FRAMES * weight(j);
    double most = limit * limit * all;
    ff_vec2 origin = anchor(action, next);
    for (int k = 0; k < FF_JOIN_FRAMES && sum <= most; ++k)
        for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j) {
            const float *p = joins->end.at[k][j], *q = next_joins->start.at[k][j];
            double a = (double)p[0] - origin.a - (double)q[0], b = (double)p[1] - origin.b - (double)q[1];
            double y = (double)p[2] - (double)q[2];
            sum += weight(j) * (a * a + b * b + y * y);
        }
    return sqrt(sum / all);
}

/* ---------------------------------------------------------------------------------------------------- the table */

typedef struct table {
    const ff_successor_settings *settings;
    const ff_pack_action *actions;
    const ff_action_joins *joins;
    uint32_t count;
    double limit;
    ff_array *next; /* of each action: ff_pack_successor */
    bool *failed;   /* of each action: out of memory */
} table;

static int by_distance(const void *x, const void *y)
{
    const ff_pack_successor *p = x, *q = y;
    if (p->distance != q->distance) return p->distance < q->distance ? -1 : 1;
    return (p->action > q->action) - (p->action < q->action);
}

static bool add(table *t, uint32_t action, uint32_t next, double distance)
{
    ff_pack_successor *s = ff_array_grow(&t->next[action], 1, sizeof *s);
    if (!s) return false;
    *s = (ff_pack_successor){next, (float)distance, (float)(t->settings->cost * distance)};
    return true;
}

static void sort(ff_array *list)
{
    if (list->count > 1) qsort(list->data, list->count, sizeof(ff_pack_successor), by_distance);
}

/* The nearest action that may follow; strict: by all rules, else by the feet alone. standing: only ones that end in
 * standing. Returns count when there is none. */
static uint32_t nearest(const table *t, uint32_t index, bool strict, bool standing, double *distance)
{
    uint32_t best = t->count;
    *distance = ANYTHING;
    for (uint32_t k = 0; k < t->count; ++k) {
        const ff_pack_action *action = &t->actions[index], *next = &t->actions[k];
        if (standing && !(next->flags & FF_ACTION_TO_STANDING)) continue;
        if (strict ? !ff_may_follow(t->settings, action, next) : !feet_agree(action, next)) continue;
        double d = ff_join_distance(action, &t->joins[index], next, &t->joins[k], *distance);
        if (d < *distance) {
            *distance = d;
            best = k;
        }
    }
    return best;
}

static void find_next(void *context, uint32_t index)
{
    table *t = context;
    const ff_pack_action *action = &t->actions[index];
    for (uint32_t k = 0; k < t->count && !t->failed[index]; ++k) {
        if (!ff_may_follow(t->settings, action, &t->actions[k])) continue;
        double d = ff_join_distance(action, &t->joins[index], &t->actions[k], &t->joins[k], t->limit);
        if (d <= t->limit && !add(t, index, k, d)) t->failed[index] = true;
    }
    for (int strict = 1; strict >= 0 && t->next[index].count == 0 && !t->failed[index]; --strict) {
        double d;
        uint32_t best = nearest(t, index, strict, false, &d);
        if (best < t->count && !add(t, index, best, d)) t->failed[index] = true;
    }
    sort(&t->next[index]);
}

static bool has_standing_next(const table *t, uint32_t index)
{
    const ff_pack_successor *next = t->next[index].data;
    for (size_t i = 0; i < t->next[index].count; ++i)
        if (t->actions[next[i].action].flags & FF_ACTION_TO_STANDING) return true;
    return false;
}

/* Who walks can stand within two actions. */
static void let_stop(void *context, uint32_t index)
{
    table *t = context;
    uint32_t mode = t->actions[index].mode;
    if (mode != FF_MODE_WALK_SHORT && mode != FF_MODE_WALK_LONG && mode != FF_MODE_START) return;
    const ff_pack_successor *next = t->next[index].data;
    bool stops = has_standing_next(t, index);
    for (size_t i = 0; i < t->next[index].count && !stops; ++i)
        stops = has_standing_next(t, next[i].action);
    if (stops) return;
    double d;
    uint32_t best = nearest(t, index, false, true, &d);
    if (best == t->count) return;
    if (!add(t, index, best, d)) t->failed[index] = true;
    sort(&t->next[index]);
}

static ff_status collect(const table *t, ff_pack_content *content, ff_error *error)
{
    ff_pack_action *actions = content->actions.data;
    for (uint32_t i = 0; i < t->count; ++i) {
        size_t count = t->next[i].count;
        actions[i].first_successor = (uint32_t)content->successors.count;
        actions[i].successor_count = (uint32_t)count;
        ff_pack_successor *out = ff_array_grow(&content->successors, count, sizeof *out);
        if (t->failed[i] || (count > 0 && !out))
            return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for what may follow %u actions", t->count);
        if (count > 0) memcpy(out, t->next[i].data, count * sizeof *out);
    }
    return FF_OK;
}

ff_status ff_pack_add_successors(ff_pack_content *content, const ff_successor_settings *settings,
                                 ff_tasks *tasks, ff_error *error)
{
    table t = {.settings = settings,
               .actions = content->actions.data,
               .joins = content->joins.data,
               .count = (uint32_t)content->actions.count};
    if (t.count == 0) return FF_OK;
    int own = 0;
    for (uint32_t i = 0; i < t.count; ++i)
        own += !(t.actions[i].flags & FF_ACTION_MIRRORED);
    t.limit = ff_join_limit(settings, own);
    t.next = ff_calloc(t.count, sizeof *t.next);
    t.failed = ff_calloc(t.count, sizeof *t.failed);
    ff_status status = FF_OK;
    if (t.next && t.failed) {
        ff_tasks_for(tasks, t.count, 8, find_next, &t);
        /* One after the other: each looks at the lists of others. */
        for (uint32_t i = 0; i < t.count; ++i)
            let_stop(&t, i);
        status = collect(&t, content, error);
    } else
        status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for what may follow %u actions", t.count);
    for (uint32_t i = 0; t.next && i < t.count; ++i)
        ff_array_free(&t.next[i]);
    free(t.next);
    free(t.failed);
    return status;
}
