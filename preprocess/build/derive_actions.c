#include "preprocess/build/derive_actions.h"

#include "preprocess/actions/annotate.h"
#include "preprocess/actions/derive_reactive.h"
#include "preprocess/motion/standing.h"
#include "preprocess/plants/plant_edit.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/plan/plan_action.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

typedef enum recipe_kind { STAND, MOVE, START, STOP, REACTIVE } recipe_kind;

/* What may be derived, and which captured action would do instead. */
typedef struct recipe {
    const char *name;
    recipe_kind kind;
    ff_stance_move move;
    double least, most; /* of the captured one: rad of turn, or m of the first foot's way */
    ff_reactive_kind reactive;
} recipe;

#define MADE(name_, kind_, low_, high_, ...)                                                                 \
    {                                                                                                        \
        .name = name_, .kind = kind_, .least = low_, .most = high_, __VA_ARGS__                              \
    }
#define TURN(degrees, low, high)                                                                             \
    MADE("turn left by " #degrees, MOVE, (low)*FF_DEG, (high)*FF_DEG,                                        \
         .move = {0.0, 0.0, (degrees)*FF_DEG, FF_LEFT, 0.36 + 0.002 * (degrees)})
static const recipe recipes[] = {
    MADE("stand", STAND, 0.0, 0.0, .move = {.first = FF_LEFT}),
    MADE("start", START, 0.25, 1.5, .move = {.first = FF_LEFT}),
    MADE("stop", STOP, 0.25, 1.5, .move = {.first = FF_LEFT}),
    TURN(20, 12.0, 32.0),
    TURN(45, 36.0, 60.0),
    TURN(90, 75.0, 110.0),
    MADE("side step left", MOVE, 0.2, 0.6, .move = {0.0, 0.30, 0.0, FF_LEFT, 0.42}),
    MADE("short side step left", MOVE, 0.08, 0.2, .move = {0.0, 0.15, 0.0, FF_LEFT, 0.36}),
    MADE("step back", MOVE, 0.2, 0.7, .move = {-0.30, 0.0, 0.0, FF_LEFT, 0.44}),
    MADE("short step", MOVE, 0.1, 0.32, .move = {0.22, 0.0, 0.0, FF_LEFT, 0.40}),
    MADE("jump", REACTIVE, 0.0, 0.3, .reactive = FF_REACTIVE_JUMP),
    MADE("jump forward", REACTIVE, 0.6, 1.6, .reactive = FF_REACTIVE_OVER),
    MADE("leap", REACTIVE, 0.8, 2.4, .reactive = FF_REACTIVE_LEAP),
    MADE("duck", REACTIVE, 0.0, 0.3, .reactive = FF_REACTIVE_DUCK),
    MADE("duck and stop", REACTIVE, 0.1, 0.9, .reactive = FF_REACTIVE_DIVE),
};
enum { RECIPE_COUNT = sizeof recipes / sizeof recipes[0] };

/* ---------------------------------------------------------------------------------------------------- what is there */

static bool between(double value, double low, double high)
{
    return value >= low && value <= high;
}

/* m: the feet are both so high at once in a jump that is of use, the head so low in a duck. */
static const double FEET_UP = 0.45, HEAD_DOWN = 1.12;
static const double LEAP_LONGEST = 1.2; /* s: captured jumps that take a run-up are no leaps out of a step */

/* Is the captured one of the recipe's kind, between what it asks for at both ends, and high or low enough? */
static bool does_reactive(const ff_action *action, const recipe *what)
{
    const ff_pack_action *r = &action->record;
    bool leap = what->reactive == FF_REACTIVE_LEAP, dive = what->reactive == FF_REACTIVE_DIVE;
    bool duck = dive || what->reactive == FF_REACTIVE_DUCK;
    uint32_t ends = FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING;
    uint32_t wanted = leap ? 0 : (dive ? (uint32_t)FF_ACTION_TO_STANDING : ends);
    double way = ff_length2(ff_v2((double)r->root_displacement[0], (double)r->root_displacement[1]));
    if (r->mode != (duck ? FF_MODE_CROUCH : FF_MODE_JUMP) || (r->flags & ends) != wanted ||
        !between(way, what->least, what->most) || fabs((double)r->theta) > 15.0 * FF_DEG ||
        (leap && ((double)r->speed > 2.0 || (double)r->duration > LEAP_LONGEST)) || !ff_action_is_usable(r))
        return false;
    double high = 0.0, low = INFINITY;
    for (uint32_t k = 0; k < r->collider_samples; ++k) {
        const ff_pack_collider *at = action->colliders[k];
        high = ff_max(high, ff_min((double)at[FF_COLLIDER_FOOT_L].y, (double)at[FF_COLLIDER_FOOT_R].y));
        low = ff_min(low, (double)at[FF_COLLIDER_HEAD].y);
    }
    return duck ? low <= HEAD_DOWN : high >= FEET_UP;
}

