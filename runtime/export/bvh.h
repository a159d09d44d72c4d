/* bvh.h - one agent's motion as BVH: metres, Y up, rotations in the order Z X Y, rest pose with arms out. */
#ifndef FF_EXPORT_BVH_H
#define FF_EXPORT_BVH_H

#include "runtime/export/recording.h"

ff_status ff_recording_write_bvh(const char *path, const ff_figure *figure, const ff_recording *recording,
                                 uint32_t agent, ff_error *error);

#endif
