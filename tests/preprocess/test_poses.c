/* Pose streams: what is stored of a motion against the motion itself, at any time, from either side, round the cycle. */
#define _GNU_SOURCE
#include "preprocess/build/pack_fill.h"
#include "preprocess/clean/clean.h"
#include "preprocess/pack/pose_spline.h"
#include "runtime/core/base/random.h"
#include "runtime/core/pack/joints.h"
#include "runtime/core/pack/pose_stream.h"
#include "tests/preprocess/motion_make.h"
#include "tests/preprocess/standard.h"

#define MEAN 0.5e-3 /* m: issue 3, bar 5 */
#define P99 2e-3
#define BYTES 5400.0 /* per second: 8,000 for 31 joints */

/* A pack of nothing but the rig and streams. */
typedef struct streams {
    ff_pack_content content;
    void *data;
    ff_pack *pack;
} streams;

static streams begin(const ff_rig *rig)
{
    streams s = {0};
    ff_error error;
    FF_ASSERT_OK(ff_pack_add_rig(&s.content, rig, &error), error);
    return s;
}

static double add(streams *s, const ff_pose_motion *motion)
{
    ff_error error;
    ff_pose_coded coded;
    uint32_t index;
    FF_ASSERT_OK(ff_pose_encode(s->content.joints.data, s->content.points.data, motion, &coded, &error),
                 error);
    FF_ASSERT_OK(ff_pack_add_stream(&s->content, &coded, motion->frame_count, 1.0 / motion->frame_time,
                                    &index, &error),
                 error);
    double bytes = coded.bytes_per_second;
    ff_pose_coded_free(&coded);
    return bytes;
}

/* Through the loader, so that what the encoder writes is what the loader lets through. */
static void open_pack(streams *s)
{
    ff_error error;
    size_t size;
    FF_ASSERT_OK(ff_pack_image(&s->content, &s->data, &size, &error), error);
    FF_ASSERT_OK(ff_pack_open_memory(s->data, size, &s->pack, &error), error);
}

static void end(streams *s)
{
    ff_pack_close(s->pack);
    free(s->data);
    ff_pack_content_free(&s->content);
}

static ff_pose_motion poses_of(const ff_motion *motion, int rest)
{
    return (ff_pose_motion){.frame_count = motion->frame_count - rest,
                            .frame_time = motion->frame_time,
                            .root = motion->root + rest,
                            .hips = motion->hips + rest,
                            .rotations = motion->rotations + (size_t)rest * FF_ROLE_JOINT_COUNT};
}

