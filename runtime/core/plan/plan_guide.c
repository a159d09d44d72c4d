#include "runtime/core/plan/plan_guide.h"

static const double BODY =
    0.1; /* m: on the field's way, which keeps its own clearance, one sees past corners */
static const double APART = 0.7; /* m: corners that are nearer to each other are one */

/* The corners on the field's way from start: each the furthest place on it that is seen from the one before. */
static uint32_t find_corners(const ff_field *field, const ff_solids *solids, ff_vec2 start, ff_vec2 *corners)
{
    enum { PATH = 160 };
    ff_vec2 path[PATH], from = start;
    uint32_t count = ff_field_path(field, start, path, PATH), at = 0, n = 0;
    while (at < count && n < FF_GUIDE_VIAS) {
        uint32_t last = at;
        while (last + 1 < count && (ff_solids_clear(solids, from, path[last + 1], BODY) ||
                                    ff_length2(ff_sub2(path[last], from)) < APART))
            ++last;
        if (last + 1 == count) break; /* the goal itself is seen */
        from = corners[n++] = path[last];
        at = last + 1;
    }
    return n;
}

/* J/kg at least to a place from a walk along a heading: the best that any walking action can do. */
static float from_a_walk(const ff_guide *guide, const ff_action_set *set, ff_vec2 along, ff_vec2 to)
{
    float least = INFINITY, distance = (float)ff_length2(to);
    for (uint32_t i = 0; guide->reach && i < set->count; ++i) {
        const ff_set_action *a = &set->actions[i];
        if (a->kind != FF_CLASS_WALK || (a->flags & FF_SET_REACTIVE)) continue;
        float beyond;
        const uint16_t *cell = ff_guide_cell(guide, (float)to.a, (float)to.b, distance, (float)along.a,
                                             (float)along.b, a, &beyond);
        float cost = guide->unit * (float)*cell + beyond;
        least = cost < least ? cost : least;
    }
    return least < INFINITY ? least - set->stop_cost : 0.0f;
}

/* What is left from each corner on: the turn at it and the way to the next one, and so on. */
static void price_corners(ff_guide *guide, const ff_action_set *set, ff_vec2 start, const ff_vec2 *corners,
                          uint32_t count, ff_vec2 goal)
{
    float beyond = 0.0f;
    guide->via_count = count;
    for (uint32_t i = count; i-- > 0;) {
        ff_vec2 before = i > 0 ? corners[i - 1] : start, after = i + 1 < count ? corners[i + 1] : goal;
        float left = (float)ff_field_distance(guide->field, corners[i]);
        float turned = beyond + from_a_walk(guide, set, ff_unit2(ff_sub2(corners[i], before)),
                                            ff_sub2(after, corners[i]));
        float straight = (left - guide->radius) * guide->rate;
        beyond = turned > straight ? turned : straight;
        ff_vec2 place = ff_sub2(corners[i], guide->origin);
        guide->via[i] = (ff_guide_goal){.at = {(float)place.a, (float)place.b},
                                        .beyond = beyond,
                                        .nearer = set->stop_cost,
                                        .field = left};
    }
}

ff_guide ff_guide_make(const ff_action_set *set, const ff_solids *solids, const ff_plan_goal *goal,
                       ff_vec2 start, ff_vec2 origin, bool table)
{
    float wider = (float)goal->radius - FF_REACH_RADIUS;
    ff_guide guide = {.reach = table ? set->reach : NULL,
                      .field = goal->field,
                      .origin = origin,
                      .radius = (float)goal->radius,
                      .rate = set->rate,
                      .unit = FF_REACH_UNIT * set->reach_share,
                      .goal = {.at = {(float)(goal->at.a - origin.a), (float)(goal->at.b - origin.b)},
                               .stand = goal->stand,
                               .nearer = (wider > 0.0f ? wider * set->rate : 0.0f) +
                                         (goal->stand ? 0.0f : set->stop_cost)}};
    if (guide.field && solids) {
        ff_vec2 corners[FF_GUIDE_VIAS];
        uint32_t count = find_corners(guide.field, solids, start, corners);
        price_corners(&guide, set, start, corners, count, goal->at);
    }
    return guide;
}
