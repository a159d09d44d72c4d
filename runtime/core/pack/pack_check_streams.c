/* Can every stream be sampled at any moment without leaving its sections, and is what comes out finite? Key bytes
 * themselves may be anything. */
#include "runtime/core/base/fail.h"
#include "runtime/core/pack/joints.h"
#include "runtime/core/pack/pack_check.h"
#include "runtime/core/pack/pose_stream.h"

#include <string.h>

#define MAX_FRAMES 0x7fffffffu
#define MAX_SECONDS 1e6f
#define LIMIT_PLACE 1e6f     /* m, rad: no root is further out */
#define LIMIT_VALUE 100.0f   /* of a lane: tangents of half angles, parts of quaternions, m */
#define LIMIT_SUM 1073741824 /* of four weighted keys */

static ff_status check_frames(const ff_pack *pack, uint32_t index, uint64_t first_frame, ff_error *error)
{
    const ff_pack_stream *stream = &pack->streams[index];
    if (stream->first_frame != first_frame || stream->frame_count == 0 ||
        first_frame + stream->frame_count > MAX_FRAMES)
        return FF_PACK_REFUSE("STRM", stream, "stream %u: %u frames from %u on, expected some from %llu on",
                              index, stream->frame_count, stream->first_frame,
                              (unsigned long long)first_frame);
    if (!(stream->rate >= 1.0f && stream->rate <= 1000.0f))
        return FF_PACK_REFUSE("STRM", &stream->rate, "stream %u: %g frames per second", index,
                              (double)stream->rate);
    if (stream->flags & ~(uint32_t)(FF_STREAM_CYCLIC | FF_STREAM_FOUR_PARTS))
        return FF_PACK_REFUSE("STRM", &stream->flags, "stream %u: unknown flags %x", index, stream->flags);
    uint32_t spans = stream->frame_count - (stream->flags & FF_STREAM_CYCLIC ? 0 : 1);
    if (!(stream->seconds > 0.0f && stream->seconds <= MAX_SECONDS &&
          (double)stream->seconds * (double)stream->rate >= 0.999 * spans))
        return FF_PACK_REFUSE("STRM", &stream->seconds, "stream %u: %g s for %u frames at %g Hz", index,
                              (double)stream->seconds, stream->frame_count, (double)stream->rate);
    return FF_OK;
}

/* A cycle goes on with its own first keys, else there would be a jump at the seam. */
static bool closes(const ff_pack *pack, const ff_pack_level *level)
{
    size_t stride = ff_level_stride(level);
    const unsigned char *first = pack->keys + level->first_byte;
    return memcmp(first, first + level->intervals * stride, 3 * stride) == 0;
}

static ff_status check_level(const ff_pack *pack, uint32_t index, int number, ff_error *error)
{
    const ff_pack_stream *stream = &pack->streams[index];
    const ff_pack_level *level = &stream->level[number];
    if (level->wide == 0 && level->narrow == 0) return FF_OK;
    uint64_t bytes = ((uint64_t)level->intervals + 3) * ff_level_stride(level) + FF_STREAM_SLACK;
    if (level->intervals == 0 || !ff_pack_range_fits(level->first_byte, bytes, pack->key_bytes))
        return FF_PACK_REFUSE("STRM", level,
                              "stream %u: %u intervals of %u wide and %u narrow lanes from byte %u on do not "
                              "fit into KEYS of %u bytes",
                              index, level->intervals, level->wide, level->narrow, level->first_byte,
                              pack->key_bytes);
    if ((stream->flags & FF_STREAM_CYCLIC) && !closes(pack, level))
        return FF_PACK_REFUSE("KEYS", pack->keys + level->first_byte,
                              "stream %u: the last three keys of a cycle must be its first three", index);
    return FF_OK;
}

/* Does a run of lanes that begins at *block hold the lane of this number? Moves on to the block after it. */
static bool run_holds(uint32_t *block, uint32_t lanes, uint32_t lane)
{
    uint32_t first = FF_LANE_FIRST + 8 * *block;
    *block += (lanes + 7) / 8;
    return lane >= first && lane - first < lanes;
}

