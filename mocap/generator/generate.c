#include "mocap/generator/capture.h"
#include "mocap/generator/feet.h"
#include "mocap/generator/gait_data.h"
#include "mocap/generator/generator.h"
#include "mocap/generator/pose.h"
#include "mocap/generator/recipes.h"
#include "mocap/generator/skeleton.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define FPS 120.0
#define TINY 1e-7 /* frames: contacts fall on whole frames up to rounding */

int ff_generator_count(void)
{
    return ff_recipe_count;
}

ff_generator_info ff_generator_describe(int index)
{
    return ff_recipes[index].info;
}

int ff_generator_find(const char *name)
{
    for (int i = 0; i < ff_recipe_count; ++i)
        if (strcmp(ff_recipes[i].info.name, name) == 0) return i;
    return -1;
}

int ff_generator_people(void)
{
    return FF_PEOPLE + 1;
}

void ff_generated_free(ff_generated *generated)
{
    ff_clip_free(&generated->clip);
    free(generated->plants);
    memset(generated, 0, sizeof *generated);
}

/* ------------------------------------------------------------------------------------------------- plants */

static int first_frame_from(double t)
{
    return (int)ceil(ff_clamp(t, -1e3, 1e6) * FPS - TINY);
}
static int last_frame_until(double t)
{
    return (int)floor(ff_clamp(t, -1e3, 1e6) * FPS + TINY);
}

/* Cut a stretch of frames to the clip; -1, -1 when it lies outside. */
static void cut(int *first, int *last, int frame_count)
{
    if (*last < 0 || *first >= frame_count || *last < *first) {
        *first = *last = -1;
        return;
    }
    if (*first < 0) *first = 0;
    if (*last >= frame_count) *last = frame_count - 1;
}

/* The part of a footing that lies in the clip; false when none does. */
static bool true_plant(const ff_footing *footing, int foot, int frame_count, ff_true_plant *out)
{
    *out = (ff_true_plant){.foot = foot,
                           .start = first_frame_from(footing->contact),
                           .end = last_frame_until(footing->toe_off),
                           .flat_start = first_frame_from(footing->flat),
                           .flat_end = last_frame_until(footing->heel_off),
                           .ball_end = last_frame_until(footing->release),
                           .ball = ff_ground(footing->ball, FF_BODY_BALL_HEIGHT),
                           .yaw = footing->yaw};
    out->ball_start = footing->pitch_contact < 0.0 ? out->start : out->flat_start;
    out->cut_start = out->start < 0;
    out->cut_end = out->end >= frame_count;
    cut(&out->start, &out->end, frame_count);
    cut(&out->flat_start, &out->flat_end, frame_count);
    cut(&out->ball_start, &out->ball_end, frame_count);
    return out->start >= 0;
}

static int by_start(const void *a, const void *b)
{
    const ff_true_plant *p = a, *q = b;
    if (p->start != q->start) return p->start < q->start ? -1 : 1;
    if (p->end != q->end) return p->end < q->end ? -1 : 1;
    return p->foot - q->foot;
}

/* Played backward, a foot lands on its ball while the toes already touch, and leaves with the toes up: each event is
 * put inside its roll. */
static ff_footing backward(const ff_footing *footing)
{
    ff_footing copy = *footing;
    copy.contact = ff_lerp(footing->contact, footing->flat, 0.4);
    copy.toe_off = ff_lerp(footing->release, footing->toe_off, 0.75);
    return copy;
}

static bool collect_plants(const ff_plan *plan, int frame_count, bool reversed, ff_generated *out)
{
    out->plants = ff_calloc((size_t)plan->contact_count + 1, sizeof *out->plants);
    if (!out->plants) return false;
    for (int foot = 0; foot < 2; ++foot)
        for (int i = 0; i < plan->footing_count[foot]; ++i) {
            const ff_footing *footing = &plan->footings[foot][i];
            ff_footing played = reversed ? backward(footing) : *footing;
            if (true_plant(&played, foot, frame_count, &out->plants[out->plant_count])) ++out->plant_count;
        }
    qsort(out->plants, (size_t)out->plant_count, sizeof *out->plants, by_start);
    return true;
}

/* -------------------------------------------------------------------------------------------------- clips */