static void sample_points(const streams *s, const ff_rig *rig, uint32_t stream, double time, uint32_t flags,
                          ff_vec3 *points)
{
    ff_error error;
    ff_root_frame root;
    ff_vec3 hips;
    ff_quat local[FF_JOINT_COUNT], world[FF_JOINT_COUNT];
    FF_ASSERT_OK(ff_pack_sample(s->pack, stream, time, flags, &root, &hips, local, &error), error);
    world[0] = local[0];
    ff_root_place(&root, &hips, &world[0]);
    for (int j = 1; j < FF_JOINT_COUNT; ++j)
        world[j] = ff_quat_mul(world[ff_joint_parents[j]], local[j]);
    ff_rig_pose(rig, hips, world, points);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Every frame of the motion against the stream; the whole tells mean and 99th percentile. */
static void check_bound(const streams *s, const ff_rig *rig, uint32_t stream, const ff_motion *motion,
                        int rest)
{
    size_t count = 0, frames = (size_t)(motion->frame_count - rest);
    double *errors = calloc(frames * FF_BODY_COUNT, sizeof *errors), sum = 0.0;
    assert_non_null(errors);
    for (int k = rest; k < motion->frame_count; ++k) {
        ff_vec3 at[FF_BODY_COUNT], wanted[FF_BODY_COUNT];
        sample_points(s, rig, stream, (k - rest) * motion->frame_time, 0, at);
        ff_motion_pose(rig, motion, k, wanted, NULL);
        for (int j = 0; j < FF_BODY_COUNT; ++j)
            sum += errors[count++] = ff_length3(ff_sub3(at[j], wanted[j]));
    }
    qsort(errors, count, sizeof *errors, by_size);
    FF_ASSERT_BELOW(sum / (double)count, MEAN);
    FF_ASSERT_BELOW(errors[count - 1 - count / 100], P99);
    free(errors);
}

static void every_built_in_clip_is_within_the_bound_and_the_bytes(void **state)
{
    (void)state;
    enum { STEP = 3 };
    ff_clip first = generated_clip(ff_generator_describe(0).name);
    ff_rig rig = rig_of(&first);
    ff_clip_free(&first);
    streams s = begin(&rig);
    made_motion made[64];
    int count = 0;
    for (int i = 0; i < ff_generator_count() && count < 64; i += STEP, ++count) {
        made[count] = make_motion(&rig, generated_clip(ff_generator_describe(i).name));
        ff_pose_motion motion = poses_of(&made[count].motion, made[count].clip.rest_frames);
        FF_ASSERT_BELOW(add(&s, &motion), BYTES);
    }
    open_pack(&s);
    assert_int_equal(ff_pack_stream_count(s.pack), count);
    for (int i = 0; i < count; ++i) {
        check_bound(&s, &rig, (uint32_t)i, &made[i].motion, made[i].clip.rest_frames);
        made_motion_free(&made[i]);
    }
    end(&s);
}

static void captured_clips_are_within_the_bound_with_feet_cleaned(void **state)
{
    (void)state;
    static const char *const names[] = {"02/02_03.amc", "09/09_06.amc", "16/16_55.amc", "49/49_04.amc",
                                        "07/07_01.amc"};
    const char *folder = ff_shared_folder();
    if (!folder) {
        print_message("SKIPPED captured clips: no shared folder\n");
        skip();
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        char path[1024];
        ff_error error;
        ff_clip clip;
        ff_load_options options = ff_load_options_default();
        snprintf(path, sizeof path, "%s/data/cmu/%s", folder, names[i]);
        FF_ASSERT_OK(ff_clip_load(path, &options, &clip, &error), error);
        ff_rig rig = rig_of(&clip);
        made_motion made = make_motion(&rig, clip);
        ff_clean_report report;
        FF_ASSERT_OK(
            ff_motion_clean(&rig, &standard()->cut.clean, &made.motion, &made.plants, &report, &error),
            error);
        streams s = begin(&rig);
        ff_pose_motion motion = poses_of(&made.motion, made.clip.rest_frames);
        FF_ASSERT_BELOW(add(&s, &motion), BYTES);
        open_pack(&s);
        check_bound(&s, &rig, 0, &made.motion, made.clip.rest_frames);
        end(&s);
        made_motion_free(&made);
    }
}

/* ------------------------------------------------------------------------------------------- motions made up here */

#define FRAMES 90

typedef struct invented {
    ff_vec3 root[FRAMES], hips[FRAMES];
    ff_quat rotations[FRAMES][FF_JOINT_COUNT];
    ff_pose_motion motion;
} invented;

/* Nobody moves. */
static void invent(invented *m, bool cyclic)
{
    for (int k = 0; k < FRAMES; ++k) {
        m->root[k] = ff_v3(1.5, -2.0, 0.3);
        m->hips[k] = ff_v3(0.01, 0.02, 0.9);
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            m->rotations[k][j] = ff_quat_axis(ff_unit3(ff_v3(1.0, 0.1 * j, 0.5)), 0.11 * j);
    }
    m->motion = (ff_pose_motion){.frame_count = FRAMES,
                                 .frame_time = 1.0 / 60.0,
                                 .cyclic = cyclic,
                                 .root = cyclic ? NULL : m->root,
                                 .hips = m->hips,
                                 .rotations = m->rotations[0]};
}

static ff_rig any_rig(void)
{
    ff_rig rig = rig_of_generated("walk-normal");
    return rig;
}

static void what_never_moves_has_no_keys(void **state)
{
    (void)state;
    static invented m;
    ff_rig rig = any_rig();
    streams s = begin(&rig);
    invent(&m, false);
    add(&s, &m.motion);
    for (int k = 0; k < FRAMES; ++k)
        m.rotations[k][FF_JOINT_ELBOW_L] = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), 0.5 * sin(0.1 * k));
    add(&s, &m.motion);
    open_pack(&s);
    const ff_pack_stream *still = &s.pack->streams[0], *elbow = &s.pack->streams[1];
    uint32_t moving = 0;
    for (int i = 0; i < FF_STREAM_LEVELS; ++i) {
        assert_int_equal(still->level[i].wide + still->level[i].narrow, 0);
        moving += elbow->level[i].wide + elbow->level[i].narrow;
    }
    assert_int_equal(moving, 1);
    assert_int_equal(still->still, 3); /* where the hips are */
    ff_vec3 hips;
    ff_quat rotations[FF_JOINT_COUNT];
    ff_root_frame root;
    FF_ASSERT_OK(ff_pack_sample(s.pack, 0, 0.7, 0, &root, &hips, rotations, NULL), (ff_error){0});
    FF_ASSERT_NEAR(root.position.a, 1.5, 1e-6);
    FF_ASSERT_NEAR(root.position.b, -2.0, 1e-6);
    FF_ASSERT_NEAR(root.heading, 0.3, 1e-6);
    FF_ASSERT_NEAR(hips.x, 0.02, 1e-6);
    FF_ASSERT_NEAR(hips.y, 0.9, 1e-6);
    FF_ASSERT_NEAR(hips.z, 0.01, 1e-6);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        FF_ASSERT_NEAR(fabs(ff_quat_dot(rotations[j], m.rotations[0][j])), 1.0,
                       1e-6 + (j == FF_JOINT_ELBOW_L));
    end(&s);
}

