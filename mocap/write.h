/* write.h - clips out, as BVH and as ASF with AMC. Lengths are written in the clip's unit_m (metres when that is 0);
 * files are written whole or not at all. Reading them back gives positions within 1e-4 m. */
#ifndef FF_WRITE_H
#define FF_WRITE_H

#include "mocap/clip.h"

/* Rotations as Z X Y angles; joints with a position track get six channels, end sites none. */
ff_status ff_bvh_write(const char *path, const ff_clip *clip, ff_error *error);

/* The clip must have one root, a position track on the root only, and every child of a joint where that joint's bone
 * ends (ASF knows no other skeletons): a joint with children in several places gets a rigid bone to each. Frames are
 * numbered from first_frame, 1 when that is 0. */
ff_status ff_asf_amc_write(const char *asf_path, const char *amc_path, const ff_clip *clip, ff_error *error);

#endif
