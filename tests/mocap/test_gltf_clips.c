/* glTF clips as a pack sees them: size, roles, rest pose, walking on the spot, and every clip of the outside data. */
#include "mocap/catalogue.h"
#include "mocap/generator/generator.h"
#include "mocap/read.h"
#include "mocap/roles_find.h"
#include "tests/check.h"

#include <stdio.h>

static ff_generated made(const char *name)
{
    ff_generated clip;
    ff_error error;
    int index = -1;
    for (int i = 0; i < ff_generator_count(); ++i)
        if (strcmp(ff_generator_describe(i).name, name) == 0) index = i;
    assert_true(index >= 0);
    FF_ASSERT_OK(ff_generator_make(index, NULL, &clip, &error), error);
    return clip;
}

/* Take the mean travel of the root out of a clip; returns it (m/s). */
static ff_vec3 put_on_the_spot(ff_clip *clip)
{
    size_t tracks = (size_t)clip->track_count, last = (size_t)clip->frame_count - 1;
    ff_vec3 *p = clip->positions;
    ff_vec3 speed = ff_scale3(ff_sub3(p[last * tracks], p[0]), 1.0 / ff_clip_seconds(clip));
    speed.y = 0.0;
    for (size_t k = 0; k <= last; ++k)
        p[k * tracks] = ff_madd3(p[k * tracks], speed, -(double)k * clip->frame_time);
    return speed;
}

static void a_walk_on_the_spot_gets_its_travel_back(void **state)
{
    (void)state;
    static const char *const names[] = {"walk-slow", "walk-normal", "walk-fast", "jog", "run", "back"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        ff_generated clip = made(names[i]);
        ff_error error;
        ff_vec3 want = put_on_the_spot(&clip.clip);
        size_t tracks = (size_t)clip.clip.track_count;
        int frames = clip.clip.frame_count;
        FF_ASSERT_OK(ff_clip_restore_travel(&clip.clip, false, &error), error);
        ff_vec3 moved = ff_sub3(clip.clip.positions[(size_t)(frames - 1) * tracks], clip.clip.positions[0]);
        ff_vec3 got = ff_scale3(moved, 1.0 / ((frames - 1) * clip.clip.frame_time));
        double off = ff_length3(ff_sub3(got, want)) / ff_length3(want);
        print_message("%s: %.3f m/s, restored to %.1f %%\n", names[i], ff_length3(want), 100.0 * off);
        assert_int_equal(clip.clip.warning_count, 1);
        FF_ASSERT_BELOW(off, 0.08);
        ff_generated_free(&clip);
    }
}

static void what_travels_or_stands_is_left_alone(void **state)
{
    (void)state;
    static const char *const names[] = {"walk-normal", "curve-left", "idle", "turn-left-90"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        ff_generated clip = made(names[i]);
        ff_error error;
        int frames = clip.clip.frame_count;
        ff_vec3 last = clip.clip.positions[(size_t)(frames - 1) * (size_t)clip.clip.track_count];
        FF_ASSERT_OK(ff_clip_restore_travel(&clip.clip, true, &error), error);
        assert_int_equal(clip.clip.frame_count, frames);
        FF_ASSERT_NEAR(clip.clip.positions[(size_t)(frames - 1) * (size_t)clip.clip.track_count].z, last.z,
                       0.0);
        assert_int_equal(clip.clip.warning_count, 0);
        ff_generated_free(&clip);
    }
}

/* -------------------------------------------------------------------------------------------------- outside data */

static const char *gltf_folder(void)
{
    static char folder[1024];
    if (!ff_shared_folder()) {
        print_message("SKIPPED the outside data is not here\n");
        skip();
    }
    snprintf(folder, sizeof folder, "%s/data/gltf", ff_shared_folder());
    return folder;
}

static const struct {
    const char *file;
    int clips;   /* animations that move */
    double unit; /* m: scale to a person's legs, 1 = has them */
} files[] = {{"boxman.glb", 34, 2.51},
             {"cesium_man.gltf", 1, 1.0},
             {"kaykit_knight.glb", 69, 2.23},
             {"robot.glb", 14, 0.546}};
enum { FILE_COUNT = sizeof files / sizeof files[0] };

