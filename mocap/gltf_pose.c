#include "mocap/gltf_pose.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* -------------------------------------------------------------------------------------------------- transforms */

ff_affine ff_affine_mul(const ff_affine *a, const ff_affine *b)
{
    return (ff_affine){ff_affine_turn(a, b->x), ff_affine_turn(a, b->y), ff_affine_turn(a, b->z),
                       ff_add3(ff_affine_turn(a, b->at), a->at)};
}

bool ff_affine_invert(const ff_affine *a, ff_affine *out)
{
    ff_vec3 u = ff_cross3(a->y, a->z), v = ff_cross3(a->z, a->x), w = ff_cross3(a->x, a->y);
    double volume = ff_dot3(a->x, u), size = ff_length3(a->x) * ff_length3(a->y) * ff_length3(a->z);
    if (!(fabs(volume) > 1e-9 * size)) return false;
    double k = 1.0 / volume;
    out->x = ff_scale3(ff_v3(u.x, v.x, w.x), k);
    out->y = ff_scale3(ff_v3(u.y, v.y, w.y), k);
    out->z = ff_scale3(ff_v3(u.z, v.z, w.z), k);
    out->at = ff_v3(0.0, 0.0, 0.0);
    out->at = ff_scale3(ff_affine_turn(out, a->at), -1.0);
    return true;
}

ff_affine ff_affine_from_columns(const double m[16])
{
    return (ff_affine){ff_v3(m[0], m[1], m[2]), ff_v3(m[4], m[5], m[6]), ff_v3(m[8], m[9], m[10]),
                       ff_v3(m[12], m[13], m[14])};
}

/* Rotation whose matrix has these perpendicular unit columns (Shepperd's method: the largest component first). */
static ff_quat quat_from_axes(ff_vec3 x, ff_vec3 y, ff_vec3 z)
{
    double trace = x.x + y.y + z.z;
    ff_quat q;
    if (trace > 0.0) {
        q = (ff_quat){y.z - z.y, z.x - x.z, x.y - y.x, 1.0 + trace};
    } else if (x.x >= y.y && x.x >= z.z) {
        q = (ff_quat){1.0 + x.x - y.y - z.z, y.x + x.y, z.x + x.z, y.z - z.y};
    } else if (y.y >= z.z) {
        q = (ff_quat){y.x + x.y, 1.0 + y.y - x.x - z.z, z.y + y.z, z.x - x.z};
    } else {
        q = (ff_quat){z.x + x.z, z.y + y.z, 1.0 + z.z - x.x - y.y, x.y - y.x};
    }
    return ff_quat_unit(q);
}

bool ff_affine_rotation(const ff_affine *a, ff_quat *out)
{
    ff_vec3 x = ff_unit3(a->x), z = ff_cross3(x, ff_unit3(a->y));
    if (!(ff_length3(z) > 1e-6)) return false;
    z = ff_unit3(z);
    *out = quat_from_axes(x, ff_cross3(z, x), z);
    return true;
}

static ff_affine affine_from_parts(const double p[10])
{
    ff_quat q = ff_quat_unit((ff_quat){p[3], p[4], p[5], p[6]});
    return (ff_affine){ff_scale3(ff_quat_rotate(q, ff_v3(1.0, 0.0, 0.0)), p[7]),
                       ff_scale3(ff_quat_rotate(q, ff_v3(0.0, 1.0, 0.0)), p[8]),
                       ff_scale3(ff_quat_rotate(q, ff_v3(0.0, 0.0, 1.0)), p[9]), ff_v3(p[0], p[1], p[2])};
}

/* Translation, rotation and scale of a node, from its matrix when it has one (a mirrored one gets a negative scale). */
static void parts_of_node(const ff_gltf_node *node, double p[10])
{
    memcpy(p, node->translation, sizeof node->translation);
    memcpy(p + 3, node->rotation, sizeof node->rotation);
    memcpy(p + 7, node->scale, sizeof node->scale);
    if (!node->has_matrix) return;
    ff_affine a = ff_affine_from_columns(node->matrix);
    ff_quat q = FF_QUAT_IDENTITY;
    ff_affine_rotation(&a, &q);
    double mirror = ff_dot3(ff_cross3(a.x, a.y), a.z) < 0.0 ? -1.0 : 1.0;
    double parts[10] = {a.at.x,
                        a.at.y,
                        a.at.z,
                        q.x,
                        q.y,
                        q.z,
                        q.w,
                        ff_length3(a.x),
                        ff_length3(a.y),
                        mirror * ff_length3(a.z)};
    memcpy(p, parts, sizeof parts);
}

