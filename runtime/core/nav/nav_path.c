#include "runtime/core/nav/nav_path.h"

#define SIDE 0.37   /* m from the root: elbows and hands, with a little room */
#define STRIDE 0.15 /* m more before and behind, where feet are of who walks */
#define BRISK 1.2   /* m/s, from which steps are that long */
#define CORE 0.30   /* m: less than that nobody has, however near they are already */

/* How far a body reaches towards n (unit) that moves at a velocity. */
static double extent(ff_vec2 velocity, ff_vec2 n)
{
    double speed = ff_length2(velocity);
    if (speed < 1e-6) return SIDE;
    double along = ff_dot2(velocity, n) / speed;
    return SIDE + STRIDE * along * along * ff_min(speed / BRISK, 1.0);
}

ff_vec2 ff_path_at(const ff_path *path, double time)
{
    double k = ff_clamp(time / FF_PATH_STEP, 0.0, FF_PATH_POINTS - 1.0);
    int i = (int)ff_min(floor(k), FF_PATH_POINTS - 2.0);
    return ff_madd2(path->at[i], ff_sub2(path->at[i + 1], path->at[i]), k - i);
}

ff_path_meeting ff_path_meet(const ff_path *path, const ff_seen *me, double ahead)
{
    ff_path_meeting out = {.time = INFINITY};
    ff_vec2 from = ff_madd2(me->position, me->velocity, ahead), start = ff_path_at(path, ahead);
    double least = INFINITY, nearest = ahead, end = FF_PATH_STEP * (FF_PATH_POINTS - 1);
    out.to_other = ff_sub2(start, from);
    for (double t = ahead; t <= end && out.time == INFINITY; t += 0.5 * FF_PATH_STEP) {
        ff_vec2 there = ff_path_at(path, t), x = ff_sub2(there, ff_madd2(from, me->reference, t - ahead)),
                n = ff_unit2(x);
        ff_vec2 theirs =
            ff_scale2(ff_sub2(ff_path_at(path, t + FF_PATH_STEP), ff_path_at(path, t - FF_PATH_STEP)),
                      0.5 / FF_PATH_STEP);
        double reach = extent(me->reference, n) + extent(theirs, n), gap = ff_length2(x) - reach;
        if (gap >= least) continue;
        least = gap;
        nearest = t;
        out.reach = reach;
        if (gap < 0.0) out.time = t;
    }
    double since = ff_max(nearest - ahead, FF_PATH_STEP);
    out.velocity = ff_scale2(ff_sub2(ff_path_at(path, ahead + since), start), 1.0 / since);
    /* Who is nearer than that already is not pushed away, but comes no nearer. */
    out.reach = ff_clamp(ff_length2(out.to_other) - 1e-3, 2.0 * CORE, out.reach);
    return out;
}
