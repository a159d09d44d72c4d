#include "runtime/export/glb_surroundings.h"

#include "runtime/core/base/fail.h"
#include "runtime/export/glb_parts.h"
#include "runtime/export/look.h"
#include "runtime/export/obstacle_outline.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct sheet {
    ff_array positions, normals, triangles;
    bool failed;
} sheet;

/* A flat four-sided piece, corners counter-clockwise seen from where normal points. */
static void add_piece(sheet *s, const ff_vec3 corners[4], ff_vec3 normal)
{
    uint32_t first = (uint32_t)s->positions.count;
    float(*p)[3] = ff_array_grow(&s->positions, 4, sizeof *p);
    float(*n)[3] = ff_array_grow(&s->normals, 4, sizeof *n);
    uint32_t(*t)[3] = ff_array_grow(&s->triangles, 2, sizeof *t);
    s->failed = s->failed || !p || !n || !t;
    if (s->failed) return;
    for (int c = 0; c < 4; ++c) {
        p[c][0] = (float)corners[c].x, p[c][1] = (float)corners[c].y, p[c][2] = (float)corners[c].z;
        n[c][0] = (float)normal.x, n[c][1] = (float)normal.y, n[c][2] = (float)normal.z;
    }
    t[0][0] = first, t[0][1] = first + 1, t[0][2] = first + 2;
    t[1][0] = first, t[1][1] = first + 2, t[1][2] = first + 3;
}

/* The pieces as a node of their own, if there are any; *node may be NULL. */
static ff_status add_sheet(ff_glb_model *model, sheet *s, const char *name, ff_colour colour, int both_sides,
                           int *node, ff_error *error)
{
    if (!s->failed && s->positions.count > 0) {
        ff_glb_primitive primitive = {.joints = -1, .weights = -1};
        primitive.positions =
            ff_glb_add_vectors(model, (const float(*)[3])s->positions.data, s->positions.count, true);
        primitive.normals =
            ff_glb_add_vectors(model, (const float(*)[3])s->normals.data, s->normals.count, false);
        primitive.indices =
            ff_glb_add_indices(model, (const uint32_t(*)[3])s->triangles.data, s->triangles.count);
        primitive.material = ff_glb_add_paint(model, name, colour, both_sides);
        int mesh = ff_glb_add_mesh(model, name, &primitive, 1);
        int made = ff_glb_add_node(model, name, -1, ff_v3(0.0, 0.0, 0.0));
        ff_glb_set_mesh(model, made, mesh, -1);
        if (node) *node = made;
    }
    ff_status status = s->failed ? ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the %s", name) : FF_OK;
    ff_array_free(&s->positions);
    ff_array_free(&s->normals);
    ff_array_free(&s->triangles);
    return status;
}

/* Tiles of one colour between two corners given in tiles. */
static void add_tiles(sheet *s, const int low[2], const int high[2], double tile, int odd)
{
    for (int z = low[0]; z < high[0]; ++z)
        for (int x = low[1]; x < high[1]; ++x) {
            if (((x + z) & 1) != odd) continue;
            const ff_vec3 corners[4] = {ff_v3(x * tile, 0.0, z * tile), ff_v3(x * tile, 0.0, (z + 1) * tile),
                                        ff_v3((x + 1) * tile, 0.0, (z + 1) * tile),
                                        ff_v3((x + 1) * tile, 0.0, z * tile)};
            add_piece(s, corners, ff_v3(0.0, 1.0, 0.0));
        }
}

ff_status ff_glb_add_surroundings(ff_glb_model *model, const ff_scene *scene, ff_vec2 low, ff_vec2 high,
                                  ff_error *error)
{
    double tile = ff_ground_tile(high.a - low.a, high.b - low.b);
    const int first[2] = {(int)floor(low.a / tile), (int)floor(low.b / tile)};
    const int last[2] = {(int)ceil(high.a / tile), (int)ceil(high.b / tile)};
    static const ff_colour colours[2] = {{206, 204, 198}, {188, 187, 182}};
    for (int odd = 0; odd < 2; ++odd) {
        sheet tiles = {0};
        add_tiles(&tiles, first, last, tile, odd);
        ff_status status = add_sheet(model, &tiles, "ground", colours[odd], 0, NULL, error);
        if (status != FF_OK) return status;
    }
    sheet walls = {0};
    for (uint32_t i = 0; i < ff_scene_wall_count(scene); ++i) {
        const ff_scene_wall *wall = &ff_scene_walls(scene)[i];
        ff_vec2 normal = ff_left2(ff_unit2(ff_sub2(wall->q, wall->p)));
        const ff_vec3 corners[4] = {ff_ground(wall->p, 0.0), ff_ground(wall->q, 0.0), ff_ground(wall->q, 1.0),
                                    ff_ground(wall->p, 1.0)};
        add_piece(&walls, corners, ff_ground(ff_scale2(normal, -1.0), 0.0));
    }
    return add_sheet(model, &walls, "walls", (ff_colour){150, 146, 140}, 1, NULL, error);
}

