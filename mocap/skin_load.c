#define _POSIX_C_SOURCE 200809L
#include "mocap/gltf_skin.h"
#include "mocap/read.h"
#include "mocap/roles_find.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ff_status take_joints(const ff_gltf *gltf, const ff_gltf_skeleton *s, ff_skin *out, ff_error *error)
{
    out->joints = ff_calloc((size_t)s->count, sizeof *out->joints);
    if (!out->joints) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d joints", s->count);
    out->joint_count = s->count;
    for (int j = 0; j < s->count; ++j) {
        ff_skin_joint *joint = &out->joints[j];
        if (s->node[j] >= 0) {
            ff_gltf_joint_name(gltf, s->node[j], joint->name);
        } else {
            snprintf(joint->name, sizeof joint->name, "tip_%d", j);
        }
        joint->parent = s->parent[j];
        joint->at = s->at[j];
        joint->role = joint->near = FF_ROLE_NONE;
    }
    return FF_OK;
}

ff_status ff_skin_rest_clip(const ff_skin *skin, ff_clip *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    size_t joints = (size_t)skin->joint_count;
    out->joints = ff_calloc(joints, sizeof *out->joints);
    out->rotations = ff_calloc(joints, sizeof *out->rotations);
    out->name = strdup("rest");
    out->source = strdup("");
    if (!out->joints || !out->rotations || !out->name || !out->source) {
        ff_clip_free(out);
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu joints", joints);
    }
    out->joint_count = skin->joint_count;
    out->frame_count = 1;
    out->frame_time = 1.0 / 60.0;
    out->unit_m = 1.0;
    for (int j = 0; j < skin->joint_count; ++j) {
        const ff_skin_joint *from = &skin->joints[j];
        ff_joint *to = &out->joints[j];
        memcpy(to->name, from->name, sizeof to->name);
        to->parent = from->parent;
        to->offset = from->parent < 0 ? from->at : ff_sub3(from->at, skin->joints[from->parent].at);
        to->track = -1;
        to->role = from->role;
        out->rotations[j] = FF_QUAT_IDENTITY;
    }
    return FF_OK;
}

/* Roles and size as a clip of the same skeleton gets them. */
static ff_status find_roles(ff_skin *skin, const ff_load_options *options, ff_error *error)
{
    ff_clip rest;
    ff_status status = ff_skin_rest_clip(skin, &rest, error);
    if (status != FF_OK) return status;
    status = ff_clip_finish_sized(&rest, options, error);
    if (status == FF_OK) status = ff_roles_require(&rest, error);
    skin->unit_m = rest.unit_m;
    for (int j = 0; j < skin->joint_count; ++j) {
        ff_skin_joint *joint = &skin->joints[j];
        joint->role = rest.joints[j].role;
        joint->at = ff_scale3(joint->at, rest.unit_m);
        bool turns = joint->role != FF_ROLE_NONE && joint->role < FF_ROLE_JOINT_COUNT;
        joint->near = turns               ? joint->role
                      : joint->parent < 0 ? FF_ROLE_HIPS
                                          : skin->joints[joint->parent].near;
    }
    for (int i = 0; i < skin->vertex_count; ++i)
        skin->vertices[i].at = ff_scale3(skin->vertices[i].at, rest.unit_m);
    skin->warning_count = rest.warning_count;
    memcpy(skin->warning, rest.warning, sizeof skin->warning);
    ff_clip_free(&rest);
    return status;
}

static ff_status read_skin(const ff_gltf *gltf, const ff_load_options *options, ff_skin *out, ff_error *error)
{
    ff_gltf_skeleton skeleton = {0};
    ff_status status = ff_gltf_skeleton_find(gltf, -1, &skeleton, error);
    if (status == FF_OK) status = ff_gltf_skeleton_add_tips(gltf, &skeleton, error);
    if (status == FF_OK) status = ff_gltf_skin_read(gltf, &skeleton, out, error);
    if (status == FF_OK && out->triangle_count == 0)
        status = ff_fail(error, FF_ERR_NO_DATA, "the file has no skin: no mesh of triangles hangs on joints");
    if (status == FF_OK) status = take_joints(gltf, &skeleton, out, error);
    if (status == FF_OK) status = find_roles(out, options, error);
    ff_gltf_skeleton_free(&skeleton);
    return status;
}

ff_status ff_skin_load(const char *path, const ff_load_options *options, ff_skin *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    ff_file file;
    ff_gltf gltf;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    status = ff_gltf_open(file.data, file.size, path, (ff_gltf_keys){false, NULL}, &gltf, error);
    ff_file_unmap(&file);
    if (status != FF_OK) return status;
    status = read_skin(&gltf, options, out, error);
    ff_gltf_close(&gltf);
    if (status != FF_OK) {
        ff_error_in_file(error, path);
        ff_skin_free(out);
    }
    return status;
}
