/* raster.h - a small software renderer: shaded triangles with a depth buffer, and their shadows on the ground. */
#ifndef FF_RASTER_H
#define FF_RASTER_H

#include "runtime/core/base/maths.h"
#include "runtime/export/picture.h"

/* Where the eye is and how metres become pixels: x = centre_x + scale * right / depth (perspective; right and depth in
 * the camera's frame) or centre_x + scale * right (parallel). */
typedef struct ff_camera {
    ff_vec3 eye, right, up, forward; /* unit, at right angles */
    bool perspective;
    double scale, centre_x, centre_y; /* pixels */
} ff_camera;

/* Looking from eye at target, y up on the picture (z when looking straight down). */
ff_camera ff_camera_look(ff_vec3 eye, ff_vec3 target, ff_vec3 up, bool perspective);
/* Pixel and depth (m along the view) of a point. Depth <= 0 in perspective is behind the eye. */
ff_pixel ff_camera_project(const ff_camera *camera, ff_vec3 point, double *depth);

typedef struct ff_raster {
    int width, height;
    uint8_t *rgb;
    float *depth;    /* 1 / depth (perspective) or -depth (parallel): larger is nearer */
    uint8_t *shadow; /* 1 where the ground is in shadow */
} ff_raster;

ff_status ff_raster_create(int width, int height, ff_raster *out, ff_error *error);
void ff_raster_destroy(ff_raster *raster);
void ff_raster_clear(ff_raster *raster, ff_colour top, ff_colour bottom); /* vertical shading */

typedef struct ff_shaded_vertex {
    ff_vec3 position, normal;
    ff_colour colour;
} ff_shaded_vertex;

/* Draw triangles lit by a high light from the upper left behind the eye. */
void ff_raster_mesh(ff_raster *raster, const ff_camera *camera, const ff_shaded_vertex *vertices,
                    const uint32_t (*triangles)[3], size_t count);
/* A flat polygon on the ground in one colour, unlit (at most 8 corners, convex). */
void ff_raster_ground(ff_raster *raster, const ff_camera *camera, const ff_vec3 *corners, int count,
                      ff_colour colour);
/* Mark the shadow of a mesh on the ground (call after drawing the ground, before the meshes); then darken once. */
void ff_raster_shadow(ff_raster *raster, const ff_camera *camera, const ff_shaded_vertex *vertices,
                      const uint32_t (*triangles)[3], size_t count);
void ff_raster_darken(ff_raster *raster);

#endif