static bool stands(const ff_clip *clip)
{
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_clip_rest_pose(clip, at);
    ff_vec3 head = at[ff_clip_find(clip, FF_ROLE_HEAD)], hips = at[ff_clip_find(clip, FF_ROLE_HIPS)];
    ff_vec3 left = at[ff_clip_find(clip, FF_ROLE_HIP_L)], right = at[ff_clip_find(clip, FF_ROLE_HIP_R)];
    ff_vec3 ankle = at[ff_clip_find(clip, FF_ROLE_ANKLE_L)];
    return head.y > hips.y + 0.3 && ankle.y < left.y - 0.3 && fabs(left.y - right.y) < 0.02;
}

static void every_animation_loads_on_a_standing_rest_pose(void **state)
{
    (void)state;
    const char *folder = gltf_folder();
    for (int f = 0; f < FILE_COUNT; ++f) {
        char path[1200];
        const char *input = path;
        ff_catalogue catalogue;
        ff_error error;
        snprintf(path, sizeof path, "%s/%s", folder, files[f].file);
        FF_ASSERT_OK(ff_catalogue_read(&input, 1, &catalogue, &error), error);
        assert_int_equal(catalogue.count, files[f].clips);
        for (int i = 0; i < catalogue.count; i += 6) {
            ff_clip clip;
            FF_ASSERT_OK(
                ff_clip_load(catalogue.entries[i].path, &catalogue.entries[i].options, &clip, &error), error);
            FF_ASSERT_OK(ff_roles_require(&clip, &error), error);
            FF_ASSERT_NEAR(clip.unit_m, files[f].unit, 0.01);
            if (!stands(&clip)) fail_msg("%s does not stand at rest", clip.name);
            ff_clip_free(&clip);
        }
        ff_catalogue_free(&catalogue);
    }
}

/* Where animations that walk on the spot go, along the body's own forward and left. */
static void animations_on_the_spot_go_where_they_face(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double forward, left; /* m/s */
    } walks[] = {{"kaykit_knight.glb#Walking_A", 1.66, 0.0},
                 {"kaykit_knight.glb#Walking_Backwards", -1.6, 0.0},
                 {"kaykit_knight.glb#Idle", 0.0, 0.0},
                 {"robot.glb#Robot_Walking", 2.2, 0.0},
                 {"cesium_man.gltf", 0.9, 0.0}};
    const char *folder = gltf_folder();
    for (size_t i = 0; i < sizeof walks / sizeof walks[0]; ++i) {
        char path[1200];
        ff_load_options options = ff_load_options_default();
        ff_error error;
        ff_clip clip;
        ff_vec3 first[FF_CLIP_MAX_JOINTS], last[FF_CLIP_MAX_JOINTS], rest[FF_CLIP_MAX_JOINTS];
        snprintf(path, sizeof path, "%s/%s", folder, walks[i].name);
        FF_ASSERT_OK(ff_clip_load(path, &options, &clip, &error), error);
        ff_clip_pose(&clip, 0, first, NULL);
        ff_clip_pose(&clip, clip.frame_count - 1, last, NULL);
        ff_clip_rest_pose(&clip, rest);
        int hips = ff_clip_find(&clip, FF_ROLE_HIPS);
        ff_vec3 across =
            ff_sub3(rest[ff_clip_find(&clip, FF_ROLE_HIP_L)], rest[ff_clip_find(&clip, FF_ROLE_HIP_R)]);
        ff_vec2 left = ff_unit2(ff_plane(across)), forward = ff_v2(left.b, -left.a);
        ff_vec2 speed = ff_scale2(ff_plane(ff_sub3(last[hips], first[hips])), 1.0 / ff_clip_seconds(&clip));
        print_message("%s: %.2f m/s forward, %.2f m/s left\n", walks[i].name, ff_dot2(speed, forward),
                      ff_dot2(speed, left));
        FF_ASSERT_NEAR(ff_dot2(speed, forward), walks[i].forward, 0.25);
        FF_ASSERT_NEAR(ff_dot2(speed, left), walks[i].left, 0.2);
        ff_clip_free(&clip);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_walk_on_the_spot_gets_its_travel_back),
        cmocka_unit_test(what_travels_or_stands_is_left_alone),
        cmocka_unit_test(every_animation_loads_on_a_standing_rest_pose),
        cmocka_unit_test(animations_on_the_spot_go_where_they_face),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