/* Would this captured action do for the recipe? */
static bool does(const ff_action *action, const recipe *what)
{
    const ff_pack_action *r = &action->record;
    bool from = (r->flags & FF_ACTION_FROM_STANDING) != 0, to = (r->flags & FF_ACTION_TO_STANDING) != 0;
    double way = ff_length2(ff_v2((double)r->swing_displacement[0], (double)r->swing_displacement[1]));
    double alpha = fabs((double)r->alpha), turn = fabs((double)r->theta);
    bool fits = between(way, what->least, what->most) && turn < 15.0 * FF_DEG;
    switch (what->kind) {
    case STAND:
        return r->mode == FF_MODE_IDLE;
    case START:
        return r->mode == FF_MODE_START && from && fits && alpha < 30.0 * FF_DEG;
    case REACTIVE:
        return does_reactive(action, what);
    case STOP:
        return r->mode == FF_MODE_STOP && to && fits && alpha < 30.0 * FF_DEG;
    default:
        if (what->move.turn != 0.0)
            return r->mode == FF_MODE_TURN && (r->flags & FF_ACTION_WHOLE) &&
                   between(turn, what->least, what->most);
        /* Out of standing, and something that goes back into it is then made along. */
        if (!from || !fits || r->mode == FF_MODE_JUMP || r->mode == FF_MODE_CROUCH) return false;
        if (what->move.left != 0.0) return to && fabs(alpha - 90.0 * FF_DEG) < 30.0 * FF_DEG;
        return to && (what->move.forward < 0.0 ? alpha > 150.0 * FF_DEG : alpha < 30.0 * FF_DEG);
    }
}

static bool is_there(const ff_build_clip *clips, int count, const recipe *what)
{
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < clips[i].actions.count; ++k)
            if (does(&clips[i].actions.items[k], what)) return true;
    return false;
}

/* ------------------------------------------------------------------------------------------------- a clip of its own */

/* The motion as a clip whose skeleton is the rig. */
static ff_status clip_of(const ff_rig *rig, const ff_motion *motion, const char *name, ff_clip *out,
                         ff_error *error)
{
    size_t frames = (size_t)motion->frame_count, joints = FF_ROLE_COUNT, length = strlen(name) + 1;
    *out = (ff_clip){.joint_count = FF_ROLE_COUNT,
                     .track_count = 1,
                     .frame_time = motion->frame_time,
                     .frame_count = motion->frame_count,
                     .unit_m = 1.0};
    out->name = malloc(length);
    out->source = ff_calloc(1, 1);
    out->joints = ff_calloc(joints, sizeof *out->joints);
    out->rotations = ff_calloc(frames * joints, sizeof *out->rotations);
    out->positions = ff_calloc(frames, sizeof *out->positions);
    if (!out->name || !out->source || !out->joints || !out->rotations || !out->positions) {
        ff_clip_free(out);
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d frames of \"%s\"", motion->frame_count,
                       name);
    }
    memcpy(out->name, name, length);
    for (int r = 0; r < FF_ROLE_COUNT; ++r) {
        ff_joint *joint = &out->joints[r];
        snprintf(joint->name, sizeof joint->name, "%s", ff_role_name((ff_role)r));
        joint->parent = (int)ff_role_parent((ff_role)r);
        joint->offset = rig->offset[r];
        joint->track = r == FF_ROLE_HIPS ? 0 : -1;
        joint->role = (ff_role)r;
        joint->end_site = r >= FF_ROLE_JOINT_COUNT;
    }
    for (size_t k = 0; k < frames; ++k) {
        ff_quat *to = out->rotations + k * joints;
        ff_vec3 root = motion->root[k], hips = motion->hips[k];
        for (size_t r = 0; r < joints; ++r)
            to[r] =
                r < FF_ROLE_JOINT_COUNT ? motion->rotations[k * FF_ROLE_JOINT_COUNT + r] : FF_QUAT_IDENTITY;
        to[0] = ff_quat_mul(ff_quat_yaw(root.z), to[0]);
        ff_vec2 at = ff_add2(ff_v2(root.x, root.y), ff_from_frame2(ff_fwd2(root.z), ff_v2(hips.x, hips.y)));
        out->positions[k] = ff_ground(at, hips.z);
    }
    return FF_OK;
}

