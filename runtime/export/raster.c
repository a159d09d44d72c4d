#include "runtime/export/raster.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define NEAREST 0.05 /* m: triangles nearer to a perspective eye are left out */

static const ff_vec3 light_fall = {0.35, -1.0, 0.28}; /* direction of the light that casts shadows, world */

ff_camera ff_camera_look(ff_vec3 eye, ff_vec3 target, ff_vec3 up, bool perspective)
{
    ff_vec3 forward = ff_unit3(ff_sub3(target, eye));
    ff_vec3 right = ff_unit3(ff_cross3(forward, up));
    return (ff_camera){.eye = eye,
                       .right = right,
                       .up = ff_cross3(right, forward),
                       .forward = forward,
                       .perspective = perspective,
                       .scale = 1.0};
}

ff_pixel ff_camera_project(const ff_camera *camera, ff_vec3 point, double *depth)
{
    ff_vec3 seen = ff_sub3(point, camera->eye);
    double x = ff_dot3(seen, camera->right), y = ff_dot3(seen, camera->up),
           z = ff_dot3(seen, camera->forward);
    double scale = camera->perspective ? camera->scale / ff_max(z, NEAREST) : camera->scale;
    if (depth) *depth = z;
    return (ff_pixel){camera->centre_x + scale * x, camera->centre_y - scale * y};
}

ff_status ff_raster_create(int width, int height, ff_raster *out, ff_error *error)
{
    size_t pixels = (size_t)width * (size_t)height;
    *out = (ff_raster){.width = width, .height = height};
    out->rgb = ff_calloc(pixels, 3);
    out->depth = ff_calloc(pixels, sizeof *out->depth);
    out->shadow = ff_calloc(pixels, 1);
    if (out->rgb && out->depth && out->shadow) return FF_OK;
    ff_raster_destroy(out);
    return ff_fail(error, FF_ERR_NO_MEMORY, "no memory to draw %d x %d pixels", width, height);
}

void ff_raster_destroy(ff_raster *raster)
{
    free(raster->rgb);
    free(raster->depth);
    free(raster->shadow);
    memset(raster, 0, sizeof *raster);
}

static uint8_t mix(uint8_t low, uint8_t high, double t)
{
    return (uint8_t)(ff_lerp(low, high, t) + 0.5);
}

void ff_raster_clear(ff_raster *raster, ff_colour top, ff_colour bottom)
{
    for (int y = 0; y < raster->height; ++y) {
        double t = raster->height > 1 ? (double)y / (raster->height - 1) : 0.0;
        uint8_t line[3] = {mix(top.r, bottom.r, t), mix(top.g, bottom.g, t), mix(top.b, bottom.b, t)};
        for (int x = 0; x < raster->width; ++x)
            memcpy(raster->rgb + 3 * ((size_t)y * (size_t)raster->width + (size_t)x), line, 3);
    }
    size_t pixels = (size_t)raster->width * (size_t)raster->height;
    for (size_t i = 0; i < pixels; ++i)
        raster->depth[i] = -1e30f;
    memset(raster->shadow, 0, pixels);
}

/* ------------------------------------------------------------------------------------------ triangles */

typedef struct corner {
    double x, y, nearness;
    double colour[3]; /* of no matter where only a shadow is cast */
} corner;

typedef enum fill { FILL_SHADED, FILL_FLAT, FILL_SHADOW } fill;

static void put(ff_raster *raster, size_t pixel, double nearness, const double colour[3], fill how)
{
    if (how == FILL_SHADOW) {
        raster->shadow[pixel] = 1;
        return;
    }
    if (how == FILL_SHADED && (float)nearness <= raster->depth[pixel]) return;
    if (how == FILL_SHADED) raster->depth[pixel] = (float)nearness;
    for (int k = 0; k < 3; ++k)
        raster->rgb[3 * pixel + (size_t)k] = (uint8_t)ff_clamp(colour[k] + 0.5, 0.0, 255.0);
}

static void fill_triangle(ff_raster *raster, const corner *a, const corner *b, const corner *c, fill how)
{
    double area = (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
    if (!(fabs(area) > 1e-9)) return;
    double low_x = ff_min(a->x, ff_min(b->x, c->x)), high_x = ff_max(a->x, ff_max(b->x, c->x));
    double low_y = ff_min(a->y, ff_min(b->y, c->y)), high_y = ff_max(a->y, ff_max(b->y, c->y));
    int x0 = (int)ceil(ff_clamp(low_x - 0.5, 0.0, raster->width));
    int x1 = (int)floor(ff_clamp(high_x - 0.5, -1.0, raster->width - 1));
    int y0 = (int)ceil(ff_clamp(low_y - 0.5, 0.0, raster->height));
    int y1 = (int)floor(ff_clamp(high_y - 0.5, -1.0, raster->height - 1));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            double px = x + 0.5, py = y + 0.5;
            double u = ((b->x - px) * (c->y - py) - (b->y - py) * (c->x - px)) / area;
            double v = ((c->x - px) * (a->y - py) - (c->y - py) * (a->x - px)) / area;
            double w = 1.0 - u - v;
            if (u < 0.0 || v < 0.0 || w < 0.0) continue;
            double colour[3];
            for (int k = 0; k < 3; ++k)
                colour[k] = u * a->colour[k] + v * b->colour[k] + w * c->colour[k];
            put(raster, (size_t)y * (size_t)raster->width + (size_t)x,
                u * a->nearness + v * b->nearness + w * c->nearness, colour, how);
        }
}

