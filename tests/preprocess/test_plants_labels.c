/* The plant detector against hand-checked labels of captured clips, scored as the labels' own tool does: per clip and
 * foot, one to one, largest overlap first. */
#include "mocap/load.h"
#include "preprocess/plants.h"
#include "tests/check.h"

#include <stdio.h>

enum { MOST_LABELS = 512 };

typedef struct label {
    char clip[16];
    int foot, start, end, frames;
    bool run, partial;
} label;

/* Found, invented and missed plants by kind (walk, run) and threshold (0.5, 0.8). */
typedef struct score {
    int found[2][2], invented[2][2], missed[2][2];
} score;

static const double thresholds[2] = {0.5, 0.8};

/* Text of column number k (from 0) of a CSV row without quotes. */
static const char *column(const char *row, int k)
{
    for (; k > 0; --k)
        row = strchr(row, ',') + 1;
    return row;
}

static int read_labels(const char *shared, label *labels)
{
    char path[512], row[1024];
    snprintf(path, sizeof path, "%s/data/labels/footplants.csv", shared);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    int count = 0;
    assert_non_null(fgets(row, sizeof row, file));
    /* clip,tag,foot,plant,start_frame,end_frame,flat_start,flat_end,start_truncated,end_truncated,partial,... */
    assert_int_equal(strncmp(column(row, 4), "start_frame", 11), 0);
    assert_int_equal(strncmp(column(row, 10), "partial", 7), 0);
    assert_int_equal(strncmp(column(row, 20), "n_frames", 8), 0);
    while (count < MOST_LABELS && fgets(row, sizeof row, file)) {
        label *l = &labels[count++];
        snprintf(l->clip, sizeof l->clip, "%.*s", (int)strcspn(row, ","), row);
        l->run = strncmp(column(row, 1), "run", 3) == 0;
        l->foot = *column(row, 2) == 'L' ? FF_LEFT : FF_RIGHT;
        l->start = atoi(column(row, 4));
        l->end = atoi(column(row, 5));
        l->partial = *column(row, 10) == '1';
        l->frames = atoi(column(row, 20));
    }
    fclose(file);
    return count;
}

static double overlap(const ff_plant *p, const label *l)
{
    int both = (p->end < l->end ? p->end : l->end) - (p->start > l->start ? p->start : l->start) + 1;
    int either = (p->end > l->end ? p->end : l->end) - (p->start < l->start ? p->start : l->start) + 1;
    return p->foot == l->foot && both > 0 ? (double)both / either : 0.0;
}

/* Match one clip's plants and labels at one threshold and count. */
static void score_clip(const ff_plants *plants, const label *labels, int count, int t, score *sum)
{
    bool plant_used[MOST_LABELS] = {false}, label_used[MOST_LABELS] = {false};
    int kind = labels[0].run;
    for (;;) {
        double best = thresholds[t];
        int p = -1, l = -1;
        for (int i = 0; i < plants->count; ++i)
            for (int j = 0; j < count; ++j)
                if (!plant_used[i] && !label_used[j] && overlap(&plants->items[i], &labels[j]) > best) {
                    best = overlap(&plants->items[i], &labels[j]);
                    p = i;
                    l = j;
                }
        if (p < 0) break;
        plant_used[p] = label_used[l] = true;
        if (!labels[l].partial) ++sum->found[kind][t];
    }
    for (int j = 0; j < count; ++j)
        if (!label_used[j] && !labels[j].partial) ++sum->missed[kind][t];
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *p = &plants->items[i];
        bool excused = plant_used[i] || p->end < 10 || p->start > labels[0].frames - 11;
        for (int j = 0; j < count; ++j)
            if (labels[j].partial && !label_used[j] && overlap(p, &labels[j]) > 0.0) excused = true;
        if (!excused) ++sum->invented[kind][t];
    }
}

static double f1(const score *s, int kind, int t)
{
    return 2.0 * s->found[kind][t] / (2.0 * s->found[kind][t] + s->invented[kind][t] + s->missed[kind][t]);
}

static void agrees_with_the_labels(void **state)
{
    (void)state;
    const char *shared = ff_shared_folder();
    if (!shared) {
        print_message("SKIPPED agrees_with_the_labels: the shared folder with labelled clips is not there\n");
        skip();
    }
    static label labels[MOST_LABELS];
    int count = read_labels(shared, labels);
    score sum = {0};
    for (int from = 0, to; from < count; from = to) {
        for (to = from; to < count && strcmp(labels[to].clip, labels[from].clip) == 0;)
            ++to;
        char path[512];
        snprintf(path, sizeof path, "%s/data/cmu/%.*s/%s.amc", shared, (int)strcspn(labels[from].clip, "_"),
                 labels[from].clip, labels[from].clip);
        ff_load_options options = ff_load_options_default();
        ff_clip clip;
        ff_plants plants;
        ff_error error;
        FF_ASSERT_OK(ff_clip_load(path, &options, &clip, &error), error);
        assert_int_equal(clip.frame_count, labels[from].frames);
        FF_ASSERT_OK(ff_plants_find(&clip, &plants, &error), error);
        assert_in_range(plants.count, 1, MOST_LABELS);
        for (int t = 0; t < 2; ++t)
            score_clip(&plants, labels + from, to - from, t, &sum);
        ff_plants_free(&plants);
        ff_clip_free(&clip);
    }
    print_message("F1 at IoU 0.5 and 0.8: walking %.4f %.4f, running %.4f %.4f\n", f1(&sum, 0, 0),
                  f1(&sum, 0, 1), f1(&sum, 1, 0), f1(&sum, 1, 1));
    assert_true(f1(&sum, 0, 0) >= 0.995);
    assert_true(f1(&sum, 0, 1) >= 0.98);
    assert_true(f1(&sum, 1, 0) >= 0.98);
    assert_true(f1(&sum, 1, 1) >= 0.93);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_labels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
