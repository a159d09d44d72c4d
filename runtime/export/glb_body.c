#include "runtime/export/glb_body.h"

#include "runtime/core/base/fail.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CELL 0.021 /* m, edge length of the body's mesh: some 5,000 vertices */
#define ROUGH 0.85

typedef struct material_entry {
    ff_colour colour;
    int material;
} material_entry;

typedef struct mesh_entry {
    ff_look look;
    int mesh;
} mesh_entry;

static const char *const cover_names[FF_COVER_COUNT] = {"skin", "hair", "shirt", "trousers", "shoes"};

/* glTF colour factors are linear, ours are sRGB. */
static double linear(uint8_t value)
{
    double v = value / 255.0;
    v = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    return floor(v * 1e4 + 0.5) / 1e4;
}

static int add_material(ff_glb_model *model, const char *name, ff_colour colour, int both_sides)
{
    double rgb[3] = {linear(colour.r), linear(colour.g), linear(colour.b)};
    return ff_glb_add_material(model, name, rgb, ROUGH, both_sides);
}

static int add_vectors(ff_glb_model *model, const float (*values)[3], size_t count, bool bounded)
{
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    for (size_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) {
            low[k] = ff_min(low[k], (double)values[i][k]);
            high[k] = ff_max(high[k], (double)values[i][k]);
        }
    int view = ff_glb_add_view(model, values, count * sizeof *values, 12, FF_GLB_VERTICES);
    return ff_glb_add_accessor(model, view, 0, FF_GLB_F32, 0, 3, count, bounded ? low : NULL,
                               bounded ? high : NULL);
}

static int add_quads(ff_glb_model *model, const void *values, size_t count, int normalised)
{
    int view = ff_glb_add_view(model, values, 4 * count, 4, FF_GLB_VERTICES);
    return ff_glb_add_accessor(model, view, 0, FF_GLB_U8, normalised, 4, count, NULL, NULL);
}

static int add_indices(ff_glb_model *model, const uint32_t (*triangles)[3], size_t count)
{
    int view = ff_glb_add_view(model, triangles, count * sizeof *triangles, 0, FF_GLB_INDICES);
    return ff_glb_add_accessor(model, view, 0, FF_GLB_U32, 0, 1, 3 * count, NULL, NULL);
}

static ff_status add_vertices(ff_glb_model *model, const ff_body_mesh *mesh, ff_glb_wardrobe *out,
                              ff_error *error)
{
    size_t count = mesh->vertices.count;
    const ff_body_vertex *vertices = mesh->vertices.data;
    float(*vectors)[3] = ff_calloc(2 * count, sizeof *vectors);
    uint8_t(*quads)[4] = ff_calloc(2 * count, sizeof *quads);
    if (!vectors || !quads) {
        free(vectors);
        free(quads);
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the body's vertices");
    }
    for (size_t i = 0; i < count; ++i) {
        memcpy(vectors[i], vertices[i].position, sizeof *vectors);
        memcpy(vectors[count + i], vertices[i].normal, sizeof *vectors);
        memcpy(quads[i], vertices[i].joints, sizeof vertices[i].joints);
        memcpy(quads[count + i], vertices[i].weights, sizeof vertices[i].weights);
    }
    out->positions = add_vectors(model, (const float(*)[3])vectors, count, true);
    out->normals = add_vectors(model, (const float(*)[3])(vectors + count), count, false);
    out->joints = add_quads(model, quads, count, 0);
    out->weights = add_quads(model, quads + count, count, 1);
    free(vectors);
    free(quads);
    return FF_OK;
}

/* Rest rotations are the identity, so a bind matrix only moves; columns first. */
static int add_inverse_binds(ff_glb_model *model, const ff_figure *figure)
{
    float matrices[FF_FIGURE_MAX_JOINTS][16];
    memset(matrices, 0, sizeof matrices);
    for (uint32_t j = 0; j < figure->joint_count; ++j) {
        for (int k = 0; k < 4; ++k)
            matrices[j][5 * k] = 1.0f;
        matrices[j][12] = (float)-figure->rest[j].x;
        matrices[j][13] = (float)-figure->rest[j].y;
        matrices[j][14] = (float)-figure->rest[j].z;
    }
    int view = ff_glb_add_view(model, matrices, figure->joint_count * sizeof matrices[0], 0, FF_GLB_DATA);
    return ff_glb_add_accessor(model, view, 0, FF_GLB_F32, 0, 16, figure->joint_count, NULL, NULL);
}

