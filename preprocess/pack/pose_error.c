/* How far joints are from where they should be in a stored motion, and putting it into the pack. */
#include "preprocess/pack/pose_encode.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/pack/joints.h"
#include "runtime/core/pack/pose_stream.h"

#include <stdlib.h>
#include <string.h>

#define PLACES (FF_JOINT_COUNT + FF_POINT_COUNT)
#define BIN 1e-5 /* m: how finely the percentile is told */
#define BINS 8192

typedef struct histogram {
    uint32_t count[BINS];
    double sum, max;
    size_t total;
} histogram;

static void add(histogram *h, double error)
{
    ++h->count[(int)ff_min(error / BIN, BINS - 1.0)];
    h->sum += error;
    h->max = ff_max(h->max, error);
    ++h->total;
}

static ff_pose_error summary(const histogram *h)
{
    size_t seen = 0, wanted = h->total - h->total / 100;
    int bin = 0;
    while (bin < BINS - 1 && (seen += h->count[bin]) < wanted)
        ++bin;
    return (ff_pose_error){h->sum / (double)h->total, ff_min((bin + 1) * BIN, h->max), h->max};
}

static ff_vec3 vec3_of(const float v[3])
{
    return ff_v3((double)v[0], (double)v[1], (double)v[2]);
}

/* World positions of joints and points. */
static void pose_places(const ff_pack_joint *joints, const ff_pack_point *points, const ff_root_frame *root,
                        ff_vec3 hips, const ff_quat *rotations, ff_vec3 *at)
{
    ff_quat world[FF_JOINT_COUNT];
    at[0] = hips;
    world[0] = rotations[0];
    ff_root_place(root, &at[0], &world[0]);
    for (int j = 1; j < FF_JOINT_COUNT; ++j) {
        int32_t parent = joints[j].parent;
        at[j] = ff_add3(at[parent], ff_quat_rotate(world[parent], vec3_of(joints[j].offset)));
        world[j] = ff_quat_mul(world[parent], rotations[j]);
    }
    for (int p = 0; p < FF_POINT_COUNT; ++p) {
        int32_t joint = points[p].joint;
        at[FF_JOINT_COUNT + p] = ff_add3(at[joint], ff_quat_rotate(world[joint], vec3_of(points[p].offset)));
    }
}

static void motion_places(const ff_pack_joint *joints, const ff_pack_point *points,
                          const ff_pose_motion *motion, int frame, ff_vec3 *at)
{
    ff_root_frame root = {{0.0, 0.0}, 0.0};
    if (motion->root)
        root = (ff_root_frame){{motion->root[frame].x, motion->root[frame].y}, motion->root[frame].z};
    ff_vec3 hips = motion->hips[frame];
    pose_places(joints, points, &root, ff_v3(hips.y, hips.z, hips.x),
                motion->rotations + (size_t)frame * FF_JOINT_COUNT, at);
}

static void compare(histogram *h, const ff_vec3 *at, const ff_vec3 *wanted)
{
    for (int i = 0; i < PLACES; ++i)
        add(h, ff_length3(ff_sub3(at[i], wanted[i])));
}

ff_status ff_pose_measure(const ff_pack_joint *joints, const ff_pack_point *points,
                          const ff_pose_motion *motion, const ff_pose_motion *splined, ff_pose_coded *coded,
                          ff_error *error)
{
    histogram *h = ff_calloc(2, sizeof *h);
    if (!h) return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory measuring %d poses", motion->frame_count);
    struct ff_pack alone = {.streams = &coded->stream,
                            .stream_count = 1,
                            .slots = &coded->slots,
                            .lanes = coded->lanes.data,
                            .keys = coded->keys.data,
                            .roots = coded->roots.data};
    for (int k = 0; k < motion->frame_count; ++k) {
        ff_vec3 at[PLACES], wanted[PLACES], hips;
        ff_quat rotations[FF_JOINT_COUNT];
        ff_root_frame root;
        ff_pack_sample(&alone, 0, k * motion->frame_time, 0, &root, &hips, rotations, NULL);
        pose_places(joints, points, &root, hips, rotations, at);
        motion_places(joints, points, splined, k, wanted);
        compare(&h[0], at, wanted);
        motion_places(joints, points, motion, k, wanted);
        compare(&h[1], at, wanted);
    }
    coded->quantised = summary(&h[0]);
    coded->whole = summary(&h[1]);
    free(h);
    return FF_OK;
}

static bool append(ff_array *to, const ff_array *from, size_t size)
{
    if (from->count == 0) return true;
    void *at = ff_array_grow(to, from->count, size);
    if (at) memcpy(at, from->data, from->count * size);
    return at != NULL;
}

ff_status ff_pack_add_stream(ff_pack_content *content, const ff_pose_coded *coded, int frame_count,
                             double rate, uint32_t *index, ff_error *error)
{
    ff_pack_stream stream = coded->stream;
    stream.first_frame = 0;
    if (content->streams.count > 0) {
        const ff_pack_stream *last =
            (const ff_pack_stream *)content->streams.data + content->streams.count - 1;
        stream.first_frame = last->first_frame + last->frame_count;
    }
    stream.frame_count = (uint32_t)frame_count;
    stream.rate = (float)rate;
    stream.first_lanes = (uint32_t)content->lanes.count;
    stream.first_root = (uint32_t)content->roots.count;
    size_t bytes = content->keys.count + coded->keys.count;
    if (bytes > INT32_MAX || (size_t)stream.first_frame + stream.frame_count > INT32_MAX)
        return ff_fail(error, FF_ERR_RANGE, "too much motion for one pack; build several");
    for (int i = 0; i < FF_STREAM_LEVELS; ++i)
        if (stream.level[i].intervals > 0) stream.level[i].first_byte += (uint32_t)content->keys.count;
    ff_pack_stream *out = ff_array_grow(&content->streams, 1, sizeof *out);
    ff_pack_slots *slots = ff_array_grow(&content->slots, 1, sizeof *slots);
    if (!out || !slots || !append(&content->lanes, &coded->lanes, sizeof(ff_pack_lanes)) ||
        !append(&content->keys, &coded->keys, 1) ||
        !append(&content->roots, &coded->roots, 3 * sizeof(float)))
        return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory storing motion");
    *out = stream;
    *slots = coded->slots;
    *index = (uint32_t)(content->streams.count - 1);
    return FF_OK;
}
