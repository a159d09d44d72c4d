#include "runtime/export/figure.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/pack/pack.h"

#include <stdio.h>
#include <string.h>

ff_status ff_figure_from_joints(uint32_t count, const int32_t *parents, const ff_vec3 *offsets,
                                const char *const *names, ff_figure *out, ff_error *error)
{
    if (count < FF_JOINT_COUNT || count > FF_FIGURE_MAX_JOINTS)
        return ff_fail(
            error, FF_ERR_UNSUPPORTED,
            "the pack's skeleton has %u joints; drawing a person needs %d to %d (build the pack with "
            "this version's footfall-pack)",
            count, FF_JOINT_COUNT, FF_FIGURE_MAX_JOINTS);
    memset(out, 0, sizeof *out);
    out->joint_count = count;
    for (uint32_t j = 0; j < count; ++j) {
        int32_t parent = parents[j];
        if (parent >= (int32_t)j || (j > 0 && parent < 0))
            return ff_fail(error, FF_ERR_UNSUPPORTED, "joint %u has joint %d as parent", j, parent);
        out->parent[j] = j == 0 ? -1 : parent;
        out->offset[j] = offsets[j];
        out->rest[j] = j == 0 ? offsets[j] : ff_add3(out->rest[parent], offsets[j]);
        snprintf(out->name[j], sizeof out->name[j], "%s", names[j] && names[j][0] ? names[j] : "joint");
    }
    return FF_OK;
}

ff_status ff_figure_from_pack(const ff_pack *pack, ff_figure *out, ff_error *error)
{
    int32_t parents[FF_FIGURE_MAX_JOINTS];
    ff_vec3 offsets[FF_FIGURE_MAX_JOINTS];
    const char *names[FF_FIGURE_MAX_JOINTS];
    uint32_t count = ff_pack_joint_count(pack);
    for (uint32_t j = 0; j < count && j < FF_FIGURE_MAX_JOINTS; ++j) {
        parents[j] = ff_pack_joint_parent(pack, j);
        offsets[j] = ff_pack_joint_offset(pack, j);
        names[j] = ff_pack_joint_name(pack, j);
    }
    ff_status status = ff_figure_from_joints(count, parents, offsets, names, out, error);
    if (status != FF_OK || pack->skin_count == 0) return status;
    const ff_pack_skin *finest = &pack->skins[0];
    out->vertices = pack->vertices + finest->first_vertex;
    out->vertex_count = finest->vertex_count;
    out->triangles = pack->triangles + finest->first_triangle;
    out->triangle_count = finest->triangle_count;
    return FF_OK;
}

void ff_figure_place(const ff_figure *figure, ff_vec3 hips, const ff_quat *local, ff_vec3 *positions,
                     ff_quat *rotations)
{
    ff_vec3 place[FF_FIGURE_MAX_JOINTS];
    ff_quat turn[FF_FIGURE_MAX_JOINTS];
    place[0] = hips;
    turn[0] = local[0];
    for (uint32_t j = 1; j < figure->joint_count; ++j) {
        int32_t parent = figure->parent[j];
        place[j] = ff_add3(place[parent], ff_quat_rotate(turn[parent], figure->offset[j]));
        turn[j] = ff_quat_mul(turn[parent], local[j]);
    }
    if (positions) memcpy(positions, place, figure->joint_count * sizeof *place);
    if (rotations) memcpy(rotations, turn, figure->joint_count * sizeof *turn);
}

void ff_figure_place_scaled(const ff_figure *figure, double scale, ff_vec3 hips, const ff_quat *local,
                            ff_vec3 *positions, ff_quat *rotations)
{
    ff_figure_place(figure, ff_scale3(hips, 1.0 / scale), local, positions, rotations);
    for (uint32_t j = 0; j < figure->joint_count && positions; ++j)
        positions[j] = ff_scale3(positions[j], scale);
}

double ff_figure_scale(const ff_figure *figure)
{
    return ff_clamp(figure->rest[FF_JOINT_HIPS].y / 0.95, 0.3, 3.0);
}

ff_vec3 ff_figure_tip(const ff_figure *figure, uint32_t joint)
{
    double scale = ff_figure_scale(figure);
    switch (joint) {
    case FF_JOINT_HEAD:
        return ff_v3(0.0, 0.20 * scale, 0.0);
    case FF_JOINT_WRIST_L:
        return ff_v3(0.17 * scale, 0.0, 0.0);
    case FF_JOINT_WRIST_R:
        return ff_v3(-0.17 * scale, 0.0, 0.0);
    case FF_JOINT_BALL_L:
    case FF_JOINT_BALL_R:
        return ff_v3(0.0, -0.5 * figure->rest[joint].y, 0.07 * scale);
    default:
        return ff_scale3(ff_unit3(figure->offset[joint]), 0.05 * scale);
    }
}
