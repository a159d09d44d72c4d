/* Steps cut from captured clips, checked from the poses: at its start one foot stands, at its end the other one has just
 * come to stand. */
#include "preprocess/actions/annotate.h"

#include "mocap/load.h"
#include "tests/check.h"
#include "tests/preprocess/standard.h"

#include <dirent.h>
#include <stdio.h>

enum { MOST_CLIPS = 256 };

typedef struct corpus {
    ff_clip clips[MOST_CLIPS];
    int count;
} corpus;

static int by_name(const void *x, const void *y)
{
    return strcmp(((const ff_clip *)x)->name, ((const ff_clip *)y)->name);
}

static void load_folder(corpus *c, const char *folder)
{
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (const struct dirent *entry; (entry = readdir(dir));) {
        size_t length = strlen(entry->d_name);
        if (length < 5 || strcmp(entry->d_name + length - 4, ".amc") != 0) continue;
        char path[1100];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        ff_load_options options = ff_load_options_default();
        ff_error error;
        assert_in_range(c->count, 0, MOST_CLIPS - 1);
        FF_ASSERT_OK(ff_clip_load(path, &options, &c->clips[c->count++], &error), error);
    }
    closedir(dir);
}

static void load_all(corpus *c, const char *shared)
{
    char root[512];
    snprintf(root, sizeof root, "%s/data/cmu", shared);
    DIR *dir = opendir(root);
    assert_non_null(dir);
    for (const struct dirent *entry; (entry = readdir(dir));) {
        char folder[768];
        if (entry->d_name[0] == '.') continue;
        snprintf(folder, sizeof folder, "%s/%s", root, entry->d_name);
        load_folder(c, folder);
    }
    closedir(dir);
    qsort(c->clips, (size_t)c->count, sizeof *c->clips, by_name);
}

/* What one foot does in a frame of the motion. */
typedef struct foot_state {
    double ball_height, heel_height; /* m over their height at rest */
    double speed;                    /* m/s, of the slower of heel and ball, over 25 ms */
} foot_state;

static foot_state look(const ff_rig *rig, const ff_motion *motion, int foot, int frame, double level)
{
    ff_vec3 rest[FF_BODY_COUNT], now[FF_BODY_COUNT], then[FF_BODY_COUNT];
    int reach = (int)(0.0125 / motion->frame_time + 0.5), n = motion->frame_count;
    reach = reach > 0 ? reach : 1;
    int from = frame - reach > 0 ? frame - reach : 0, to = frame + reach < n ? frame + reach : n - 1;
    ff_rig_rest_pose(rig, rest);
    ff_motion_pose(rig, motion, frame, now, NULL);
    int ball = foot == FF_LEFT ? FF_ROLE_BALL_L : FF_ROLE_BALL_R;
    int heel = foot == FF_LEFT ? FF_BODY_HEEL_L : FF_BODY_HEEL_R;
    foot_state s = {now[ball].y - rest[ball].y - level, now[heel].y - rest[heel].y - level, 0.0};
    ff_motion_pose(rig, motion, from, now, NULL);
    ff_motion_pose(rig, motion, to, then, NULL);
    double seconds = (to - from) * motion->frame_time;
    s.speed = ff_min(ff_length3(ff_sub3(then[ball], now[ball])), ff_length3(ff_sub3(then[heel], now[heel]))) /
              seconds;
    return s;
}

/* Does the foot stand in this frame? Limits are those of the labels, with room for capture noise. */
static bool stands(const ff_rig *rig, const ff_motion *motion, int foot, int frame, double level, bool run)
{
    foot_state s = look(rig, motion, foot, frame, level);
    return s.speed < (run ? 1.0 : 0.7) && fabs(s.ball_height) < 0.04 && s.heel_height < (run ? 0.09 : 0.06);
}

