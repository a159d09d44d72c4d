/* obstacle_outline.h - where a scene's obstacle is at a time, and its outline on the ground, for pictures. */
#ifndef FF_OBSTACLE_OUTLINE_H
#define FF_OBSTACLE_OUTLINE_H

#include "runtime/footfall.h"

/* m, at time (s, of the scene). */
ff_vec2 ff_obstacle_at(const ff_obstacle_def *obstacle, double time);

/* Its outline then, counter-clockwise; rounded corners have four points each. */
enum { FF_OBSTACLE_CORNERS = 16 };
void ff_obstacle_outline(const ff_obstacle_def *obstacle, double time, ff_vec2 out[FF_OBSTACLE_CORNERS]);

#endif
