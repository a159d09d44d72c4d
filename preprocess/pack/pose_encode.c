/* Which of eight ways (four rates, two widths) a lane is kept in is a matter of price: each costs bytes per second, and
 * loses so many square metres of mean position error. For one exchange rate between the two, every lane takes what is
 * best for it; the rate is the best quality (WORTH) or, if that takes too many bytes, the one that just fits. So noisy
 * capture keeps its shaking where it shows, in hips and legs, and smooth motion is small. */
#include "preprocess/pack/pose_encode.h"

#include "preprocess/pack/pose_lanes.h"
#include "preprocess/pack/pose_spline.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/pack/pose_stream.h"

#include <stdlib.h>
#include <string.h>

#define TOP_RATE 120.0    /* Hz: keys at most */
#define LEAST_KEYS 3000.0 /* bytes per second of keys that even the shortest stream may have */
#define WORTH 1e-10       /* m2 of mean square error that a byte per second must gain */
#define ROOT_ERROR 1e-4   /* m, rad */
#define WAYS (2 * FF_STREAM_LEVELS)

static const int key_size[2] = {1, 2};

typedef struct encoder {
    const ff_pose_motion *motion;
    ff_pose_lanes lanes;
    ff_spline_fit fit[FF_STREAM_LEVELS];
    int root_level;
    double seconds;
    double *keys[FF_LANES_MAX][FF_STREAM_LEVELS];
    double *root_keys[3];
    double loss[FF_LANES_MAX][WAYS]; /* way = 2 * level + wide */
    int way[FF_LANES_MAX];
} encoder;

/* --------------------------------------------------------------------------------------------------- quantising */

/* Codes of one lane: value = low + step * (code - least code). */
typedef struct grid {
    double low, step;
    int least, most;
} grid;

static grid grid_of(const double *keys, int count, bool wide)
{
    grid g = {keys[0], 0.0, wide ? -32768 : -128, wide ? 32767 : 127};
    double high = keys[0];
    for (int i = 1; i < count; ++i) {
        g.low = ff_min(g.low, keys[i]);
        high = ff_max(high, keys[i]);
    }
    g.step = (high - g.low) / (g.most - g.least);
    return g;
}

static int code_of(const grid *g, double value)
{
    if (!(g->step > 0.0)) return g->least;
    return g->least + (int)ff_clamp(floor((value - g->low) / g->step + 0.5), 0.0, g->most - g->least);
}

/* Mean square error in m2 of keeping a lane with these keys, rounded. */
static double loss_of(const encoder *e, int index, int level, bool wide, double *scratch)
{
    const ff_spline_fit *fit = &e->fit[level];
    const double *keys = e->keys[index][level];
    int count = fit->intervals + 3;
    grid g = grid_of(keys, count, wide);
    for (int i = 0; i < count; ++i)
        scratch[i] = g.low + g.step * (code_of(&g, keys[i]) - g.least);
    double sum = 0.0, lever = e->lanes.lane[index].lever;
    for (int i = 0; i < fit->samples; ++i) {
        double off = ff_spline_fit_value(fit, scratch, i) - e->lanes.lane[index].values[i];
        off *= ff_pose_lane_effect(&e->lanes, index, i);
        sum += off * off;
    }
    return lever * lever * sum / fit->samples;
}

/* ------------------------------------------------------------------------------------------------------- fitting */

static ff_status no_memory(const encoder *e, ff_error *error)
{
    return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory storing %d poses", e->motion->frame_count);
}

static ff_status make_fits(encoder *e, ff_error *error)
{
    const ff_pose_motion *m = e->motion;
    int spans = m->cyclic ? m->frame_count : m->frame_count - 1;
    if (spans < 1) spans = 1;
    e->seconds = spans * m->frame_time;
    double top = ff_min((double)spans, ff_max(1.0, floor(e->seconds * TOP_RATE + 0.5)));
    ff_status status = FF_OK;
    for (int level = 0; level < FF_STREAM_LEVELS && status == FF_OK; ++level) {
        int intervals = (int)ceil(top / (1 << level));
        status = ff_spline_fit_create(m->frame_count, intervals, m->cyclic, &e->fit[level], error);
    }
    return status;
}

