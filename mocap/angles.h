/* angles.h - sines and cosines of half angles, a whole row of a motion file at a time. */
#ifndef FF_ANGLES_H
#define FF_ANGLES_H

#include <stdbool.h>
#include <stddef.h>

enum { FF_ANGLE_BLOCK = 8 };

/* How long arrays of count angles must be: whole blocks. */
static inline size_t ff_angle_room(size_t count)
{
    return (count + FF_ANGLE_BLOCK - 1) / FF_ANGLE_BLOCK * FF_ANGLE_BLOCK;
}

/* sine[i], cosine[i] of angles[i] / 2, the angles in degrees or in radians, |angle| < 1e9. All arrays have
 * ff_angle_room(count) elements and do not overlap; what is in the last ones does not matter. Error below 1e-15
 * (degrees are reduced exactly), the same bits everywhere. */
void ff_half_sincos(const double *angles, size_t count, bool degrees, double *sine, double *cosine);

#endif
