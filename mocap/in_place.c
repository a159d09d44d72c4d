/* Animations for games often walk on the spot: the game moves the character, and the planted feet slide backward under
 * it. What the feet slide is what the body should have travelled. */
#include "mocap/read.h"
#include "mocap/roles_find.h"
#include "mocap/text.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* All lengths in legs, so that children, giants and toys are judged alike. */
#define STAYS 0.15         /* a body whose hips end up this near to where they were did not travel */
#define WANDERS 0.6        /* nor did it when they never were farther off */
#define DOWN 0.06          /* a foot less than this over its lowest is down */
#define SLOWEST 0.2        /* legs per second: feet that slide slower stand */
#define UNEVEN 0.5         /* most that the middle half of the sliding speeds may differ from their median */
#define SMOOTHING 0.07     /* s to either side that speeds are averaged over */
#define CLOSES 0.08        /* mean distance of the joints of the last pose from the first that make a cycle */
#define ENOUGH_SECONDS 4.0 /* a cycle is repeated until it lasts so long */
enum { MOST_REPEATS = 8 };

typedef struct travel {
    ff_clip *clip;
    int hips;
    int feet[2][2]; /* ankle and toe (or ankle twice) of the left and right foot */
    double leg;
    ff_vec3 *at;    /* [frames][4] of those four points */
    double *low;    /* [frames][2] lowest of the two points of a foot, over the lowest in the clip */
    ff_vec2 *speed; /* [frames] of the body that the feet on the ground ask for, m/s */
    bool *known;    /* [frames] a foot was down */
    ff_vec2 mean;
} travel;

static int either(int a, int b)
{
    return a >= 0 ? a : b;
}

static bool find_feet(travel *t)
{
    static const ff_role ankles[2] = {FF_ROLE_ANKLE_L, FF_ROLE_ANKLE_R},
                         balls[2] = {FF_ROLE_BALL_L, FF_ROLE_BALL_R};
    static const ff_role knees[2] = {FF_ROLE_KNEE_L, FF_ROLE_KNEE_R},
                         hips[2] = {FF_ROLE_HIP_L, FF_ROLE_HIP_R};
    const ff_clip *clip = t->clip;
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_clip_pose(clip, 0, at, NULL);
    t->hips = ff_clip_find(clip, FF_ROLE_HIPS);
    for (int f = 0; f < 2; ++f) {
        int ankle = ff_clip_find(clip, ankles[f]), knee = ff_clip_find(clip, knees[f]),
            hip = ff_clip_find(clip, hips[f]);
        if (ankle < 0 || knee < 0 || hip < 0) return false;
        t->feet[f][0] = ankle;
        t->feet[f][1] = either(ff_clip_find(clip, balls[f]), ankle);
        t->leg += 0.5 * (ff_length3(ff_sub3(at[hip], at[knee])) + ff_length3(ff_sub3(at[knee], at[ankle])));
    }
    return t->hips >= 0 && t->leg > 0.0;
}

/* Points of the feet in every frame; false when the hips travel by themselves. */
static bool follow_feet(travel *t)
{
    const ff_clip *clip = t->clip;
    ff_vec3 at[FF_CLIP_MAX_JOINTS], first = {0}, last = {0};
    double lowest[2] = {HUGE_VAL, HUGE_VAL}, farthest = 0.0;
    for (int k = 0; k < clip->frame_count; ++k) {
        ff_clip_pose(clip, k, at, NULL);
        last = at[t->hips];
        if (k == 0) first = last;
        farthest = ff_max(farthest, ff_length2(ff_plane(ff_sub3(last, first))));
        for (int i = 0; i < 4; ++i)
            t->at[4 * k + i] = at[t->feet[i / 2][i % 2]];
        for (int f = 0; f < 2; ++f) {
            t->low[2 * k + f] = t->at[4 * k + 2 * f].y + t->at[4 * k + 2 * f + 1].y;
            lowest[f] = ff_min(lowest[f], t->low[2 * k + f]);
        }
    }
    for (int i = 0; i < 2 * clip->frame_count; ++i)
        t->low[i] = 0.5 * (t->low[i] - lowest[i % 2]);
    return ff_length2(ff_plane(ff_sub3(last, first))) < STAYS * t->leg && farthest < WANDERS * t->leg;
}

