#include "preprocess/clean/clean_knots.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define KNOT_RATE                                                                                            \
    60.0 /* Hz: half of it leaves 10 mm at worst, twice of it gains nothing (cleanup study, section 2) */
#define WINDOW 1.0       /* s */
#define OVERLAP 0.3      /* s, looked ahead and then solved again */
#define NEAR_GROUND 0.08 /* m: points that start higher never reach the ground */

enum { KNOWN = 2 }; /* settled knots that second differences reach back to */

typedef struct knots {
    ff_clean_problem problem;
    int stride; /* frames per knot */
} knots;

static int knot_frame(const knots *k, int index, int frames)
{
    int frame = index * k->stride;
    return frame < frames ? frame : frames - 1;
}

static void knots_free(knots *k)
{
    free(k->problem.knots);
    free(k->problem.root);
    free(k->problem.legs);
}

static void put_knot(const ff_motion *motion, const ff_clean_pins *pins, int frame, knots *k, int index)
{
    ff_clean_knot *knot = &k->problem.knots[index];
    const double zero[FF_CLEAN_LEG] = {0};
    ff_clean_pose_read(motion, frame, &knot->pose);
    for (int side = 0; side < 2; ++side) {
        ff_vec3 places[FF_FOOT_PLACES];
        knot->plant[side] = -1;
        knot->ground[side] = ff_clean_ground(pins, side, frame);
        ff_clean_foot(k->problem.rig, &knot->pose, side, zero, zero, places, NULL);
        for (int p = 0; p < FF_FOOT_PLACES; ++p)
            knot->near_ground[side] |= places[p].y < knot->ground[side] + NEAR_GROUND;
    }
    for (int i = 0; i < pins->count; ++i) {
        const ff_clean_pin *pin = &pins->items[i];
        double heel, ball;
        ff_clean_pin_weights(pin, frame, motion->frame_time, &heel, &ball);
        if (heel + ball <= knot->heel[pin->foot] + knot->ball[pin->foot]) continue;
        knot->plant[pin->foot] = i;
        knot->heel[pin->foot] = heel;
        knot->ball[pin->foot] = ball;
    }
}

static ff_status make_knots(const ff_rig *rig, const ff_motion *motion, ff_clean_pins *pins, knots *k,
                            ff_error *error)
{
    int stride = (int)(1.0 / (KNOT_RATE * motion->frame_time) + 0.5);
    if (stride < 1) stride = 1;
    int count = (motion->frame_count - 2 + stride) / stride + 1;
    *k = (knots){.stride = stride,
                 .problem = {.rig = rig,
                             .settings = pins->settings,
                             .knot_time = stride * motion->frame_time,
                             .knot_count = count,
                             .plant_count = pins->count,
                             .plants = pins->plants}};
    ff_clean_problem *p = &k->problem;
    p->knots = ff_calloc((size_t)count, sizeof *p->knots);
    p->root = ff_calloc((size_t)count, sizeof *p->root);
    p->legs = ff_calloc((size_t)count, sizeof *p->legs);
    if (!p->knots || !p->root || !p->legs) {
        knots_free(k);
        return ff_fail(error, FF_ERR_NO_MEMORY, "cleaning %d frames", motion->frame_count);
    }
    for (int i = 0; i < count; ++i)
        put_knot(motion, pins, knot_frame(k, i, motion->frame_count), k, i);
    return FF_OK;
}

/* Plants that kept knots lean on stay where they are from now on. */
static void settle_plants(ff_clean_problem *p, int first, int last)
{
    for (int i = first; i < last; ++i)
        for (int side = 0; side < 2; ++side)
            if (p->knots[i].plant[side] >= 0) p->plants[p->knots[i].plant[side]].settled = true;
}

