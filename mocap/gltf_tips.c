/* Tips: how far the skin reaches from the last joints of a skeleton. */
#include "mocap/gltf_skin.h"

#include "mocap/clip.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* What the skin around one joint looks like. */
typedef struct reach {
    ff_vec3 sum; /* of the vertices that hang mostly on the joint, from the joint */
    int count;
    double far; /* along the direction to their middle */
} reach;

static int main_joint(const ff_skin_vertex *v)
{
    return v->weight[0] >= 0.5 ? v->joint[0] : -1;
}

static void measure(const ff_skin *skin, const ff_gltf_skeleton *s, reach *around)
{
    for (int i = 0; i < skin->vertex_count; ++i) {
        int j = main_joint(&skin->vertices[i]);
        if (j < 0) continue;
        around[j].sum = ff_add3(around[j].sum, ff_sub3(skin->vertices[i].at, s->at[j]));
        around[j].count++;
    }
    for (int i = 0; i < skin->vertex_count; ++i) {
        int j = main_joint(&skin->vertices[i]);
        if (j < 0) continue;
        double along = ff_dot3(ff_unit3(around[j].sum), ff_sub3(skin->vertices[i].at, s->at[j]));
        around[j].far = ff_max(around[j].far, along);
    }
}

static bool is_last(const ff_gltf_skeleton *s, int joint)
{
    return joint + 1 >= s->count || s->parent[joint + 1] != joint;
}

static bool has_tip(const ff_gltf_skeleton *s, const reach *around, int joint)
{
    enum { FEWEST_VERTICES = 3 };
    return is_last(s, joint) && around[joint].count >= FEWEST_VERTICES && around[joint].far > 0.0 &&
           ff_length3(around[joint].sum) > 0.1 * around[joint].far * around[joint].count;
}

/* The arrays again, with a tip behind each joint that gets one. */
static bool insert(ff_gltf_skeleton *s, const reach *around, int tips, int node_count)
{
    size_t count = (size_t)s->count + (size_t)tips;
    ff_gltf_skeleton wide = *s;
    wide.node = ff_calloc(count, sizeof *wide.node);
    wide.parent = ff_calloc(count, sizeof *wide.parent);
    wide.turned = ff_calloc(count, sizeof *wide.turned);
    wide.at = ff_calloc(count, sizeof *wide.at);
    wide.joint = ff_calloc((size_t)node_count, sizeof *wide.joint);
    int *moved = ff_calloc((size_t)s->count, sizeof *moved), n = 0;
    bool room = wide.node && wide.parent && wide.turned && wide.at && wide.joint && moved;
    for (int j = 0; room && j < s->count; ++j) {
        wide.node[n] = s->node[j];
        wide.parent[n] = s->parent[j] < 0 ? -1 : moved[s->parent[j]];
        wide.turned[n] = s->turned[j];
        wide.at[n] = s->at[j];
        moved[j] = n++;
        if (!has_tip(s, around, j)) continue;
        wide.node[n] = -1;
        wide.parent[n] = moved[j];
        wide.turned[n] = s->turned[j];
        wide.at[n++] = ff_madd3(s->at[j], ff_unit3(around[j].sum), around[j].far);
    }
    for (int i = 0; room && i < node_count; ++i)
        wide.joint[i] = s->joint[i] < 0 ? -1 : moved[s->joint[i]];
    wide.count = n;
    free(moved);
    ff_gltf_skeleton old = room ? *s : wide;
    if (room) *s = wide;
    ff_gltf_skeleton_free(&old);
    return room;
}

ff_status ff_gltf_skeleton_add_tips(const ff_gltf *gltf, ff_gltf_skeleton *skeleton, ff_error *error)
{
    ff_skin skin;
    if (skeleton->skin < 0 || ff_gltf_skin_read(gltf, skeleton, &skin, NULL) != FF_OK) return FF_OK;
    reach *around = ff_calloc((size_t)skeleton->count, sizeof *around);
    bool room = around != NULL;
    int tips = 0;
    if (room) measure(&skin, skeleton, around);
    for (int j = 0; room && j < skeleton->count; ++j)
        tips += has_tip(skeleton, around, j);
    if (room && tips > 0 && skeleton->count + tips <= FF_CLIP_MAX_JOINTS)
        room = insert(skeleton, around, tips, gltf->node_count);
    free(around);
    ff_skin_free(&skin);
    return room ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d joints", skeleton->count + tips);
}
