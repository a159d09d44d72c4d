#include "runtime/export/naturalness.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/pack/pack.h"

#include <stdlib.h>
#include <string.h>

#define POSE_RATE 30.0 /* per second */
#define HINTS 45       /* poses around the last one that are looked at first */

/* Feet first: a pose that is too far off is given up soon. */
static const int joints[FF_LEGS] = {FF_JOINT_ANKLE_L, FF_JOINT_ANKLE_R, FF_JOINT_BALL_L, FF_JOINT_BALL_R,
                                    FF_JOINT_KNEE_L,  FF_JOINT_KNEE_R,  FF_JOINT_HIP_L,  FF_JOINT_HIP_R};
static const float weights[FF_LEGS] = {2.0f, 2.0f, 2.0f, 2.0f, 1.0f, 1.0f, 1.0f, 1.0f};
#define WEIGHT 12.0

ff_leg_pose_points ff_legs_of(const ff_vec3 *places, ff_vec2 position, double heading)
{
    ff_leg_pose_points out;
    ff_vec2 ahead = ff_fwd2(heading);
    for (int i = 0; i < FF_LEGS; ++i) {
        ff_vec3 p = places[joints[i]];
        ff_vec2 at = ff_to_frame2(ahead, ff_sub2(ff_plane(p), position));
        out.at[i][0] = (float)at.a;
        out.at[i][1] = (float)at.b;
        out.at[i][2] = (float)p.y;
    }
    return out;
}

/* Left and right exchanged: they are neighbours in the list of joints. */
static ff_leg_pose_points mirrored(const ff_leg_pose_points *legs)
{
    ff_leg_pose_points out;
    for (int i = 0; i < FF_LEGS; ++i) {
        memcpy(out.at[i], legs->at[i ^ 1], sizeof out.at[i]);
        out.at[i][1] = -out.at[i][1];
    }
    return out;
}

/* None of a made-up clip: nobody was seen to move so. */
static uint32_t poses_of(const ff_pack *pack, uint32_t clip)
{
    if (pack->clips[clip].flags & FF_CLIP_DERIVED) return 0;
    return 1 + (uint32_t)(ff_pack_stream_seconds(pack, ff_pack_clip_stream(pack, clip)) * POSE_RATE);
}

ff_status ff_pose_base_create(const ff_pack *pack, const ff_figure *figure, ff_pose_base *out,
                              ff_error *error)
{
    size_t count = 0;
    *out = (ff_pose_base){NULL, 0};
    for (uint32_t c = 0; c < ff_pack_clip_count(pack); ++c)
        count += 2 * (size_t)poses_of(pack, c);
    out->poses = ff_calloc(count, sizeof *out->poses);
    if (!out->poses) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu poses", count);
    for (uint32_t c = 0; c < ff_pack_clip_count(pack); ++c) {
        for (uint32_t k = 0; k < poses_of(pack, c); ++k) {
            ff_vec3 hips, places[FF_FIGURE_MAX_JOINTS];
            ff_quat rotations[FF_FIGURE_MAX_JOINTS];
            ff_status status = ff_pack_sample(pack, ff_pack_clip_stream(pack, c), k / POSE_RATE, 0, NULL,
                                              &hips, rotations, error);
            if (status != FF_OK) {
                ff_pose_base_free(out);
                return status;
            }
            ff_figure_place(figure, hips, rotations, places, NULL);
            ff_leg_pose_points legs = ff_legs_of(places, ff_v2(0.0, 0.0), 0.0);
            out->poses[out->count++] = legs;
            out->poses[out->count++] = mirrored(&legs);
        }
    }
    if (out->count > 0) return FF_OK;
    ff_pose_base_free(out);
    return ff_fail(error, FF_ERR_NO_DATA, "the pack has no clips to compare poses with");
}

void ff_pose_base_free(ff_pose_base *base)
{
    free(base->poses);
    *base = (ff_pose_base){NULL, 0};
}

/* Weighted sum of distances, or something above limit when it would be that. */
static double distance(const ff_leg_pose_points *p, const ff_leg_pose_points *q, double limit)
{
    double sum = 0.0;
    for (int i = 0; i < FF_LEGS && sum < limit; ++i) {
        float x = p->at[i][0] - q->at[i][0], y = p->at[i][1] - q->at[i][1], z = p->at[i][2] - q->at[i][2];
        sum += (double)weights[i] * sqrt((double)(x * x + y * y + z * z));
    }
    return sum;
}

static void search(const ff_pose_base *base, const ff_leg_pose_points *legs, uint32_t from, uint32_t to,
                   double *best, uint32_t *where)
{
    for (uint32_t i = from; i < to; ++i) {
        double sum = distance(&base->poses[i], legs, *best);
        if (sum < *best) *best = sum, *where = i;
    }
}

double ff_pose_base_nearest(const ff_pose_base *base, const ff_leg_pose_points *legs, uint32_t *hint)
{
    double best = 1e9;
    uint32_t first = *hint > HINTS ? *hint - HINTS : 0, end = first + 2 * HINTS;
    search(base, legs, first, end < base->count ? end : base->count, &best, hint);
    search(base, legs, 0, base->count, &best, hint);
    return best / WEIGHT;
}
