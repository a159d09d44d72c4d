#include "runtime/core/nav/nav_density.h"

#define PEAK 0.26596152026762179 /* 1 / (1.5 sqrt(2 pi)), 1/m */
#define DEVIATION 1.5            /* m, along the way */
#define ACROSS 2.5               /* how much narrower the kernel is across */
#define WALL_DEVIATION 0.75      /* m */
#define BODY_WIDTH 0.48          /* m */
#define STRIDE 1.57              /* stride factor alpha */
#define AVAILABLE_MAX 100.0      /* m */

double ff_density_of_agent(ff_vec2 offset, ff_vec2 ahead)
{
    double along = ff_dot2(offset, ahead), across = ACROSS * ff_det2(ahead, offset);
    double square = along * along + across * across;
    if (square > FF_DENSITY_REACH * FF_DENSITY_REACH) return 0.0;
    return PEAK * ff_exp(-square / (2.0 * DEVIATION * DEVIATION));
}

double ff_density_of_wall(ff_vec2 offset)
{
    return PEAK * ff_exp(-ff_dot2(offset, offset) / (2.0 * WALL_DEVIATION * WALL_DEVIATION));
}

double ff_density_speed(double rho, double beta)
{
    double available = rho > BODY_WIDTH / AVAILABLE_MAX ? BODY_WIDTH / rho : AVAILABLE_MAX;
    double root = available * STRIDE / (0.5 * (1.0 + beta));
    return root * root;
}
