#include "mocap/gltf.h"

#include "mocap/gltf_guard.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* --------------------------------------------------------------------------------------------------- checks */

static size_t component_size(int component)
{
    switch (component) {
    case FF_GLTF_I8:
    case FF_GLTF_U8:
        return 1;
    case FF_GLTF_I16:
    case FF_GLTF_U16:
        return 2;
    case FF_GLTF_U32:
    case FF_GLTF_F32:
        return 4;
    default:
        return 0;
    }
}

/* Depth first, children in the order of their indices; what is not reached from a root is part of a loop. */
static int sort_nodes(ff_gltf *gltf, int *first, int *next, int *stack)
{
    int placed = 0, depth = 0;
    for (int i = 0; i <= gltf->node_count; ++i)
        first[i] = -1;
    for (int i = gltf->node_count - 1; i >= 0; --i) {
        int *list = &first[gltf->nodes[i].parent + 1]; /* roots are the children of node -1 */
        next[i] = *list;
        *list = i;
    }
    for (int n = first[0]; n >= 0 || depth > 0;) {
        if (n < 0) {
            n = next[stack[--depth]];
            continue;
        }
        gltf->order[placed++] = n;
        stack[depth++] = n;
        n = first[n + 1];
    }
    return placed;
}

static ff_status check_nodes(ff_gltf *gltf, ff_error *error)
{
    size_t count = (size_t)gltf->node_count;
    int *room = ff_calloc(3 * count + 1, sizeof *room);
    if (!room) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu nodes", count);
    int placed = sort_nodes(gltf, room, room + count + 1, room + 2 * count + 1);
    free(room);
    if (placed < gltf->node_count) return ff_fail(error, FF_ERR_PARSE, "nodes: some are their own ancestors");
    for (int i = 0; i < gltf->node_count; ++i) {
        const ff_gltf_node *node = &gltf->nodes[i];
        if (node->mesh >= gltf->mesh_count || node->skin >= gltf->skin_count)
            return ff_fail(error, FF_ERR_PARSE, "nodes[%d]: no such mesh or skin", i);
    }
    return FF_OK;
}

static ff_status check_views(const ff_gltf *gltf, ff_error *error)
{
    for (int i = 0; i < gltf->view_count; ++i) {
        const ff_gltf_view *view = &gltf->views[i];
        if (view->buffer < 0 || view->buffer >= gltf->buffer_count)
            return ff_fail(error, FF_ERR_PARSE, "bufferViews[%d].buffer: no buffer %d", view->number,
                           view->buffer);
        size_t size = gltf->buffers[view->buffer].size;
        if (view->offset > size || view->size > size - view->offset)
            return ff_fail(error, FF_ERR_PARSE,
                           "bufferViews[%d]: bytes %zu to %zu of buffer %d, which has %zu", view->number,
                           view->offset, view->offset + view->size, view->buffer, size);
    }
    return FF_OK;
}

/* count elements of width numbers lie inside the view of a place. */
static bool fits(const ff_gltf *gltf, const ff_gltf_place *at, size_t count, int width, bool packed)
{
    if (at->view < 0 || at->view >= gltf->view_count) return false;
    const ff_gltf_view *view = &gltf->views[at->view];
    size_t size = component_size(at->component) * (size_t)width;
    size_t stride = view->stride && !packed ? view->stride : size;
    if (size == 0 || stride < size || at->offset > view->size || size > view->size - at->offset) return false;
    return count >= 1 && (count - 1) <= (view->size - at->offset - size) / stride;
}

/* An accessor without a view is zeros: its count is checked by nothing in the file. */
enum { MOST_ZEROS = 1 << 20 };

static ff_status check_accessors(const ff_gltf *gltf, ff_error *error)
{
    for (int i = 0; i < gltf->accessor_count; ++i) {
        const ff_gltf_accessor *a = &gltf->accessors[i];
        if (component_size(a->at.component) == 0)
            return ff_fail(error, FF_ERR_PARSE, "accessors[%d].componentType: %d is none", a->number,
                           a->at.component);
        if (a->count == 0 || a->width < 1 || a->width > 16)
            return ff_fail(error, FF_ERR_PARSE, "accessors[%d]: holds nothing", a->number);
        if (a->at.view >= 0 ? !fits(gltf, &a->at, a->count, a->width, false) : a->count > MOST_ZEROS)
            return ff_fail(error, FF_ERR_PARSE, "accessors[%d]: %zu elements do not fit into bufferView %d",
                           a->number, a->count, a->at.view);
        if (a->sparse_count == 0) continue;
        int index = a->sparse_indices.component;
        if (index != FF_GLTF_U8 && index != FF_GLTF_U16 && index != FF_GLTF_U32)
            return ff_fail(error, FF_ERR_PARSE,
                           "accessors[%d].sparse.indices.componentType: %d is no unsigned integer", a->number,
                           index);
        if (a->sparse_count > a->count || !fits(gltf, &a->sparse_indices, a->sparse_count, 1, true) ||
            !fits(gltf, &a->sparse_values, a->sparse_count, a->width, true))
            return ff_fail(error, FF_ERR_PARSE, "accessors[%d].sparse: %zu elements do not fit", a->number,
                           a->sparse_count);
    }
    return FF_OK;
}

