/* glb_surroundings.h - ground, walls and obstacles of a glTF document. */
#ifndef FF_GLB_SURROUNDINGS_H
#define FF_GLB_SURROUNDINGS_H

#include "runtime/export/glb_model.h"
#include "runtime/export/recording.h"
#include "runtime/export/scene.h"

/* A checkered ground of 1 m tiles under everything between low and high, and the scene's walls. */
ff_status ff_glb_add_surroundings(ff_glb_model *model, const ff_scene *scene, ff_vec2 low, ff_vec2 high,
                                  ff_error *error);

/* The scene's obstacles, a node each; those on a path get a channel of the animation, whose keys lie at the recording's
 * poses (accessor `times`). */
ff_status ff_glb_add_obstacles(ff_glb_model *model, const ff_scene *scene, const ff_recording *recording,
                               int animation, int times, ff_error *error);

#endif
