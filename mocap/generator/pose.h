/* pose.h - from a plan to poses: pelvis, legs, spine, head and arms. */
#ifndef FF_POSE_H
#define FF_POSE_H

#include "mocap/clip.h"
#include "mocap/generator/plan.h"

/* Pose every frame of clip (made by ff_body_clip): frame f is at f * frame_time seconds of the plan. False when memory
 * is short. */
bool ff_pose_clip(const ff_plan *plan, ff_clip *clip);

#endif