static bool none_or(int index, int count)
{
    return index < count; /* below 0 = none */
}

static const ff_gltf_accessor *accessor_at(const ff_gltf *gltf, int index)
{
    return index >= 0 && index < gltf->accessor_count ? &gltf->accessors[index] : NULL;
}

static ff_status check_channels(const ff_gltf *gltf, int animation, ff_error *error)
{
    static const int widths[] = {3, 4, 3};
    const ff_gltf_animation *a = &gltf->animations[animation];
    for (int c = 0; c < a->channel_count; ++c) {
        const ff_gltf_channel *channel = &gltf->channels[a->first_channel + c];
        const ff_gltf_accessor *input = accessor_at(gltf, channel->input),
                               *output = accessor_at(gltf, channel->output);
        if (!none_or(channel->node, gltf->node_count))
            return ff_fail(error, FF_ERR_PARSE, "animations[%d].channels[%d]: no node %d", animation, c,
                           channel->node);
        if (!input || !output)
            return ff_fail(error, FF_ERR_PARSE, "animations[%d].channels[%d]: its sampler names no accessor",
                           animation, c);
        if (channel->node < 0 || channel->path == FF_GLTF_OTHER) continue;
        size_t values = channel->interpolation == FF_GLTF_CUBICSPLINE ? 3 : 1;
        if (input->width != 1 || input->at.component != FF_GLTF_F32)
            return ff_fail(error, FF_ERR_PARSE,
                           "animations[%d].channels[%d]: times are not single floats (accessors[%d])",
                           animation, c, input->number);
        if (output->width != widths[channel->path] || output->count != input->count * values)
            return ff_fail(error, FF_ERR_PARSE,
                           "animations[%d].channels[%d]: %zu keys need %zu values of %d numbers, "
                           "accessors[%d] has %zu of %d",
                           animation, c, input->count, input->count * values, widths[channel->path],
                           output->number, output->count, output->width);
    }
    return FF_OK;
}

static ff_status check_skins(const ff_gltf *gltf, ff_error *error)
{
    for (int i = 0; i < gltf->skin_joint_count; ++i)
        if (gltf->skin_joints[i] < 0 || gltf->skin_joints[i] >= gltf->node_count)
            return ff_fail(error, FF_ERR_PARSE, "skins: no node %d", gltf->skin_joints[i]);
    for (int i = 0; i < gltf->skin_count; ++i) {
        const ff_gltf_skin *skin = &gltf->skins[i];
        const ff_gltf_accessor *bind = accessor_at(gltf, skin->inverse_bind);
        if (skin->inverse_bind < 0) continue;
        if (!bind || bind->width != 16 || bind->at.component != FF_GLTF_F32 ||
            bind->count < (size_t)skin->joint_count)
            return ff_fail(error, FF_ERR_PARSE,
                           "skins[%d].inverseBindMatrices: expected %d matrices of floats", i,
                           skin->joint_count);
    }
    return FF_OK;
}

static ff_status check_primitives(const ff_gltf *gltf, ff_error *error)
{
    int most = gltf->accessor_count;
    for (int i = 0; i < gltf->primitive_count; ++i) {
        const ff_gltf_primitive *p = &gltf->primitives[i];
        if (!none_or(p->indices, most) || !none_or(p->position, most) || !none_or(p->normal, most) ||
            !none_or(p->uv, most) || !none_or(p->joints, most) || !none_or(p->weights, most))
            return ff_fail(error, FF_ERR_PARSE, "meshes: a primitive names an accessor that does not exist");
    }
    return FF_OK;
}

ff_status ff_gltf_check(ff_gltf *gltf, ff_error *error)
{
    ff_status status = check_nodes(gltf, error);
    if (status == FF_OK) status = check_views(gltf, error);
    if (status == FF_OK) status = check_accessors(gltf, error);
    for (int i = 0; i < gltf->animation_count && status == FF_OK; ++i)
        status = check_channels(gltf, i, error);
    if (status == FF_OK) status = check_skins(gltf, error);
    if (status == FF_OK) status = check_primitives(gltf, error);
    return status;
}