static void swap_ends(int *first, int *last, int frame_count)
{
    if (*first < 0) return;
    int was = *first;
    *first = frame_count - 1 - *last;
    *last = frame_count - 1 - was;
}

/* Play everything from the last frame to the first. */
static void reverse(ff_generated *g)
{
    int n = g->clip.frame_count, joints = g->clip.joint_count;
    for (int a = 0, b = n - 1; a < b; ++a, --b) {
        ff_vec3 p = g->clip.positions[a];
        g->clip.positions[a] = g->clip.positions[b];
        g->clip.positions[b] = p;
        ff_quat *qa = g->clip.rotations + (size_t)a * (size_t)joints;
        ff_quat *qb = g->clip.rotations + (size_t)b * (size_t)joints;
        for (int j = 0; j < joints; ++j) {
            ff_quat q = qa[j];
            qa[j] = qb[j];
            qb[j] = q;
        }
    }
    for (int i = 0; i < g->plant_count; ++i) {
        ff_true_plant *p = &g->plants[i];
        swap_ends(&p->start, &p->end, n);
        swap_ends(&p->flat_start, &p->flat_end, n);
        swap_ends(&p->ball_start, &p->ball_end, n);
        bool cut_start = p->cut_start;
        p->cut_start = p->cut_end;
        p->cut_end = cut_start;
    }
    qsort(g->plants, (size_t)g->plant_count, sizeof *g->plants, by_start);
}

/* Written so that nan is refused. */
static ff_status check_options(const ff_generator_options *o, ff_error *error)
{
    int people = ff_generator_people();
    if (o->person < 0 || o->person >= people)
        return ff_fail(error, FF_ERR_ARGUMENT, "person %d: choose 0 to %d", o->person, people - 1);
    if (!(o->noise_mm >= 0.0 && o->noise_mm <= 1000.0 && o->skate_cm >= 0.0 && o->skate_cm <= 1000.0))
        return ff_fail(error, FF_ERR_ARGUMENT, "noise %g mm or skate %g cm: expected 0 to 1000", o->noise_mm,
                       o->skate_cm);
    if (!(fabs(o->floor_cm) <= 1e4 && fabs(o->tilt_deg) <= 45.0))
        return ff_fail(error, FF_ERR_ARGUMENT, "floor %g cm or tilt %g degrees: expected at most 1e4 and 45",
                       o->floor_cm, o->tilt_deg);
    if (!(o->missing >= 0.0 && o->missing < 0.9))
        return ff_fail(error, FF_ERR_ARGUMENT, "missing %g: expected 0 to 0.9", o->missing);
    return FF_OK;
}

ff_status ff_generator_make(int index, const ff_generator_options *options, ff_generated *out,
                            ff_error *error)
{
    static const ff_generator_options plain = {0};
    memset(out, 0, sizeof *out);
    if (!options) options = &plain;
    if (index < 0 || index >= ff_recipe_count)
        return ff_fail(error, FF_ERR_ARGUMENT, "built-in clip %d: there are %d", index, ff_recipe_count);
    ff_status status = check_options(options, error);
    if (status != FF_OK) return status;
    const ff_recipe *recipe = &ff_recipes[index];
    ff_plan *plan = ff_calloc(1, sizeof *plan);
    if (!plan) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the plan of %s", recipe->info.name);
    plan->style = recipe->style;
    plan->style.person = options->person;
    plan->style.backward = recipe->reversed;
    plan->style.seed = options->seed;
    int frames = recipe->plan(recipe, plan);
    plan->style.side = plan->contacts[0].foot == 0 ? 1.0 : -1.0;
    status = ff_body_clip(recipe->info.name, frames, &out->clip, error);
    if (status == FF_OK) {
        bool done = ff_plan_finish(plan);
        if (done && recipe->adjust) recipe->adjust(plan);
        if (done) ff_feet_clear(plan);
        done = done && ff_pose_clip(plan, &out->clip) && collect_plants(plan, frames, recipe->reversed, out);
        if (!done) status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the clip %s", recipe->info.name);
    }
    ff_plan_free(plan);
    free(plan);
    if (status == FF_OK && recipe->reversed) reverse(out);
    if (status == FF_OK) ff_capture_spoil(options, (uint64_t)index, out);
    if (status != FF_OK) ff_generated_free(out);
    return status;
}
