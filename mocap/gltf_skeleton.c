#include "mocap/gltf_skeleton.h"

#include "mocap/clip.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

void ff_gltf_skeleton_free(ff_gltf_skeleton *skeleton)
{
    free(skeleton->node);
    free(skeleton->parent);
    free(skeleton->joint);
    free(skeleton->turned);
    free(skeleton->at);
    memset(skeleton, 0, sizeof *skeleton);
}

/* --------------------------------------------------------------------------------------------- whose joints */

static const int *joints_of(const ff_gltf *gltf, int skin)
{
    return gltf->skin_joints + gltf->skins[skin].first_joint;
}

/* Skins that share a joint dress one body: number them by the first skin of their body. */
static void find_bodies(const ff_gltf *gltf, int *body, int *owner)
{
    for (int n = 0; n < gltf->node_count; ++n)
        owner[n] = -1;
    for (int s = 0; s < gltf->skin_count; ++s) {
        body[s] = s;
        for (int i = 0; i < gltf->skins[s].joint_count; ++i) {
            int *first = &owner[joints_of(gltf, s)[i]];
            if (*first < 0) *first = s;
            int one = body[*first], other = body[s];
            for (int t = 0; one != other && t <= s; ++t)
                if (body[t] == one || body[t] == other) body[t] = one < other ? one : other;
        }
    }
}

/* Channels of the animation that move the joints of a body; joints count too when there is no animation. */
static int weigh_body(const ff_gltf *gltf, int animation, const int *body, const int *owner, int wanted)
{
    int weight = 0;
    if (animation >= 0) {
        const ff_gltf_animation *a = &gltf->animations[animation];
        for (int c = 0; c < a->channel_count; ++c) {
            int n = gltf->channels[a->first_channel + c].node;
            weight += n >= 0 && owner[n] >= 0 && body[owner[n]] == wanted;
        }
        return weight;
    }
    for (int s = 0; s < gltf->skin_count; ++s)
        if (body[s] == wanted) weight += gltf->skins[s].joint_count;
    return weight;
}

static void mark_body(const ff_gltf *gltf, int animation, const int *body, const int *owner, bool *marked,
                      ff_gltf_skeleton *out)
{
    int best = -1, most = -1;
    for (int s = 0; s < gltf->skin_count; ++s) {
        int weight = body[s] == s ? weigh_body(gltf, animation, body, owner, s) : -1;
        if (weight > most) most = weight, best = s;
    }
    for (int s = 0; s < gltf->skin_count; ++s) {
        out->left_out += body[s] != best;
        if (body[s] != best) continue;
        if (out->skin < 0 || gltf->skins[s].joint_count > gltf->skins[out->skin].joint_count) out->skin = s;
        for (int i = 0; i < gltf->skins[s].joint_count; ++i)
            marked[joints_of(gltf, s)[i]] = true;
    }
}

/* A file without a skin: what the animation moves, what hangs on it, and the nodes that join these. moved and children
 * [node_count] are room to work in, zeroed. */
static void mark_moving(const ff_gltf *gltf, int animation, bool *marked, bool *moved, int *children)
{
    const ff_gltf_animation *a = &gltf->animations[animation];
    for (int c = 0; c < a->channel_count; ++c) {
        const ff_gltf_channel *channel = &gltf->channels[a->first_channel + c];
        if (channel->node >= 0 && channel->path != FF_GLTF_OTHER) moved[channel->node] = true;
    }
    for (int i = 0; i < gltf->node_count; ++i) {
        int n = gltf->order[i], parent = gltf->nodes[n].parent;
        marked[n] = moved[n] = moved[n] || (parent >= 0 && moved[parent]);
    }
    for (int i = gltf->node_count - 1; i >= 0; --i) { /* children before parents */
        int n = gltf->order[i], parent = gltf->nodes[n].parent;
        if (!marked[n] || parent < 0) continue;
        marked[parent] = true;
        children[parent]++;
    }
    /* Whatever merely stands above all of it is folded in. */
    for (int i = 0; i < gltf->node_count; ++i) {
        int n = gltf->order[i], parent = gltf->nodes[n].parent;
        if (!moved[n] && children[n] < 2 && (parent < 0 || !marked[parent])) marked[n] = false;
    }
}