static ff_affine local_of_node(const ff_gltf_node *node)
{
    double parts[10];
    if (node->has_matrix) return ff_affine_from_columns(node->matrix);
    parts_of_node(node, parts);
    return affine_from_parts(parts);
}

static void to_world(const ff_gltf *gltf, const ff_affine *local, ff_affine *world)
{
    for (int i = 0; i < gltf->node_count; ++i) {
        int n = gltf->order[i], parent = gltf->nodes[n].parent;
        world[n] = parent < 0 ? local[n] : ff_affine_mul(&world[parent], &local[n]);
    }
}

void ff_gltf_placed(const ff_gltf *gltf, ff_affine *world)
{
    for (int i = 0; i < gltf->node_count; ++i) {
        int n = gltf->order[i], parent = gltf->nodes[n].parent;
        ff_affine local = local_of_node(&gltf->nodes[n]);
        world[n] = parent < 0 ? local : ff_affine_mul(&world[parent], &local);
    }
}

/* -------------------------------------------------------------------------------------------------------- curves */

/* The key at or before time, from the cursor on: times are asked for in order, mostly. */
static size_t key_before(ff_gltf_curve *curve, double time)
{
    size_t k = curve->cursor;
    if (time < curve->times[k]) k = 0;
    while (k + 1 < curve->count && curve->times[k + 1] <= time)
        ++k;
    return curve->cursor = k;
}

static ff_quat quat_at(const double *v)
{
    return ff_quat_unit((ff_quat){v[0], v[1], v[2], v[3]});
}

