#include "runtime/core/nav/nav_time.h"

ff_wall ff_wall_between(ff_vec2 from, ff_vec2 to)
{
    ff_vec2 span = ff_sub2(to, from);
    return (ff_wall){from, to, ff_unit2(span), ff_length2(span)};
}

ff_vec2 ff_wall_nearest(const ff_wall *wall, ff_vec2 p)
{
    double s = ff_clamp(ff_dot2(ff_sub2(p, wall->from), wall->along), 0.0, wall->length);
    return ff_madd2(wall->from, wall->along, s);
}

ff_vec2 ff_time_to_disc_gradient(ff_vec2 x, ff_vec2 v, double reach)
{
    double square = ff_dot2(v, v), closing = -ff_dot2(x, v), gap = ff_dot2(x, x) - reach * reach;
    double root = sqrt(ff_max(closing * closing - square * gap, 0.0));
    if (square < 1e-9 || root < 1e-9) return ff_v2(0.0, 0.0);
    ff_vec2 turned = ff_add2(ff_scale2(x, square), ff_scale2(v, closing));
    return ff_scale2(ff_sub2(ff_scale2(turned, 1.0 / root), v), 1.0 / square);
}

/* Contact with the flat side of the wall, which the ends' discs continue. */
static double time_to_side(const ff_wall *wall, ff_vec2 p, ff_vec2 v, double radius, ff_vec2 *gradient)
{
    ff_vec2 normal = ff_left2(wall->along);
    double height = ff_dot2(normal, ff_sub2(p, wall->from));
    if (height < 0.0) normal = ff_scale2(normal, -1.0), height = -height;
    double approach = -ff_dot2(v, normal);
    if (height <= radius || approach < 1e-9) return INFINITY;
    double time = (height - radius) / approach;
    double s = ff_dot2(ff_sub2(ff_madd2(p, v, time), wall->from), wall->along);
    if (s < 0.0 || s > wall->length) return INFINITY;
    *gradient = ff_scale2(normal, 1.0 / approach);
    return time;
}

double ff_time_to_wall(const ff_wall *wall, ff_vec2 p, ff_vec2 v, double radius, ff_vec2 *gradient)
{
    ff_vec2 unused;
    if (!gradient) gradient = &unused;
    ff_vec2 away = ff_sub2(p, ff_wall_nearest(wall, p));
    *gradient = ff_unit2(away);
    if (ff_dot2(away, away) <= radius * radius) return 0.0;
    *gradient = ff_v2(0.0, 0.0);
    double time = time_to_side(wall, p, v, radius, gradient);
    const ff_vec2 ends[2] = {wall->from, wall->to};
    for (int i = 0; i < 2; ++i) {
        ff_vec2 x = ff_sub2(p, ends[i]);
        double to_end = ff_time_to_disc(x, v, radius);
        if (to_end < time) {
            time = to_end;
            *gradient = ff_time_to_disc_gradient(x, v, radius);
        }
    }
    return time;
}
