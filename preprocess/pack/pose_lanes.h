/* pose_lanes.h - a motion as signals over time, one per slot of a stream (pack_format.h), and back. */
#ifndef FF_POSE_LANES_H
#define FF_POSE_LANES_H

#include "preprocess/pack/pose_encode.h"
#include "runtime/core/pack/joints.h"

#define FF_LANES_MAX (4 * FF_JOINT_COUNT + 3)

typedef struct ff_pose_lane {
    int slot;
    bool still;
    double lever;   /* m, root mean square over all joints and points: how far they move per unit */
    double *values; /* [frame_count] */
} ff_pose_lane;

typedef struct ff_pose_lanes {
    ff_pose_lane lane[FF_LANES_MAX];
    int count;
    ff_quat reference[FF_JOINT_COUNT];
    bool whole[FF_JOINT_COUNT]; /* all four parts have lanes */
    double *values;             /* of all lanes */
} ff_pose_lanes;

ff_status ff_pose_lanes_create(const ff_pack_joint *joints, const ff_pack_point *points,
                               const ff_pose_motion *motion, ff_pose_lanes *out, ff_error *error);
void ff_pose_lanes_free(ff_pose_lanes *lanes);

/* What a change of a lane by one does to the pose at a frame, as a share of what it does at the reference. */
double ff_pose_lane_effect(const ff_pose_lanes *lanes, int index, int frame);

/* Pose from one value per lane. */
void ff_pose_lanes_pose(const ff_pose_lanes *lanes, const double *value, ff_vec3 *hips, ff_quat *rotations);

#endif
