/* A skin onto the rig: each joint's part turned so that its bone points where the rig's does, stretched along it to the
 * rig's length, and put where the rig has the joint. */
#include "preprocess/base/filter.h"
#include "preprocess/motion/retarget.h"
#include "preprocess/skin/mesh.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The part of the body that turns with one role. */
typedef struct part {
    ff_vec3 from; /* its joint on the character at rest */
    ff_vec3 to;   /* on the rig */
    ff_quat turn; /* from the character's rest pose to the rig's */
    ff_vec3 bone; /* unit, on the rig; zero = none */
    double scale; /* rig over character, by height: by its short legs a toy's head would be a giant's */
    /* m, the bone's after scaling, and how much longer the rig's is; what lies beyond its ends moves along with them */
    double length, stretch;
} part;

/* The role at the far end of the bone that starts at a role; its own for a tip that no file has. */
static int bone_end(int role)
{
    switch (role) {
    case FF_ROLE_HIPS:
        return FF_ROLE_SPINE;
    case FF_ROLE_CHEST:
        return FF_ROLE_NECK;
    case FF_ROLE_HEAD:
        return FF_ROLE_HEAD_TOP;
    case FF_ROLE_WRIST_L:
        return FF_ROLE_HAND_L;
    case FF_ROLE_WRIST_R:
        return FF_ROLE_HAND_R;
    case FF_ROLE_BALL_L:
        return FF_ROLE_TOE_L;
    case FF_ROLE_BALL_R:
        return FF_ROLE_TOE_R;
    default:
        return role + 1; /* along spine, neck, arms and legs roles follow each other */
    }
}

/* Parts much longer or shorter than the rig's are left as they are: a toy's head is not a neck that grew. */
static bool stretches(int role)
{
    return role != FF_ROLE_HEAD && role != FF_ROLE_WRIST_L && role != FF_ROLE_WRIST_R &&
           role != FF_ROLE_BALL_L && role != FF_ROLE_BALL_R && role != FF_ROLE_HIPS;
}

static double height_of(const ff_skin *skin)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < skin->vertex_count; ++i) {
        low = ff_min(low, skin->vertices[i].at.y);
        high = ff_max(high, skin->vertices[i].at.y);
    }
    return high - low;
}

static void make_parts(const ff_clip *rest, const ff_retarget *onto, const ff_rig *rig, double height,
                       part *parts)
{
    ff_vec3 at[FF_CLIP_MAX_JOINTS], rig_at[FF_BODY_COUNT];
    ff_clip_rest_pose(rest, at);
    ff_rig_rest_pose(rig, rig_at);
    double scale = height > 0.1 ? rig_at[FF_ROLE_HEAD_TOP].y / height : onto->scale;
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        part *p = &parts[r];
        int joint = onto->joint[r], end = bone_end(r);
        *p = (part){.to = rig_at[r], .scale = scale, .stretch = 1.0};
        p->turn = ff_quat_conj(onto->align[r]);
        if (joint < 0) continue; /* nothing hangs on it */
        p->from = at[joint];
        ff_vec3 own = ff_sub3(rig_at[end], rig_at[r]);
        if (onto->joint[end] < 0 || !stretches(r)) continue;
        double length = scale * ff_length3(ff_sub3(at[onto->joint[end]], at[joint]));
        if (length < 0.01 || ff_length3(own) < 0.01) continue;
        p->bone = ff_unit3(own);
        p->length = length;
        p->stretch = ff_clamp(ff_length3(own) / length, 0.25, 4.0);
    }
}

static ff_vec3 place(const part *p, ff_vec3 v)
{
    ff_vec3 local = ff_scale3(ff_quat_rotate(p->turn, ff_sub3(v, p->from)), p->scale);
    double along = ff_clamp(ff_dot3(p->bone, local), 0.0, p->length);
    local = ff_madd3(local, p->bone, (p->stretch - 1.0) * along);
    return ff_add3(p->to, local);
}

/* Weights of joints that have no role go to the next one above that has; the same role twice is one. */
static void merge_weights(const ff_skin *skin, ff_skin_vertex *v)
{
    int count = 0;
    int roles[FF_SKIN_BONES];
    double weights[FF_SKIN_BONES];
    for (int i = 0; i < FF_SKIN_BONES; ++i) {
        if (!(v->weight[i] > 0.0)) continue;
        int role = (int)skin->joints[v->joint[i]].near, k = 0;
        while (k < count && roles[k] != role)
            ++k;
        if (k == count) roles[count] = role, weights[count++] = 0.0;
        weights[k] += v->weight[i];
    }
    for (int i = 0; i < FF_SKIN_BONES; ++i) { /* largest first */
        int most = 0;
        for (int k = 1; k < count; ++k)
            if (weights[k] > weights[most]) most = k;
        v->joint[i] = i < count ? roles[most] : 0;
        v->weight[i] = i < count ? weights[most] : 0.0;
        if (i < count) weights[most] = -1.0;
    }
}