/* Did it move at least once in the quarter second before (0.6 m/s; 3 cm over the floor will do too)? */
static bool just_came(const ff_rig *rig, const ff_motion *motion, int foot, int frame)
{
    int reach = (int)(0.25 / motion->frame_time);
    for (int i = frame - reach > 0 ? frame - reach : 0; i < frame; ++i)
        if (look(rig, motion, foot, i, 0.0).speed > 0.6 || look(rig, motion, foot, i, 0.0).heel_height > 0.03)
            return true;
    return false;
}

static void steps_begin_on_one_foot_and_end_as_the_other_stands(void **state)
{
    (void)state;
    const char *shared = ff_shared_folder();
    if (!shared) {
        print_message(
            "SKIPPED steps_begin_on_one_foot_and_end_as_the_other_stands: the shared folder is not there\n");
        skip();
    }
    static corpus c;
    static const ff_clip *clips[MOST_CLIPS];
    load_all(&c, shared);
    for (int i = 0; i < c.count; ++i)
        clips[i] = &c.clips[i];
    ff_rig rig;
    ff_error error;
    FF_ASSERT_OK(ff_rig_from_clips(clips, c.count, &rig, &error), error);
    int steps = 0, good = 0;
    for (int i = 0; i < c.count; ++i) {
        ff_plants plants;
        ff_motion motion;
        ff_actions actions;
        FF_ASSERT_OK(ff_plants_find(clips[i], &standard()->find, &plants, &error), error);
        FF_ASSERT_OK(ff_motion_from_clip(&rig, clips[i], &plants, &motion, &error), error);
        FF_ASSERT_OK(ff_actions_cut(&standard()->cut, &rig, &motion, &plants, -1, &actions, &error), error);
        for (int k = 0; k < actions.count; ++k) {
            const ff_action *a = &actions.items[k];
            if (a->record.mode == FF_MODE_IDLE) continue;
            bool run = a->record.speed > 1.8f;
            double level = (double)a->record.height, landed = level + (double)a->record.rise;
            bool start = stands(&rig, &motion, (int)a->record.support, a->first_frame, level, run);
            bool end = stands(&rig, &motion, (int)a->record.swing, a->last_frame, landed, run);
            /* Who comes to standing landed a while ago. */
            bool came = (a->record.flags & FF_ACTION_TO_STANDING) ||
                        just_came(&rig, &motion, (int)a->record.swing, a->last_frame);
            ++steps;
            good += start && end && came;
            if (!(start && end && came)) {
                foot_state s = look(&rig, &motion, (int)a->record.support, a->first_frame, level);
                foot_state e = look(&rig, &motion, (int)a->record.swing, a->last_frame, landed);
                print_message(
                    "%s %d to %d: mode %u support %.2f m/s %.3f %.3f, landing %.2f m/s %.3f %.3f%s\n",
                    clips[i]->name, a->first_frame, a->last_frame, a->record.mode, s.speed, s.ball_height,
                    s.heel_height, e.speed, e.ball_height, e.heel_height, came ? "" : ", did not move");
            }
        }
        ff_actions_free(&actions);
        ff_motion_free(&motion);
        ff_plants_free(&plants);
    }
    for (int i = 0; i < c.count; ++i)
        ff_clip_free(&c.clips[i]);
    print_message("%d steps from %d clips, %d stand on one foot and land on the other\n", steps, c.count,
                  good);
    assert_true(good >= 400);
    assert_true(good >= 0.97 * steps);
}

/* One clip all the way, on a rig of its own proportions. */
typedef struct walk {
    ff_clip clip;
    ff_plants plants;
    ff_rig rig;
    ff_motion motion;
    ff_actions actions;
} walk;

