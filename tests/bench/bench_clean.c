/* What the clean-up of feet costs, and what it reaches beside what is asked of it: over captured clips when the outside
 * data is there, over built-in clips with noise and skate when it is not. Clips are named on the command line, or the
 * labelled ones and a backward walk are taken. */
#define _GNU_SOURCE
#include "mocap/generator/generator.h"
#include "mocap/load.h"
#include "preprocess/clean/clean.h"
#include "tests/preprocess/standard.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_CLIPS = 256 };

typedef struct bench {
    ff_clip clips[MOST_CLIPS];
    int count;
} bench;

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now); /* of this one core, whatever else the machine does */
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void load(bench *b, const char *path)
{
    ff_load_options options = ff_load_options_default();
    ff_error error;
    char text[1024];
    if (b->count == MOST_CLIPS) return;
    if (ff_clip_load(path, &options, &b->clips[b->count], &error) == FF_OK)
        ++b->count;
    else
        fprintf(stderr, "%s\n", ff_error_text(&error, text, sizeof text));
}

/* First column of the labels' table of clips: SUBJECT_NUMBER. */
static void load_labelled(bench *b, const char *shared)
{
    char path[4096], line[1024];
    snprintf(path, sizeof path, "%s/data/labels/steps.csv", shared);
    FILE *table = fopen(path, "r");
    if (!table) return;
    bool header = true;
    while (fgets(line, sizeof line, table)) {
        char *comma = strchr(line, ','), *bar = strchr(line, '_');
        if (!header && comma && bar && bar < comma) {
            *comma = '\0';
            snprintf(path, sizeof path, "%s/data/cmu/%.*s/%s.amc", shared, (int)(bar - line), line, line);
            load(b, path);
        }
        header = false;
    }
    fclose(table);
    snprintf(path, sizeof path, "%s/data/cmu/09/09_12.amc", shared);
    load(b, path);
}

static void make_up(bench *b)
{
    for (int i = 0; i < ff_generator_count() && b->count < MOST_CLIPS; ++i) {
        ff_generator_options options = {.noise_mm = 1.0, .skate_cm = 1.0};
        ff_generated made;
        if (ff_generator_make(i, &options, &made, NULL) != FF_OK) continue;
        b->clips[b->count++] = made.clip;
        memset(&made.clip, 0, sizeof made.clip);
        ff_generated_free(&made);
    }
}

typedef struct tally {
    double worst[7], motion, spent;
    int cleaned, untouched, failed;
} tally;

static void worse(tally *t, int row, double value)
{
    t->worst[row] = ff_max(t->worst[row], value);
}

static void clean_one(const ff_rig *rig, const ff_clip *clip, tally *t)
{
    ff_plants plants;
    ff_motion motion;
    ff_clean_report r;
    ff_error error;
    char text[1024];
    ff_status status = ff_plants_find(clip, &standard()->find, &plants, &error);
    if (status != FF_OK) {
        ++t->failed;
        return;
    }
    status = ff_motion_from_clip(rig, clip, &plants, &motion, &error);
    if (status == FF_OK) {
        double start = seconds();
        status = ff_motion_clean(rig, &standard()->cut.clean, &motion, &plants, &r, &error);
        t->spent += seconds() - start;
        t->motion += ff_clip_seconds(clip);
        ff_motion_free(&motion);
    }
    ff_plants_free(&plants);
    if (status != FF_OK) {
        printf("%s: %s\n", clip->name, ff_error_text(&error, text, sizeof text));
        ++t->failed;
        return;
    }
    ++t->cleaned;
    t->untouched += r.was_clean;
    const double values[7] = {1e3 * r.pin_median.after,    1e3 * r.pin_worst.after, r.turn_mean / FF_DEG,
                              r.turn_most_95 / FF_DEG,     r.acceleration,          1e3 * r.floor_dip.after,
                              -r.knee_least.after / FF_DEG};
    for (int row = 0; row < 7; ++row)
        worse(t, row, values[row]);
}

int main(int argc, char **argv)
{
    static bench b;
    const char *shared = getenv("FF_SHARED");
    for (int i = 1; i < argc; ++i)
        load(&b, argv[i]);
    if (argc < 2 && shared && *shared) load_labelled(&b, shared);
    if (argc < 2 && b.count == 0) make_up(&b);
    const ff_clip *clips[MOST_CLIPS];
    for (int i = 0; i < b.count; ++i)
        clips[i] = &b.clips[i];
    ff_rig rig;
    if (b.count == 0 || ff_rig_from_clips(clips, b.count, &rig, NULL) != FF_OK) return 1;
    tally t = {.worst = {0, 0, 0, 0, 0, 0, -180.0}};
    for (int i = 0; i < b.count; ++i)
        clean_one(&rig, clips[i], &t);
    static const char *const rows[7] = {"ball of a flat foot from its pin, median (mm; asked 0.1)",
                                        "    worst frame (mm; asked 3, backwards 6)",
                                        "joints turned, mean (degrees; asked 1.5)",
                                        "    95 % below (degrees; asked 5)",
                                        "accelerations, after / before (asked 1.1)",
                                        "sole under the floor (mm; asked 10)",
                                        "knee bent the wrong way (degrees; asked 0, negative = never)"};
    printf("%d clips, %d of them needed nothing, %d failed, %.1f s of motion; worst clip:\n", t.cleaned,
           t.untouched, t.failed, t.motion);
    for (int row = 0; row < 7; ++row)
        printf("  %-64s %8.3f\n", rows[row], t.worst[row]);
    printf("  %-64s %8.3f\n", "one core, s per minute of motion (asked 5)", 60.0 * t.spent / t.motion);
    for (int i = 0; i < b.count; ++i)
        ff_clip_free(&b.clips[i]);
    return t.failed > 0;
}