/* Minus the speed of the foot that is down from this frame to the next: of two, the lower one. */
static void measure_speeds(travel *t)
{
    const ff_clip *clip = t->clip;
    for (int k = 0; k + 1 < clip->frame_count; ++k) {
        const double *low = t->low + 2 * k;
        int f = low[0] <= low[1] ? 0 : 1;
        if (low[f] > DOWN * t->leg || t->low[2 * (k + 1) + f] > DOWN * t->leg) continue;
        /* The point of the foot that carries it: the lower one. */
        int point = 4 * k + 2 * f + (t->at[4 * k + 2 * f + 1].y <= t->at[4 * k + 2 * f].y ? 1 : 0);
        ff_vec2 moved = ff_plane(ff_sub3(t->at[point + 4], t->at[point]));
        t->speed[k] = ff_scale2(moved, -1.0 / clip->frame_time);
        t->known[k] = true;
    }
}

static int ascending(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* The middle of the speeds along an axis, and how far the middle half of them is spread. */
static double middle(const travel *t, bool along_b, double *sorted, double *spread)
{
    int n = 0;
    for (int k = 0; k < t->clip->frame_count; ++k)
        if (t->known[k]) sorted[n++] = along_b ? t->speed[k].b : t->speed[k].a;
    if (n == 0) return 0.0;
    qsort(sorted, (size_t)n, sizeof *sorted, ascending);
    *spread = 0.5 * (sorted[(3 * n) / 4 < n ? (3 * n) / 4 : n - 1] - sorted[n / 4]);
    return sorted[n / 2];
}

/* Do the feet that are down, both of them, slide one way at one speed? (In a run they are down in one frame of eight.) */
static bool slides(travel *t, double *sorted)
{
    enum { FEWEST = 2 };
    int frames[2] = {0, 0};
    for (int k = 0; k < t->clip->frame_count; ++k)
        if (t->known[k]) frames[t->low[2 * k] <= t->low[2 * k + 1] ? 0 : 1]++;
    double spread_a = 0.0, spread_b = 0.0;
    t->mean.a = middle(t, false, sorted, &spread_a);
    t->mean.b = middle(t, true, sorted, &spread_b);
    double speed = ff_length2(t->mean), spread = ff_length2(ff_v2(spread_a, spread_b));
    return frames[0] >= FEWEST && frames[1] >= FEWEST &&
           10 * (frames[0] + frames[1]) >= t->clip->frame_count && speed > SLOWEST * t->leg &&
           spread < UNEVEN * speed;
}

/* Speeds near the middle one are taken as they are, so that feet stand; others (toes that swing off, flight) are the
 * middle one. Then a moving average, going round when the animation is a cycle. */
static void smooth_speeds(travel *t, bool cycle, ff_vec2 *smooth)
{
    int intervals = t->clip->frame_count - 1, half = (int)(SMOOTHING / t->clip->frame_time + 0.5);
    if (half > intervals / 2) half = intervals / 2;
    double most = UNEVEN * ff_length2(t->mean);
    for (int k = 0; k < intervals; ++k)
        if (!t->known[k] || ff_length2(ff_sub2(t->speed[k], t->mean)) > most) t->speed[k] = t->mean;
    for (int k = 0; k < intervals; ++k) {
        ff_vec2 sum = {0.0, 0.0};
        for (int d = -half; d <= half; ++d) {
            int i = k + d;
            i = cycle ? (i + intervals) % intervals : (i < 0 ? 0 : (i >= intervals ? intervals - 1 : i));
            sum = ff_add2(sum, t->speed[i]);
        }
        smooth[k] = ff_scale2(sum, 1.0 / (2 * half + 1));
    }
}

static bool closes(const travel *t)
{
    const ff_clip *clip = t->clip;
    ff_vec3 first[FF_CLIP_MAX_JOINTS], last[FF_CLIP_MAX_JOINTS];
    ff_clip_pose(clip, 0, first, NULL);
    ff_clip_pose(clip, clip->frame_count - 1, last, NULL);
    double sum = 0.0;
    int n = 0;
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        int j = ff_clip_find(clip, (ff_role)r);
        if (j < 0) continue;
        sum += ff_length3(ff_sub3(first[j], last[j]));
        ++n;
    }
    return n > 0 && sum < CLOSES * t->leg * n;
}