/* A convex lid on an outline of an even count of corners, in pieces that share its first one. */
static void add_lid(sheet *s, const ff_vec2 *outline, int count, double height, bool top)
{
    for (int c = 1; c + 2 < count; c += 2) {
        ff_vec2 first = outline[top ? c : c + 2], last = outline[top ? c + 2 : c];
        const ff_vec3 corners[4] = {ff_ground(outline[0], height), ff_ground(first, height),
                                    ff_ground(outline[c + 1], height), ff_ground(last, height)};
        add_piece(s, corners, ff_v3(0.0, top ? 1.0 : -1.0, 0.0));
    }
}

/* The outline around the obstacle's own middle, so that the node's place is the obstacle's; without the corners that fall
 * together where it is not rounded (12 are left of a disc, 14 of a capsule, 4 of a box). */
static int own_outline(const ff_obstacle_def *obstacle, ff_vec2 out[FF_OBSTACLE_CORNERS])
{
    ff_obstacle_def here = *obstacle;
    here.kind = FF_OBSTACLE_STATIC;
    here.position = ff_v2(0.0, 0.0);
    ff_vec2 all[FF_OBSTACLE_CORNERS];
    ff_obstacle_outline(&here, 0.0, all);
    int count = 0;
    for (int c = 0; c < FF_OBSTACLE_CORNERS; ++c) {
        ff_vec2 before = all[(c + FF_OBSTACLE_CORNERS - 1) % FF_OBSTACLE_CORNERS];
        if (ff_length2(ff_sub2(all[c], before)) > 1e-6) out[count++] = all[c];
    }
    return count;
}

static void add_solid(sheet *s, const ff_obstacle_def *obstacle)
{
    ff_vec2 outline[FF_OBSTACLE_CORNERS];
    int count = own_outline(obstacle, outline);
    double low = ff_max(obstacle->low, 0.0), high = obstacle->high;
    for (int c = 0; c < count; ++c) {
        ff_vec2 p = outline[c], q = outline[(c + 1) % count];
        const ff_vec3 corners[4] = {ff_ground(p, low), ff_ground(q, low), ff_ground(q, high),
                                    ff_ground(p, high)};
        add_piece(s, corners, ff_ground(ff_scale2(ff_left2(ff_unit2(ff_sub2(q, p))), -1.0), 0.0));
    }
    add_lid(s, outline, count, high, true);
    if (low > 0.0) add_lid(s, outline, count, low, false);
}

static ff_status add_way(ff_glb_model *model, const ff_obstacle_def *obstacle, const ff_recording *recording,
                         int animation, int node, int times, ff_error *error)
{
    uint32_t count = recording->pose_count;
    float(*places)[3] = ff_calloc(count, sizeof *places);
    if (!places) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for an obstacle's way");
    for (uint32_t k = 0; k < count; ++k) {
        ff_vec2 at = ff_obstacle_at(obstacle, recording->start + k * ff_recording_pose_step(recording));
        ff_vec3 place = ff_ground(at, 0.0);
        places[k][0] = (float)place.x, places[k][2] = (float)place.z;
    }
    int view = ff_glb_add_view(model, places, count * sizeof *places, 0, FF_GLB_DATA);
    int values = ff_glb_add_accessor(model, view, 0, FF_GLB_F32, 0, 3, count, NULL, NULL);
    ff_glb_add_channel(model, animation, node, FF_GLB_TRANSLATION, times, values, 0);
    free(places);
    return FF_OK;
}

ff_status ff_glb_add_obstacles(ff_glb_model *model, const ff_scene *scene, const ff_recording *recording,
                               int animation, int times, ff_error *error)
{
    const ff_obstacle_def *obstacles = scene->obstacles.data;
    ff_status status = FF_OK;
    for (size_t i = 0; i < scene->obstacles.count && status == FF_OK; ++i) {
        char name[32];
        int node = -1;
        sheet solid = {0};
        snprintf(name, sizeof name, "obstacle %zu", i);
        add_solid(&solid, &obstacles[i]);
        status = add_sheet(model, &solid, name, (ff_colour){168, 140, 108}, 0, &node, error);
        if (status != FF_OK || node < 0) break;
        ff_glb_set_translation(model, node, ff_ground(ff_obstacle_at(&obstacles[i], recording->start), 0.0));
        if (obstacles[i].kind == FF_OBSTACLE_PATH)
            status = add_way(model, &obstacles[i], recording, animation, node, times, error);
    }
    return status;
}