static ff_status mark(const ff_gltf *gltf, int animation, bool *marked, ff_gltf_skeleton *out,
                      ff_error *error)
{
    out->skin = -1;
    size_t nodes = (size_t)gltf->node_count, skins = (size_t)gltf->skin_count;
    if (gltf->skin_count == 0) {
        bool *moved = ff_calloc(nodes, sizeof *moved);
        int *children = ff_calloc(nodes, sizeof *children);
        bool have = moved && children;
        if (have && animation >= 0) mark_moving(gltf, animation, marked, moved, children);
        free(moved);
        free(children);
        return have ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu nodes", nodes);
    }
    int *room = ff_calloc(nodes + skins, sizeof *room);
    if (!room) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu skins", skins);
    find_bodies(gltf, room, room + skins);
    mark_body(gltf, animation, room, room + skins, marked, out);
    free(room);
    return FF_OK;
}

static ff_status list_joints(const ff_gltf *gltf, const bool *marked, ff_gltf_skeleton *out, ff_error *error)
{
    for (int n = 0; n < gltf->node_count; ++n)
        out->count += marked[n];
    if (out->count == 0)
        return ff_fail(error, FF_ERR_NO_DATA, "no skin and no animated node: there is no skeleton");
    if (out->count > FF_CLIP_MAX_JOINTS)
        return ff_fail(error, FF_ERR_RANGE, "%d joints, at most %d are read", out->count, FF_CLIP_MAX_JOINTS);
    size_t count = (size_t)out->count;
    out->node = ff_calloc(count, sizeof *out->node);
    out->parent = ff_calloc(count, sizeof *out->parent);
    out->turned = ff_calloc(count, sizeof *out->turned);
    out->at = ff_calloc(count, sizeof *out->at);
    out->joint = ff_calloc((size_t)gltf->node_count, sizeof *out->joint);
    if (!out->node || !out->parent || !out->turned || !out->at || !out->joint)
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d joints", out->count);
    int j = 0;
    for (int i = 0; i < gltf->node_count; ++i) {
        int n = gltf->order[i], parent = gltf->nodes[n].parent, above = parent >= 0 ? out->joint[parent] : -1;
        out->joint[n] = above; /* for now: the joint this node moves with */
        if (!marked[n]) continue;
        out->node[j] = n;
        out->parent[j] = above;
        out->joint[n] = j++;
    }
    for (int n = 0; n < gltf->node_count; ++n)
        if (!marked[n]) out->joint[n] = -1;
    return FF_OK;
}

/* ---------------------------------------------------------------------------------------------------- at rest */

static void rest_as_placed(const ff_affine *placed, ff_gltf_skeleton *s)
{
    for (int j = 0; j < s->count; ++j) {
        const ff_affine *world = &placed[s->node[j]];
        if (!ff_affine_rotation(world, &s->turned[j]))
            s->turned[j] = s->parent[j] >= 0 ? s->turned[s->parent[j]] : FF_QUAT_IDENTITY;
        s->at[j] = world->at;
    }
}

/* How the skin's own space lies in the world. The root's place in the file would tell if the file's nodes were at rest,
 * but some exporters leave them in a pose: so the turn is taken to be none or that of what stands above the
 * skeleton, whichever is nearer to it, unless neither is. */
static ff_quat turn_of_bind(const ff_gltf *gltf, const ff_affine *placed, int root, ff_quat seen)
{
    ff_quat above = FF_QUAT_IDENTITY;
    int parent = gltf->nodes[root].parent;
    if (parent >= 0) ff_affine_rotation(&placed[parent], &above);
    double plain = ff_quat_angle(seen), turned = ff_quat_angle(ff_quat_mul(ff_quat_conj(above), seen));
    if (ff_min(plain, turned) > 45.0 * FF_DEG) return seen;
    return plain <= turned ? FF_QUAT_IDENTITY : above;
}

/* Lengths of bones in the world over their lengths at bind: what a 0.01 above the skeleton makes of them. */
static double scale_of_bind(const ff_gltf_skeleton *s, const ff_affine *placed, const ff_vec3 *bound,
                            const bool *known)
{
    double world = 0.0, own = 0.0;
    for (int j = 0; j < s->count; ++j) {
        int p = s->parent[j];
        if (p < 0 || !known[j] || !known[p]) continue;
        world += ff_length3(ff_sub3(placed[s->node[j]].at, placed[s->node[p]].at));
        own += ff_length3(ff_sub3(bound[j], bound[p]));
    }
    return own > 0.0 ? world / own : 1.0;
}

