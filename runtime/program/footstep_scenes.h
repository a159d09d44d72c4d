/* footstep_scenes.h - Figures 7 and 8 of the footstep planning paper, walked again: two blocks on known paths in front of somebody,
 * and a wall that is moved into somebody's way. */
#ifndef FF_FOOTSTEP_SCENES_H
#define FF_FOOTSTEP_SCENES_H

#include "runtime/export/plan_picture.h"

/* Write both pictures, DIR/fig7.png and DIR/fig8.png. */
ff_status ff_footstep_scenes_draw(const ff_pack *pack, const char *folder, ff_error *error);

#endif