static ff_status fit_lanes(encoder *e, ff_error *error)
{
    double *scratch = ff_calloc((size_t)e->fit[0].intervals + 3, sizeof *scratch);
    if (!scratch) return no_memory(e, error);
    for (int i = 0; i < e->lanes.count; ++i)
        for (int level = 0; level < FF_STREAM_LEVELS && !e->lanes.lane[i].still; ++level) {
            double *keys = ff_calloc((size_t)e->fit[level].intervals + 3, sizeof *keys);
            e->keys[i][level] = keys;
            if (!keys) {
                free(scratch);
                return no_memory(e, error);
            }
            ff_spline_fit_keys(&e->fit[level], e->lanes.lane[i].values, keys);
            for (int wide = 0; wide < 2; ++wide)
                e->loss[i][2 * level + wide] = loss_of(e, i, level, wide != 0, scratch);
        }
    free(scratch);
    return FF_OK;
}

/* The slowest keys that follow the root's path closely; float keys, so there is no rounding to speak of. */
static ff_status fit_root(encoder *e, ff_error *error)
{
    const ff_pose_motion *m = e->motion;
    if (!m->root) return FF_OK;
    double *path = ff_calloc((size_t)m->frame_count, sizeof *path), most = 0.0;
    for (int c = 0; c < 3; ++c)
        e->root_keys[c] = ff_calloc((size_t)e->fit[0].intervals + 3, sizeof(double));
    if (!path || !e->root_keys[0] || !e->root_keys[1] || !e->root_keys[2]) {
        free(path);
        return no_memory(e, error);
    }
    for (int level = FF_STREAM_LEVELS - 1; level >= 0; --level) {
        most = 0.0;
        for (int c = 0; c < 3; ++c) {
            for (int k = 0; k < m->frame_count; ++k)
                path[k] = c == 0 ? m->root[k].x : (c == 1 ? m->root[k].y : m->root[k].z);
            ff_spline_fit_keys(&e->fit[level], path, e->root_keys[c]);
            for (int k = 0; k < m->frame_count; ++k)
                most = ff_max(most, fabs(ff_spline_fit_value(&e->fit[level], e->root_keys[c], k) - path[k]));
        }
        e->root_level = level;
        if (most < ROOT_ERROR) break;
    }
    free(path);
    return FF_OK;
}

/* ------------------------------------------------------------------------------------------------------ choosing */

static double price(const encoder *e, int way)
{
    return key_size[way % 2] * (e->fit[way / 2].intervals + 3) / e->seconds;
}

/* The best way of every lane for an exchange rate (m2 per byte and second); returns the bytes per second of all. */
static double choose(encoder *e, double worth)
{
    double bytes = 0.0;
    for (int i = 0; i < e->lanes.count; ++i) {
        if (e->lanes.lane[i].still) continue;
        int best = 0;
        for (int way = 1; way < WAYS; ++way)
            if (e->loss[i][way] + worth * price(e, way) < e->loss[i][best] + worth * price(e, best))
                best = way;
        e->way[i] = best;
        bytes += price(e, best);
    }
    return bytes;
}

static void choose_ways(encoder *e)
{
    double tables = sizeof(ff_pack_stream) + sizeof(ff_pack_slots) + FF_STREAM_SLACK +
                    (FF_LANES_MAX / 8.0 + 2.0) * sizeof(ff_pack_lanes);
    if (e->motion->root) tables += (e->fit[e->root_level].intervals + 3) * 3.0 * sizeof(float);
    double most = e->motion->bytes > 0.0 ? e->motion->bytes : FF_POSE_BYTES;
    double limit = ff_max(most - tables / e->seconds, LEAST_KEYS * most / FF_POSE_BYTES);
    if (choose(e, WORTH) <= limit) return;
    double dear = WORTH, cheap = 1.0;
    for (int i = 0; i < 60; ++i) {
        double middle = sqrt(dear * cheap);
        if (choose(e, middle) > limit) {
            dear = middle;
        } else {
            cheap = middle;
        }
    }
    choose(e, cheap);
}

/* ------------------------------------------------------------------------------------------------------- writing */

/* Room for one more lane of a run that has so many, and the slot that shows it. */
static ff_pack_lanes *add_lane(const encoder *e, int index, int used, ff_pose_coded *out)
{
    int slot = e->lanes.lane[index].slot, part = slot / FF_STREAM_SLOTS;
    if (used % 8 == 0) {
        ff_pack_lanes *added = ff_array_grow(&out->lanes, 1, sizeof *added);
        if (!added) return NULL;
        memset(added, 0, sizeof *added);
    }
    size_t block = out->lanes.count - 1;
    out->slots.lane[part][slot % FF_STREAM_SLOTS] = (uint8_t)(FF_LANE_FIRST + 8 * (int)block + used % 8);
    if (part == 3) out->stream.flags |= FF_STREAM_FOUR_PARTS;
    return (ff_pack_lanes *)out->lanes.data + block;
}

