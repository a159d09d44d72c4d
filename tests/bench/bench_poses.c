/* Pose streams (issue 3, bar 5): how far joints are from the clip at its own rate, bytes per second, time per sample.
 * Usage: bench_poses [CATALOGUE|FOLDER|CLIP...]; without, the CMU clips of the shared folder, or else the built-in ones. */
#define _GNU_SOURCE
#include "mocap/generator/generator.h"
#include "preprocess/build/pack_fill.h"
#include "preprocess/clean/clean.h"
#include "preprocess/motion/motion.h"
#include "runtime/core/base/random.h"
#include "runtime/core/pack/joints.h"
#include "runtime/core/pack/pose_stream.h"
#include "tests/preprocess/standard.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define SAMPLES 400000
#define TALLY_BIN 1e-5
#define TALLY_BINS 10000

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t); /* not what other programs take */
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void give_up(const ff_error *error)
{
    char text[1024];
    fprintf(stderr, "%s\n", ff_error_text(error, text, sizeof text));
    exit(1);
}

/* Errors of many frames. */
typedef struct tally {
    uint32_t count[TALLY_BINS];
    double sum, max, seconds, bytes;
    size_t total;
} tally;

static void add(tally *t, double error)
{
    ++t->count[error < TALLY_BIN * (TALLY_BINS - 1) ? (int)(error / TALLY_BIN) : TALLY_BINS - 1];
    t->sum += error;
    t->max = error > t->max ? error : t->max;
    ++t->total;
}

static double percentile(const tally *t, double share)
{
    size_t seen = 0;
    for (int i = 0; i < TALLY_BINS; ++i)
        if ((double)(seen += t->count[i]) >= share * (double)t->total) return (i + 1) * TALLY_BIN;
    return t->max;
}

static void print(const tally *t, const char *name)
{
    printf("%-24s %7.1f %8.3f %7.2f %7.2f %7.2f\n", name, t->seconds, 1e3 * t->sum / (double)t->total,
           1e3 * percentile(t, 0.99), 1e3 * t->max, 1e-3 * t->bytes / t->seconds);
}

/* Every frame of the clip against the stream at its time; joints, without tips. */
static void compare(const ff_pack *pack, uint32_t stream, const ff_rig *rig, const ff_motion *motion,
                    int rest, tally *one, tally *all)
{
    for (int k = rest; k < motion->frame_count; ++k) {
        ff_vec3 wanted[FF_BODY_COUNT], at[FF_BODY_COUNT], hips;
        ff_quat local[FF_JOINT_COUNT];
        ff_root_frame root;
        ff_pack_sample(pack, stream, (k - rest) * motion->frame_time, 0, &root, &hips, local, NULL);
        ff_vec3 r = ff_v3(root.position.a, root.position.b, root.heading), h = ff_v3(hips.z, hips.x, hips.y);
        ff_motion moment = {
            .frame_count = 1, .frame_time = 1.0, .scale = 1.0, .root = &r, .hips = &h, .rotations = local};
        ff_motion_pose(rig, motion, k, wanted, NULL);
        ff_motion_pose(rig, &moment, 0, at, NULL);
        for (int j = 0; j < FF_JOINT_COUNT; ++j) {
            double error = ff_length3(ff_sub3(at[j], wanted[j]));
            add(one, error);
            add(all, error);
        }
    }
}

typedef struct source {
    ff_clip clip;
    ff_plants plants;
    ff_motion motion;
    bool good;
} source;

static source *load(int argc, const char *const *argv, int *count)
{
    ff_error error;
    ff_catalogue catalogue = {0};
    char shared[1024];
    const char *folder = getenv("FF_SHARED");
    snprintf(shared, sizeof shared, "%s/data/cmu", folder ? folder : "");
    const char *usual[] = {shared};
    bool built_in = argc == 0 && !folder;
    if (!built_in && ff_catalogue_read(argc ? argv : usual, argc ? argc : 1, &catalogue, &error) != FF_OK)
        give_up(&error);
    *count = built_in ? ff_generator_count() : catalogue.count;
    source *sources = calloc((size_t)*count, sizeof *sources);
    for (int i = 0; sources && i < *count; ++i) {
        ff_generated made = {0};
        ff_status status = built_in ? ff_generator_make(i, NULL, &made, &error)
                                    : ff_clip_load(catalogue.entries[i].path, &catalogue.entries[i].options,
                                                   &made.clip, &error);
        sources[i].clip = made.clip;
        memset(&made.clip, 0, sizeof made.clip);
        ff_generated_free(&made);
        sources[i].good = status == FF_OK && ff_plants_find(&sources[i].clip, &standard()->find,
                                                            &sources[i].plants, &error) == FF_OK;
    }
    ff_catalogue_free(&catalogue);
    return sources;
}

static void code(const ff_pack_content *content, source *s, ff_pose_coded *coded)
{
    ff_error error;
    size_t rest = (size_t)s->clip.rest_frames;
    ff_pose_motion motion = {.frame_count = s->motion.frame_count - (int)rest,
                             .frame_time = s->motion.frame_time,
                             .root = s->motion.root + rest,
                             .hips = s->motion.hips + rest,
                             .rotations = s->motion.rotations + rest * FF_ROLE_JOINT_COUNT};
    if (ff_pose_encode(content->joints.data, content->points.data, &motion, coded, &error) != FF_OK)
        give_up(&error);
}

