#include "preprocess/base/filter.h"
#include "preprocess/report/report_parts.h"
#include "preprocess/report/validate.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/pack/joints.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

#define LOOP_JUMP 0.001 /* m, at the seam of an example (issue 3, bar 6) */
enum { MOMENTS = 12 };

static ff_vec3 ball_at(const ff_pack *pack, const ff_pack_clip *clip, uint32_t foot, double seconds)
{
    ff_vec3 at[FF_PACK_MAX_JOINTS + FF_POINT_COUNT];
    ff_report_pose(pack, clip->stream, seconds - (double)clip->time_offset, at);
    return at[foot ? FF_JOINT_BALL_R : FF_JOINT_BALL_L];
}

/* Furthest that the ball gets from its mean place in the flat stretch, on the ground. */
static double slide_of(const ff_pack *pack, const ff_pack_plant *plant)
{
    const ff_pack_clip *clip = &pack->clips[plant->clip];
    ff_vec2 at[MOMENTS], mean = {0.0, 0.0};
    double from = (double)plant->flat_start, length = (double)plant->flat_end - from, most = 0.0;
    for (int k = 0; k < MOMENTS; ++k) {
        at[k] = ff_plane(ball_at(pack, clip, plant->foot, from + length * k / (MOMENTS - 1)));
        mean = ff_add2(mean, ff_scale2(at[k], 1.0 / MOMENTS));
    }
    for (int k = 0; k < MOMENTS; ++k)
        most = ff_max(most, ff_length2(ff_sub2(at[k], mean)));
    return most;
}

static ff_status check_plants(const ff_pack *pack, ff_valid_own *v, ff_error *error)
{
    double *slides = ff_calloc((size_t)pack->plant_count + 1, sizeof *slides);
    if (!slides) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u plants", pack->plant_count);
    for (uint32_t i = 0; i < pack->plant_count; ++i) {
        const ff_pack_plant *plant = &pack->plants[i];
        if (plant->flat_start < 0.0f || plant->flat_end <= plant->flat_start) continue;
        double slide = slides[v->plants++] = slide_of(pack, plant);
        v->slide_most = ff_max(v->slide_most, slide);
        if (slide <= FF_VALID_SLIDE) continue;
        if (v->sliding++ == 0)
            snprintf(v->first[0], sizeof v->first[0], "%.80s, %s foot, %.2f s: %.1f mm",
                     ff_pack_string(pack, pack->clips[plant->clip].name), plant->foot ? "right" : "left",
                     (double)plant->flat_start, 1e3 * slide);
    }
    if (v->plants > 0) v->slide_median = ff_filter_quantile(slides, (int)v->plants, 0.5);
    free(slides);
    return FF_OK;
}

/* Is the plant's foot down at this time of its clip? */
static bool is_down(const ff_pack *pack, uint32_t index, double seconds)
{
    if (index == UINT32_MAX) return false;
    const ff_pack_plant *plant = &pack->plants[index];
    const ff_pack_clip *clip = &pack->clips[plant->clip];
    double frame = 1.0 / (double)clip->source_rate, rest = 0.0;
    for (int32_t j = FF_JOINT_BALL_L; j >= 0; j = pack->joints[j].parent)
        rest += (double)pack->joints[j].offset[1];
    if (seconds < (double)plant->start - frame || seconds > (double)plant->end + frame) return false;
    return ball_at(pack, clip, plant->foot, seconds).y - (double)plant->level < rest + FF_VALID_RISE;
}

static void check_actions(const ff_pack *pack, ff_valid_own *v)
{
    for (uint32_t i = 0; i < pack->action_count; ++i) {
        const ff_pack_action *a = &pack->actions[i];
        ++v->actions;
        if (is_down(pack, a->support_plant, (double)a->t_0) &&
            is_down(pack, a->swing_plant, (double)a->t_end))
            continue;
        if (v->unplanted++ == 0)
            snprintf(v->first[1], sizeof v->first[1], "action %u of %.80s, %.2f to %.2f s", i,
                     ff_pack_string(pack, pack->clips[a->clip].name), (double)a->t_0, (double)a->t_end);
    }
}

static bool says_cleaned(const ff_pack *pack)
{
    json_error_t place;
    json_t *meta = json_loadb(pack->meta, (size_t)pack->meta_size, 0, &place);
    const json_t *motion = json_object_get(json_object_get(meta, "settings"), "motion");
    bool cleaned = json_is_true(json_object_get(motion, "clean"));
    json_decref(meta);
    return cleaned;
}

ff_status ff_validate_own(const ff_pack *pack, ff_valid_own *out, ff_error *error)
{
    *out = (ff_valid_own){.cleaned = says_cleaned(pack)};
    ff_status status = check_plants(pack, out, error);
    if (status != FF_OK) return status;
    check_actions(pack, out);
    for (uint32_t i = 0; i < pack->loop_count; ++i) {
        ++out->loops;
        out->open_loops += (double)pack->loops[i].jump > LOOP_JUMP;
    }
    return FF_OK;
}
