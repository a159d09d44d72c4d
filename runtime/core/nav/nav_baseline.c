#include "runtime/core/nav/nav_baseline.h"

#include "runtime/core/nav/nav_forces.h"

#define FORCE_MAX 20.0 /* m/s^2 */
#define START 0.1 /* m/s, above the idle threshold of the body: from rest, one step asks for less than that */

ff_vec2 ff_nav_orca(const ff_nav_view *view, ff_vec2 preferred)
{
    ff_constraints lines;
    ff_circle circle = {ff_v2(0.0, 0.0), view->speed_max};
    ff_nav_add_walls(view, &lines);
    ff_nav_add_movers(view, 0.0, &lines);
    ff_nav_add_agents(view, (ff_avoiding){0}, &lines);
    return ff_nav_solve(&lines, circle, circle, preferred);
}

ff_vec2 ff_nav_social_force(const ff_nav_view *view, ff_vec2 preferred)
{
    ff_vec2 v = view->me->velocity;
    ff_vec2 drive = ff_scale2(ff_sub2(preferred, v), 1.0 / FF_RELAXATION);
    ff_vec2 force = ff_add2(drive, ff_nav_forces(view, FORCE_MAX, FORCE_MAX));
    ff_vec2 next = ff_shorten2(ff_madd2(v, force, view->world->step), view->speed_max);
    double speed = ff_length2(next);
    /* Study 8: at small steps nobody who stands would ever start. */
    if (speed < START && speed > 0.0 && ff_length2(preferred) > START) next = ff_scale2(next, START / speed);
    return next;
}
