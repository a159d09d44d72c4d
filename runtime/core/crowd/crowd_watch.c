/* crowd_watch.c - tracks beside what moves in ways that no plan knows. */
#include "runtime/core/crowd/crowd_footsteps.h"
#include "runtime/core/plan/plan_solids.h"

bool ff_track_meets(const ff_track *track, double from, double seconds, const ff_shape *shape,
                    ff_vec2 velocity, double margin, double *when)
{
    ff_solid solid = ff_solid_of_shape(shape);
    int64_t first = (int64_t)floor(from / FF_TRACK_STEP);
    int64_t last = (int64_t)floor((from + seconds) / FF_TRACK_STEP);
    ff_vec2 moved = ff_scale2(velocity, FF_TRACK_STEP);
    for (int64_t k = first; k <= last; ++k) {
        int64_t i = k - track->first, end = (int64_t)track->count - 1;
        int64_t now = i < 0 ? 0 : (i > end ? end : i), next = i < 0 ? 0 : (i + 1 > end ? end : i + 1);
        solid.centre = ff_madd2(shape->centre, velocity, (double)k * FF_TRACK_STEP - from);
        if (!ff_solid_hit(&solid, moved, track->origin, &track->knots[now], &track->knots[next], track->radii,
                          margin))
            continue;
        if (when) *when = ff_max((double)k * FF_TRACK_STEP, from);
        return true;
    }
    return false;
}

ff_bounds ff_track_bounds(const ff_track *track)
{
    ff_bounds all = FF_BOUNDS_NONE;
    for (uint32_t c = 0; c < ff_track_rooms(track); ++c) {
        const ff_track_room *room = &track->room[c];
        all.low = ff_v2(ff_min(all.low.a, (double)room->low_a), ff_min(all.low.b, (double)room->low_b));
        all.high = ff_v2(ff_max(all.high.a, (double)room->high_a), ff_max(all.high.b, (double)room->high_b));
    }
    return (ff_bounds){ff_add2(all.low, track->origin), ff_add2(all.high, track->origin)};
}
