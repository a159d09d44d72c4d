#include "mocap/gltf_skin.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* More than any character has. */
enum { MOST_VERTICES = 1 << 20, MOST_TRIANGLES = 1 << 21 };

typedef struct reader {
    const ff_gltf *gltf;
    const ff_gltf_skeleton *skeleton;
    ff_array vertices, triangles; /* ff_skin_vertex, uint32_t[3] */
    ff_error *error;
} reader;

/* The numbers of one primitive's attributes; NULL = not there. */
typedef struct attributes {
    double *position, *normal, *uv, *joints, *weights, *indices;
    size_t count;
} attributes;

static void free_attributes(attributes *a)
{
    free(a->position);
    free(a->normal);
    free(a->uv);
    free(a->joints);
    free(a->weights);
    free(a->indices);
}

static ff_status read_attribute(reader *r, int accessor, const char *name, int width, attributes *a,
                                double **out)
{
    if (accessor < 0) return FF_OK;
    const ff_gltf_accessor *from = &r->gltf->accessors[accessor];
    if (from->width != width || from->count != a->count)
        return ff_fail(r->error, FF_ERR_PARSE, "accessors[%d]: %s needs %zu elements of %d numbers",
                       from->number, name, a->count, width);
    return ff_gltf_read(r->gltf, accessor, out, r->error);
}

static ff_status read_primitive(reader *r, const ff_gltf_primitive *p, attributes *a)
{
    a->count = r->gltf->accessors[p->position].count;
    if (a->count + r->vertices.count > MOST_VERTICES)
        return ff_fail(r->error, FF_ERR_RANGE, "meshes: more than %d vertices", MOST_VERTICES);
    ff_status status = read_attribute(r, p->position, "POSITION", 3, a, &a->position);
    if (status == FF_OK) status = read_attribute(r, p->normal, "NORMAL", 3, a, &a->normal);
    if (status == FF_OK) status = read_attribute(r, p->uv, "TEXCOORD_0", 2, a, &a->uv);
    if (status == FF_OK) status = read_attribute(r, p->joints, "JOINTS_0", 4, a, &a->joints);
    if (status == FF_OK) status = read_attribute(r, p->weights, "WEIGHTS_0", 4, a, &a->weights);
    if (status != FF_OK || p->indices < 0) return status;
    const ff_gltf_accessor *indices = &r->gltf->accessors[p->indices];
    if (indices->width != 1 || indices->at.component == FF_GLTF_F32 ||
        indices->count > 3 * (size_t)MOST_TRIANGLES)
        return ff_fail(r->error, FF_ERR_PARSE, "accessors[%d]: no list of indices", indices->number);
    return ff_gltf_read(r->gltf, p->indices, &a->indices, r->error);
}

/* Weights largest first, adding up to 1. */
static bool settle_weights(ff_skin_vertex *v)
{
    double sum = 0.0;
    for (int i = 0; i < FF_SKIN_BONES; ++i) {
        if (!(v->weight[i] > 0.0)) v->weight[i] = 0.0;
        sum += v->weight[i];
        for (int k = i; k > 0 && v->weight[k] > v->weight[k - 1]; --k) {
            double weight = v->weight[k];
            int joint = v->joint[k];
            v->weight[k] = v->weight[k - 1], v->joint[k] = v->joint[k - 1];
            v->weight[k - 1] = weight, v->joint[k - 1] = joint;
        }
    }
    if (!(sum > 1e-6)) return false;
    for (int i = 0; i < FF_SKIN_BONES; ++i)
        v->weight[i] /= sum;
    return true;
}