/* Room for the poses of all repeats; the last frame of one is the first of the next. */
static ff_status repeat(ff_clip *clip, int times, ff_error *error)
{
    int cycle = clip->frame_count - 1, capacity = clip->frame_count;
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count;
    ff_status status = ff_clip_reserve(clip, &capacity, cycle * times + 1, cycle * times + 1, error);
    if (status != FF_OK) return status;
    for (size_t k = (size_t)clip->frame_count; k <= (size_t)cycle * (size_t)times; ++k) {
        size_t from = k % (size_t)cycle;
        memcpy(clip->rotations + k * joints, clip->rotations + from * joints, joints * sizeof(ff_quat));
        memcpy(clip->positions + k * tracks, clip->positions + from * tracks, tracks * sizeof(ff_vec3));
    }
    clip->frame_count = cycle * times + 1;
    return FF_OK;
}

static void move_roots(ff_clip *clip, const ff_vec2 *speed, int cycle)
{
    ff_vec2 moved = {0.0, 0.0};
    for (int k = 0; k < clip->frame_count; ++k) {
        for (int j = 0; j < clip->joint_count; ++j) {
            if (clip->joints[j].parent >= 0) continue;
            ff_vec3 *p =
                &clip->positions[(size_t)k * (size_t)clip->track_count + (size_t)clip->joints[j].track];
            *p = ff_add3(*p, ff_ground(moved, 0.0));
        }
        moved = ff_madd2(moved, speed[k % cycle], clip->frame_time);
    }
}

static ff_status restore(travel *t, bool strict, double *sorted, ff_vec2 *smooth, ff_error *error)
{
    ff_clip *clip = t->clip;
    if (!find_feet(t) || !follow_feet(t)) return FF_OK;
    measure_speeds(t);
    if (!slides(t, sorted)) return FF_OK;
    char message[160];
    int cycle = clip->frame_count - 1, times = 1;
    bool closed = closes(t);
    if (closed) times = (int)ceil(ENOUGH_SECONDS / (cycle * clip->frame_time));
    if (times > MOST_REPEATS) times = MOST_REPEATS;
    if (times < 1) times = 1;
    snprintf(message, sizeof message,
             "walks on the spot: moved at %.2f m/s so that its feet stand, and repeated %d times",
             ff_length2(t->mean), times);
    if (times == 1) *strstr(message, ", and repeated") = '\0';
    if (strict) return ff_fail(error, FF_ERR_NO_DATA, "%s; \"in_place\": true leaves it there", message);
    ff_clip_warn(clip, "%s", message);
    clip->drawn = true;
    smooth_speeds(t, closed, smooth);
    ff_status status = times > 1 ? repeat(clip, times, error) : FF_OK;
    if (status == FF_OK) move_roots(clip, smooth, cycle);
    return status;
}

ff_status ff_clip_restore_travel(ff_clip *clip, bool strict, ff_error *error)
{
    enum { FEWEST = 8 }; /* frames */
    if (clip->frame_count < FEWEST) return FF_OK;
    for (int j = 0; j < clip->joint_count; ++j)
        if (clip->joints[j].parent < 0 && clip->joints[j].track < 0) return FF_OK;
    size_t n = (size_t)clip->frame_count;
    travel t = {.clip = clip};
    t.at = ff_calloc(4 * n, sizeof *t.at);
    t.low = ff_calloc(2 * n, sizeof *t.low);
    t.speed = ff_calloc(n, sizeof *t.speed);
    t.known = ff_calloc(n, sizeof *t.known);
    double *sorted = ff_calloc(n, sizeof *sorted);
    ff_vec2 *smooth = ff_calloc(n, sizeof *smooth);
    ff_status status = FF_OK;
    if (t.at && t.low && t.speed && t.known && sorted && smooth) {
        status = restore(&t, strict, sorted, smooth, error);
    } else {
        status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu frames", n);
    }
    free(t.at);
    free(t.low);
    free(t.speed);
    free(t.known);
    free(sorted);
    free(smooth);
    return status;
}
