/* film_walk.h - the walk of a recording's first agent: two gait cycles from the side, the front and above, and when each foot
 * is planted. */
#ifndef FF_FILM_WALK_H
#define FF_FILM_WALK_H

#include "runtime/export/picture.h"
#include "runtime/export/recording.h"

#define FF_FILM_WIDTH 2000 /* pixels */

int ff_film_walk_height(void); /* pixels */

/* Onto a picture FF_FILM_WIDTH wide, from line top on; name says who walks. A run of one step has no walk, and leaves the
 * picture as it is. */
ff_status ff_film_walk_draw(ff_picture *picture, const ff_figure *figure, const ff_recording *recording,
                            const char *name, int top, ff_error *error);

/* A picture of nothing else, as PNG. */
ff_status ff_film_walk_write(const char *path, const ff_figure *figure, const ff_recording *recording,
                             const char *name, ff_error *error);

#endif