/* The cubic Hermite spline of the glTF specification, appendix C.5: each key is in-tangent, value, out-tangent. */
static void cubic(const ff_gltf_curve *curve, size_t k, double t, double span, int width, double *out)
{
    const double *from = curve->values + k * 3 * (size_t)width, *to = from + 3 * (size_t)width;
    double t2 = t * t, t3 = t2 * t;
    for (int i = 0; i < width; ++i)
        out[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * from[width + i] +
                 span * (t3 - 2.0 * t2 + t) * from[2 * width + i] + (3.0 * t2 - 2.0 * t3) * to[width + i] +
                 span * (t3 - t2) * to[i];
}

static void curve_at(ff_gltf_curve *curve, double time, double *out)
{
    int width = curve->path == FF_GLTF_ROTATION ? 4 : 3;
    bool spline = curve->interpolation == FF_GLTF_CUBICSPLINE;
    size_t k = key_before(curve, time), step = (size_t)width * (spline ? 3 : 1);
    const double *value = curve->values + k * step + (spline ? width : 0);
    double span = k + 1 < curve->count ? curve->times[k + 1] - curve->times[k] : 0.0;
    double t = span > 0.0 ? ff_clamp((time - curve->times[k]) / span, 0.0, 1.0) : 0.0;
    if (t <= 0.0 || curve->interpolation == FF_GLTF_STEP) {
        memcpy(out, value, (size_t)width * sizeof *out);
    } else if (spline) {
        cubic(curve, k, t, span, width, out);
    } else if (width == 3) {
        for (int i = 0; i < 3; ++i)
            out[i] = ff_lerp(value[i], value[3 + i], t);
    } else {
        ff_quat q = ff_quat_slerp(quat_at(value), quat_at(value + 4), t);
        memcpy(out, &q, sizeof q);
    }
}

/* ------------------------------------------------------------------------------------------------------- motion */

void ff_gltf_motion_free(ff_gltf_motion *motion)
{
    for (int i = 0; i < motion->curve_count; ++i) {
        free(motion->curves[i].times);
        free(motion->curves[i].values);
    }
    free(motion->curves);
    free(motion->local);
    free(motion->parts);
    free(motion->moving);
    memset(motion, 0, sizeof *motion);
}

static ff_status read_curve(const ff_gltf *gltf, const ff_gltf_channel *channel, ff_gltf_curve *out,
                            ff_error *error)
{
    *out = (ff_gltf_curve){.node = channel->node,
                           .path = channel->path,
                           .interpolation = channel->interpolation,
                           .count = gltf->accessors[channel->input].count};
    ff_status status = ff_gltf_read(gltf, channel->input, &out->times, error);
    if (status == FF_OK) status = ff_gltf_read(gltf, channel->output, &out->values, error);
    for (size_t i = 1; status == FF_OK && i < out->count; ++i)
        if (out->times[i] < out->times[i - 1])
            status = ff_fail(error, FF_ERR_PARSE, "accessors[%d]: times of keys go back at key %zu",
                             gltf->accessors[channel->input].number, i);
    return status;
}

/* Doubles of all keys of one animation at most: hours of any skeleton, half a gigabyte. */
#define MOST_NUMBERS ((size_t)1 << 26)

static ff_status read_curves(ff_gltf_motion *m, const ff_gltf_animation *animation, ff_error *error)
{
    const ff_gltf *gltf = m->gltf;
    m->curves = ff_calloc((size_t)animation->channel_count, sizeof *m->curves);
    if (!m->curves)
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d channels", animation->channel_count);
    size_t numbers = 0;
    m->start = HUGE_VAL;
    m->end = -HUGE_VAL;
    for (int c = 0; c < animation->channel_count; ++c) {
        const ff_gltf_channel *channel = &gltf->channels[animation->first_channel + c];
        if (channel->node < 0 || channel->path == FF_GLTF_OTHER) continue;
        numbers += gltf->accessors[channel->input].count + 4 * gltf->accessors[channel->output].count;
        if (numbers > MOST_NUMBERS)
            return ff_fail(error, FF_ERR_RANGE, "the animation's channels hold absurdly many keys");
        ff_gltf_curve *curve = &m->curves[m->curve_count++];
        ff_status status = read_curve(gltf, channel, curve, error);
        if (status != FF_OK) return status;
        m->moving[curve->node] = true;
        m->start = ff_min(m->start, curve->times[0]);
        m->end = ff_max(m->end, curve->times[curve->count - 1]);
    }
    if (m->curve_count == 0) m->start = m->end = 0.0;
    return FF_OK;
}

ff_status ff_gltf_motion_start(const ff_gltf *gltf, int animation, ff_gltf_motion *out, ff_error *error)
{
    size_t count = (size_t)gltf->node_count;
    memset(out, 0, sizeof *out);
    out->gltf = gltf;
    out->local = ff_calloc(count, sizeof *out->local);
    out->parts = ff_calloc(count, sizeof *out->parts);
    out->moving = ff_calloc(count, sizeof *out->moving);
    if (!out->local || !out->parts || !out->moving)
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu nodes", count);
    for (size_t i = 0; i < count; ++i) {
        out->local[i] = local_of_node(&gltf->nodes[i]);
        parts_of_node(&gltf->nodes[i], out->parts[i]);
    }
    return animation < 0 ? FF_OK : read_curves(out, &gltf->animations[animation], error);
}

void ff_gltf_motion_at(ff_gltf_motion *motion, double time, ff_affine *world)
{
    static const int first[] = {0, 3, 7};
    for (int i = 0; i < motion->curve_count; ++i) {
        ff_gltf_curve *curve = &motion->curves[i];
        double *part = motion->parts[curve->node] + first[curve->path];
        curve_at(curve, time, part);
        if (curve->path != FF_GLTF_SCALE) continue;
        for (int k = 0; k < 3; ++k) {
            double change =
                fabs(part[k] - curve->values[k + (curve->interpolation == FF_GLTF_CUBICSPLINE ? 3 : 0)]);
            motion->largest_scale_change = ff_max(motion->largest_scale_change, change);
        }
    }
    for (int n = 0; n < motion->gltf->node_count; ++n)
        if (motion->moving[n]) motion->local[n] = affine_from_parts(motion->parts[n]);
    to_world(motion->gltf, motion->local, world);
}
