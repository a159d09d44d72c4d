/* pose_distance.h - how far two moments of two cycles are apart (Kovar et al. 2002; algorithms A.12): clouds of body
 * points over a short window, laid on each other by a turn and a shift on the ground. */
#ifndef FF_POSE_DISTANCE_H
#define FF_POSE_DISTANCE_H

#include "preprocess/examples/example.h"

#define FF_WINDOW 9                 /* poses of a window ... */
#define FF_WINDOW_STEP (1.0 / 30.0) /* ... s apart: 0.3 s, the middle one is the moment itself */
#define FF_CLOUD_MAX (FF_WINDOW * FF_ROLE_JOINT_COUNT)
#define FF_MAP_SIDE 64 /* moments per cycle of a distance map */

/* Points of a body over a cycle whose root moves at constant rates. */
typedef struct ff_point_cycle {
    int frame_count, point_count;
    double period;         /* s */
    ff_vec2 velocity;      /* of the root in its own frame, m/s */
    double turn;           /* rad/s */
    ff_vec3 *points;       /* [frame_count][point_count] in the root's frame: x left, y up, z forward */
    const double *weights; /* [point_count] */
} ff_point_cycle;

/* The joints of an example; feet count double, legs one and a half. The caller frees with ff_point_cycle_free. */
ff_status ff_point_cycle_from_example(const ff_rig *rig, const ff_example *example, ff_point_cycle *out,
                                      ff_error *error);
void ff_point_cycle_free(ff_point_cycle *cycle);

/* Points around a phase (any number; its fraction counts), [FF_WINDOW][point_count], in the root's frame at that
 * phase; slopes (or NULL) receives their change per cycle of phase. Smooth in phase. */
void ff_cycle_window(const ff_point_cycle *cycle, double phase, ff_vec3 *points, ff_vec3 *slopes);

/* How the second cloud is laid on the first: turned, then shifted (a forward, b left). */
typedef struct ff_alignment {
    double turn;
    ff_vec2 shift;
} ff_alignment;

ff_vec3 ff_aligned(const ff_alignment *alignment, ff_vec3 point);

/* The best alignment of count points; weights repeat after period of them. */
ff_alignment ff_cloud_align(const ff_vec3 *first, const ff_vec3 *second, const double *weights, int period,
                            int count);

/* Root of the weighted mean square distance (m) under an alignment; weights NULL = all alike. */
double ff_cloud_distance(const ff_vec3 *first, const ff_vec3 *second, const double *weights, int period,
                         int count, const ff_alignment *alignment);

/* Windows of a cycle at FF_MAP_SIDE phases with the sums the map needs. */
typedef struct ff_map_windows {
    int point_count; /* of one window, all its poses */
    double total;    /* weight */
    ff_vec3 *points; /* [FF_MAP_SIDE][point_count], each times the root of its weight */
    ff_vec3 *sums;   /* [FF_MAP_SIDE] of weight * point */
    double *spread;  /* [FF_MAP_SIDE] of weight * |point|^2 */
    double *roots;   /* [point_count] of the weights */
} ff_map_windows;

ff_status ff_map_windows_make(const ff_point_cycle *cycle, ff_map_windows *out, ff_error *error);
void ff_map_windows_free(ff_map_windows *windows);

/* Distances after alignment, [FF_MAP_SIDE (first)][FF_MAP_SIDE (second)], m. Both have the same points and weights. */
void ff_distance_map(const ff_map_windows *first, const ff_map_windows *second, double *map);

#endif