ff_status ff_glb_wardrobe_create(ff_glb_model *model, const ff_figure *figure, ff_glb_wardrobe *out,
                                 ff_error *error)
{
    ff_body_mesh mesh;
    memset(out, 0, sizeof *out);
    ff_status status = ff_body_mesh_make(figure, CELL, &mesh, error);
    if (status != FF_OK) return status;
    status = add_vertices(model, &mesh, out, error);
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])mesh.triangles.data;
    for (int cover = 0; cover < FF_COVER_COUNT && status == FF_OK; ++cover) {
        uint32_t first = mesh.cover_first[cover], count = mesh.cover_first[cover + 1] - first;
        out->indices[cover] = count > 0 ? add_indices(model, triangles + first, count) : -1;
    }
    out->inverse_binds = add_inverse_binds(model, figure);
    ff_body_mesh_free(&mesh);
    return status;
}

void ff_glb_wardrobe_free(ff_glb_wardrobe *wardrobe)
{
    ff_array_free(&wardrobe->materials);
    ff_array_free(&wardrobe->meshes);
}

static int material_of(ff_glb_wardrobe *wardrobe, ff_glb_model *model, ff_cover cover, ff_colour colour)
{
    material_entry *known = wardrobe->materials.data;
    for (size_t i = 0; i < wardrobe->materials.count; ++i)
        if (memcmp(&known[i].colour, &colour, sizeof colour) == 0) return known[i].material;
    material_entry *entry = ff_array_grow(&wardrobe->materials, 1, sizeof *entry);
    if (!entry) return -1;
    *entry = (material_entry){colour, add_material(model, cover_names[cover], colour, 0)};
    return entry->material;
}

int ff_glb_wardrobe_mesh(ff_glb_wardrobe *wardrobe, ff_glb_model *model, const ff_look *look)
{
    const mesh_entry *known = wardrobe->meshes.data;
    for (size_t i = 0; i < wardrobe->meshes.count; ++i)
        if (memcmp(&known[i].look, look, sizeof *look) == 0) return known[i].mesh;
    ff_glb_primitive primitives[FF_COVER_COUNT];
    int count = 0;
    for (int cover = 0; cover < FF_COVER_COUNT; ++cover) {
        if (wardrobe->indices[cover] < 0) continue;
        primitives[count++] =
            (ff_glb_primitive){.positions = wardrobe->positions,
                               .normals = wardrobe->normals,
                               .joints = wardrobe->joints,
                               .weights = wardrobe->weights,
                               .indices = wardrobe->indices[cover],
                               .material = material_of(wardrobe, model, (ff_cover)cover, look->cover[cover])};
    }
    mesh_entry *entry = ff_array_grow(&wardrobe->meshes, 1, sizeof *entry);
    if (!entry) return -1;
    char name[32];
    snprintf(name, sizeof name, "body %zu", wardrobe->meshes.count);
    *entry = (mesh_entry){*look, ff_glb_add_mesh(model, name, primitives, count)};
    return entry->mesh;
}

/* ------------------------------------------------------------------------------------------ surroundings */

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

static ff_status add_sheet(ff_glb_model *model, sheet *s, const char *name, ff_colour colour, int both_sides,
                           ff_error *error)
{
    if (!s->failed && s->positions.count > 0) {
        ff_glb_primitive primitive = {.joints = -1, .weights = -1};
        primitive.positions =
            add_vectors(model, (const float(*)[3])s->positions.data, s->positions.count, true);
        primitive.normals = add_vectors(model, (const float(*)[3])s->normals.data, s->normals.count, false);
        primitive.indices = add_indices(model, (const uint32_t(*)[3])s->triangles.data, s->triangles.count);
        primitive.material = add_material(model, name, colour, both_sides);
        int mesh = ff_glb_add_mesh(model, name, &primitive, 1);
        ff_glb_set_mesh(model, ff_glb_add_node(model, name, -1, ff_v3(0.0, 0.0, 0.0)), mesh, -1);
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
        ff_status status = add_sheet(model, &tiles, "ground", colours[odd], 0, error);
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
    return add_sheet(model, &walls, "walls", (ff_colour){150, 146, 140}, 1, error);
}
