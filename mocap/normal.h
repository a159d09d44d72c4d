/* normal.h - one form for clips of every origin: metres, no rest frames, the skeleton's rest pose facing +Z, and the
 * motion starting over the origin, facing +Z. */
#ifndef FF_NORMAL_H
#define FF_NORMAL_H

#include "mocap/clip.h"

/* Where a body faces: the way left of the line from its right to its left hip and shoulder joints (rad); positions as
 * ff_clip_pose gives them. False when the clip has no hips or the line is upright. */
bool ff_clip_heading(const ff_clip *clip, const ff_vec3 *positions, double *heading);

/* Bring a clip to that form, in place. Every pose stays what it was but for where it is on the ground and faces. */
ff_status ff_clip_normalise(ff_clip *clip, ff_error *error);

#endif