/* Of what was cut only that which was asked for: the steps of the walk that a start leads to are captured anyway. */
static void keep_wanted(ff_actions *actions, recipe_kind kind)
{
    int kept = 0;
    for (int i = 0; i < actions->count; ++i) {
        ff_action *a = &actions->items[i];
        uint32_t ends = FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING;
        bool wanted = kind == REACTIVE ? true
                      : kind == STAND  ? a->record.mode == FF_MODE_IDLE
                                       : a->record.mode != FF_MODE_IDLE && (a->record.flags & ends);
        if (!wanted) continue;
        a->record.flags |= FF_ACTION_DERIVED;
        actions->items[kept++] = *a;
    }
    actions->count = kept;
    free(actions->rejections);
    actions->rejections = NULL;
    actions->rejection_count = 0;
}

static ff_status derive_motion(const ff_derive_base *base, const recipe *what, ff_motion *out,
                               ff_reactive_times *times, ff_error *error)
{
    memset(times, 0, sizeof *times);
    switch (what->kind) {
    case STAND:
        return ff_derive_stand(base, out, error);
    case START:
        return ff_derive_start(base, out, error);
    case STOP:
        return ff_derive_stop(base, false, out, error);
    case REACTIVE:
        return ff_derive_reactive(base, what->reactive, out, times, error);
    default:
        return ff_derive_stance_move(base, &what->move, out, error);
    }
}

/* When the feet of a move stand. */
static void times_of_move(const ff_stance_move *move, ff_reactive_times *out)
{
    double leaves[2], lands[2];
    ff_stance_times(move, leaves, lands);
    for (int i = 0; i < 2; ++i) {
        int foot = i ? 1 - move->first : move->first;
        out->plant[2 * i].foot = out->plant[2 * i + 1].foot = foot;
        out->plant[2 * i].to = leaves[i];
        out->plant[2 * i + 1].from = lands[i];
        out->plant[2 * i + 1].to = INFINITY;
    }
    out->plant_count = 4;
}

/* Small steps on the spot, and jumps, are hard to find: their times are known. */
static ff_status known_plants(const ff_find_settings *find, const ff_reactive_times *times,
                              const ff_clip *clip, ff_plants *out, ff_error *error)
{
    ff_plant_edit known[FF_REACTIVE_PLANTS];
    for (int i = 0; i < times->plant_count; ++i) {
        double last = times->plant[i].to / clip->frame_time;
        known[i] = (ff_plant_edit){.kind = FF_EDIT_ADD,
                                   .foot = times->plant[i].foot,
                                   .start = (int)ceil(times->plant[i].from / clip->frame_time),
                                   .end = last < clip->frame_count - 1 ? (int)last : clip->frame_count - 1,
                                   .flat_start = FF_EDIT_LEAVE,
                                   .flat_end = FF_EDIT_LEAVE};
    }
    ff_plant_edits edits = {.items = known, .count = times->plant_count, .all = true};
    ff_status status = ff_plants_find_edited(clip, find, &edits, out, error);
    for (int i = 0; status == FF_OK && i < out->count; ++i)
        out->items[i].written = false;
    out->found_count = 0; /* nobody needs to see what was found without knowing */
    return status;
}

/* The one action of a motion whose times are known. */
static ff_status cut_reactive(const ff_cut_settings *cut, const ff_rig *rig, const ff_motion *motion,
                              const ff_plants *plants, const ff_reactive_times *times, ff_actions *out,
                              ff_error *error)
{
    int swing = 1 - times->support;
    ff_step_span span = {.first = (int)(times->first / motion->frame_time + 0.5),
                         .last = (int)(times->last / motion->frame_time + 0.5),
                         .mode = times->mode,
                         .flags = times->flags};
    span.support = ff_plant_at(plants, times->support, span.first);
    span.swing = ff_plant_at(plants, swing, span.last);
    span.swing_from = ff_plant_at(plants, swing, span.first);
    memset(out, 0, sizeof *out);
    if (span.support < 0 || span.swing < 0)
        return ff_fail(error, FF_ERR_NO_DATA, "no foot stands at the ends of a derived action");
    out->items = ff_calloc(1, sizeof *out->items);
    if (!out->items) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a derived action");
    out->count = 1;
    ff_action_annotate(cut, rig, motion, plants, &span, out->items);
    return FF_OK;
}