/* Lanes of one run (level and width) as blocks of eight; the codes into column after column of the level's keys. */
static ff_status write_run(encoder *e, int level, bool wide, unsigned char *first, size_t stride,
                           ff_pose_coded *out, ff_error *error)
{
    int used = 0, count = e->fit[level].intervals + 3;
    for (int i = 0; i < e->lanes.count; ++i) {
        if (e->lanes.lane[i].still || e->way[i] != 2 * level + wide) continue;
        ff_pack_lanes *block = add_lane(e, i, used, out);
        if (!block) return no_memory(e, error);
        grid g = grid_of(e->keys[i][level], count, wide);
        block->base[used % 8] = (float)(g.low - g.step * g.least);
        block->scale[used % 8] = (float)(g.step / (wide ? 32768.0 : 32768.0 * 256.0));
        for (int k = 0; k < count; ++k) {
            int16_t code = (int16_t)code_of(&g, e->keys[i][level][k]);
            signed char small = (signed char)code;
            unsigned char *at = first + (size_t)k * stride + (size_t)used * (size_t)key_size[wide];
            memcpy(at, wide ? (const void *)&code : (const void *)&small, (size_t)key_size[wide]);
        }
        ++used;
    }
    return FF_OK;
}

static ff_status write_level(encoder *e, int number, ff_pose_coded *out, ff_error *error)
{
    ff_pack_level *level = &out->stream.level[number];
    for (int i = 0; i < e->lanes.count; ++i) {
        if (e->lanes.lane[i].still) continue;
        level->narrow = (uint16_t)(level->narrow + (e->way[i] == 2 * number));
        level->wide = (uint16_t)(level->wide + (e->way[i] == 2 * number + 1));
    }
    if (level->wide + level->narrow == 0) return FF_OK;
    size_t stride = ff_level_stride(level), bytes = stride * ((size_t)e->fit[number].intervals + 3);
    if (out->keys.count + bytes > 0x7fffffff)
        return ff_fail(error, FF_ERR_RANGE, "a motion of %.0f s is too long", e->seconds);
    level->first_byte = (uint32_t)out->keys.count;
    level->intervals = (uint32_t)e->fit[number].intervals;
    unsigned char *first = ff_array_grow(&out->keys, bytes, 1);
    if (!first) return no_memory(e, error);
    memset(first, 0, bytes);
    ff_status status = write_run(e, number, true, first, stride, out, error);
    if (status == FF_OK)
        status = write_run(e, number, false, first + 2 * (size_t)level->wide, stride, out, error);
    return status;
}

static ff_status write_still(encoder *e, ff_pose_coded *out, ff_error *error)
{
    for (int i = 0; i < e->lanes.count; ++i) {
        if (!e->lanes.lane[i].still) continue;
        int used = (int)out->stream.still++;
        ff_pack_lanes *block = add_lane(e, i, used, out);
        if (!block) return no_memory(e, error);
        block->base[used % 8] = (float)e->lanes.lane[i].values[0];
    }
    return FF_OK;
}

static ff_status write_root(encoder *e, ff_pose_coded *out, ff_error *error)
{
    if (!e->motion->root) return FF_OK;
    size_t count = (size_t)e->fit[e->root_level].intervals + 3;
    float(*keys)[3] = ff_array_grow(&out->roots, count, sizeof *keys);
    if (!keys) return no_memory(e, error);
    out->stream.root_intervals = (uint32_t)e->fit[e->root_level].intervals;
    for (size_t k = 0; k < count; ++k)
        for (int c = 0; c < 3; ++c)
            keys[k][c] = (float)e->root_keys[c][k];
    return FF_OK;
}

