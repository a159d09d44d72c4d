/* metrics.h - figures that judge a crowd, as pure functions of its recorded paths. */
#ifndef FF_METRICS_H
#define FF_METRICS_H

#include "runtime/core/base/memory.h"
#include "runtime/export/recording.h"

/* Smallest distance of two discs' centres while their relative position goes from p to p + v in a straight line.
 * FbCrowd's equation 16 prints |p|^2 where the minimiser needs |v|^2 and does not clamp: both are put right. */
double ff_closest_distance(ff_vec2 p, ff_vec2 v);

/* Equation 17: 0 = apart or touching, 1 = centres met. */
double ff_penetration(double distance, double radius_sum);

/* Collisions of a whole run. */
typedef struct ff_collisions {
    uint32_t agent_count;
    double sum;           /* of penetrations over pairs and steps */
    uint64_t agent_steps; /* agents present, summed over steps: T * N when nobody leaves */
    double deepest;       /* m, of any pair at any time */
    uint64_t pairs;       /* different pairs that were ever deeper than FF_OVERLAP_LEAST */
    uint8_t *seen;        /* one bit per pair counted */
} ff_collisions;

#define FF_OVERLAP_LEAST 0.01 /* m */

ff_status ff_collisions_create(uint32_t agents, ff_collisions *out, ff_error *error);
void ff_collisions_free(ff_collisions *collisions);
/* One interval: tracks at its two ends (agents absent from either are left out). */
void ff_collisions_add(ff_collisions *collisions, const ff_track *before, const ff_track *after,
                       const double *radii);
double ff_collision_rate(const ff_collisions *collisions); /* C of equation 17, per agent and step */

/* Mean |dv| / dt (equation 18) over points [0, count) of one path, velocities being taken over `window` steps: 1 =
 * raw, one step of walking (0.5 s) = without the sway of the gait. Where both velocities are below still (m/s), nobody goes anywhere, and
 * nothing is counted. Adds to *sum and *terms. */
void ff_acceleration_add(const ff_vec2 *points, size_t count, size_t window, double step, double still,
                         double *sum, uint64_t *terms);

/* Quantile q in [0, 1] of values, linear between neighbours; sorts values. 0 when there are none. */
double ff_quantile(double *values, size_t count, double q);

#endif
