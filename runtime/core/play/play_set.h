/* play_set.h - the pack's actions, made ready to be played: where in its stream each one is, and when and where either
 * foot stands still in it. Immutable; one for a whole crowd. */
#ifndef FF_PLAY_SET_H
#define FF_PLAY_SET_H

#include "runtime/core/gait/blend.h"

#define FF_PLAY_SETTLE                                                                                       \
    0.25 /* s, in which a foot that has left its place, and comes to no other, takes to the clip's way */
enum { FF_PLAY_STANCES = 6 }; /* of one foot in one action: a jump or a turn has a few */

/* The ball of a foot stands still, seen from frame S0 of the action (pack_format.h). */
typedef struct ff_play_stance {
    double from,
        to;      /* s from t_0; from <= 0: it stands when the action begins, to >= duration: when it ends */
    double down; /* s, not before from: since when it lies on the ground, as it does at the end */
    double a, b; /* m */
    double yaw;  /* rad, of the foot */
    double over[2]; /* m, that it must be put down by (play_pose.c) as it comes down and as it leaves */
    ff_vec2 off[2],
        speed[2]; /* m, m/s: how far off its place the clip's ball is at either end, and how it moves then */
} ff_play_stance;

typedef struct ff_play_action {
    double start, duration; /* s, in the stream */
    ff_vec2 origin;         /* of S0, in the stream's world (the mirror image's, where it is mirrored) */
    double heading;
    double level;              /* m, of the support plant over the clip's floor */
    uint32_t stream, mirrored; /* for ff_pack_sample */
    uint32_t support, idle;    /* foot; 1: only stands */
    uint32_t stance_count[2];
    ff_play_stance stance[2][FF_PLAY_STANCES]; /* in order of time */
} ff_play_action;

/* One action of a pack, whose body is given. */
void ff_play_action_make(const ff_pack *pack, const ff_body_frame *body, uint32_t index, ff_play_action *out);

/* When and where its feet stand (play_stance.c), all else of action given. */
void ff_play_find_stances(const ff_pack *pack, const ff_body_frame *body, const ff_pack_action *record,
                          ff_play_action *action);

typedef struct ff_play_set {
    const ff_pack *pack;
    const ff_blend_space *space; /* for standing, and the skeleton */
    ff_play_action *actions;     /* [pack->action_count] */
} ff_play_set;

/* space must be made of the pack and outlive the set, as must the pack. */
ff_status ff_play_set_create(const ff_pack *pack, const ff_blend_space *space, ff_play_set **out,
                             ff_error *error);
void ff_play_set_destroy(ff_play_set *set); /* NULL is fine */

/* A moment of an action seen from S0: time in s from t_0; before 0 and beyond the duration the clip goes on as long as it
 * lasts. */
typedef struct ff_play_sample {
    ff_vec2 root;
    double heading;
    ff_vec3 hips;                      /* plane and height, as ff_ground() gives them */
    ff_quat rotations[FF_JOINT_COUNT]; /* joint 0 in S0, the others local */
    ff_vec3 ball[2];
    ff_quat foot[2]; /* rotation of the ankle joint in S0 */
} ff_play_sample;

void ff_play_sample_at(const ff_play_set *set, uint32_t action, double time, ff_play_sample *out);

/* The same of one action that belongs to no set. */
void ff_play_action_sample(const ff_pack *pack, const ff_body_frame *body, const ff_play_action *action,
                           double time, ff_play_sample *out);

/* The root alone, seen from S0. */
ff_root_frame ff_play_root_at(const ff_play_set *set, uint32_t action, double time);

/* Which way a foot points: square to its side, which tells of one on tiptoe as well. */
double ff_play_foot_yaw(ff_quat rotation);

/* How high a foot is over the ground on which it is to stand, m. */
typedef struct ff_play_over {
    double heel; /* below 0 under the ground */
    double toes; /* >= 0: the ball over the heel (or over the ground, if the heel is under it) */
    double sole; /* >= 0: the whole foot; 0 where the heel is well up, as when it rolls off its toes */
} ff_play_over;
ff_play_over ff_play_over_ground(const ff_body_frame *body, int foot, double ball_height, ff_quat rotation);

#endif