/* -------------------------------------------------------------------------------------------- open and close */

void ff_gltf_close(ff_gltf *gltf)
{
    free(gltf->nodes);
    free(gltf->order);
    free(gltf->buffers);
    free(gltf->views);
    free(gltf->accessors);
    free(gltf->animations);
    free(gltf->channels);
    free(gltf->skins);
    free(gltf->skin_joints);
    free(gltf->meshes);
    free(gltf->primitives);
    if (gltf->model) ff_gltf_release_model(gltf->model);
    memset(gltf, 0, sizeof *gltf);
}

ff_status ff_gltf_open(const char *data, size_t size, const char *path, ff_gltf_keys keys, ff_gltf *out,
                       ff_error *error)
{
    memset(out, 0, sizeof *out);
    ff_gltf_guarded *guarded = ff_calloc(1, sizeof *guarded);
    if (!guarded) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the document");
    ff_status status = ff_gltf_guard(data, size, path, keys, guarded, error);
    if (status == FF_OK)
        status = ff_gltf_adapt(guarded->json, guarded->buffers, guarded->buffer_count, out, error);
    ff_gltf_guarded_free(guarded);
    free(guarded);
    if (status == FF_OK) status = ff_gltf_check(out, error);
    if (status != FF_OK) {
        ff_error_in_file(error, path);
        ff_gltf_close(out);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------- accessors */

/* Bytes are little-endian whatever the machine. */
static double component_at(const unsigned char *p, int component, bool normalised)
{
    uint32_t u = p[0];
    if (component_size(component) >= 2) u |= (uint32_t)p[1] << 8;
    if (component_size(component) == 4) u |= (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    float f;
    double value;
    switch (component) {
    case FF_GLTF_I8:
        value = (int8_t)u;
        return normalised ? (value < -127.0 ? -1.0 : value / 127.0) : value;
    case FF_GLTF_U8:
        return normalised ? u / 255.0 : u;
    case FF_GLTF_I16:
        value = (int16_t)u;
        return normalised ? (value < -32767.0 ? -1.0 : value / 32767.0) : value;
    case FF_GLTF_U16:
        return normalised ? u / 65535.0 : u;
    case FF_GLTF_U32:
        return u;
    default:
        memcpy(&f, &u, sizeof f);
        return (double)f;
    }
}

static const unsigned char *element_at(const ff_gltf *gltf, const ff_gltf_place *at, size_t index, int width,
                                       bool packed)
{
    const ff_gltf_view *view = &gltf->views[at->view];
    size_t stride = view->stride && !packed ? view->stride : component_size(at->component) * (size_t)width;
    return gltf->buffers[view->buffer].data + view->offset + at->offset + index * stride;
}

static bool read_element(const ff_gltf *gltf, const ff_gltf_accessor *a, const ff_gltf_place *at,
                         size_t index, bool packed, double *out)
{
    const unsigned char *p = element_at(gltf, at, index, a->width, packed);
    bool finite = true;
    for (int i = 0; i < a->width; ++i) {
        out[i] = component_at(p + (size_t)i * component_size(at->component), at->component, a->normalised);
        finite = finite && out[i] >= -1e30 && out[i] <= 1e30;
    }
    return finite;
}

ff_status ff_gltf_read(const ff_gltf *gltf, int accessor, double **out, ff_error *error)
{
    const ff_gltf_accessor *a = &gltf->accessors[accessor];
    size_t width = (size_t)a->width;
    double *values = ff_calloc(a->count * width, sizeof *values);
    *out = NULL;
    if (!values)
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for accessors[%d] of %zu elements", a->number,
                       a->count);
    bool finite = true, inside = true;
    for (size_t i = 0; a->at.view >= 0 && i < a->count; ++i)
        finite = read_element(gltf, a, &a->at, i, false, values + i * width) && finite;
    for (size_t i = 0; i < a->sparse_count; ++i) {
        const unsigned char *p = element_at(gltf, &a->sparse_indices, i, 1, true);
        double index = component_at(p, a->sparse_indices.component, false);
        inside = inside && index < (double)a->count;
        if (inside)
            finite =
                read_element(gltf, a, &a->sparse_values, i, true, values + (size_t)index * width) && finite;
    }
    if (finite && inside) {
        *out = values;
        return FF_OK;
    }
    free(values);
    if (!inside)
        return ff_fail(error, FF_ERR_PARSE, "accessors[%d].sparse: an index is beyond its %zu elements",
                       a->number, a->count);
    return ff_fail(error, FF_ERR_NOT_FINITE, "accessors[%d] holds nan, inf or absurd numbers", a->number);
}