/* Three cartwheels in a row: no reference is within 140 degrees of all of it. */
static void a_joint_may_turn_as_often_as_it_likes(void **state)
{
    (void)state;
    static invented m;
    ff_rig rig = any_rig();
    streams s = begin(&rig);
    invent(&m, false);
    for (int k = 0; k < FRAMES; ++k)
        m.rotations[k][0] = ff_quat_axis(ff_v3(0.0, 0.0, 1.0), 3.0 * FF_TAU * k / (FRAMES - 1));
    add(&s, &m.motion);
    open_pack(&s);
    assert_true(s.pack->streams[0].flags & FF_STREAM_FOUR_PARTS);
    for (int k = 0; k < FRAMES; ++k) {
        ff_quat rotations[FF_JOINT_COUNT], plain[FF_JOINT_COUNT];
        double time = k * m.motion.frame_time;
        FF_ASSERT_OK(ff_pack_sample(s.pack, 0, time, 0, NULL, NULL, rotations, NULL), (ff_error){0});
        ff_stream_pose_plain(s.pack, 0, ff_stream_fraction(s.pack->streams, time), false, NULL, plain);
        assert_memory_equal(rotations, plain, sizeof plain);
        FF_ASSERT_BELOW(ff_quat_angle(ff_quat_mul(ff_quat_conj(rotations[0]), m.rotations[k][0])), 0.002);
    }
    end(&s);
}

static void invent_cycle(invented *m)
{
    invent(m, true);
    for (int k = 0; k < FRAMES; ++k) {
        double u = FF_TAU * k / FRAMES;
        m->hips[k] = ff_v3(0.02 * sin(u), 0.03 * cos(u), 0.9 + 0.02 * sin(2.0 * u));
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            m->rotations[k][j] =
                ff_quat_mul(ff_quat_axis(ff_v3(1.0, 0.0, 0.0), 0.4 * sin(u + j) + 0.05 * sin(5.0 * u)),
                            ff_quat_axis(ff_v3(0.0, 1.0, 0.0), 0.2 * cos(u + 2.0 * j)));
    }
}

