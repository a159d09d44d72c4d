#include "mocap/generator/capture.h"
#include "runtime/core/base/random.h"

#include <string.h>

/* Streams of random numbers that must not meet. */
enum { STREAM_ROOT = 1000, STREAM_JOINTS = 2000, STREAM_MISSING = 3000, STREAM_SKATE = 4000 };

/* How far a turn of each joint carries what hangs on it, m. */
static double reach_of(ff_role role)
{
    switch (role) {
    case FF_ROLE_HIP_L:
    case FF_ROLE_HIP_R:
        return 0.82;
    case FF_ROLE_KNEE_L:
    case FF_ROLE_KNEE_R:
        return 0.43;
    case FF_ROLE_SHOULDER_L:
    case FF_ROLE_SHOULDER_R:
        return 0.55;
    case FF_ROLE_HIPS:
        return 1.20; /* it carries the whole body */
    case FF_ROLE_SPINE:
    case FF_ROLE_CHEST:
        return 0.50;
    default:
        return 0.20;
    }
}

static ff_vec3 normal3(ff_random *random)
{
    double x = ff_random_normal(random), y = ff_random_normal(random), z = ff_random_normal(random);
    return ff_v3(x, y, z);
}

/* Root and joints each take such a part that the feet, four links away, move by about noise on every axis. */
static void add_noise(double noise, uint64_t seed, uint64_t stream, ff_clip *clip)
{
    for (int f = 0; f < clip->frame_count; ++f) {
        ff_random root = {seed, stream * 8191u + STREAM_ROOT, (uint64_t)f * 64u};
        ff_vec3 *place = &clip->positions[(size_t)f * (size_t)clip->track_count];
        *place = ff_madd3(*place, normal3(&root), 0.5 * noise);
        for (int j = 0; j < clip->joint_count; ++j) {
            if (clip->joints[j].end_site) continue;
            ff_random random = {seed, stream * 8191u + STREAM_JOINTS + (uint64_t)j, (uint64_t)f * 64u};
            double angle = 0.5 * noise / reach_of(clip->joints[j].role);
            ff_quat *local = &clip->rotations[(size_t)f * (size_t)clip->joint_count + (size_t)j];
            *local = ff_quat_mul(*local, ff_quat_exp(ff_scale3(normal3(&random), angle)));
        }
    }
}

/* The whole body creeps to and fro, so that a foot drifts by about skate during a stance. */
static void add_skate(double skate, uint64_t seed, uint64_t stream, ff_clip *clip)
{
    ff_random random = {seed, stream * 8191u + STREAM_SKATE, 0};
    double start_x = ff_random_unit(&random), start_z = ff_random_unit(&random);
    for (int f = 0; f < clip->frame_count; ++f) {
        double t = f * clip->frame_time;
        ff_vec3 *place = &clip->positions[(size_t)f * (size_t)clip->track_count];
        place->x += 0.25 * skate * ff_sin(FF_TAU * (0.83 * t + start_x));
        place->z += 0.50 * skate * ff_sin(FF_TAU * (0.71 * t + start_z));
    }
}

/* Raise the floor and let it rise along z. */
static void tilt_floor(double height, double tilt, ff_generated *g)
{
    ff_quat turn = ff_quat_axis(ff_v3(1, 0, 0), -tilt);
    ff_clip *clip = &g->clip;
    for (int f = 0; f < clip->frame_count; ++f) {
        ff_vec3 *place = &clip->positions[(size_t)f * (size_t)clip->track_count];
        ff_quat *root = &clip->rotations[(size_t)f * (size_t)clip->joint_count];
        *place = ff_quat_rotate(turn, *place);
        place->y += height;
        *root = ff_quat_mul(turn, *root);
    }
    for (int i = 0; i < g->plant_count; ++i) {
        g->plants[i].ball = ff_quat_rotate(turn, g->plants[i].ball);
        g->plants[i].ball.y += height;
    }
}

/* Stretches of 2 to 7 frames repeat the frame before them. */
static void lose_frames(double share, uint64_t seed, uint64_t stream, ff_clip *clip)
{
    const double mean_length = 4.5;
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count;
    int left = 0;
    for (int f = 1; f < clip->frame_count; ++f) {
        ff_random random = {seed, stream * 8191u + STREAM_MISSING, (uint64_t)f * 2u};
        if (left == 0 && ff_random_unit(&random) < share / (mean_length * (1.0 - share)))
            left = 2 + (int)(6.0 * ff_random_unit(&random));
        if (left == 0) continue;
        --left;
        size_t now = (size_t)f, before = now - 1;
        memcpy(clip->positions + now * tracks, clip->positions + before * tracks,
               tracks * sizeof *clip->positions);
        memcpy(clip->rotations + now * joints, clip->rotations + before * joints,
               joints * sizeof *clip->rotations);
    }
}

void ff_capture_spoil(const ff_generator_options *options, uint64_t stream, ff_generated *generated)
{
    ff_clip *clip = &generated->clip;
    uint64_t seed = options->seed;
    if (options->skate_cm > 0.0) add_skate(0.01 * options->skate_cm, seed, stream, clip);
    if (options->floor_cm != 0.0 || options->tilt_deg != 0.0)
        tilt_floor(0.01 * options->floor_cm, options->tilt_deg * FF_DEG, generated);
    if (options->noise_mm > 0.0) add_noise(0.001 * options->noise_mm, seed, stream, clip);
    if (options->missing > 0.0) lose_frames(options->missing, seed, stream, clip);
}
