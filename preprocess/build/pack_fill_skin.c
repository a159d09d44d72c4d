/* The surface of a character into the pack, at three levels of detail. */
#include "preprocess/build/pack_fill.h"
#include "preprocess/skin/mesh.h"
#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

ff_status ff_mesh_levels(const ff_skin_settings *settings, const ff_mesh *mesh,
                         ff_mesh levels[FF_MESH_LEVELS], ff_mesh_faults *faults, ff_error *error)
{
    const double shares[FF_MESH_LEVELS] = {1.0, settings->second, settings->third};
    memset(levels, 0, FF_MESH_LEVELS * sizeof *levels);
    int finest = mesh->triangle_count < settings->triangles ? mesh->triangle_count : (int)settings->triangles;
    int least = settings->least < finest ? (int)settings->least : finest;
    ff_status status = FF_OK;
    for (int i = 0; i < FF_MESH_LEVELS && status == FF_OK; ++i) {
        int wanted = (int)(finest * shares[i]);
        ff_mesh_faults again = {0};
        if (wanted < least) wanted = least;
        status = ff_mesh_reduce(mesh, wanted, settings->crease, &levels[i], i == 0 ? faults : &again, error);
    }
    for (int i = 0; status != FF_OK && i < FF_MESH_LEVELS; ++i)
        ff_mesh_free(&levels[i]);
    return status;
}

/* Largest remainders: whole parts of 255 that add up to it. */
static void quantise_weights(const double weight[FF_SKIN_BONES], uint8_t out[FF_SKIN_BONES])
{
    int left = 255;
    double rest[FF_SKIN_BONES];
    for (int i = 0; i < FF_SKIN_BONES; ++i) {
        double exact = 255.0 * ff_clamp(weight[i], 0.0, 1.0);
        int whole = (int)floor(exact);
        if (whole > left) whole = left;
        out[i] = (uint8_t)whole;
        rest[i] = exact - whole;
        left -= whole;
    }
    while (left > 0) {
        int most = 0;
        for (int i = 1; i < FF_SKIN_BONES; ++i)
            if (rest[i] > rest[most] && out[i] < 255) most = i;
        out[most]++;
        rest[most] = -1.0;
        --left;
    }
}

static void pack_vertex(const ff_skin_vertex *from, ff_pack_vertex *to)
{
    const double p[3] = {from->at.x, from->at.y, from->at.z};
    const double n[3] = {from->normal.x, from->normal.y, from->normal.z};
    memset(to, 0, sizeof *to);
    for (int k = 0; k < 3; ++k) {
        to->position[k] = (float)p[k];
        to->normal[k] = (float)n[k];
    }
    for (int k = 0; k < 2; ++k)
        to->uv[k] = (float)ff_clamp(from->uv[k], -1e5, 1e5);
    quantise_weights(from->weight, to->weights);
    for (int b = 0; b < FF_SKIN_BONES; ++b)
        to->joints[b] = to->weights[b] ? (uint8_t)from->joint[b] : 0;
}

static ff_status add_level(ff_pack_content *content, const ff_mesh *mesh, ff_error *error)
{
    ff_pack_skin level = {(uint32_t)content->vertices.count, (uint32_t)mesh->vertex_count,
                          (uint32_t)content->triangles.count, (uint32_t)mesh->triangle_count};
    ff_pack_skin *skin = ff_array_grow(&content->skins, 1, sizeof *skin);
    ff_pack_vertex *v = ff_array_grow(&content->vertices, (size_t)mesh->vertex_count, sizeof *v);
    ff_pack_triangle *t = ff_array_grow(&content->triangles, (size_t)mesh->triangle_count, sizeof *t);
    if (!skin || !v || !t)
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a skin of %d triangles", mesh->triangle_count);
    *skin = level;
    for (int i = 0; i < mesh->vertex_count; ++i)
        pack_vertex(&mesh->vertices[i], &v[i]);
    memcpy(t, mesh->triangles, (size_t)mesh->triangle_count * sizeof *t);
    return FF_OK;
}

/* Parts that the character does not have keep the size they had. */
static ff_status measure_colliders(ff_pack_content *content, const ff_mesh *mesh, const ff_rig *rig,
                                   ff_error *error)
{
    double radii[FF_COLLIDER_COUNT];
    ff_status status = ff_mesh_collider_radii(mesh, rig, radii, error);
    const float *before = content->collider_radii.data;
    for (int c = 0; c < FF_COLLIDER_COUNT && before; ++c)
        if (!(radii[c] > 0.0)) radii[c] = (double)before[c];
    return status == FF_OK ? ff_pack_set_collider_radii(content, radii, error) : status;
}

ff_status ff_pack_add_skin(ff_pack_content *content, const ff_skin_settings *settings, const ff_rig *rig,
                           const char *path, const ff_load_options *options, ff_error *error)
{
    ff_skin skin;
    ff_mesh mesh = {0}, levels[FF_MESH_LEVELS] = {{0}};
    ff_mesh_faults faults = {0};
    double radius[FF_ROLE_JOINT_COUNT];
    ff_status status = ff_skin_load(path, options, &skin, error);
    if (status != FF_OK) return status;
    status = ff_mesh_fit(&skin, rig, &mesh, radius, error);
    if (status == FF_OK) status = measure_colliders(content, &mesh, rig, error);
    if (status == FF_OK) status = ff_mesh_clean(&mesh, &faults, error);
    if (status == FF_OK) status = ff_mesh_levels(settings, &mesh, levels, &faults, error);
    for (int i = 0; i < FF_MESH_LEVELS && status == FF_OK; ++i)
        status = add_level(content, &levels[i], error);
    ff_pack_joint *joints = content->joints.data;
    for (size_t j = 0; status == FF_OK && j < content->joints.count && j < FF_ROLE_JOINT_COUNT; ++j)
        if (radius[j] > 0.0) joints[j].radius = (float)radius[j];
    for (int i = 0; i < FF_MESH_LEVELS; ++i)
        ff_mesh_free(&levels[i]);
    ff_mesh_free(&mesh);
    ff_skin_free(&skin);
    if (status != FF_OK) ff_error_in_file(error, path);
    return status;
}
