/* roles_find.h - which joint of a clip plays which role: by its name, else by the shape of the skeleton, and what the
 * caller says overrides both. */
#ifndef FF_ROLES_FIND_H
#define FF_ROLES_FIND_H

#include "mocap/load.h"

/* Set the role of every joint of a clip (metres or file units, Y up). Fails only for an override that names no joint. */
ff_status ff_roles_find(ff_clip *clip, const ff_role_override *overrides, int override_count,
                        ff_error *error);

/* Steps of the above, in the order they are taken. Each only adds roles that are not given yet. */
void ff_roles_by_name(ff_clip *clip);
void ff_roles_by_shape(ff_clip *clip);
void ff_roles_complete(
    ff_clip *clip); /* spine, chest, neck, tips: from the joints between and behind the others */

/* Hips, and hip, knee and ankle on both sides: without them a clip is of no use. The error names what is missing. */
ff_status ff_roles_require(const ff_clip *clip, ff_error *error);

/* The frame by which shapes are judged: the first that is motion. */
static inline int ff_clip_typical_frame(const ff_clip *clip)
{
    return clip->rest_frames < clip->frame_count ? clip->rest_frames : 0;
}

#endif
