#include "runtime/core/play/play_set.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/gait/leg_pose.h"

#include <stdlib.h>

#define STILL 0.004    /* m, that a ball may be off its place on the ground ... */
#define STILL_UP 0.02  /* ... and over its height there (it rises as the toes bend) */
#define SLIDE 0.02     /* m: so near to its place, with the ball no higher ... */
#define BALL_UP 0.0035 /* ... than this, ... */
#define HEEL_UP 0.012  /* ... and the heel than this, a foot has arrived: what it still slides is taken out */
#define SOONER 0.1     /* s, by which that may be before the contact in the clip's signals */
#define TIPTOE 0.04    /* m: so high a heel is not meant to lie down */
#define SHORTEST 0.05  /* s: what is still for less as an action begins is leaving already */
#define LOOK (1.0 / 120.0) /* s between two looks */

double ff_play_foot_yaw(ff_quat rotation)
{
    ff_vec3 side = ff_quat_rotate(rotation, ff_v3(1.0, 0.0, 0.0));
    return ff_atan2(-side.z, side.x);
}

ff_play_over ff_play_over_ground(const ff_body_frame *body, int foot, double ball_height, ff_quat rotation)
{
    ff_vec3 ball = body->offset[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
    ff_vec3 to_heel = ff_sub3(body->heel[foot], ball);
    double up = ball_height - body->ball_rest;
    ff_play_over out = {.heel = up + ff_quat_rotate(rotation, to_heel).y - to_heel.y};
    double heel = ff_max(0.0, out.heel);
    out.toes = ff_max(0.0, up - heel);
    out.sole = ff_max(0.0, ff_min(up, heel)) * (1.0 - ff_smooth(heel / TIPTOE));
    return out;
}

/* Whose actions they are. */
typedef struct source {
    const ff_pack *pack;
    const ff_body_frame *body;
} source;

/* Seen from a place and heading of the stream's world. */
static void sample_from(const source *of, const ff_play_action *action, double time, ff_play_sample *out)
{
    ff_root_frame root;
    ff_pack_sample(of->pack, action->stream, action->start + time,
                   action->mirrored ? (uint32_t)FF_SAMPLE_MIRRORED : 0u, &root, &out->hips, out->rotations,
                   NULL);
    out->root = ff_to_frame2(ff_fwd2(action->heading), ff_sub2(root.position, action->origin));
    out->heading = root.heading - action->heading;
    ff_root_frame here = {out->root, out->heading};
    ff_root_place(&here, &out->hips, &out->rotations[FF_JOINT_HIPS]);
    out->hips.y -= action->level;
    ff_legs_of_pose(of->body, out->hips, out->rotations, out->ball, out->foot);
}

void ff_play_action_sample(const ff_pack *pack, const ff_body_frame *body, const ff_play_action *action,
                           double time, ff_play_sample *out)
{
    const source of = {pack, body};
    sample_from(&of, action, time, out);
}

void ff_play_sample_at(const ff_play_set *set, uint32_t action, double time, ff_play_sample *out)
{
    ff_play_action_sample(set->pack, &set->space->body, &set->actions[action], time, out);
}

ff_root_frame ff_play_root_at(const ff_play_set *set, uint32_t index, double time)
{
    const ff_play_action *action = &set->actions[index];
    ff_root_frame root;
    ff_pack_sample(set->pack, action->stream, action->start + time,
                   action->mirrored ? (uint32_t)FF_SAMPLE_MIRRORED : 0u, &root, NULL, NULL, NULL);
    return (ff_root_frame){ff_to_frame2(ff_fwd2(action->heading), ff_sub2(root.position, action->origin)),
                           root.heading - action->heading};
}

/* ----------------------------------------------------------------------------------------------- stances */

/* A foot at one moment. */
typedef struct still_foot {
    ff_vec3 ball;
    double yaw;
    ff_play_over over;
} still_foot;

static still_foot look_at(const source *of, const ff_play_action *action, int foot, double time)
{
    ff_play_sample at;
    sample_from(of, action, time, &at);
    still_foot out = {.ball = at.ball[foot], .yaw = ff_play_foot_yaw(at.foot[foot])};
    out.over = ff_play_over_ground(of->body, foot, out.ball.y, at.foot[foot]);
    return out;
}

static bool is_still(still_foot now, still_foot there)
{
    double a = now.ball.z - there.ball.z, b = now.ball.x - there.ball.x;
    return a * a + b * b < STILL * STILL && now.ball.y - there.ball.y < STILL_UP;
}

/* Does the whole foot lie on the ground, all but at its place? */
static bool has_arrived(const source *of, still_foot now, still_foot there)
{
    double a = now.ball.z - there.ball.z, b = now.ball.x - there.ball.x;
    return a * a + b * b < SLIDE * SLIDE && now.ball.y - of->body->ball_rest < BALL_UP &&
           now.over.heel < HEEL_UP;
}

/* From a moment at which the foot stands, until when it goes on standing, not beyond limit. */
static double reach_of_stance(const source *of, const ff_play_action *action, int foot, double time,
                              still_foot there, double limit)
{
    while (time < limit) {
        double next = ff_min(time + LOOK, limit);
        if (!is_still(look_at(of, action, foot, next), there)) break;
        time = next;
    }
    return time;
}

/* Since when: still, but not before its contact (low), or arrived, not before limit. */
static double start_of_stance(const source *of, const ff_play_action *action, int foot, double time,
                              still_foot there, double low, double limit)
{
    while (time > limit) {
        double next = ff_max(time - LOOK, time > low ? low : limit);
        still_foot now = look_at(of, action, foot, next);
        if (!(next >= low && is_still(now, there)) && !has_arrived(of, now, there)) break;
        time = next;
    }
    return time;
}

/* From when on a foot that stands in [from, to] is down until then: its ball, and, if it comes down at all, its heel. */
static double comes_down(const source *of, const ff_play_action *action, int foot, double from, double to)
{
    bool on_ball = look_at(of, action, foot, to).over.heel >= HEEL_UP; /* all the time */
    double time = to;
    while (time > from) {
        double next = ff_max(time - LOOK, from);
        still_foot now = look_at(of, action, foot, next);
        if (now.ball.y - of->body->ball_rest >= BALL_UP || (!on_ball && now.over.heel >= HEEL_UP)) break;
        time = next;
    }
    return time;
}

static void add_end(const source *of, const ff_play_action *action, int foot, int end, ff_play_stance *stance)
{
    double time = end == 0 ? stance->from : stance->to;
    ff_vec2 now = ff_plane(look_at(of, action, foot, time).ball);
    ff_vec2 later = ff_plane(look_at(of, action, foot, time + LOOK).ball);
    stance->off[end] = ff_sub2(now, ff_v2(stance->a, stance->b));
    stance->speed[end] = ff_scale2(ff_sub2(later, now), 1.0 / LOOK);
}

/* The moment of a plant (times from t_0) at which the foot surely stands: the place of a support foot is where it is when
 * the action begins, that of a landing where it is at the end (pack_format.h, S0 and land); else the middle. */
static double surely_still(const ff_play_action *action, const double plant[2], const double flat[2])
{
    double low = ff_clamp(plant[0], 0.0, action->duration), high = ff_min(plant[1], action->duration);
    if (flat[0] <= LOOK && flat[1] >= 0.0) return low;
    if (flat[0] <= action->duration + LOOK && flat[1] >= action->duration) return high;
    return ff_clamp(0.5 * (ff_max(flat[0], low) + ff_min(flat[1], high)), low, high);
}

static double must_go_down(ff_play_over over)
{
    return over.toes + over.sole;
}

/* Since when a foot stands that surely does at a time of a plant that begins at low. */
static double stance_begins(const source *of, const ff_play_action *action, int foot, double surely,
                            still_foot there, double low)
{
    double limit = low;
    uint32_t count = action->stance_count[foot];
    if (low > 0.0) limit = ff_clamp(low - SOONER, 0.0, low);
    if (low > 0.0 && count > 0) limit = ff_clamp(action->stance[foot][count - 1].to + SHORTEST, limit, low);
    return start_of_stance(of, action, foot, surely, there, low, limit);
}

static void add_stance(const source *of, ff_play_action *action, int foot, const double plant[2],
                       const double flat[2])
{
    double low = ff_clamp(plant[0], 0.0, action->duration), high = ff_min(plant[1], action->duration);
    uint32_t count = action->stance_count[foot];
    if (count == FF_PLAY_STANCES || high < low) return;
    double surely = surely_still(action, plant, flat);
    still_foot there = look_at(of, action, foot, surely);
    double from = stance_begins(of, action, foot, surely, there, low);
    double to = reach_of_stance(of, action, foot, surely, there, high);
    if (to > action->duration - LOOK) to = action->duration; /* the plant's own times are rounded */
    if (to - from < SHORTEST && to < action->duration) return;
    if (foot == (int)action->support && count == 0 && low <= LOOK) {
        from = 0.0; /* the body is on it, though in its clip it may only come to rest a little later */
        there = look_at(of, action, foot, from);
    }
    ff_play_stance *stance = &action->stance[foot][count];
    double down = from > 0.0 ? comes_down(of, action, foot, from, ff_min(to, action->duration)) : from;
    *stance = (ff_play_stance){
        .from = from, .to = to, .down = down, .a = there.ball.z, .b = there.ball.x, .yaw = there.yaw};
    stance->over[0] = must_go_down(look_at(of, action, foot, down).over);
    stance->over[1] = must_go_down(look_at(of, action, foot, to).over);
    if (stance->over[0] < BALL_UP) stance->over[0] = 0.0; /* it comes down by itself */
    add_end(of, action, foot, 0, stance);
    add_end(of, action, foot, 1, stance);
    action->stance_count[foot] = count + 1;
}

static void find_stances(const source *of, const ff_pack_action *record, ff_play_action *action)
{
    const ff_pack_clip *clip = &of->pack->clips[record->clip];
    for (uint32_t p = clip->first_plant; p < clip->first_plant + clip->plant_count; ++p) {
        const ff_pack_plant *plant = &of->pack->plants[p];
        double t_0 = (double)record->t_0;
        double whole[2] = {(double)plant->start - t_0, (double)plant->end - t_0},
               flat[2] = {whole[0], whole[1]};
        if (plant->flat_start >= 0.0f && plant->flat_end >= plant->flat_start)
            flat[0] = (double)plant->flat_start - t_0, flat[1] = (double)plant->flat_end - t_0;
        if (whole[1] < 0.0 || whole[0] > action->duration + LOOK) continue;
        int foot = action->mirrored ? 1 - (int)plant->foot : (int)plant->foot;
        add_stance(of, action, foot, whole, flat);
    }
}

void ff_play_action_make(const ff_pack *pack, const ff_body_frame *body, uint32_t index,
                         ff_play_action *action)
{
    const ff_pack_action *record = &pack->actions[index];
    const ff_pack_clip *clip = &pack->clips[record->clip];
    const source of = {pack, body};
    *action = (ff_play_action){.start = (double)record->t_0 - (double)clip->time_offset,
                               .duration = (double)record->duration,
                               .level = (double)record->height,
                               .stream = clip->stream,
                               .mirrored = (record->flags & FF_ACTION_MIRRORED) != 0,
                               .support = record->support,
                               .idle = record->mode == FF_MODE_IDLE};
    ff_play_sample at;
    sample_from(&of, action, 0.0, &at);
    action->origin = ff_plane(at.ball[record->support]);
    action->heading = at.heading;
    find_stances(&of, record, action);
}

ff_status ff_play_set_create(const ff_pack *pack, const ff_blend_space *space, ff_play_set **out,
                             ff_error *error)
{
    *out = NULL;
    ff_play_set *set = ff_calloc(1, sizeof *set);
    if (set) set->actions = ff_calloc(pack->action_count, sizeof *set->actions);
    if (!set || !set->actions) {
        ff_play_set_destroy(set);
        return ff_fail(error, FF_ERR_NO_MEMORY, "%u actions to play", pack->action_count);
    }
    set->pack = pack;
    set->space = space;
    for (uint32_t i = 0; i < pack->action_count; ++i)
        ff_play_action_make(pack, &space->body, i, &set->actions[i]);
    *out = set;
    return FF_OK;
}

void ff_play_set_destroy(ff_play_set *set)
{
    if (!set) return;
    free(set->actions);
    free(set);
}
