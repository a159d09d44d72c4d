/* pack_fill.h - from what was found in the clips to the records of a pack. */
#ifndef FF_PACK_FILL_H
#define FF_PACK_FILL_H

#include "preprocess/build/build.h"
#include "preprocess/build/build_clip.h"
#include "preprocess/examples/examples.h"
#include "runtime/core/base/tasks.h"

/* Joints and points of the rig. */
ff_status ff_pack_add_rig(ff_pack_content *content, const ff_rig *rig, ff_error *error);
/* Examples with their streams and feet, the simplices of each gait and the velocity hull. Must come before clips. */
ff_status ff_pack_add_examples(ff_pack_content *content, const ff_example_set *set, ff_error *error);
/* Clips with streams, tracks, plants and actions; then the mirrored actions of all. */
ff_status ff_pack_add_clips(ff_pack_content *content, const ff_build_clip *clips, int count, double rate,
                            ff_error *error);
/* Provenance: versions, settings, clips, what was rejected and skipped. */
ff_status ff_pack_add_meta(ff_pack_content *content, const ff_build_settings *settings,
                           const ff_build_clip *clips, int count, const ff_build_clip *skipped,
                           int skipped_count, const ff_example_set *set, ff_error *error);

/* How they were closed, when to pass from one to another, the semi-procedural clip and the limits of sharp turns; after
 * the examples. */
ff_status ff_pack_add_gait(ff_pack_content *content, const ff_correspondence_settings *settings,
                           const ff_rig *rig, const ff_example_set *set, ff_tasks *tasks, ff_error *error);

/* How large the colliders are (m), and, from that, the coarse radius of every action; after the clips. */
ff_status ff_pack_set_collider_radii(ff_pack_content *content, const double radii[FF_COLLIDER_COUNT],
                                     ff_error *error);

/* A character's surface at three levels of detail, the thickness of its bones and the size of its colliders; after the rig
 * and the clips. */
ff_status ff_pack_add_skin(ff_pack_content *content, const ff_skin_settings *settings, const ff_rig *rig,
                           const char *path, const ff_load_options *options, ff_error *error);

#endif