static ff_status add_vertices(reader *r, const attributes *a, int skin_index)
{
    const ff_gltf_skin *skin = &r->gltf->skins[skin_index];
    const ff_gltf_skeleton *s = r->skeleton;
    const int *nodes = r->gltf->skin_joints + skin->first_joint;
    ff_skin_vertex *v = ff_array_grow(&r->vertices, a->count, sizeof *v);
    if (!v) return ff_fail(r->error, FF_ERR_NO_MEMORY, "no memory for %zu vertices", a->count);
    for (size_t i = 0; i < a->count; ++i, ++v) {
        const double *p = a->position + 3 * i, *n = a->normal ? a->normal + 3 * i : NULL;
        *v = (ff_skin_vertex){
            .at = ff_scale3(ff_quat_rotate(s->bind_turn, ff_v3(p[0], p[1], p[2])), s->bind_scale)};
        if (n) v->normal = ff_unit3(ff_quat_rotate(s->bind_turn, ff_v3(n[0], n[1], n[2])));
        if (a->uv) memcpy(v->uv, a->uv + 2 * i, sizeof v->uv);
        for (int b = 0; b < FF_SKIN_BONES; ++b) {
            double index = a->joints[4 * i + (size_t)b];
            v->weight[b] = a->weights[4 * i + (size_t)b];
            bool known = index >= 0.0 && index < skin->joint_count;
            if (v->weight[b] > 0.0 && !known)
                return ff_fail(r->error, FF_ERR_PARSE, "vertex %zu hangs on joint %g of %d", i, index,
                               skin->joint_count);
            v->joint[b] = known ? s->joint[nodes[(int)index]] : 0;
        }
        if (!settle_weights(v)) return ff_fail(r->error, FF_ERR_PARSE, "vertex %zu hangs on no joint", i);
    }
    return FF_OK;
}

static ff_status add_triangles(reader *r, const ff_gltf_primitive *p, const attributes *a, size_t first)
{
    size_t corners = p->indices >= 0 ? r->gltf->accessors[p->indices].count : a->count, count = corners / 3;
    if (count == 0) return FF_OK;
    if (count + r->triangles.count > MOST_TRIANGLES)
        return ff_fail(r->error, FF_ERR_RANGE, "meshes: more than %d triangles", MOST_TRIANGLES);
    uint32_t(*to)[3] = ff_array_grow(&r->triangles, count, sizeof *to);
    if (!to) return ff_fail(r->error, FF_ERR_NO_MEMORY, "no memory for %zu triangles", count);
    for (size_t i = 0; i < 3 * count; ++i) {
        double index = a->indices ? a->indices[i] : (double)i;
        if (!(index >= 0.0 && index < (double)a->count))
            return ff_fail(r->error, FF_ERR_PARSE, "triangle %zu: no vertex %g among %zu", i / 3, index,
                           a->count);
        to[i / 3][i % 3] = (uint32_t)(first + (size_t)index);
    }
    return FF_OK;
}

static ff_status add_primitive(reader *r, const ff_gltf_primitive *p, int skin)
{
    enum { TRIANGLES = 4 };
    if (p->mode != TRIANGLES || p->position < 0 || p->joints < 0 || p->weights < 0) return FF_OK;
    attributes a = {0};
    size_t first = r->vertices.count;
    ff_status status = read_primitive(r, p, &a);
    if (status == FF_OK) status = add_vertices(r, &a, skin);
    if (status == FF_OK) status = add_triangles(r, p, &a, first);
    free_attributes(&a);
    return status;
}

/* Does this skin dress the body? Then all of its joints are the skeleton's. */
static bool dresses(const reader *r, int skin)
{
    const ff_gltf_skin *s = &r->gltf->skins[skin];
    return s->joint_count > 0 && r->skeleton->joint[r->gltf->skin_joints[s->first_joint]] >= 0;
}

ff_status ff_gltf_skin_read(const ff_gltf *gltf, const ff_gltf_skeleton *skeleton, ff_skin *out,
                            ff_error *error)
{
    memset(out, 0, sizeof *out);
    reader r = {.gltf = gltf, .skeleton = skeleton, .error = error};
    ff_status status = FF_OK;
    for (int n = 0; n < gltf->node_count && status == FF_OK; ++n) {
        const ff_gltf_node *node = &gltf->nodes[n];
        if (node->mesh < 0 || node->skin < 0 || !dresses(&r, node->skin)) continue;
        const ff_gltf_mesh *mesh = &gltf->meshes[node->mesh];
        for (int p = 0; p < mesh->primitive_count && status == FF_OK; ++p)
            status = add_primitive(&r, &gltf->primitives[mesh->first_primitive + p], node->skin);
    }
    out->vertices = r.vertices.data;
    out->vertex_count = (int)r.vertices.count;
    out->triangles = r.triangles.data;
    out->triangle_count = (int)r.triangles.count;
    if (status != FF_OK) ff_skin_free(out);
    return status;
}

void ff_skin_free(ff_skin *skin)
{
    free(skin->vertices);
    free(skin->triangles);
    free(skin->joints);
    memset(skin, 0, sizeof *skin);
}
