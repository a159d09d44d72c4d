#include "runtime/export/stage.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

ff_status ff_stage_create(const ff_figure *figure, double cell, ff_stage *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->figure = figure;
    ff_status status = ff_body_mesh_make(figure, cell, &out->mesh, error);
    if (status != FF_OK) return status;
    size_t count = out->mesh.vertices.count;
    out->positions = ff_calloc(count, sizeof *out->positions);
    out->normals = ff_calloc(count, sizeof *out->normals);
    out->vertices = ff_calloc(count, sizeof *out->vertices);
    if (out->positions && out->normals && out->vertices) return FF_OK;
    ff_stage_destroy(out);
    return ff_fail(error, FF_ERR_NO_MEMORY, "no memory to draw a person");
}

void ff_stage_destroy(ff_stage *stage)
{
    ff_body_mesh_free(&stage->mesh);
    free(stage->positions);
    free(stage->normals);
    free(stage->vertices);
    memset(stage, 0, sizeof *stage);
}

void ff_stage_pose(ff_stage *stage, const ff_recording *recording, uint32_t pose, uint32_t agent,
                   ff_vec3 *joints)
{
    ff_vec3 hips, places[FF_FIGURE_MAX_JOINTS];
    ff_quat local[FF_FIGURE_MAX_JOINTS], turns[FF_FIGURE_MAX_JOINTS];
    ff_recording_pose(recording, pose, agent, &hips, local);
    /* As large as the pack's, and then stretched about the origin: so the mesh need not know of sizes. */
    double scale = ff_recording_scale(recording, agent);
    ff_figure_place(stage->figure, ff_scale3(hips, 1.0 / scale), local, places, turns);
    ff_body_mesh_skin(&stage->mesh, stage->figure, places, turns, stage->positions, stage->normals);
    for (size_t i = 0; i < stage->mesh.vertices.count; ++i) {
        stage->vertices[i].position = ff_scale3(stage->positions[i], scale);
        stage->vertices[i].normal = stage->normals[i];
    }
    for (uint32_t j = 0; j < stage->figure->joint_count && joints; ++j)
        joints[j] = ff_scale3(places[j], scale);
}

void ff_stage_dress(ff_stage *stage, const ff_look *look)
{
    const ff_body_vertex *body = stage->mesh.vertices.data;
    for (size_t i = 0; i < stage->mesh.vertices.count; ++i)
        stage->vertices[i].colour = look->cover[body[i].cover];
}

static uint8_t mix(uint8_t trunk, uint8_t limb, double share)
{
    return (uint8_t)ff_lerp(trunk, limb, share);
}

void ff_stage_mark_sides(ff_stage *stage, ff_colour left, ff_colour right, ff_colour trunk)
{
    const ff_body_vertex *body = stage->mesh.vertices.data;
    for (size_t i = 0; i < stage->mesh.vertices.count; ++i) {
        int share = 0; /* of the limbs in what moves this vertex; of the right ones negative */
        for (int k = 0; k < 4; ++k)
            share += ff_joint_side(body[i].joints[k]) * body[i].weights[k];
        ff_colour limb = share > 0 ? left : right;
        double part = ff_smooth(abs(share) / 255.0);
        stage->vertices[i].colour =
            (ff_colour){mix(trunk.r, limb.r, part), mix(trunk.g, limb.g, part), mix(trunk.b, limb.b, part)};
        if (body[i].cover == FF_COVER_HAIR) stage->vertices[i].colour = (ff_colour){96, 94, 92};
    }
}

void ff_stage_draw(const ff_stage *stage, ff_raster *raster, const ff_camera *camera)
{
    ff_raster_mesh(raster, camera, stage->vertices, (const uint32_t(*)[3])stage->mesh.triangles.data,
                   stage->mesh.triangles.count);
}

void ff_stage_shadow(const ff_stage *stage, ff_raster *raster, const ff_camera *camera)
{
    ff_raster_shadow(raster, camera, stage->vertices, (const uint32_t(*)[3])stage->mesh.triangles.data,
                     stage->mesh.triangles.count);
}
