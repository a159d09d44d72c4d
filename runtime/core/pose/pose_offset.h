/* pose_offset.h - from one motion to another without a jump: what the two differ by at the switch is added to the new
 * motion and fades out within FF_POSE_OFFSET_TIME (inertialised transition; synthesis study, section 6).
 *
 * Taken up are the hips, the joints and where the feet are meant to be. The legs' joints count only as far as they tell the
 * IK which way a knee and a foot in the air are turned: where a foot is, is the lock's and the foot target's affair, and a
 * planted one stays where it is whatever was played before. One motion is evaluated after the switch, not two.
 */
#ifndef FF_POSE_OFFSET_H
#define FF_POSE_OFFSET_H

#include "runtime/core/base/maths.h"
#include "runtime/core/pack/joints.h"

#define FF_POSE_OFFSET_TIME 0.3 /* s */

/* A foot in the root's frame: where the ball shall be (m), the foot's yaw from the root's heading and pitch, toes up +
 * (rad). */
typedef struct ff_pose_foot {
    double forward, left, height, yaw, pitch;
} ff_pose_foot;

/* What a motion makes of the body at one moment, in the frame of the root. */
typedef struct ff_pose_targets {
    ff_vec3 hips;                 /* m: forward, left, up from the ground */
    ff_quat turn[FF_JOINT_COUNT]; /* unit; [0] from the root's heading, the others local to their parents */
    ff_pose_foot foot[2];         /* left, right */
} ff_pose_targets;

/* A switch from old to new. The poses _later are those a short time (s) after those _now, from which the speeds follow.
 * The old ones are what was shown, with whatever offset there was. A foot that lands within FF_POSE_OFFSET_TIME must have
 * got rid of its offset by then: until tells when each foot shall. */
typedef struct ff_pose_switch {
    const ff_pose_targets *old_now, *old_later, *new_now, *new_later;
    double later;
    double until[2];
    /* On the ground in both: it may neither rise nor sink, so what its height and pitch differ by only shrinks, however
     * fast it came down. */
    bool stands[2];
} ff_pose_switch;

/* Plain data, no padding: may be hashed and saved as bytes. All zero: nothing to add. */
typedef struct ff_pose_offset {
    double age; /* s, since the switch */
    /* s, until nothing is left: of hips, trunk and arms; of either foot; of the legs' joints */
    float time[4];
    float hips[2][3];                 /* the difference at the switch, m, and its change then, m/s */
    float foot[2][2][5];              /* per foot the same: forward, left, height (m), yaw, pitch (rad) */
    float turn[2][FF_JOINT_COUNT][3]; /* rotation vectors in the parent's frame, rad and rad/s */
    float late[FF_ARM_JOINTS];        /* s, by which ff_arm_joints are behind in this (ff_pose_offset_hold) */
} ff_pose_offset;

void ff_pose_offset_begin(ff_pose_offset *offset, const ff_pose_switch *change);

/* dt seconds pass. */
void ff_pose_offset_advance(ff_pose_offset *offset, double dt);

/* For ff_arm_joints[arm], after ff_pose_offset_advance: its fade waits, as far as that helps, where it would turn the joint by
 * more than `most` (rad) in these dt seconds. The motion's own rotation of the joint was before and is now. Arms carry nothing,
 * so they may take their time; a fade that is as long for everybody turns them too quickly whenever the new motion swings
 * them the same way. */
void ff_pose_offset_hold(ff_pose_offset *offset, int arm, ff_quat before, ff_quat now, double most,
                         double dt);

/* rad/s, how fast the fade turns ff_arm_joints[arm] now. */
double ff_pose_offset_speed(const ff_pose_offset *offset, int arm);

static inline bool ff_pose_offset_active(const ff_pose_offset *offset)
{
    return offset->time[0] > 0.0f;
}

/* What is to be added now to hips and to a foot (0 left, 1 right), and a joint's rotation with its offset. Pure. */
ff_vec3 ff_pose_offset_hips(const ff_pose_offset *offset);
ff_pose_foot ff_pose_offset_foot(const ff_pose_offset *offset, int foot);
ff_quat ff_pose_offset_turn(const ff_pose_offset *offset, int joint, ff_quat rotation);

/* All of it, added to targets. */
void ff_pose_offset_apply(const ff_pose_offset *offset, ff_pose_targets *targets);

#endif
