/* film.h - a contact sheet of a run: the crowd at several times, and one agent's walk from the side, the front and
 * above, so that anyone can see how they walk. */
#ifndef FF_FILM_H
#define FF_FILM_H

#include "runtime/export/recording.h"
#include "runtime/export/scene.h"

ff_status ff_film_write(const char *path, const ff_figure *figure, const ff_scene *scene,
                        const ff_recording *recording, ff_error *error);

#endif
