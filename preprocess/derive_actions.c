#include "preprocess/derive_actions.h"

#include "preprocess/derive_motion.h"
#include "preprocess/plant_edit.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

typedef enum recipe_kind { STAND, MOVE, START, STOP } recipe_kind;

/* What may be derived, and which captured action would do instead. */
typedef struct recipe {
    const char *name;
    recipe_kind kind;
    ff_stance_move move;
    double least, most; /* of the captured one: rad of turn, or m of the first foot's way */
} recipe;

#define TURN(degrees, low, high)                                                                             \
    {                                                                                                        \
        "turn left by " #degrees, MOVE, {0.0, 0.0, (degrees)*FF_DEG, FF_LEFT, 0.36 + 0.002 * (degrees)},     \
            (low)*FF_DEG, (high)*FF_DEG                                                                      \
    }
static const recipe recipes[] = {
    {"stand", STAND, {0.0, 0.0, 0.0, FF_LEFT, 0.0}, 0.0, 0.0},
    {"start", START, {0.0, 0.0, 0.0, FF_LEFT, 0.0}, 0.25, 1.5},
    {"stop", STOP, {0.0, 0.0, 0.0, FF_LEFT, 0.0}, 0.25, 1.5},
    TURN(20, 12.0, 32.0),
    TURN(45, 36.0, 60.0),
    TURN(90, 75.0, 110.0),
    {"side step left", MOVE, {0.0, 0.30, 0.0, FF_LEFT, 0.42}, 0.2, 0.6},
    {"short side step left", MOVE, {0.0, 0.15, 0.0, FF_LEFT, 0.36}, 0.08, 0.2},
    {"step back", MOVE, {-0.30, 0.0, 0.0, FF_LEFT, 0.44}, 0.2, 0.7},
    {"short step", MOVE, {0.22, 0.0, 0.0, FF_LEFT, 0.40}, 0.1, 0.32},
};
enum { RECIPE_COUNT = sizeof recipes / sizeof recipes[0] };

/* ---------------------------------------------------------------------------------------------------- what is there */

static bool between(double value, double low, double high)
{
    return value >= low && value <= high;
}

/* Would this captured action do for the recipe? */
static bool does(const ff_pack_action *r, const recipe *what)
{
    bool from = (r->flags & FF_ACTION_FROM_STANDING) != 0, to = (r->flags & FF_ACTION_TO_STANDING) != 0;
    double way = ff_length2(ff_v2((double)r->swing_displacement[0], (double)r->swing_displacement[1]));
    double alpha = fabs((double)r->alpha), turn = fabs((double)r->theta);
    bool fits = between(way, what->least, what->most) && turn < 15.0 * FF_DEG;
    switch (what->kind) {
    case STAND:
        return r->mode == FF_MODE_IDLE;
    case START:
        return r->mode == FF_MODE_START && from && fits && alpha < 30.0 * FF_DEG;
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
            if (does(&clips[i].actions.items[k].record, what)) return true;
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
        bool wanted = kind == STAND ? a->record.mode == FF_MODE_IDLE
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
                               ff_error *error)
{
    switch (what->kind) {
    case STAND:
        return ff_derive_stand(base, out, error);
    case START:
        return ff_derive_start(base, out, error);
    case STOP:
        return ff_derive_stop(base, out, error);
    default:
        return ff_derive_stance_move(base, &what->move, out, error);
    }
}

/* Small steps on the spot are hard to find: their times are known. */
static ff_status known_plants(const ff_find_settings *find, const recipe *what, const ff_clip *clip,
                              ff_plants *out, ff_error *error)
{
    double leaves[2], lands[2];
    ff_stance_times(&what->move, leaves, lands);
    ff_plant_edit known[4];
    for (int i = 0; i < 2; ++i) {
        ff_plant_edit edit = {.kind = FF_EDIT_ADD,
                              .foot = i ? 1 - what->move.first : what->move.first,
                              .start = 0,
                              .end = (int)(leaves[i] / clip->frame_time),
                              .flat_start = FF_EDIT_LEAVE,
                              .flat_end = FF_EDIT_LEAVE};
        known[2 * i] = edit;
        edit.start = (int)ceil(lands[i] / clip->frame_time);
        edit.end = clip->frame_count - 1;
        known[2 * i + 1] = edit;
    }
    ff_plant_edits edits = {.items = known, .count = 4, .all = true};
    ff_status status = ff_plants_find_edited(clip, find, &edits, out, error);
    for (int i = 0; status == FF_OK && i < out->count; ++i)
        out->items[i].written = false;
    out->found_count = 0; /* nobody needs to see what was found without knowing */
    return status;
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
    ff_status status = derive_motion(base, what, &out->motion, error);
    if (status == FF_OK) status = clip_of(base->rig, &out->motion, what->name, &out->clip, error);
    if (status == FF_OK)
        status = what->kind == MOVE
                     ? known_plants(&shared->settings->find, what, &out->clip, &out->plants, error)
                     : ff_plants_find(&out->clip, &shared->settings->find, &out->plants, error);
    if (status == FF_OK)
        status = ff_actions_cut(&shared->settings->cut, base->rig, &out->motion, &out->plants, -1,
                                &out->actions, error);
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
