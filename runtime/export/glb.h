/* glb.h - a whole run as glTF: every agent an animated person, ground, walls and obstacles; metres, Y up.
 *
 * One body, whose vertices all agents share; per agent a skeleton of nodes, a skin that names them (inverse bind
 * matrices are shared too), and channels of one animation: hips translation, and rotations as normalised int16. A
 * joint that never moves gets no channel.
 */
#ifndef FF_GLB_H
#define FF_GLB_H

#include "runtime/export/recording.h"
#include "runtime/export/scene.h"

ff_status ff_glb_write(const char *path, const ff_figure *figure, const ff_scene *scene,
                       const ff_recording *recording, ff_error *error);

#endif
