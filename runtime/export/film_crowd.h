/* film_crowd.h - the crowd from an oblique camera. */
#ifndef FF_FILM_CROWD_H
#define FF_FILM_CROWD_H

#include "runtime/export/stage.h"

/* Whether everybody's paths lie in a strip that a wide picture suits. */
bool ff_film_crowd_is_long(const ff_recording *recording);

/* Side of the tiles on the ground, m. */
double ff_film_crowd_tile(const ff_recording *recording);

/* A camera that sees everybody present in a recorded pose, on pictures of width x height pixels. It looks the same way
 * at all times. */
ff_camera ff_film_crowd_camera(const ff_recording *recording, uint32_t pose, int width, int height);

/* Everybody present in a recorded pose, with ground, walls and shadows. */
void ff_film_crowd_draw(ff_stage *stage, const ff_scene *scene, const ff_recording *recording, uint32_t pose,
                        const ff_camera *camera, ff_raster *raster);

#endif
