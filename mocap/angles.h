/* angles.h - sines and cosines of half angles, a whole row of a motion file at a time. */
#ifndef FF_ANGLES_H
#define FF_ANGLES_H

#include <stdbool.h>
#include <stddef.h>

/* sine[i], cosine[i] of angles[i] / 2, the angles in degrees or in radians, |angle| < 1e9. Error below 1e-15 (degrees
 * are reduced exactly), the same bits everywhere. */
void ff_half_sincos(const double *angles, size_t count, bool degrees, double *sine, double *cosine);

#endif
