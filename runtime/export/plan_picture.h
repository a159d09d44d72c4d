/* plan_picture.h - footprints and plans from above, as Figures 1, 7 and 8 of the footstep planning paper: prints stood on are
 * filled, planned ones are outlines, joined by the way; obstacles and walls. */
#ifndef FF_PLAN_PICTURE_H
#define FF_PLAN_PICTURE_H

#include "runtime/core/base/memory.h"

/* A print that somebody stood on. */
typedef struct ff_stood_print {
    ff_vec2 ball;
    double yaw;
    uint32_t agent, foot;
} ff_stood_print;

/* A shape as it is now: a box with rounded edges, sides before the radius. */
typedef struct ff_drawn_shape {
    ff_vec2 centre;
    double heading, half_length, half_width, radius;
    uint32_t kind; /* ff_obstacle_kind */
} ff_drawn_shape;

/* Everything but texts is ff_array, empty ones are fine. */
typedef struct ff_plan_scene {
    const char *title, *subtitle;
    ff_array stood;   /* ff_stood_print, in order of time */
    ff_array planned; /* ff_stood_print: of the plans in force */
    ff_array bodies;  /* ff_stood_print: roots now, yaw the heading; foot unused */
    ff_array goals;   /* ff_stood_print: place and agent */
    ff_array shapes;  /* ff_drawn_shape */
    ff_array walls;   /* ff_vec2[2] */
} ff_plan_scene;

/* Once per step: what the crowd shows now of some agents. Prints stood on are added, once each, all else is made anew. */
ff_status ff_plan_scene_look(ff_plan_scene *scene, const ff_crowd *crowd, const ff_agent *agents,
                             uint32_t count, ff_error *error);
void ff_plan_scene_free(ff_plan_scene *scene);

/* Several scenes side by side on the same scale, on one sheet. */
ff_status ff_plan_picture_write(const char *path, const ff_plan_scene *scenes, uint32_t count,
                                ff_error *error);

#endif