static void place_vertex(const part *parts, const ff_skin_vertex *from, ff_skin_vertex *to)
{
    to->at = ff_v3(0.0, 0.0, 0.0);
    to->normal = ff_v3(0.0, 0.0, 0.0);
    for (int i = 0; i < FF_SKIN_BONES; ++i) {
        if (!(to->weight[i] > 0.0)) continue;
        const part *p = &parts[to->joint[i]];
        to->at = ff_madd3(to->at, place(p, from->at), to->weight[i]);
        to->normal = ff_madd3(to->normal, ff_quat_rotate(p->turn, from->normal), to->weight[i]);
    }
    to->normal = ff_unit3(to->normal);
}

/* Soles onto the ground: how thick they are differs from file to file, and often the ankle is a guess. */
static void lower_feet(const ff_skin *skin, const ff_mesh *mesh, part *parts)
{
    for (int foot = 0; foot < 2; ++foot) {
        int ankle = foot ? FF_ROLE_ANKLE_R : FF_ROLE_ANKLE_L;
        double low = HUGE_VAL;
        for (int i = 0; i < mesh->vertex_count; ++i) {
            const ff_skin_vertex *v = &mesh->vertices[i];
            if (v->weight[0] < 0.5 || (v->joint[0] != ankle && v->joint[0] != ankle + 1)) continue;
            low = ff_min(low, place(&parts[v->joint[0]], skin->vertices[i].at).y);
        }
        if (low > 1e6) { /* a character without feet stands on its shins */
            part *shin = &parts[ankle - 1];
            shin->stretch *= shin->to.y / (shin->to.y - parts[ankle].to.y);
            continue;
        }
        parts[ankle].to.y -= low;
        parts[ankle + 1].to.y -= low;
    }
}

/* ------------------------------------------------------------------------------------------------------ thickness */

static double distance_to_bone(const ff_vec3 *rig_at, int role, ff_vec3 v)
{
    ff_vec3 a = rig_at[role], along = ff_sub3(rig_at[bone_end(role)], a);
    double length = ff_length3(along);
    double t = length > 0.0 ? ff_clamp(ff_dot3(ff_sub3(v, a), along) / (length * length), 0.0, 1.0) : 0.0;
    return ff_length3(ff_sub3(v, ff_madd3(a, along, t)));
}

static void measure_radii(const ff_mesh *mesh, const ff_rig *rig, double *distances, double *radius)
{
    enum { FEWEST = 4 };
    ff_vec3 rig_at[FF_BODY_COUNT];
    ff_rig_rest_pose(rig, rig_at);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        int n = 0;
        for (int i = 0; i < mesh->vertex_count; ++i) {
            const ff_skin_vertex *v = &mesh->vertices[i];
            for (int b = 0; b < FF_SKIN_BONES; ++b)
                if (v->joint[b] == r && v->weight[b] >= 0.5)
                    distances[n++] = distance_to_bone(rig_at, r, v->at);
        }
        radius[r] = n >= FEWEST ? ff_filter_quantile(distances, n, 0.9) : 0.0;
    }
}

/* ------------------------------------------------------------------------------------------------------------ all */

static ff_status copy_skin(const ff_skin *skin, ff_mesh *out, ff_error *error)
{
    out->vertices = ff_calloc((size_t)skin->vertex_count, sizeof *out->vertices);
    out->triangles = ff_calloc((size_t)skin->triangle_count, sizeof *out->triangles);
    if (!out->vertices || !out->triangles)
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a mesh of %d triangles", skin->triangle_count);
    memcpy(out->vertices, skin->vertices, (size_t)skin->vertex_count * sizeof *out->vertices);
    memcpy(out->triangles, skin->triangles, (size_t)skin->triangle_count * sizeof *out->triangles);
    out->vertex_count = skin->vertex_count;
    out->triangle_count = skin->triangle_count;
    return FF_OK;
}

ff_status ff_mesh_fit(const ff_skin *skin, const ff_rig *rig, ff_mesh *out, double *radius, ff_error *error)
{
    memset(out, 0, sizeof *out);
    ff_clip rest;
    ff_retarget onto;
    const ff_plants none = {0};
    part parts[FF_ROLE_JOINT_COUNT];
    double *distances = ff_calloc((size_t)skin->vertex_count * FF_SKIN_BONES, sizeof *distances);
    if (!distances) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d vertices", skin->vertex_count);
    ff_status status = ff_skin_rest_clip(skin, &rest, error);
    if (status == FF_OK) {
        status = ff_retarget_begin(rig, &rest, &none, &onto, error);
        if (status == FF_OK) make_parts(&rest, &onto, rig, height_of(skin), parts);
        ff_clip_free(&rest);
    }
    if (status == FF_OK) status = copy_skin(skin, out, error);
    if (status == FF_OK) {
        for (int i = 0; i < out->vertex_count; ++i)
            merge_weights(skin, &out->vertices[i]);
        lower_feet(skin, out, parts);
        for (int i = 0; i < out->vertex_count; ++i)
            place_vertex(parts, &skin->vertices[i], &out->vertices[i]);
    }
    if (status == FF_OK) {
        measure_radii(out, rig, distances, radius);
    } else {
        ff_mesh_free(out);
    }
    free(distances);
    return status;
}