static ff_status solve_windows(ff_clean_problem *p, ff_clean_report *report, ff_error *error)
{
    int window = (int)(WINDOW / p->knot_time + 0.5), overlap = (int)(OVERLAP / p->knot_time + 0.5);
    if (window < 4) window = 4;
    for (int kept = 0; kept < p->knot_count;) {
        int first = kept < KNOWN ? 0 : kept - KNOWN, last = kept + window;
        if (last > p->knot_count) last = p->knot_count;
        ff_clean_solution solution;
        ff_status status = ff_clean_solve(p, first, last, kept - first, &solution, error);
        if (status != FF_OK) return status;
        report->solves += 1;
        report->unconverged += !solution.converged;
        report->iterations += solution.iterations;
        int next = last == p->knot_count ? last : last - overlap;
        settle_plants(p, kept, next);
        kept = next;
    }
    return FF_OK;
}

/* RMS distance of pinned points from their places. */
static double residual_of(const ff_clean_problem *p)
{
    double sum = 0.0, weight = 0.0;
    for (int i = 0; i < p->knot_count; ++i) {
        const ff_clean_knot *knot = &p->knots[i];
        for (int side = 0; side < 2; ++side) {
            if (knot->plant[side] < 0) continue;
            ff_vec3 places[FF_FOOT_PLACES], heel, ball;
            ff_clean_foot(p->rig, &knot->pose, side, p->root[i], p->legs[i][side], places, NULL);
            ff_clean_plant_places(p->rig, &p->plants[knot->plant[side]], &heel, &ball);
            ff_vec3 off[2] = {ff_sub3(places[FF_FOOT_AT_HEEL], heel), ff_sub3(places[FF_FOOT_AT_BALL], ball)};
            double share[2] = {knot->heel[side] * knot->heel[side], knot->ball[side] * knot->ball[side]};
            for (int point = 0; point < 2; ++point) {
                sum += share[point] * ff_dot3(off[point], off[point]);
                weight += share[point];
            }
        }
    }
    return weight > 0.0 ? sqrt(sum / weight) : 0.0;
}

/* Catmull-Rom between four values, t in [0, 1] between the middle two. */
static double between(double before, double from, double to, double after, double t)
{
    double s = 0.5 * (to - before), e = 0.5 * (after - from), d = to - from;
    return from + t * (s + t * (3.0 * d - 2.0 * s - e + t * (s + e - 2.0 * d)));
}

static void mix(const double *all, size_t width, const int *knot, double t, double *out)
{
    for (size_t i = 0; i < width; ++i)
        out[i] = between(all[(size_t)knot[0] * width + i], all[(size_t)knot[1] * width + i],
                         all[(size_t)knot[2] * width + i], all[(size_t)knot[3] * width + i], t);
}

static void add_changes(const knots *k, ff_motion *motion)
{
    const ff_clean_problem *p = &k->problem;
    int top = p->knot_count - 1;
    for (int frame = 0; frame < motion->frame_count; ++frame) {
        int low = frame / k->stride;
        if (low > top - 1) low = top > 0 ? top - 1 : 0;
        int high = low < top ? low + 1 : top;
        int from = knot_frame(k, low, motion->frame_count), to = knot_frame(k, high, motion->frame_count);
        int knot[4] = {low > 0 ? low - 1 : 0, low, high, high < top ? high + 1 : top};
        double root[FF_CLEAN_ROOT], legs[2 * FF_CLEAN_LEG];
        double t = to > from ? (double)(frame - from) / (to - from) : 0.0;
        mix(p->root[0], FF_CLEAN_ROOT, knot, t, root);
        mix(p->legs[0][0], 2 * FF_CLEAN_LEG, knot, t, legs);
        ff_clean_pose pose;
        ff_clean_pose_read(motion, frame, &pose);
        ff_clean_pose_change(&pose, root, legs);
        ff_clean_pose_write(&pose, motion, frame);
    }
}

ff_status ff_clean_by_knots(const ff_rig *rig, ff_motion *motion, ff_clean_pins *pins,
                            ff_clean_report *report, ff_error *error)
{
    knots k;
    ff_status status = make_knots(rig, motion, pins, &k, error);
    if (status != FF_OK) return status;
    status = solve_windows(&k.problem, report, error);
    if (status == FF_OK) {
        report->residual = residual_of(&k.problem);
        add_changes(&k, motion);
    }
    knots_free(&k);
    return status;
}
