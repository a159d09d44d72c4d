#include "preprocess/examples/hull.h"

#include "runtime/core/base/maths.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>

ff_vec2 ff_hull_velocity(double speed, double turn_rate)
{
    return ff_scale2(ff_fwd2(ff_clamp(turn_rate, -FF_PI, FF_PI)), speed);
}

int ff_hull_of_velocities(const ff_vec2 *velocities, int count, ff_vec2 *out)
{
    int *corner = ff_calloc((size_t)(count > 0 ? count : 0), sizeof *corner);
    if (!corner) return -1;
    int corners = ff_hull_find(velocities, count, corner);
    for (int i = 0; i < corners; ++i)
        out[i] = velocities[corner[i]];
    free(corner);
    if (corners < 0 || corners >= 3) return corners;
    double fastest = 0.0;
    for (int i = 0; i < count; ++i)
        fastest = ff_max(fastest, ff_length2(velocities[i]));
    const ff_vec2 box[4] = {
        {0.0, -0.3 * fastest}, {fastest, -0.3 * fastest}, {fastest, 0.3 * fastest}, {0.0, 0.3 * fastest}};
    for (int i = 0; i < 4; ++i)
        out[i] = box[i];
    return 4;
}
