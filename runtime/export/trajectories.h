/* trajectories.h - everybody's path from above, as FbCrowd's Figure 7. */
#ifndef FF_TRAJECTORIES_H
#define FF_TRAJECTORIES_H

#include "runtime/export/recording.h"
#include "runtime/export/scene.h"

ff_status ff_trajectories_write(const char *path, const ff_scene *scene, const ff_recording *recording,
                                ff_error *error);

#endif