static bool lane_known(const ff_pack_stream *stream, uint32_t lane)
{
    uint32_t block = 0;
    bool known = lane == FF_LANE_ZERO || lane == FF_LANE_ONE;
    for (int i = 0; i < FF_STREAM_LEVELS; ++i) {
        known |= run_holds(&block, stream->level[i].wide, lane);
        known |= run_holds(&block, stream->level[i].narrow, lane);
    }
    return known | run_holds(&block, stream->still, lane);
}

static ff_status check_lanes(const ff_pack *pack, uint32_t index, ff_error *error)
{
    uint32_t count = ff_stream_lane_blocks(&pack->streams[index]), first = pack->streams[index].first_lanes;
    if (count > FF_STREAM_BLOCKS || !ff_pack_range_fits(first, count, pack->lanes_count))
        return FF_PACK_REFUSE("STRM", &pack->streams[index].first_lanes,
                              "stream %u: %u blocks of lanes from %u on of %u, at most %d", index, count,
                              first, pack->lanes_count, FF_STREAM_BLOCKS);
    for (uint32_t b = first; b < first + count; ++b)
        for (int i = 0; i < 8; ++i) {
            const ff_pack_lanes *lanes = &pack->lanes[b];
            if (!(fabsf(lanes->base[i]) + LIMIT_SUM * fabsf(lanes->scale[i]) <= LIMIT_VALUE))
                return FF_PACK_REFUSE("LANE", &lanes->base[i], "lane %u of stream %u: from %g by %g",
                                      8 * (b - first) + (uint32_t)i, index, (double)lanes->base[i],
                                      (double)lanes->scale[i]);
        }
    return FF_OK;
}

static ff_status check_roots(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_stream *stream = &pack->streams[index];
    if (stream->root_intervals == 0) return FF_OK;
    uint64_t count = (uint64_t)stream->root_intervals + 3;
    if (!ff_pack_range_fits(stream->first_root, count, pack->root_count))
        return FF_PACK_REFUSE("STRM", &stream->first_root, "stream %u: %llu root keys from %u on of %u",
                              index, (unsigned long long)count, stream->first_root, pack->root_count);
    const float *wild = ff_pack_wild_float(pack->roots[stream->first_root], 3 * count, LIMIT_PLACE);
    if (wild) return FF_PACK_REFUSE("ROOT", wild, "a root key of stream %u: %g", index, (double)*wild);
    return FF_OK;
}

static ff_status check_slots(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_stream *stream = &pack->streams[index];
    const ff_pack_slots *s = &pack->slots[index];
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        double x = (double)s->x[j], y = (double)s->y[j], z = (double)s->z[j], w = (double)s->w[j];
        if (!(fabs(x * x + y * y + z * z + w * w - 1.0) <= 1e-3))
            return FF_PACK_REFUSE("SLOT", &s->x[j],
                                  "the reference of joint %d of stream %u is not a unit quaternion", j,
                                  index);
    }
    for (int c = 0; c < 4; ++c)
        for (int j = 0; j < FF_STREAM_SLOTS; ++j) {
            uint32_t lane = s->lane[c][j];
            bool three = c == 3 && !(stream->flags & FF_STREAM_FOUR_PARTS);
            if (!lane_known(stream, lane) || (three && lane != FF_LANE_ONE))
                return FF_PACK_REFUSE("SLOT", &s->lane[c][j],
                                      "slot %d of joint %d of stream %u shows lane %u", c, j, index, lane);
        }
    return FF_OK;
}

ff_status ff_pack_check_streams(const ff_pack *pack, ff_error *error)
{
    uint64_t first_frame = 0;
    if (pack->slots_count != pack->stream_count)
        return FF_PACK_REFUSE("SLOT", pack->slots, "%u records for %u streams", pack->slots_count,
                              pack->stream_count);
    for (uint32_t i = 0; i < pack->stream_count; ++i) {
        ff_status status = check_frames(pack, i, first_frame, error);
        for (int k = 0; k < FF_STREAM_LEVELS && status == FF_OK; ++k)
            status = check_level(pack, i, k, error);
        if (status == FF_OK) status = check_lanes(pack, i, error);
        if (status == FF_OK) status = check_roots(pack, i, error);
        if (status == FF_OK) status = check_slots(pack, i, error);
        if (status != FF_OK) return status;
        first_frame += pack->streams[i].frame_count;
    }
    return FF_OK;
}
