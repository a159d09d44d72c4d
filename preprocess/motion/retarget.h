/* retarget.h - how the joints of one clip's skeleton turn those of the rig.
 *
 * Rotations are carried over by role: world rotation on the rig = world rotation in the clip * align. For a joint with
 * a clear bone, align is the smallest rotation from the rig's rest direction to the clip's rest direction (cleanup
 * study, section 1); trunk and head keep their rotation relative to the clip's rest pose. Feet are levelled by the
 * foot shape the plants were found with. A file whose identity pose is no standing person (Maya joint axes, as in
 * the Bandai-Namco files) is calibrated on its own motion instead.
 */
#ifndef FF_RETARGET_H
#define FF_RETARGET_H

#include "preprocess/motion/motion.h"

typedef struct ff_retarget {
    int joint[FF_ROLE_COUNT]; /* of the clip, -1 = the clip has none: it moves with its parent */
    ff_quat align[FF_ROLE_JOINT_COUNT];
    ff_vec3 toes[2]; /* in the ball joint's frame: along the foot when the foot is flat */
    double scale;    /* rig leg / clip leg */
} ff_retarget;

/* Fails with FF_ERR_NO_DATA when hips, a knee or an ankle is missing. */
ff_status ff_retarget_begin(const ff_rig *rig, const ff_clip *clip, const ff_plants *plants, ff_retarget *out,
                            ff_error *error);

/* One frame: position of the hips in the clip's world times scale (floor not yet taken off) and world rotations
 * [FF_ROLE_JOINT_COUNT]. The middle of the hip joints is where the clip has it. */
void ff_retarget_pose(const ff_retarget *retarget, const ff_rig *rig, const ff_clip *clip, int frame,
                      ff_vec3 *hips, ff_quat *world);

/* Does the identity pose of the file show a standing person? positions [joint_count] receives that pose; heading
 * where it faces. joint as in ff_retarget. */
bool ff_rest_is_standing(const ff_clip *clip, const int *joint, ff_vec3 *positions, double *heading);

/* Thigh + shank, mean of both sides (m), from bone lengths; 0 when a joint is missing. */
double ff_clip_leg_length(const int *joint, const ff_vec3 *positions);

#endif
