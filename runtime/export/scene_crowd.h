/* scene_crowd.h - a crowd as a scene says. */
#ifndef FF_SCENE_CROWD_H
#define FF_SCENE_CROWD_H

#include "runtime/export/scene.h"

/* The definition that a scene's crowd is created with; *behaviour is filled in and used by it, and points into the scene. */
ff_crowd_def ff_scene_crowd_def(const ff_scene *scene, ff_behaviour_def *behaviour);

/* Put in everybody who is there at the start, and the walls. Agent i of the scene gets number i. */
ff_status ff_scene_populate(const ff_scene *scene, ff_crowd *crowd, ff_error *error);

#endif
