/* watched.h - a generated clip with the world place of every role in every frame, and what tests measure on it. */
#ifndef FF_TEST_WATCHED_H
#define FF_TEST_WATCHED_H

#include "mocap/generator/generator.h"
#include "mocap/generator/skeleton.h"
#include "tests/check.h"

typedef struct ff_watched {
    ff_generated made;
    int frames;
    ff_vec3 *points; /* [frame][FF_ROLE_COUNT] by role, m */
    ff_quat *turns;  /* the same, world rotations */
    ff_vec3 *heels;  /* [frame][2] */
} ff_watched;

static inline ff_vec3 at(const ff_watched *w, int frame, int role)
{
    return w->points[frame * FF_ROLE_COUNT + role];
}
static inline ff_quat turn_at(const ff_watched *w, int frame, int role)
{
    return w->turns[frame * FF_ROLE_COUNT + role];
}
static inline int ankle_of(int foot)
{
    return foot == 0 ? FF_ROLE_ANKLE_L : FF_ROLE_ANKLE_R;
}

static inline void watch_frame(ff_watched *w, int f)
{
    const ff_clip *clip = &w->made.clip;
    ff_vec3 p[FF_ROLE_COUNT];
    ff_quat q[FF_ROLE_COUNT];
    ff_clip_pose(clip, f, p, q);
    for (int j = 0; j < clip->joint_count; ++j) {
        w->points[f * FF_ROLE_COUNT + clip->joints[j].role] = p[j];
        w->turns[f * FF_ROLE_COUNT + clip->joints[j].role] = q[j];
    }
    const ff_vec3 to_heel = ff_v3(0, FF_BODY_BALL_HEIGHT - FF_BODY_ANKLE_HEIGHT, -FF_BODY_HEEL);
    for (int foot = 0; foot < 2; ++foot)
        w->heels[2 * f + foot] =
            ff_add3(at(w, f, ankle_of(foot)), ff_quat_rotate(turn_at(w, f, ankle_of(foot)), to_heel));
}

static inline void watch(int index, const ff_generator_options *options, ff_watched *out)
{
    ff_error error;
    FF_ASSERT_OK(ff_generator_make(index, options, &out->made, &error), error);
    out->frames = out->made.clip.frame_count;
    size_t count = (size_t)out->frames * FF_ROLE_COUNT;
    out->points = malloc(count * sizeof *out->points);
    out->turns = malloc(count * sizeof *out->turns);
    out->heels = malloc(2 * (size_t)out->frames * sizeof *out->heels);
    assert_non_null(out->points);
    assert_non_null(out->turns);
    assert_non_null(out->heels);
    for (int f = 0; f < out->frames; ++f)
        watch_frame(out, f);
}

static inline void watch_named(const char *name, ff_watched *out)
{
    int index = ff_generator_find(name);
    assert_true(index >= 0);
    watch(index, NULL, out);
}

static inline void unwatch(ff_watched *w)
{
    free(w->points);
    free(w->turns);
    free(w->heels);
    ff_generated_free(&w->made);
}

/* Degrees; negative when the knee bends forward. */
static inline double knee_flexion(const ff_watched *w, int frame, int foot)
{
    int hip = foot == 0 ? FF_ROLE_HIP_L : FF_ROLE_HIP_R;
    ff_vec3 thigh = ff_unit3(ff_sub3(at(w, frame, hip + 1), at(w, frame, hip)));
    ff_vec3 shank = ff_unit3(ff_sub3(at(w, frame, hip + 2), at(w, frame, hip + 1)));
    ff_vec3 hinge = ff_quat_rotate(turn_at(w, frame, hip), ff_v3(1, 0, 0));
    double angle = ff_acos(ff_dot3(thigh, shank)) / FF_DEG;
    return ff_dot3(ff_cross3(thigh, shank), hinge) >= 0.0 ? angle : -angle;
}

static inline int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}
static inline double quantile(double *values, int count, double share)
{
    qsort(values, (size_t)count, sizeof *values, ascending);
    return values[(int)(share * (count - 1))];
}

#endif
