/* plant_score.h - found plants against hand-checked labels, scored as the labels' own tool does: per clip and foot, one
 * to one, largest overlap first. */
#ifndef FF_PLANT_SCORE_H
#define FF_PLANT_SCORE_H

#include "mocap/load.h"
#include "preprocess/plants/plants.h"
#include "tests/check.h"
#include "tests/preprocess/standard.h"

#include <stdio.h>
#include <stdlib.h>

enum { MOST_LABELS = 512 };

typedef struct label {
    char clip[16];
    int foot, start, end, flat_start, flat_end, frames;
    bool run, partial, cut_start, cut_end;
} label;

enum { EDGE_START, EDGE_END, EDGE_FLAT_START, EDGE_FLAT_END, EDGE_COUNT, MOST_EDGES = 1024 };

/* Found, invented and missed plants by kind (walk, run) and threshold (0.5, 0.8); how many frames late the edges of
 * those found at 0.5 are. */
typedef struct score {
    int found[2][2], invented[2][2], missed[2][2];
    int late[2][EDGE_COUNT][MOST_EDGES], edges[2][EDGE_COUNT];
} score;

static const double thresholds[2] = {0.5, 0.8};

/* Text of column number k (from 0) of a CSV row without quotes. */
static inline const char *column(const char *row, int k)
{
    for (; k > 0; --k)
        row = strchr(row, ',') + 1;
    return row;
}

static inline int read_labels(const char *shared, label *labels)
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
        l->flat_start = atoi(column(row, 6));
        l->flat_end = atoi(column(row, 7));
        l->cut_start = *column(row, 8) == '1';
        l->cut_end = *column(row, 9) == '1';
        l->partial = *column(row, 10) == '1';
        l->frames = atoi(column(row, 20));
    }
    fclose(file);
    return count;
}

static inline double overlap(const ff_plant *p, const label *l)
{
    int both = (p->end < l->end ? p->end : l->end) - (p->start > l->start ? p->start : l->start) + 1;
    int either = (p->end > l->end ? p->end : l->end) - (p->start < l->start ? p->start : l->start) + 1;
    return p->foot == l->foot && both > 0 ? (double)both / either : 0.0;
}

static inline void score_edge(score *sum, int kind, int edge, int is, int should)
{
    if (is >= 0 && should >= 0 && sum->edges[kind][edge] < MOST_EDGES)
        sum->late[kind][edge][sum->edges[kind][edge]++] = is - should;
}

static inline void score_edges(const ff_plant *p, const label *l, score *sum)
{
    if (!l->cut_start && !p->cut_start) score_edge(sum, l->run, EDGE_START, p->start, l->start);
    if (!l->cut_end && !p->cut_end) score_edge(sum, l->run, EDGE_END, p->end, l->end);
    score_edge(sum, l->run, EDGE_FLAT_START, p->flat_start, l->flat_start);
    score_edge(sum, l->run, EDGE_FLAT_END, p->flat_end, l->flat_end);
}

static inline int compare_ints(const void *x, const void *y)
{
    return *(const int *)x - *(const int *)y;
}

/* Median of how late an edge is (signed), and the share of those within so many frames. */
static inline int edge_median(score *sum, int kind, int edge)
{
    int n = sum->edges[kind][edge];
    qsort(sum->late[kind][edge], (size_t)n, sizeof(int), compare_ints);
    return n > 0 ? sum->late[kind][edge][n / 2] : 0;
}

static inline double edge_within(const score *sum, int kind, int edge, int frames)
{
    int n = sum->edges[kind][edge], good = 0;
    for (int i = 0; i < n; ++i)
        good += abs(sum->late[kind][edge][i]) <= frames;
    return n > 0 ? (double)good / n : 1.0;
}

/* Match one clip's plants and labels at one threshold and count. */
static inline void score_clip(const ff_plants *plants, const label *labels, int count, int t, score *sum)
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
        if (!labels[l].partial) {
            ++sum->found[kind][t];
            if (t == 0) score_edges(&plants->items[p], &labels[l], sum);
        }
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

static inline double f1(const score *s, int kind, int t)
{
    return 2.0 * s->found[kind][t] / (2.0 * s->found[kind][t] + s->invented[kind][t] + s->missed[kind][t]);
}

/* All labelled clips below the shared folder; change (may be NULL) alters each of them first. */
static inline void score_all(const char *shared, void (*change)(ff_clip *), score *sum)
{
    static label labels[MOST_LABELS];
    int count = read_labels(shared, labels);
    memset(sum, 0, sizeof *sum);
    for (int from = 0, to; from < count; from = to) {
        for (to = from; to < count && strcmp(labels[to].clip, labels[from].clip) == 0;)
            ++to;
        char path[512];
        snprintf(path, sizeof path, "%s/data/cmu/%.*s/%s.amc", shared, (int)strcspn(labels[from].clip, "_"),
                 labels[from].clip, labels[from].clip);
        ff_load_options options = ff_load_options_default();
        ff_clip clip;
        ff_breaks breaks;
        ff_plants plants;
        ff_error error;
        FF_ASSERT_OK(ff_clip_load(path, &options, &clip, &error), error);
        assert_int_equal(clip.frame_count, labels[from].frames);
        FF_ASSERT_OK(ff_breaks_repair(&clip, &standard()->find.breaks, &breaks, &error), error);
        if (change) change(&clip);
        FF_ASSERT_OK(ff_plants_find(&clip, &standard()->find, &plants, &error), error);
        assert_in_range(plants.count, 1, MOST_LABELS);
        for (int t = 0; t < 2; ++t)
            score_clip(&plants, labels + from, to - from, t, sum);
        ff_plants_free(&plants);
        ff_breaks_free(&breaks);
        ff_clip_free(&clip);
    }
}

#endif
