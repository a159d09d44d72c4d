/* Places and amounts. */
#include "runtime/core/behave/behave.h"

double ff_region_distance(const ff_region *region, ff_vec2 p)
{
    ff_vec2 offset = ff_sub2(p, region->centre);
    if (region->shape == FF_REGION_POINT) return ff_length2(offset);
    if (region->shape == FF_REGION_CIRCLE) return ff_max(0.0, ff_length2(offset) - region->half.a);
    ff_vec2 local = ff_to_frame2(ff_fwd2(region->heading), offset);
    double a = ff_max(0.0, fabs(local.a) - region->half.a), b = ff_max(0.0, fabs(local.b) - region->half.b);
    return sqrt(a * a + b * b);
}

ff_vec2 ff_region_point(const ff_region *region, double margin, ff_random *random)
{
    double x = ff_random_unit(random), y = ff_random_unit(random);
    double a = ff_max(0.0, region->half.a - margin), b = ff_max(0.0, region->half.b - margin);
    if (region->shape == FF_REGION_POINT) return region->centre;
    if (region->shape == FF_REGION_CIRCLE)
        return ff_madd2(region->centre, ff_fwd2(FF_TAU * y - FF_PI), a * sqrt(x));
    ff_vec2 local = ff_v2(a * (2.0 * x - 1.0), b * (2.0 * y - 1.0));
    return ff_add2(region->centre, ff_from_frame2(ff_fwd2(region->heading), local));
}

double ff_amount_draw(const ff_amount *amount, ff_random *random)
{
    if (amount->kind == FF_AMOUNT_UNIFORM) return ff_random_range(random, amount->a, amount->b);
    if (amount->kind == FF_AMOUNT_CONST) return amount->a;
    double deviation = ff_clamp(ff_random_normal(random), -2.0, 2.0);
    return ff_max(0.0, amount->a + amount->b * deviation);
}