static void cycles_have_no_seam(void **state)
{
    (void)state;
    static invented m;
    ff_rig rig = any_rig();
    streams s = begin(&rig);
    invent_cycle(&m);
    add(&s, &m.motion);
    open_pack(&s);
    double period = ff_pack_stream_seconds(s.pack, 0), tiny = 1e-5;
    assert_true(ff_pack_stream_cyclic(s.pack, 0));
    FF_ASSERT_NEAR(period, FRAMES / 60.0, 1e-6);
    ff_vec3 before[FF_BODY_COUNT], at[FF_BODY_COUNT], after[FF_BODY_COUNT], later[FF_BODY_COUNT];
    sample_points(&s, &rig, 0, -tiny, 0, before);
    sample_points(&s, &rig, 0, 0.0, 0, at);
    sample_points(&s, &rig, 0, tiny, 0, after);
    sample_points(&s, &rig, 0, 1000.0 * period + 0.25 * period, 0, later);
    for (int j = 0; j < FF_BODY_COUNT; ++j) {
        FF_ASSERT_BELOW(ff_length3(ff_sub3(at[j], before[j])), 1e-4);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(after[j], at[j])), 1e-4);
    }
    sample_points(&s, &rig, 0, 0.25 * period, 0, at);
    for (int j = 0; j < FF_BODY_COUNT; ++j)
        FF_ASSERT_BELOW(ff_length3(ff_sub3(at[j], later[j])), 1e-5);
    for (int k = 0; k < FRAMES; ++k) {
        ff_quat rotations[FF_JOINT_COUNT];
        FF_ASSERT_OK(ff_pack_sample(s.pack, 0, k / 60.0, 0, NULL, NULL, rotations, NULL), (ff_error){0});
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            FF_ASSERT_BELOW(ff_quat_angle(ff_quat_mul(ff_quat_conj(rotations[j]), m.rotations[k][j])), 0.004);
    }
    end(&s);
}

/* ---------------------------------------------------------------------------------------------------- sampling */

static void order_and_instructions_make_no_difference(void **state)
{
    (void)state;
    static invented m;
    ff_rig rig = any_rig();
    streams s = begin(&rig);
    made_motion made = make_motion(&rig, generated_clip("run"));
    ff_pose_motion motion = poses_of(&made.motion, made.clip.rest_frames);
    add(&s, &motion);
    invent_cycle(&m);
    add(&s, &m.motion);
    open_pack(&s);
    enum { TIMES = 500 };
    static ff_quat in_order[TIMES][FF_JOINT_COUNT];
    for (uint32_t stream = 0; stream < 2; ++stream) {
        double seconds = ff_pack_stream_seconds(s.pack, stream);
        for (int i = 0; i < TIMES; ++i)
            ff_stream_pose(s.pack, stream,
                           ff_stream_fraction(&s.pack->streams[stream], seconds * i / (TIMES - 1)), i % 2,
                           NULL, in_order[i]);
        ff_random random = {3, stream, 0};
        for (int i = 0; i < 2 * TIMES; ++i) {
            int k = (int)(ff_random_unit(&random) * TIMES);
            ff_quat again[FF_JOINT_COUNT], plain[FF_JOINT_COUNT];
            ff_vec3 hips, plain_hips;
            double fraction = ff_stream_fraction(&s.pack->streams[stream], seconds * k / (TIMES - 1));
            ff_stream_pose(s.pack, stream, fraction, k % 2, &hips, again);
            ff_stream_pose_plain(s.pack, stream, fraction, k % 2, &plain_hips, plain);
            assert_memory_equal(again, in_order[k], sizeof again);
            assert_memory_equal(plain, again, sizeof again);
            assert_memory_equal(&plain_hips, &hips, sizeof hips);
            for (int j = 0; j < FF_JOINT_COUNT; ++j)
                FF_ASSERT_NEAR(ff_quat_dot(again[j], again[j]), 1.0, 1e-6);
        }
    }
    end(&s);
    made_motion_free(&made);
}