static walk walk_cut(const char *shared, const char *name)
{
    walk w;
    ff_error error;
    char path[512];
    ff_load_options options = ff_load_options_default();
    snprintf(path, sizeof path, "%s/data/cmu/%.*s/%s.amc", shared, (int)strcspn(name, "_"), name, name);
    FF_ASSERT_OK(ff_clip_load(path, &options, &w.clip, &error), error);
    const ff_clip *clip = &w.clip;
    FF_ASSERT_OK(ff_plants_find(clip, &standard()->find, &w.plants, &error), error);
    FF_ASSERT_OK(ff_rig_from_clips(&clip, 1, &w.rig, &error), error);
    FF_ASSERT_OK(ff_motion_from_clip(&w.rig, clip, &w.plants, &w.motion, &error), error);
    FF_ASSERT_OK(ff_actions_cut(&standard()->cut, &w.rig, &w.motion, &w.plants, -1, &w.actions, &error),
                 error);
    return w;
}

static void walk_free(walk *w)
{
    ff_actions_free(&w->actions);
    ff_motion_free(&w->motion);
    ff_plants_free(&w->plants);
    ff_clip_free(&w->clip);
}

/* Algorithms H: full plants of 35_01 near frames 157 left, 222 right and 289 left of the uncut clip; the file begins
 * with frame 135, counted from 1. */
static void the_known_walk_is_cut_where_it_is_known_to_be(void **state)
{
    (void)state;
    const char *shared = ff_shared_folder();
    if (!shared) {
        print_message(
            "SKIPPED the_known_walk_is_cut_where_it_is_known_to_be: the shared folder is not there\n");
        skip();
    }
    walk w = walk_cut(shared, "35_01");
    assert_int_equal(w.clip.first_frame, 135);
    assert_true(w.actions.count >= 2);
    static const int full[3] = {157 - 134, 222 - 134, 289 - 134};
    for (int i = 0; i < 2; ++i) {
        const ff_action *a = &w.actions.items[i];
        assert_int_equal(a->record.support, i % 2 ? FF_RIGHT : FF_LEFT);
        FF_ASSERT_NEAR(a->first_frame, full[i], 5);
        FF_ASSERT_NEAR(a->last_frame, full[i + 1], 5);
        FF_ASSERT_NEAR(a->record.alpha, 0.0, 10.0 * FF_DEG);
        FF_ASSERT_NEAR(a->record.theta, 0.0, 10.0 * FF_DEG);
    }
    walk_free(&w);
}

/* steps.csv: mean ball-to-ball steps along the way, measured by other means (straight, level walks). */
static void steps_are_as_long_as_others_measured_them(void **state)
{
    (void)state;
    const char *shared = ff_shared_folder();
    if (!shared) {
        print_message("SKIPPED steps_are_as_long_as_others_measured_them: the shared folder is not there\n");
        skip();
    }
    char path[512], row[1024];
    snprintf(path, sizeof path, "%s/data/labels/steps.csv", shared);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    int clips = 0;
    while (fgets(row, sizeof row, file)) {
        char name[16], tag[32];
        double length = 0.0, spread = 0.0;
        /* clip,n_frames,fps,tag,11 columns,...: step_len_m is the 17th, its deviation the 18th. */
        const char *at = row;
        for (int k = 0; k < 16 && at; ++k)
            at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL;
        if (!at || sscanf(row, "%15[^,],%*[^,],%*[^,],%31[^,]", name, tag) != 2 || strcmp(tag, "walk") != 0)
            continue;
        if (sscanf(at, "%lf,%lf", &length, &spread) != 2) continue;
        walk w = walk_cut(shared, name);
        double sum = 0.0;
        for (int i = 0; i < w.actions.count; ++i)
            sum += (double)w.actions.items[i].record.step_length / w.motion.scale;
        if (w.actions.count >= 2) {
            FF_ASSERT_NEAR(sum / w.actions.count, length, 0.03 + spread);
            ++clips;
        }
        walk_free(&w);
    }
    fclose(file);
    assert_true(clips >= 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_begin_on_one_foot_and_end_as_the_other_stands),
        cmocka_unit_test(the_known_walk_is_cut_where_it_is_known_to_be),
        cmocka_unit_test(steps_are_as_long_as_others_measured_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
