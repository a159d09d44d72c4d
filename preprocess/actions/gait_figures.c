#include "preprocess/actions/gait_figures.h"

#include "preprocess/base/filter.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

static const double TURN_CUTOFF = 3.0; /* Hz, labels */
static const double TRAVEL_WINDOW =
    0.5; /* s before and after a contact: the way that its step is measured along */

/* The hips over time. */
typedef struct way {
    ff_vec3 *hips; /* m */
    double *yaw;   /* rad, unwrapped, low-passed */
    int count;
} way;

static void read_way(const ff_clip *clip, ff_vec3 *pose, way *w)
{
    int hips = ff_clip_find(clip, FF_ROLE_HIPS);
    int left = ff_clip_find(clip, FF_ROLE_HIP_L), right = ff_clip_find(clip, FF_ROLE_HIP_R);
    if (hips < 0) hips = left;
    for (int i = 0; i < w->count; ++i) {
        ff_clip_pose(clip, clip->rest_frames + i, pose, NULL);
        ff_vec3 across = ff_sub3(pose[left], pose[right]);
        double yaw = ff_atan2(-across.z, across.x);
        w->hips[i] = pose[hips];
        w->yaw[i] = i == 0 ? yaw : w->yaw[i - 1] + ff_wrap(yaw - w->yaw[i - 1]);
    }
    ff_filter_low_pass(w->yaw, w->count, 1, 1.0 / clip->frame_time, TURN_CUTOFF);
}

static void measure_way(const way *w, ff_gait_figures *out)
{
    double path = 0.0;
    for (int i = 1; i < w->count; ++i)
        path += ff_length2(ff_plane(ff_sub3(w->hips[i], w->hips[i - 1])));
    out->speed_path = out->seconds > 0.0 ? path / out->seconds : 0.0;
    ff_vec2 net = ff_plane(ff_sub3(w->hips[w->count - 1], w->hips[0]));
    out->speed_net = out->seconds > 0.0 ? ff_length2(net) / out->seconds : 0.0;
    out->turn = w->yaw[w->count - 1] - w->yaw[0];
}

static void count_contacts(const ff_plants *plants, double frame_time, ff_gait_figures *out)
{
    int last_of[2] = {-1, -1}, strides = 0;
    double stride_sum = 0.0;
    out->first_ic = out->last_ic = -1;
    out->contacts = plants->count;
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *p = &plants->items[i];
        if (p->cut_start) continue;
        ++out->initial_contacts;
        if (out->first_ic < 0) out->first_ic = p->start;
        out->last_ic = p->start;
        if (last_of[p->foot] >= 0) {
            stride_sum += (p->start - last_of[p->foot]) * frame_time;
            ++strides;
        }
        last_of[p->foot] = p->start;
    }
    out->steps = out->initial_contacts > 0 ? out->initial_contacts - 1 : 0;
    if (out->last_ic > out->first_ic)
        out->cadence = 60.0 * out->steps / ((out->last_ic - out->first_ic) * frame_time);
    out->stride_time = strides > 0 ? stride_sum / strides : 0.0;
}

/* Does the clip show where this foot stood? Not when its end cuts the contact before the foot is flat. */
static bool has_place(const ff_plant *p)
{
    return p->flat_start >= 0 || !(p->cut_start || p->cut_end);
}

/* Which way the hips go round a frame of the clip. */
static ff_vec2 travel(const way *w, int frame, int reach)
{
    int from = frame - reach > 0 ? frame - reach : 0,
        to = frame + reach < w->count ? frame + reach : w->count - 1;
    return ff_unit2(ff_plane(ff_sub3(w->hips[to], w->hips[from])));
}

static void measure_steps(const ff_clip *clip, const ff_plants *plants, const way *w, ff_gait_figures *out)
{
    int reach = (int)(TRAVEL_WINDOW / clip->frame_time + 0.5), count = 0;
    double sum = 0.0, squares = 0.0, width = 0.0;
    for (int i = 0; i + 1 < plants->count; ++i) {
        const ff_plant *p = &plants->items[i], *q = &plants->items[i + 1];
        if (p->foot == q->foot || !has_place(p) || !has_place(q)) continue;
        ff_vec2 step = ff_to_frame2(travel(w, (p->start + q->start) / 2 - clip->rest_frames, reach),
                                    ff_sub2(q->ball, p->ball));
        sum += step.a;
        squares += step.a * step.a;
        width += q->foot == FF_LEFT ? step.b : -step.b;
        ++count;
    }
    if (count == 0) return;
    out->step_length = sum / count;
    out->step_width = width / count;
    out->step_length_sd = sqrt(ff_max(0.0, squares / count - out->step_length * out->step_length));
}

ff_status ff_gait_figures_find(const ff_clip *clip, const ff_plants *plants, ff_gait_figures *out,
                               ff_error *error)
{
    memset(out, 0, sizeof *out);
    way w = {.count = clip->frame_count - clip->rest_frames};
    ff_vec3 *pose = ff_calloc((size_t)clip->joint_count, sizeof *pose);
    w.hips = ff_calloc((size_t)w.count, sizeof *w.hips);
    w.yaw = ff_calloc((size_t)w.count, sizeof *w.yaw);
    ff_status status = FF_OK;
    if (!pose || !w.hips || !w.yaw)
        status = ff_fail(error, FF_ERR_NO_MEMORY, "%s: no memory for %d frames", clip->name, w.count);
    else {
        read_way(clip, pose, &w);
        out->seconds = (w.count - 1) * clip->frame_time;
        measure_way(&w, out);
        count_contacts(plants, clip->frame_time, out);
        measure_steps(clip, plants, &w, out);
    }
    free(pose);
    free(w.hips);
    free(w.yaw);
    return status;
}
