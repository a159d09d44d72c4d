/* foot_signals.h - where heel, ball and toe of one foot are over time, cleaned and at a rate that is fine enough to
 * find foot plants by one set of rules whatever the clip's own rate. Internal to the plant detector.
 */
#ifndef FF_FOOT_SIGNALS_H
#define FF_FOOT_SIGNALS_H

#include "preprocess/plants/plants.h"

/* The three points of a foot that touch the floor. */
enum { FF_FOOT_HEEL, FF_FOOT_BALL, FF_FOOT_TOE, FF_FOOT_POINT_COUNT };

typedef struct ff_foot_signals {
    int count;                           /* working frames: every factor-th one is a frame of the clip */
    int factor;                          /* working frames per clip frame */
    double rate;                         /* Hz, of the working frames */
    ff_vec3 *point[FF_FOOT_POINT_COUNT]; /* m, world, zero-phase low-passed */
    double *speed[FF_FOOT_POINT_COUNT];  /* m/s, in space */
    double *height[FF_FOOT_POINT_COUNT]; /* m over the point's own rest level; set by ff_floor_heights */
    void *memory;
    const ff_plant_settings *settings;
} ff_foot_signals;

/* Read one foot of a clip (frames from clip->rest_frames on), clean it and find its shape (heel and ball, not yet the
 * heights). Fails when the clip lacks the leg's joints. settings are kept. The caller frees *out with
 * ff_foot_signals_free. */
ff_status ff_foot_signals_read(const ff_clip *clip, int foot, const ff_plant_settings *settings,
                               ff_foot_signals *out, ff_foot_shape *shape, ff_error *error);
void ff_foot_signals_free(ff_foot_signals *signals);

#endif