static void mirrored_sampling_is_sampling_the_mirrored_motion(void **state)
{
    (void)state;
    ff_rig rig = any_rig();
    made_motion made = make_motion(&rig, generated_clip("curve-left"));
    ff_error error;
    ff_motion other;
    FF_ASSERT_OK(ff_motion_mirror(&made.motion, &other, &error), error);
    streams s = begin(&rig);
    ff_pose_motion motion = poses_of(&made.motion, made.clip.rest_frames),
                   mirrored = poses_of(&other, made.clip.rest_frames);
    add(&s, &motion);
    add(&s, &mirrored);
    open_pack(&s);
    for (double time = 0.0; time < ff_pack_stream_seconds(s.pack, 0); time += 0.037) {
        ff_vec3 at[FF_BODY_COUNT], wanted[FF_BODY_COUNT];
        sample_points(&s, &rig, 0, time, FF_SAMPLE_MIRRORED, at);
        sample_points(&s, &rig, 1, time, 0, wanted);
        ff_quat p[FF_JOINT_COUNT], q[FF_JOINT_COUNT];
        ff_root_frame x, y;
        ff_vec3 h, g;
        FF_ASSERT_OK(ff_pack_sample(s.pack, 0, time, FF_SAMPLE_MIRRORED, &x, &h, p, &error), error);
        FF_ASSERT_OK(ff_pack_sample(s.pack, 1, time, 0, &y, &g, q, &error), error);
        FF_ASSERT_NEAR(x.heading, y.heading, 1e-6);
        FF_ASSERT_BELOW(ff_length2(ff_sub2(x.position, y.position)), 1e-6);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(h, g)), 1e-6);
        for (int j = 0; j < FF_JOINT_COUNT; ++j) {
            double sign = ff_quat_dot(p[j], q[j]) < 0.0 ? -1.0 : 1.0;
            FF_ASSERT_NEAR(p[j].x, sign * q[j].x, 1e-6);
            FF_ASSERT_NEAR(p[j].y, sign * q[j].y, 1e-6);
            FF_ASSERT_NEAR(p[j].z, sign * q[j].z, 1e-6);
            FF_ASSERT_NEAR(p[j].w, sign * q[j].w, 1e-6);
        }
        for (int j = 0; j < FF_BODY_COUNT; ++j)
            FF_ASSERT_BELOW(ff_length3(ff_sub3(at[j], wanted[j])), 1e-5);
    }
    end(&s);
    ff_motion_free(&other);
    made_motion_free(&made);
}