static bool to_corner(const ff_camera *camera, ff_vec3 position, corner *out)
{
    double depth;
    ff_pixel p = ff_camera_project(camera, position, &depth);
    *out =
        (corner){.x = p.x, .y = p.y, .nearness = camera->perspective ? 1.0 / ff_max(depth, NEAREST) : -depth};
    return !camera->perspective || depth > NEAREST;
}

/* Sky light from above, a key light over the viewer's left shoulder, and a paler rim. */
static void shade(const ff_camera *camera, const ff_shaded_vertex *vertex, double colour[3])
{
    ff_vec3 key = ff_unit3(
        ff_madd3(ff_madd3(ff_scale3(camera->forward, -0.6), camera->right, -0.5), ff_v3(0.0, 1.0, 0.0), 0.7));
    double lit = ff_max(0.0, 0.25 + 0.75 * ff_dot3(vertex->normal, key));
    double sky = 0.5 + 0.5 * vertex->normal.y;
    double facing = fabs(ff_dot3(vertex->normal, camera->forward));
    double rim = (1.0 - facing) * (1.0 - facing) * 0.10;
    double light = 0.30 + 0.20 * sky + 0.62 * lit;
    const double base[3] = {vertex->colour.r, vertex->colour.g, vertex->colour.b};
    for (int k = 0; k < 3; ++k)
        colour[k] = base[k] * light + 255.0 * rim * sky;
}

void ff_raster_mesh(ff_raster *raster, const ff_camera *camera, const ff_shaded_vertex *vertices,
                    const uint32_t (*triangles)[3], size_t count)
{
    for (size_t t = 0; t < count; ++t) {
        corner corners[3];
        bool seen = true;
        for (int k = 0; k < 3; ++k) {
            const ff_shaded_vertex *vertex = &vertices[triangles[t][k]];
            seen = to_corner(camera, vertex->position, &corners[k]) && seen;
        }
        if (!seen) continue;
        /* Pixels' y points down, so what is counter-clockwise in space has a negative area here. */
        double area = (corners[1].x - corners[0].x) * (corners[2].y - corners[0].y) -
                      (corners[1].y - corners[0].y) * (corners[2].x - corners[0].x);
        if (area >= 0.0) continue;
        for (int k = 0; k < 3; ++k)
            shade(camera, &vertices[triangles[t][k]], corners[k].colour);
        fill_triangle(raster, &corners[0], &corners[1], &corners[2], FILL_SHADED);
    }
}

void ff_raster_ground(ff_raster *raster, const ff_camera *camera, const ff_vec3 *corners, int count,
                      ff_colour colour)
{
    corner ring[8];
    for (int i = 0; i < count && i < 8; ++i) {
        if (!to_corner(camera, corners[i], &ring[i])) return;
        ring[i].colour[0] = colour.r;
        ring[i].colour[1] = colour.g;
        ring[i].colour[2] = colour.b;
    }
    for (int i = 2; i < count && i < 8; ++i)
        fill_triangle(raster, &ring[0], &ring[i - 1], &ring[i], FILL_FLAT);
}

void ff_raster_shadow(ff_raster *raster, const ff_camera *camera, const ff_shaded_vertex *vertices,
                      const uint32_t (*triangles)[3], size_t count)
{
    for (size_t t = 0; t < count; ++t) {
        corner corners[3];
        bool seen = true;
        for (int k = 0; k < 3; ++k) {
            ff_vec3 p = vertices[triangles[t][k]].position;
            ff_vec3 fallen = ff_madd3(p, light_fall, ff_max(p.y, 0.0) / -light_fall.y);
            seen = to_corner(camera, ff_v3(fallen.x, 0.0, fallen.z), &corners[k]) && seen;
        }
        if (seen) fill_triangle(raster, &corners[0], &corners[1], &corners[2], FILL_SHADOW);
    }
}

void ff_raster_darken(ff_raster *raster)
{
    size_t pixels = (size_t)raster->width * (size_t)raster->height;
    for (size_t i = 0; i < pixels; ++i) {
        if (!raster->shadow[i]) continue;
        for (size_t k = 0; k < 3; ++k)
            raster->rgb[3 * i + k] = (uint8_t)(raster->rgb[3 * i + k] * 0.80);
        raster->shadow[i] = 0;
    }
}
