/* nav_density.h - the speed that the space ahead allows (Narang et al. 2015 with the parameters of Menge's PedVO;
 * algorithms C.4). */
#ifndef FF_NAV_DENSITY_H
#define FF_NAV_DENSITY_H

#include "runtime/core/base/maths.h"

#define FF_DENSITY_AHEAD 1.0 /* m, from the walker to the critical point */
#define FF_DENSITY_REACH 4.5 /* m from the critical point: three deviations, beyond it nobody counts */

/* What somebody at offset from the critical point adds to the linear density (1/m); ahead = unit walking
 * direction. */
double ff_density_of_agent(ff_vec2 offset, ff_vec2 ahead);

/* What a wall adds whose nearest point to the critical point is at offset from it. */
double ff_density_of_wall(ff_vec2 offset);

/* Highest speed at linear density rho (1/m): stride length grows with the square root of speed. */
double ff_density_speed(double rho, double beta);

#endif