static void odd_questions_get_errors_and_odd_times_the_ends(void **state)
{
    (void)state;
    static invented m;
    ff_rig rig = any_rig();
    streams s = begin(&rig);
    invent(&m, false);
    for (int k = 0; k < FRAMES; ++k)
        m.hips[k].z = 0.9 + 0.001 * k;
    add(&s, &m.motion);
    open_pack(&s);
    ff_error error;
    ff_vec3 hips;
    assert_int_equal(ff_pack_sample(s.pack, 1, 0.0, 0, NULL, &hips, NULL, &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_pack_sample(s.pack, 0, 0.0, 4, NULL, &hips, NULL, &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_pack_sample(s.pack, 0, NAN, 0, NULL, &hips, NULL, &error), FF_ERR_NOT_FINITE);
    FF_ASSERT_OK(ff_pack_sample(s.pack, 0, 0.0, 0, NULL, NULL, NULL, &error), error);
    FF_ASSERT_OK(ff_pack_sample(s.pack, 0, -1e9, 0, NULL, &hips, NULL, &error), error);
    FF_ASSERT_NEAR(hips.y, 0.9, 1e-4);
    FF_ASSERT_OK(ff_pack_sample(s.pack, 0, 1e9, 0, NULL, &hips, NULL, &error), error);
    FF_ASSERT_NEAR(hips.y, 0.9 + 0.001 * (FRAMES - 1), 1e-4);
    end(&s);
}

/* --------------------------------------------------------------------------------------------------- the pieces */

static void weights_are_those_of_the_cubic_spline(void **state)
{
    (void)state;
    for (int i = 0; i <= 1000; ++i) {
        double t = i / 1000.0, s = 1.0 - t;
        int32_t w[4];
        ff_stream_weights((float)t, w);
        assert_int_equal(w[0] + w[1] + w[2] + w[3], 32768);
        const double wanted[4] = {s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
                                  (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, t * t * t / 6.0};
        for (int k = 0; k < 4; ++k) {
            assert_in_range(w[k], 0, 32767);
            FF_ASSERT_NEAR(w[k] / 32768.0, wanted[k], 2.0 / 32768.0);
        }
    }
}

static void a_fit_gives_back_what_is_a_spline(void **state)
{
    (void)state;
    ff_error error;
    ff_spline_fit fit;
    double values[121], keys[64];
    for (int i = 0; i < 121; ++i) {
        double x = i / 60.0 - 1.0;
        values[i] = 0.3 - x + 2.0 * x * x - 1.5 * x * x * x;
    }
    FF_ASSERT_OK(ff_spline_fit_create(121, 15, false, &fit, &error), error);
    ff_spline_fit_keys(&fit, values, keys);
    for (int i = 0; i < 121; ++i)
        FF_ASSERT_NEAR(ff_spline_fit_value(&fit, keys, i), values[i], 1e-5);
    ff_spline_fit_free(&fit);
    for (int i = 0; i < 120; ++i)
        values[i] = sin(FF_TAU * i / 120.0);
    for (int intervals = 1; intervals <= 60; intervals += intervals < 8 ? 1 : 13) {
        FF_ASSERT_OK(ff_spline_fit_create(120, intervals, true, &fit, &error), error);
        ff_spline_fit_keys(&fit, values, keys);
        for (int i = 0; i < 3; ++i)
            FF_ASSERT_NEAR(keys[intervals + i], keys[i], 0.0);
        for (int i = 0; i < 120 && intervals >= 8; ++i)
            FF_ASSERT_NEAR(ff_spline_fit_value(&fit, keys, i), values[i], 0.001);
        ff_spline_fit_free(&fit);
    }
    for (int samples = 1; samples <= 4; ++samples) {
        FF_ASSERT_OK(ff_spline_fit_create(samples, 2, false, &fit, &error), error);
        ff_spline_fit_keys(&fit, values, keys);
        for (int i = 0; i < samples; ++i)
            FF_ASSERT_NEAR(ff_spline_fit_value(&fit, keys, i), values[i], 1e-4);
        ff_spline_fit_free(&fit);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_built_in_clip_is_within_the_bound_and_the_bytes),
        cmocka_unit_test(captured_clips_are_within_the_bound_with_feet_cleaned),
        cmocka_unit_test(what_never_moves_has_no_keys),
        cmocka_unit_test(a_joint_may_turn_as_often_as_it_likes),
        cmocka_unit_test(cycles_have_no_seam),
        cmocka_unit_test(order_and_instructions_make_no_difference),
        cmocka_unit_test(mirrored_sampling_is_sampling_the_mirrored_motion),
        cmocka_unit_test(odd_questions_get_errors_and_odd_times_the_ends),
        cmocka_unit_test(weights_are_those_of_the_cubic_spline),
        cmocka_unit_test(a_fit_gives_back_what_is_a_spline),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
