/* foot_lock.h - feet that stand where they landed, and land where the root will want them (synthesis study,
 * section 4): in stance the ball is at its lock; in swing the clip's foot is followed with an offset that leads from
 * the old lock to the new one without a jump in place or speed. */
#ifndef FF_FOOT_LOCK_H
#define FF_FOOT_LOCK_H

#include "runtime/core/gait/gait_sample.h"

/* What a foot needs to know of the moving body. */
typedef struct ff_foot_scene {
    const ff_blend_space *space;
    const ff_blend *blend;
    const ff_cursor *cursor; /* of the blend now */
    ff_vec2 position;        /* root */
    double heading;
    ff_rates rates;        /* of the root now */
    ff_rates acceleration; /* per s, of the rates, smoothed */
    double phase;
    double idle_time;
    double dt;
    double tempo;      /* factor on phase speed, now */
    double goal_tempo; /* ... and soon, */
    double delay;      /* s, that is lost until then */
} ff_foot_scene;

/* Where the root will be after time s if it goes on as it does now: braking to a stop, or speeding up for a while. */
void ff_root_predict(const ff_foot_scene *scene, double time, ff_vec2 *position, double *heading);

/* The clip's foot put into the world, without any lock. */
ff_foothold ff_foot_of_clip(const ff_foot_scene *scene, int foot);

/* Where the foot of a standing body will be, time s from now. */
void ff_foot_neutral(const ff_foot_scene *scene, int foot, double time, ff_foothold *out);

/* 1 for a body at rest, whose steps only close its feet, to 0 for one that walks. */
double ff_foot_closing(ff_rates rates);

/* The foot leaves the ground: the offset it has from the clip's foot starts the swing. Returns how long ago (s), within this
 * step, that was. */
double ff_foot_lift(const ff_foot_scene *scene, ff_gait_foot *state, int foot, double standing);

/* It was at rest and takes up its swing gradually: until then it is between where it stood and the swing's own path. */
bool ff_foot_sets_off(const ff_gait_foot *state);

/* The foot lands and stays. */
void ff_foot_land(ff_gait_foot *state, double ball_rest);

/* One step of a planted foot; standing, 0 to 1, flattens it. */
void ff_foot_hold(const ff_foot_scene *scene, ff_gait_foot *state, int foot, double standing);

/* Where the ball of a planted foot is at its pitch: over the floor by what the heel needs. */
void ff_foot_rest(const ff_body_frame *body, ff_gait_foot *state, int foot);

/* One step of a swing; other is the foot on the ground. Returns true when it is time to land. */
bool ff_foot_swing(const ff_foot_scene *scene, ff_gait_foot *state, const ff_gait_foot *other, int foot);

/* After either, and whatever was added to where the foot is: in swing it goes past the other ankle, not through it, and over the
 * floor. By construction: what it does is no part of the path, which a switch takes over and the next step starts from. */
void ff_foot_keep_clear(const ff_foot_scene *scene, ff_gait_foot *state, const ff_gait_foot *other, int foot);

#endif
