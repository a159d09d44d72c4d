/* play.h - the animation engine of footsteps: a queue of actions becomes a pose at any time (footstep planning paper,
 * section 6; algorithms B.9).
 *
 * Every action is anchored on its support foot, so footprints are exact by construction and it is the root that jumps, by
 * centimetres, from one to the next. No time is lost for blending: an action begins where the last one ends, and what the
 * two poses differ by is added and fades out (pose_offset.h). Feet that stand, stand; the others are led from where they
 * stood to where the plan wants them.
 */
#ifndef FF_PLAY_H
#define FF_PLAY_H

#include "runtime/core/play/play_set.h"
#include "runtime/core/pose/pose_offset.h"

#define FF_PLAY_STAND 0xffffffffu /* in place of an action: stand where the feet are */
#define FF_PLAY_FOREVER 1e300     /* s, an end that does not come */

/* Where a foot is, in the world. */
typedef struct ff_play_foot {
    double a, b, yaw;
    uint32_t planted, unused; /* 0: in the air; its place says nothing then */
} ff_play_foot;

/* One entry: an action whose frame S0 lies at anchor and heading, from start to end. */
typedef struct ff_play_step {
    double start, end; /* s, absolute */
    /* s, absolute, from when it is played: start, or later for one that takes over in the middle */
    double entered;
    double pace;          /* factor on the action's speed */
    double a, b;          /* m: the support ball (of FF_PLAY_STAND: the root) */
    double heading;       /* rad, of the root at the start */
    ff_play_foot foot[2]; /* as the action begins */
    uint32_t action;
    /* of FF_PLAY_STAND: the action in whose last pose it stands; FF_PLAY_STAND: the idle example's */
    uint32_t last;
} ff_play_step;

/* Plain data, no pointers, no padding. */
typedef struct ff_play {
    /* the one being played, and what follows (one that does not end has nothing after it) */
    ff_play_step step[2];
    double idle_time; /* s, of the idle motion at absolute time 0 */
    double joined;    /* s, absolute: when offset began */
    ff_pose_offset offset;
} ff_play;

/* An action to play: S0 at anchor and heading, from start on, for the action's duration divided by pace. FF_PLAY_STAND: stand
 * from start on as the last one left off; only start counts then. */
typedef struct ff_play_order {
    uint32_t action; /* of the pack */
    uint32_t unused;
    double start, pace;
    ff_vec2 anchor;
    double heading;
} ff_play_order;

/* A pose before the legs are solved to it. */
typedef struct ff_play_targets {
    ff_vec2 root;
    double heading;
    ff_vec3 hips;                      /* world */
    ff_quat rotations[FF_JOINT_COUNT]; /* [0] in the world, the others local */
    ff_vec3 ball[2];                   /* world */
    ff_quat foot[2];                   /* world */
    uint32_t planted[2];
    double grip[2]; /* 1 while planted, fading to 0 after and rising to it before */
} ff_play_targets;

/* Stand in the last pose of an action from time on. idle_time: where in the idle motion (s). */
void ff_play_init(const ff_play_set *set, ff_play *play, const ff_play_order *last, double time,
                  double idle_time);

/* What follows the entry that is being played. It must start when that one ends; one who stands may start at any time from
 * now on. Without an order, and after each one, the body stands. */
void ff_play_next(const ff_play_set *set, ff_play *play, const ff_play_order *order);

/* Begin with an order at time coming from another motion: the feet are where they are, and what was shown, at time and
 * a little later, fades out. */
void ff_play_enter(const ff_play_set *set, ff_play *play, const ff_play_order *order,
                   const ff_play_foot feet[2], const ff_play_targets shown[2], double later, double time,
                   double idle_time);

/* Take over in the middle of the present entry, at time: the order has begun at its own start, which may lie before.
 * FF_PLAY_STAND: stop dead, the foot in the air is put down where it is. */
void ff_play_cut(const ff_play_set *set, ff_play *play, const ff_play_order *order, double time);

/* Time has come to this: entries that are over by then are left, each join at its own moment. Never backwards. */
void ff_play_advance(const ff_play_set *set, ff_play *play, double time);

/* Where the root is and how it is turned, at a time within the present entry; much cheaper than all targets. */
void ff_play_root(const ff_play_set *set, const ff_play *play, double time, ff_vec2 *root, double *heading);

/* At a time within the present entry. */
void ff_play_targets_at(const ff_play_set *set, const ff_play *play, double time, ff_play_targets *out);

/* Pose at a time within the present entry, as ff_gait_pose gives it. */
void ff_play_pose(const ff_play_set *set, const ff_play *play, double time, ff_vec3 *hips,
                  ff_quat *rotations);

/* The join to the present entry at time: what is shown, at time and a little later, fades out of it. */
void ff_play_join(const ff_play_set *set, ff_play *play, const ff_play_targets shown[2], double later,
                  double time);

/* Where the feet are as an entry ends. */
void ff_play_feet_after(const ff_play_set *set, const ff_play_step *step, ff_play_foot feet[2]);

/* When a foot has come to stand where it stands as an entry ends (s, absolute): on its print, and down on the ground. Captured
 * feet are down up to 0.1 s before the entry ends and the next one is begun on them. */
double ff_play_landing(const ff_play_set *set, const ff_play_step *step, int foot);

#endif
