/* pose_offset.h - from one motion to another without a jump: what the two differ by at the switch is added to the new
 * motion and fades out within FF_POSE_OFFSET_TIME (inertialised transition; synthesis study, section 6).
 *
 * Taken up are the hips, the upper body and where the feet are meant to be. Leg joints are not: they are solved to hips and
 * feet, and a planted foot stays at its lock whatever was played before. One motion is evaluated after the switch, not two.
 */
#ifndef FF_POSE_OFFSET_H
#define FF_POSE_OFFSET_H

#include "runtime/core/base/maths.h"
#include "runtime/core/joints.h"

#define FF_POSE_OFFSET_TIME 0.3                  /* s */
enum { FF_POSE_OFFSET_JOINTS = FF_JOINT_HIP_L }; /* joints 0 to 12: hips, spine, head, arms */

/* A foot in the root's frame: where the ball shall be (m), the foot's yaw from the root's heading and pitch, toes up + (rad). */
typedef struct ff_pose_foot {
    double forward, left, height, yaw, pitch;
} ff_pose_foot;

/* What a motion makes of the body at one moment, in the frame of the root. */
typedef struct ff_pose_targets {
    ff_vec3 hips; /* m: forward, left, up from the ground */
    ff_quat turn
        [FF_POSE_OFFSET_JOINTS]; /* unit; [0] from the root's heading, the others local to their parents */
    ff_pose_foot foot[2];        /* left, right */
} ff_pose_targets;

/* Plain data, no padding: may be hashed and saved as bytes. All zero: nothing to add. */
typedef struct ff_pose_offset {
    double left;         /* s, until nothing is left; 0: nothing is */
    float hips[2][3];    /* the difference at the switch, m, and its change then, m/s */
    float foot[2][2][5]; /* per foot the same: forward, left, height (m), yaw, pitch (rad) */
    float turn[2][FF_POSE_OFFSET_JOINTS][3]; /* rotation vectors in the parent's frame, rad and rad/s */
} ff_pose_offset;

/* A switch: old_now was shown last (with whatever offset it had), new_now is what the new motion has at the same moment.
 * The _later ones are both a short time h (s) later, from which the speeds follow. */
void ff_pose_offset_begin(ff_pose_offset *offset, const ff_pose_targets *old_now,
                          const ff_pose_targets *old_later, const ff_pose_targets *new_now,
                          const ff_pose_targets *new_later, double h);

/* dt seconds pass. */
void ff_pose_offset_advance(ff_pose_offset *offset, double dt);

static inline bool ff_pose_offset_active(const ff_pose_offset *offset)
{
    return offset->left > 0.0;
}

/* What is to be added now to hips and to a foot (0 left, 1 right), and joint's rotation with its offset (joint below
 * FF_POSE_OFFSET_JOINTS). Pure. */
ff_vec3 ff_pose_offset_hips(const ff_pose_offset *offset);
ff_pose_foot ff_pose_offset_foot(const ff_pose_offset *offset, int foot);
ff_quat ff_pose_offset_turn(const ff_pose_offset *offset, int joint, ff_quat rotation);

/* All of it, added to targets. */
void ff_pose_offset_apply(const ff_pose_offset *offset, ff_pose_targets *targets);

#endif