typedef void pose_function(const ff_pack *, uint32_t, double, bool, ff_vec3 *, ff_quat *);

/* Random moments of the first so many streams, s per sample. */
static double time_samples(const ff_pack *pack, uint32_t streams, pose_function *sample)
{
    enum { MOMENTS = 4096 };
    static uint32_t stream[MOMENTS];
    static double fraction[MOMENTS];
    ff_random random = {7, 7, 0};
    for (int i = 0; i < MOMENTS; ++i) {
        stream[i] = (uint32_t)(ff_random_unit(&random) * streams);
        fraction[i] = ff_random_unit(&random);
    }
    double best = 1.0, keep = 0.0;
    for (int turn = 0; turn < 5; ++turn) {
        double start = now();
        for (int i = 0; i < SAMPLES; ++i) {
            ff_vec3 hips;
            ff_quat rotations[FF_JOINT_COUNT];
            sample(pack, stream[i % MOMENTS], fraction[i % MOMENTS], false, &hips, rotations);
            keep += hips.y + rotations[20].x;
        }
        double spent = (now() - start) / SAMPLES;
        best = spent < best ? spent : best;
    }
    if (keep == 0.123) printf("\n");
    return best;
}

static void time_all(const ff_pack *pack)
{
    uint32_t few = pack->stream_count < 4 ? pack->stream_count : 4;
    printf("\na random moment of %d joints, us        SIMD   plain C\n", FF_JOINT_COUNT);
    printf("  of %3u streams                      %6.3f    %6.3f\n", few,
           1e6 * time_samples(pack, few, ff_stream_pose),
           1e6 * time_samples(pack, few, ff_stream_pose_plain));
    printf("  of %3u streams, %5.1f MB            %6.3f    %6.3f\n", pack->stream_count,
           1e-6 * pack->key_bytes, 1e6 * time_samples(pack, pack->stream_count, ff_stream_pose),
           1e6 * time_samples(pack, pack->stream_count, ff_stream_pose_plain));
}

static void measure(source *sources, int count, const ff_rig *rig, bool clean)
{
    static tally all, one;
    ff_pack_content content = {0};
    ff_error error;
    memset(&all, 0, sizeof all);
    if (ff_pack_add_rig(&content, rig, &error) != FF_OK) give_up(&error);
    printf("\n%-24s %7s %8s %7s %7s %7s\n", clean ? "clips, feet cleaned" : "clips as captured", "s",
           "mean mm", "p99", "max", "kB/s");
    ff_pose_coded *coded = calloc((size_t)count, sizeof *coded);
    double spent = 0.0;
    for (int i = 0; i < count; ++i) {
        source *s = &sources[i];
        ff_clean_report report;
        if (!s->good || ff_motion_from_clip(rig, &s->clip, &s->plants, &s->motion, &error) != FF_OK) continue;
        if (clean &&
            ff_motion_clean(rig, &standard()->cut.clean, &s->motion, &s->plants, &report, &error) != FF_OK)
            continue;
        double start = now();
        code(&content, s, &coded[i]);
        spent += now() - start;
        uint32_t stream;
        if (ff_pack_add_stream(&content, &coded[i], 1, 60.0, &stream, &error) != FF_OK) give_up(&error);
        struct ff_pack alone = {.streams = &coded[i].stream,
                                .stream_count = 1,
                                .slots = &coded[i].slots,
                                .lanes = coded[i].lanes.data,
                                .keys = coded[i].keys.data,
                                .roots = coded[i].roots.data};
        memset(&one, 0, sizeof one);
        one.seconds = (double)coded[i].stream.seconds;
        one.bytes = coded[i].bytes_per_second * one.seconds;
        all.seconds += one.seconds;
        all.bytes += one.bytes;
        compare(&alone, 0, rig, &s->motion, s->clip.rest_frames, &one, &all);
        print(&one, s->clip.name);
        ff_motion_free(&s->motion);
    }
    print(&all, "all");
    printf("storing took %.2f s of processor time per minute of motion\n", spent / (all.seconds / 60.0));
    struct ff_pack pack = {.streams = content.streams.data,
                           .stream_count = (uint32_t)content.streams.count,
                           .slots = content.slots.data,
                           .lanes = content.lanes.data,
                           .keys = content.keys.data,
                           .key_bytes = (uint32_t)content.keys.count,
                           .roots = (const float(*)[3])content.roots.data};
    if (clean) time_all(&pack);
    for (int i = 0; i < count; ++i)
        ff_pose_coded_free(&coded[i]);
    free(coded);
    ff_pack_content_free(&content);
}

int main(int argc, char **argv)
{
    int count, good = 0;
    ff_error error;
    ff_rig rig;
    source *sources = load(argc - 1, (const char *const *)(argv + 1), &count);
    const ff_clip **clips = calloc((size_t)count, sizeof *clips);
    for (int i = 0; i < count; ++i)
        if (sources[i].good) clips[good++] = &sources[i].clip;
    if (ff_rig_from_clips(clips, good, &rig, &error) != FF_OK) give_up(&error);
    measure(sources, count, &rig, false);
    measure(sources, count, &rig, true);
    for (int i = 0; i < count; ++i) {
        ff_clip_free(&sources[i].clip);
        ff_plants_free(&sources[i].plants);
    }
    free(sources);
    free(clips);
    return 0;
}
