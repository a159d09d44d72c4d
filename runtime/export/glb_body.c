#include "runtime/export/glb_body.h"

#include "runtime/core/base/fail.h"
#include "runtime/export/glb_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CELL 0.021 /* m, edge length of the body's mesh: some 5,000 vertices */

typedef struct material_entry {
    ff_colour colour;
    int material;
} material_entry;

typedef struct mesh_entry {
    ff_look look;
    int mesh;
} mesh_entry;

static const char *const cover_names[FF_COVER_COUNT] = {"skin", "hair", "shirt", "trousers", "shoes"};

static int add_quads(ff_glb_model *model, const void *values, size_t count, int normalised)
{
    int view = ff_glb_add_view(model, values, 4 * count, 4, FF_GLB_VERTICES);
    return ff_glb_add_accessor(model, view, 0, FF_GLB_U8, normalised, 4, count, NULL, NULL);
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
    out->positions = ff_glb_add_vectors(model, (const float(*)[3])vectors, count, true);
    out->normals = ff_glb_add_vectors(model, (const float(*)[3])(vectors + count), count, false);
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
        out->indices[cover] = count > 0 ? ff_glb_add_indices(model, triangles + first, count) : -1;
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
    *entry = (material_entry){colour, ff_glb_add_paint(model, cover_names[cover], colour, 0)};
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