/* Plants and actions of the motion. */
static ff_status cut_motion(const ff_build_shared *shared, const recipe *what, ff_reactive_times *times,
                            ff_build_clip *out, ff_error *error)
{
    const ff_settings *settings = shared->settings;
    if (what->kind == MOVE) times_of_move(&what->move, times);
    ff_status status = what->kind == MOVE || what->kind == REACTIVE
                           ? known_plants(&settings->find, times, &out->clip, &out->plants, error)
                           : ff_plants_find(&out->clip, &settings->find, &out->plants, error);
    if (status != FF_OK) return status;
    if (what->kind == REACTIVE)
        return cut_reactive(&settings->cut, shared->rig, &out->motion, &out->plants, times, &out->actions,
                            error);
    return ff_actions_cut(&settings->cut, shared->rig, &out->motion, &out->plants, -1, &out->actions, error);
}

static ff_status derive_clip(const ff_derive_base *base, const ff_build_shared *shared,
                             const ff_build_clip *from, const recipe *what, ff_build_clip *out,
                             ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->derived = true;
    out->licence = from->licence;
    out->citation = from->citation;
    out->tags = "derived";
    out->mode = "";
    out->mirror = true;
    out->subject = from->subject;
    size_t length = strlen(from->source) + 1;
    out->source = malloc(length);
    if (!out->source) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for \"%s\"", what->name);
    memcpy(out->source, from->source, length);
    ff_reactive_times times;
    ff_status status = derive_motion(base, what, &out->motion, &times, error);
    if (status == FF_OK) status = clip_of(base->rig, &out->motion, what->name, &out->clip, error);
    if (status == FF_OK) status = cut_motion(shared, what, &times, out, error);
    if (status == FF_OK) {
        status = ff_build_clip_store(out, shared);
        if (status != FF_OK) *error = out->error;
    }
    if (status != FF_OK) {
        ff_build_clip_free(out);
        return status;
    }
    out->frames = out->clip.frame_count;
    size_t poses = (size_t)out->frames * FF_ROLE_COUNT;
    out->hash = XXH64(out->clip.rotations, poses * sizeof *out->clip.rotations, 0);
    keep_wanted(&out->actions, what->kind);
    return FF_OK;
}

/* ------------------------------------------------------------------------------------------------------------ all */

/* Standing, and the straight walk nearest to a moderate one; captured ones first. */
static bool choose_base(const ff_example_set *set, ff_derive_base *base)
{
    double best = 1e9;
    for (int i = 0; i < set->count; ++i) {
        const ff_pack_example *r = &set->items[i].record;
        if ((r->flags & FF_EXAMPLE_IDLE) && !base->stand) base->stand = &set->items[i];
        bool straight =
            r->gait == FF_GAIT_WALK && r->v_left == 0.0f && r->turn_rate == 0.0f && r->v_forward > 0.5f;
        if (!straight || (r->flags & (FF_EXAMPLE_IDLE | FF_EXAMPLE_MIRRORED))) continue;
        double off =
            fabs((double)r->v_forward - base->settings->walk) + (r->flags & FF_EXAMPLE_DERIVED ? 1.0 : 0.0);
        if (off < best) {
            best = off;
            base->walk = &set->items[i];
        }
    }
    return base->stand && base->walk;
}

ff_status ff_derive_actions(const ff_build_shared *shared, const ff_example_set *set,
                            const ff_build_clip *clips, int count, ff_build_clip **out, int *out_count,
                            ff_error *error)
{
    *out = NULL;
    *out_count = 0;
    ff_derive_base base = {.rig = shared->rig, .settings = &shared->settings->actions};
    if (!choose_base(set, &base) || base.walk->clip < 0 || base.walk->clip >= count) return FF_OK;
    ff_build_clip *made = ff_calloc(RECIPE_COUNT, sizeof *made);
    if (!made) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for derived actions");
    int n = 0;
    ff_status status = FF_OK;
    for (int i = 0; i < RECIPE_COUNT && status == FF_OK; ++i) {
        if (is_there(clips, count, &recipes[i])) continue;
        status = derive_clip(&base, shared, &clips[base.walk->clip], &recipes[i], &made[n], error);
        if (status == FF_OK) ++n;
    }
    if (status != FF_OK) {
        for (int i = 0; i < n; ++i)
            ff_build_clip_free(&made[i]);
        free(made);
        return status;
    }
    *out = made;
    *out_count = n;
    return FF_OK;
}