/* The pose the skin was bound in, which is what a person calls the rest pose (T or A). Joints that the skin does not
 * have keep their place in the file relative to their parent. */
static bool rest_as_bound(const ff_gltf *gltf, const ff_affine *placed, const double *inverse,
                          ff_gltf_skeleton *s, ff_vec3 *bound, bool *known)
{
    const ff_gltf_skin *skin = &gltf->skins[s->skin];
    int root = -1;
    ff_quat own_turn = FF_QUAT_IDENTITY;
    for (int i = 0; i < skin->joint_count; ++i) {
        int j = s->joint[joints_of(gltf, s->skin)[i]];
        ff_affine unbind = ff_affine_from_columns(inverse + 16 * (size_t)i), bind;
        ff_quat turned;
        if (!ff_affine_invert(&unbind, &bind) || !ff_affine_rotation(&bind, &turned)) return false;
        bound[j] = bind.at;
        s->turned[j] = turned;
        known[j] = true;
        if (root >= 0 && j >= root) continue;
        root = j;
        own_turn = turned;
    }
    ff_quat world;
    if (root < 0 || !ff_affine_rotation(&placed[s->node[root]], &world)) return false;
    s->bind_turn = turn_of_bind(gltf, placed, s->node[root], ff_quat_mul(world, ff_quat_conj(own_turn)));
    s->bind_scale = scale_of_bind(s, placed, bound, known);
    for (int j = 0; j < s->count; ++j) {
        if (known[j]) {
            s->turned[j] = ff_quat_mul(s->bind_turn, s->turned[j]);
            s->at[j] = ff_scale3(ff_quat_rotate(s->bind_turn, bound[j]), s->bind_scale);
            continue;
        }
        int p = s->parent[j];
        ff_quat here = FF_QUAT_IDENTITY, above = FF_QUAT_IDENTITY;
        ff_affine_rotation(&placed[s->node[j]], &here);
        s->turned[j] = here;
        s->at[j] = placed[s->node[j]].at;
        if (p < 0) continue;
        ff_affine_rotation(&placed[s->node[p]], &above);
        ff_quat change = ff_quat_mul(s->turned[p], ff_quat_conj(above));
        s->turned[j] = ff_quat_mul(change, here);
        s->at[j] =
            ff_add3(s->at[p], ff_quat_rotate(change, ff_sub3(placed[s->node[j]].at, placed[s->node[p]].at)));
    }
    return true;
}

static ff_status find_rest(const ff_gltf *gltf, ff_gltf_skeleton *s, ff_error *error)
{
    ff_affine *placed = ff_calloc((size_t)gltf->node_count, sizeof *placed);
    ff_vec3 *bound = ff_calloc((size_t)s->count, sizeof *bound);
    bool *known = ff_calloc((size_t)s->count, sizeof *known);
    double *inverse = NULL;
    ff_status status = FF_OK;
    if (!placed || !bound || !known)
        status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d joints", s->count);
    int accessor = s->skin >= 0 ? gltf->skins[s->skin].inverse_bind : -1;
    if (status == FF_OK && accessor >= 0) status = ff_gltf_read(gltf, accessor, &inverse, error);
    if (status == FF_OK) {
        ff_gltf_placed(gltf, placed);
        s->bind_scale = 1.0;
        s->bind_turn = FF_QUAT_IDENTITY;
        if (!inverse || !rest_as_bound(gltf, placed, inverse, s, bound, known)) rest_as_placed(placed, s);
    }
    free(placed);
    free(bound);
    free(known);
    free(inverse);
    return status;
}

ff_status ff_gltf_skeleton_find(const ff_gltf *gltf, int animation, ff_gltf_skeleton *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    bool *marked = ff_calloc((size_t)gltf->node_count, sizeof *marked);
    if (!marked) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d nodes", gltf->node_count);
    ff_status status = mark(gltf, animation, marked, out, error);
    if (status == FF_OK) status = list_joints(gltf, marked, out, error);
    free(marked);
    return status == FF_OK ? find_rest(gltf, out, error) : status;
}
