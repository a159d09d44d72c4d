/* Steps, cadence, speed, step length and turn of clips, against figures others measured on the same captures (labels,
 * steps.csv) and against what the generator was asked for. */
#include "preprocess/actions/gait_figures.h"

#include "mocap/load.h"
#include "tests/preprocess/motion_make.h"
#include "tests/preprocess/standard.h"

#include <stdio.h>

/* One row of steps.csv. */
typedef struct row {
    char clip[16], tag[32];
    double value[24];
} row;

enum { STEPS = 8, CADENCE = 12, SPEED_PATH = 15, STEP_LENGTH = 16, TURN = 23 };

static bool read_row(FILE *file, row *out)
{
    char text[1024];
    if (!fgets(text, sizeof text, file)) return false;
    memset(out, 0, sizeof *out);
    char *at = text;
    for (int k = 0; k < 24 && at; ++k) {
        char *end = strpbrk(at, ",\r\n");
        if (end) *end = '\0';
        if (k == 0) snprintf(out->clip, sizeof out->clip, "%.15s", at);
        if (k == 3) snprintf(out->tag, sizeof out->tag, "%.31s", at);
        out->value[k] = *at ? strtod(at, NULL) : NAN;
        at = end ? end + 1 : NULL;
    }
    return true;
}

static ff_gait_figures measure(const char *path)
{
    ff_load_options options = ff_load_options_default();
    ff_error error;
    ff_clip clip;
    ff_breaks breaks;
    ff_plants plants;
    ff_gait_figures figures;
    FF_ASSERT_OK(ff_clip_load(path, &options, &clip, &error), error);
    FF_ASSERT_OK(ff_breaks_repair(&clip, &standard()->find.breaks, &breaks, &error), error);
    FF_ASSERT_OK(ff_plants_find(&clip, &standard()->find, &plants, &error), error);
    FF_ASSERT_OK(ff_gait_figures_find(&clip, &plants, &figures, &error), error);
    ff_plants_free(&plants);
    ff_breaks_free(&breaks);
    ff_clip_free(&clip);
    return figures;
}

static void agrees_with_what_others_measured(void **state)
{
    (void)state;
    const char *shared = ff_shared_folder();
    if (!shared) {
        print_message("SKIPPED agrees_with_what_others_measured: the shared folder is not there\n");
        skip();
    }
    char path[512];
    snprintf(path, sizeof path, "%s/data/labels/steps.csv", shared);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    row r;
    assert_true(read_row(file, &r)); /* the header */
    int walks = 0, exact = 0;
    double cadence = 0.0, speed = 0.0, length = 0.0, turn = 0.0; /* worst of the walks */
    while (read_row(file, &r)) {
        if (strncmp(r.tag, "walk", 4) != 0) continue;
        snprintf(path, sizeof path, "%s/data/cmu/%.*s/%s.amc", shared, (int)strcspn(r.clip, "_"), r.clip,
                 r.clip);
        ff_gait_figures f = measure(path);
        ++walks;
        exact += f.steps == (int)r.value[STEPS];
        assert_in_range(f.steps, (int)r.value[STEPS] - 1, (int)r.value[STEPS] + 1);
        cadence = ff_max(cadence, fabs(f.cadence / r.value[CADENCE] - 1.0));
        speed = ff_max(speed, fabs(f.speed_path / r.value[SPEED_PATH] - 1.0));
        length = ff_max(length, fabs(f.step_length - r.value[STEP_LENGTH]));
        turn = ff_max(turn, fabs(f.turn / FF_DEG - r.value[TURN]));
        FF_ASSERT_BELOW(fabs(f.cadence / r.value[CADENCE] - 1.0), 0.03);
        FF_ASSERT_BELOW(fabs(f.speed_path / r.value[SPEED_PATH] - 1.0), 0.01);
        FF_ASSERT_BELOW(fabs(f.turn / FF_DEG - r.value[TURN]), 5.0);
        FF_ASSERT_BELOW(fabs(f.step_length - r.value[STEP_LENGTH]), 0.03);
    }
    fclose(file);
    print_message("%d of %d walks have the same number of steps; worst: cadence %.1f %%, speed %.2f %%, step "
                  "%.1f cm, turn %.1f degrees\n",
                  exact, walks, 100.0 * cadence, 100.0 * speed, 100.0 * length, turn);
    assert_true(exact >= 0.9 * walks);
}

static void measures_what_the_generator_was_asked_for(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double speed, turn; /* m/s, rad/s: below zero to the right */
    } asked[] = {{"walk-slow", 1.02, 0.0}, {"walk-normal", 1.27, 0.0}, {"run", 3.0, 0.0}};
    for (size_t i = 0; i < sizeof asked / sizeof asked[0]; ++i) {
        ff_clip clip = generated_clip(asked[i].name);
        ff_plants plants;
        ff_gait_figures f;
        ff_error error;
        FF_ASSERT_OK(ff_plants_find(&clip, &standard()->find, &plants, &error), error);
        FF_ASSERT_OK(ff_gait_figures_find(&clip, &plants, &f, &error), error);
        FF_ASSERT_NEAR(f.speed_net, asked[i].speed, 0.02 * asked[i].speed);
        FF_ASSERT_NEAR(f.turn, asked[i].turn * f.seconds, 5.0 * FF_DEG);
        FF_ASSERT_NEAR(f.step_length * f.cadence / 60.0, asked[i].speed, 0.03 * asked[i].speed);
        ff_plants_free(&plants);
        ff_clip_free(&clip);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_what_others_measured),
        cmocka_unit_test(measures_what_the_generator_was_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