static ff_status write_all(encoder *e, ff_pose_coded *out, ff_error *error)
{
    ff_status status = FF_OK;
    out->stream.flags = e->motion->cyclic ? FF_STREAM_CYCLIC : 0;
    out->stream.seconds = (float)e->seconds;
    for (int j = 0; j < FF_STREAM_SLOTS; ++j) {
        ff_quat q = j < FF_JOINT_COUNT ? e->lanes.reference[j] : FF_QUAT_IDENTITY;
        out->slots.x[j] = (float)q.x;
        out->slots.y[j] = (float)q.y;
        out->slots.z[j] = (float)q.z;
        out->slots.w[j] = (float)q.w;
    }
    memset(out->slots.lane, FF_LANE_ZERO, sizeof out->slots.lane);
    memset(out->slots.lane[3], FF_LANE_ONE, sizeof out->slots.lane[3]);
    for (int level = 0; level < FF_STREAM_LEVELS && status == FF_OK; ++level)
        status = write_level(e, level, out, error);
    if (status == FF_OK) status = write_still(e, out, error);
    if (status == FF_OK) status = write_root(e, out, error);
    if (status != FF_OK) return status;
    unsigned char *slack = ff_array_grow(&out->keys, FF_STREAM_SLACK, 1);
    if (!slack) return no_memory(e, error);
    memset(slack, 0, FF_STREAM_SLACK);
    double bytes = (double)(out->keys.count + out->lanes.count * sizeof(ff_pack_lanes) +
                            out->roots.count * 3 * sizeof(float)) +
                   sizeof out->stream + sizeof out->slots;
    out->bytes_per_second = bytes / e->seconds;
    return FF_OK;
}

/* ----------------------------------------------------------------------------------------------------- measuring */

static ff_status measure(encoder *e, const ff_pack_joint *joints, const ff_pack_point *points,
                         ff_pose_coded *out, ff_error *error)
{
    size_t n = (size_t)e->motion->frame_count;
    ff_vec3 *root = ff_calloc(n, sizeof *root), *hips = ff_calloc(n, sizeof *hips);
    ff_quat *rotations = ff_calloc(n, FF_JOINT_COUNT * sizeof *rotations);
    ff_status status = root && hips && rotations ? FF_OK : no_memory(e, error);
    for (size_t k = 0; k < n && status == FF_OK; ++k) {
        double value[FF_LANES_MAX], at[3] = {0.0, 0.0, 0.0};
        for (int i = 0; i < e->lanes.count; ++i) {
            int level = e->way[i] / 2;
            value[i] = e->lanes.lane[i].still
                           ? e->lanes.lane[i].values[0]
                           : ff_spline_fit_value(&e->fit[level], e->keys[i][level], (int)k);
        }
        for (int c = 0; c < 3 && e->motion->root; ++c)
            at[c] = ff_spline_fit_value(&e->fit[e->root_level], e->root_keys[c], (int)k);
        root[k] = ff_v3(at[0], at[1], at[2]);
        ff_pose_lanes_pose(&e->lanes, value, &hips[k], rotations + k * FF_JOINT_COUNT);
    }
    ff_pose_motion splined = *e->motion;
    splined.root = root;
    splined.hips = hips;
    splined.rotations = rotations;
    if (status == FF_OK) status = ff_pose_measure(joints, points, e->motion, &splined, out, error);
    free(root);
    free(hips);
    free(rotations);
    return status;
}

static void release(encoder *e)
{
    for (int i = 0; i < FF_LANES_MAX; ++i)
        for (int level = 0; level < FF_STREAM_LEVELS; ++level)
            free(e->keys[i][level]);
    for (int c = 0; c < 3; ++c)
        free(e->root_keys[c]);
    for (int level = 0; level < FF_STREAM_LEVELS; ++level)
        ff_spline_fit_free(&e->fit[level]);
    ff_pose_lanes_free(&e->lanes);
    free(e);
}

ff_status ff_pose_encode(const ff_pack_joint *joints, const ff_pack_point *points,
                         const ff_pose_motion *motion, ff_pose_coded *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    encoder *e = ff_calloc(1, sizeof *e);
    if (!e) return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory storing %d poses", motion->frame_count);
    e->motion = motion;
    ff_status status = make_fits(e, error);
    if (status == FF_OK) status = ff_pose_lanes_create(joints, points, motion, &e->lanes, error);
    if (status == FF_OK) status = fit_lanes(e, error);
    if (status == FF_OK) status = fit_root(e, error);
    if (status == FF_OK) {
        choose_ways(e);
        status = write_all(e, out, error);
    }
    if (status == FF_OK) status = measure(e, joints, points, out, error);
    release(e);
    if (status != FF_OK) ff_pose_coded_free(out);
    return status;
}

void ff_pose_coded_free(ff_pose_coded *coded)
{
    ff_array_free(&coded->lanes);
    ff_array_free(&coded->keys);
    ff_array_free(&coded->roots);
    memset(coded, 0, sizeof *coded);
}
