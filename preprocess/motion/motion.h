/* motion.h - a clip on the pack's skeleton (the rig): root ground frame, hips and joint rotations. Everything after
 * the foot plants works on this form, so it sees one skeleton, one facing and a level floor at y = 0.
 */
#ifndef FF_MOTION_H
#define FF_MOTION_H

#include "mocap/clip.h"
#include "preprocess/base/stage_settings.h"
#include "preprocess/plants/plants.h"

/* Points of a posed body: the roles, then both heels. */
enum { FF_BODY_HEEL_L = FF_ROLE_COUNT, FF_BODY_HEEL_R, FF_BODY_COUNT };

/* The pack's skeleton. In its rest pose all global rotations are the identity: facing +Z, arms out, legs straight
 * down, feet flat, soles at y = 0; left-right symmetric. */
typedef struct ff_rig {
    ff_vec3 offset[FF_BODY_COUNT]; /* m, from the parent role; HIPS: (0, rest height, 0) */
    double leg;                    /* m, thigh + shank */
} ff_rig;

/* Frame k is frame k of the clip; leading rest frames of the file hold the first real pose instead. */
typedef struct ff_motion {
    int frame_count;
    double frame_time; /* s: the clip's own */
    double scale; /* rig leg over the clip's own leg: what positions in the clip's world were multiplied by */
    ff_vec3 *root;      /* [frame_count] x = a (m), y = b (m), z = heading (rad, unwrapped) */
    ff_vec3 *hips;      /* [frame_count] x = forward, y = left of the root, z = height (m) */
    ff_quat *rotations; /* [frame_count][FF_ROLE_JOINT_COUNT] local; joint 0 relative to the root's heading */
} ff_motion;

/* Median of the clips' own proportions, made symmetric. */
ff_status ff_rig_from_clips(const ff_clip *const *clips, int clip_count, ff_rig *out, ff_error *error);

/* Where the points of the standing rig are, [FF_BODY_COUNT]. */
void ff_rig_rest_pose(const ff_rig *rig, ff_vec3 *positions);
/* Points [FF_BODY_COUNT] from the position of the hips and world rotations [FF_ROLE_JOINT_COUNT]. */
void ff_rig_pose(const ff_rig *rig, ff_vec3 hips, const ff_quat *world, ff_vec3 *positions);

/* The same from a root ground frame (a, b, heading), hips and local rotations as an ff_motion holds them. */
void ff_rig_pose_local(const ff_rig *rig, ff_vec3 root, ff_vec3 hips, const ff_quat *local,
                       ff_vec3 *positions);

/* Bring a clip onto the rig: limb directions copied by role (smallest rotation between rest directions), root path
 * scaled by leg length, floor levelled by the plants' plane, planted balls at the rig's rest height. Root frame as algorithms A.4: hips low-passed twice over
 * 0.25 s, facing from hips and shoulders. The caller frees *out with ff_motion_free. */
ff_status ff_motion_from_clip(const ff_rig *rig, const ff_clip *clip, const ff_plants *plants, ff_motion *out,
                              ff_error *error);
/* A motion of zeroed frames, scale 1. */
ff_status ff_motion_alloc(ff_motion *motion, int frames, double frame_time, ff_error *error);
void ff_motion_free(ff_motion *motion);

/* World positions [FF_BODY_COUNT] of one frame (world = the clip's, floor at y = 0); rotations may be NULL or
 * receives the world rotations [FF_ROLE_JOINT_COUNT]. */
void ff_motion_pose(const ff_rig *rig, const ff_motion *motion, int frame, ff_vec3 *positions,
                    ff_quat *rotations);

/* Root, hips and local rotations [FF_ROLE_JOINT_COUNT] between frames (any of them may be NULL); frame is clamped. */
void ff_motion_sample(const ff_motion *motion, double frame, ff_vec3 *root, ff_vec3 *hips,
                      ff_quat *rotations);

ff_status ff_motion_copy(const ff_motion *motion, ff_motion *out, ff_error *error);

/* A pose relative to its root with left and right exchanged: hips, and local rotations [FF_ROLE_JOINT_COUNT]. from and to
 * are not the same array. */
void ff_pose_mirror(const ff_vec3 *hips, const ff_quat *from, ff_vec3 *out, ff_quat *to);

/* The same motion with left and right exchanged (algorithms A.8). */
ff_status ff_motion_mirror(const ff_motion *motion, ff_motion *out, ff_error *error);

#endif
