/* crowd_change.c - from moving by velocity to moving by footsteps, and back, without a jump: it happens as a foot lands, feet
 * that stand go on standing where they are, and what the two poses differ by fades out (pose_offset.h). */
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/gait/blend.h"
#include "runtime/core/gait/gait_switch.h"
#include "runtime/core/gait/leg_pose.h"

#include <string.h>

#define LATER (1.0 / 240.0) /* s, over which speeds are taken */
#define JUST_LANDED 0.2     /* u of a gait's phase: a foot that has been down for no longer has just landed */
#define DOUBLE_SUPPORT 1.0  /* u: both feet are down for no longer */
#define TURN_WEIGHT 0.3     /* m/s for a rad/s, between a gait and the action that it is taken for */

/* ------------------------------------------------------------------------------------------------- to footsteps */

/* The foot that has just landed, or -1. */
static int landed_foot(const ff_crowd *crowd, const ff_gait *gait)
{
    if (gait->mode != FF_GAIT_STEP || gait->blend.way == FF_RUNNING) return -1;
    for (int foot = 0; foot < 2; ++foot) {
        double start, length;
        ff_blend_lock(crowd->space, &gait->blend, foot, &start, &length);
        if (gait->foot[foot].planted && ff_phase_wrap(gait->phase - start) < JUST_LANDED) return foot;
    }
    return -1;
}

/* The action that is most like what the gait has just done: a step of that foot, as fast and turning as much. */
static bool likest_action(const ff_action_set *set, const ff_gait *gait, int foot, uint32_t *out)
{
    double best = INFINITY;
    for (uint32_t i = 0; i < ff_action_set_count(set); ++i) {
        const ff_pack_action *r = ff_action_set_record(set, i);
        bool walks = r->mode == FF_MODE_WALK_SHORT || r->mode == FF_MODE_WALK_LONG;
        if (!walks || (int)r->swing != foot || r->flags & FF_ACTION_TO_STANDING) continue;
        double pace = ff_action_set_pace(set, i);
        ff_vec2 speed = ff_scale2(ff_fwd2((double)r->direction), pace * (double)r->speed);
        double turn = pace * (double)r->theta / (double)r->duration - gait->rates.turn;
        double off =
            fabs(speed.a - gait->rates.forward) + fabs(speed.b - gait->rates.left) + TURN_WEIGHT * fabs(turn);
        if (off >= best) continue;
        best = off;
        *out = i;
    }
    return best < INFINITY;
}

bool ff_stepper_enters(const ff_crowd *crowd, uint32_t slot, double time, ff_plan *current)
{
    const ff_action_set *set = crowd->footsteps->actions;
    const ff_gait *gait = &crowd->gaits[slot];
    const ff_body *body = &crowd->bodies[slot];
    if (gait->mode == FF_GAIT_STAND && gait->stand >= 1.0) {
        ff_plan_stand(set, body->position, body->heading, time, current);
        return true;
    }
    uint32_t action = 0;
    int foot = landed_foot(crowd, gait);
    if (foot < 0 || !likest_action(set, gait, foot, &action)) return false;
    const ff_pack_action *r = ff_action_set_record(set, action);
    ff_plan_step step = {.heading = body->heading - (double)r->theta,
                         .start = time - (double)r->duration / ff_action_set_pace(set, action),
                         .action = action};
    ff_vec2 land = ff_v2((double)r->land[0], (double)r->land[1]);
    ff_vec2 lock = ff_v2(gait->foot[foot].lock.a, gait->foot[foot].lock.b);
    step.anchor = ff_sub2(lock, ff_from_frame2(ff_fwd2(step.heading), land));
    memset(current, 0, sizeof *current);
    current->from = current->steps[0] = current->steps[1] = step;
    current->steps[1].start = time;
    current->steps[1].hold = 1;
    current->count = 2;
    current->own = current->stop = 1;
    return true;
}

static ff_gait_root later_root(const ff_body *body, double time)
{
    ff_vec2 ahead = ff_fwd2(body->heading + 0.5 * body->rates.turn * time);
    ff_vec2 moved = ff_from_frame2(ahead, ff_v2(body->rates.forward, body->rates.left));
    return (ff_gait_root){ff_madd2(body->position, moved, time), body->heading + body->rates.turn * time,
                          body->rates};
}

/* What a gait shows, as play sees things. */
static void gait_shows(const ff_blend_space *space, const ff_gait *gait, const ff_gait_root *root,
                       ff_play_targets *out)
{
    memset(out, 0, sizeof *out);
    out->root = root->position;
    out->heading = root->heading;
    ff_gait_pose(space, gait, root->position, root->heading, &out->hips, out->rotations);
    ff_legs_of_pose(&space->body, out->hips, out->rotations, out->ball, out->foot);
    for (int foot = 0; foot < 2; ++foot)
        out->planted[foot] = gait->foot[foot].planted;
}

void ff_stepper_enter(ff_crowd *crowd, uint32_t slot, const ff_plan_job *job, double time)
{
    ff_stepper *s = &crowd->steppers[slot];
    const ff_footsteps *f = crowd->footsteps;
    const ff_gait *gait = &crowd->gaits[slot];
    ff_gait_root now = later_root(&crowd->bodies[slot], 0.0), later = later_root(&crowd->bodies[slot], LATER);
    ff_gait ahead = *gait;
    ff_gait_advance(crowd->space, &ahead, &later, LATER);
    ff_play_targets shown[2];
    gait_shows(crowd->space, gait, &now, &shown[0]);
    gait_shows(crowd->space, &ahead, &later, &shown[1]);
    ff_play_foot feet[2];
    for (int foot = 0; foot < 2; ++foot) {
        const ff_gait_foot *state = &gait->foot[foot];
        feet[foot] = (ff_play_foot){state->lock.a, state->lock.b, state->lock.yaw, state->planted, 0};
    }
    ff_stepper_adopt(crowd, slot, job, time);
    while (s->at + 1 < s->plan.count && s->plan.steps[s->at + 1].start <= time)
        ++s->at;
    ff_play_order order = ff_order_of(f, &s->plan.steps[s->at]);
    if (s->plan.steps[s->at].hold)
        order = (ff_play_order){FF_PLAY_STAND, 0, time, 1.0, {0.0, 0.0}, now.heading};
    ff_play_enter(f->play, &s->play, &order, feet, shown, LATER, time, gait->idle_time);
    s->moves = FF_PLANNER_FOOTSTEPS;
}

/* ------------------------------------------------------------------------------------------------- to velocity */

/* What play shows, as a gait sees things, from the root at the same moment. */
static void play_shows(const ff_footsteps *f, const ff_play *play, double time, ff_pose_targets *out)
{
    ff_play_targets at;
    ff_vec3 hips;
    ff_play_targets_at(f->play, play, time, &at);
    ff_play_pose(f->play, play, time, &hips, out->turn);
    ff_vec2 ahead = ff_fwd2(at.heading), place = ff_to_frame2(ahead, ff_sub2(ff_plane(hips), at.root));
    out->hips = ff_v3(place.a, place.b, hips.y);
    out->turn[FF_JOINT_HIPS] = ff_quat_mul(ff_quat_yaw(-at.heading), out->turn[FF_JOINT_HIPS]);
    for (int foot = 0; foot < 2; ++foot) {
        ff_vec2 ball = ff_to_frame2(ahead, ff_sub2(ff_plane(at.ball[foot]), at.root));
        ff_vec3 toe = ff_quat_rotate(at.foot[foot], ff_v3(0.0, 0.0, 1.0));
        double pitch = ff_atan2(toe.y, sqrt(toe.x * toe.x + toe.z * toe.z));
        out->foot[foot] = (ff_pose_foot){ball.a, ball.b, at.ball[foot].y,
                                         ff_wrap(ff_play_foot_yaw(at.foot[foot]) - at.heading), pitch};
    }
}

/* Both feet stand where they are: who has just landed has the other one on its toes. */
static void place_feet(const ff_crowd *crowd, const ff_play_targets *at, ff_gait *gait)
{
    memset(gait->foot, 0, sizeof gait->foot);
    for (int foot = 0; foot < 2; ++foot) {
        ff_gait_foot *state = &gait->foot[foot];
        state->lock = (ff_foothold){at->ball[foot].z, at->ball[foot].x, crowd->space->body.ball_rest,
                                    ff_wrap(ff_play_foot_yaw(at->foot[foot]))};
        state->now = state->lock;
        state->planted = 1;
    }
}

/* The rates of the action that is over, in the frame that it has left the body in. */
static ff_rates rates_of(const ff_stepper *s, const ff_footsteps *f)
{
    if (s->play.step[0].action == FF_PLAY_STAND) return (ff_rates){0.0, 0.0, 0.0};
    const ff_plan_step *step = s->at > 0 ? &s->plan.steps[s->at - 1] : &s->plan.from;
    const ff_pack_action *r = ff_action_set_record(f->actions, step->action);
    double pace = ff_action_set_pace(f->actions, step->action);
    ff_vec2 speed = ff_scale2(ff_fwd2((double)r->direction - (double)r->theta), pace * (double)r->speed);
    return (ff_rates){speed.a, speed.b, pace * (double)r->theta / (double)r->duration};
}

/* Where in the cycle somebody is whose support foot has just landed: where the other foot, on its toes by now, leaves the
 * ground. */
static double phase_of(const ff_crowd *crowd, const ff_blend *blend, int support)
{
    double start[2], length[2];
    for (int foot = 0; foot < 2; ++foot)
        ff_blend_lock(crowd->space, blend, foot, &start[foot], &length[foot]);
    double off = ff_phase_wrap(start[1 - support] + length[1 - support]);
    return ff_phase_wrap(off - start[support]) < DOUBLE_SUPPORT ? off : start[support];
}

static void leave(ff_crowd *crowd, uint32_t slot, double time)
{
    ff_stepper *s = &crowd->steppers[slot];
    const ff_footsteps *f = crowd->footsteps;
    const ff_blend_space *space = crowd->space;
    ff_gait *gait = &crowd->gaits[slot];
    ff_body *body = &crowd->bodies[slot];
    ff_play_targets at;
    ff_pose_targets old[2], new[2];
    ff_play_targets_at(f->play, &s->play, time, &at);
    play_shows(f, &s->play, time, &old[0]);
    play_shows(f, &s->play, time + LATER, &old[1]);
    bool stands = s->play.step[0].action == FF_PLAY_STAND;
    gait->idle_time = s->play.idle_time + time;
    gait->wanted = FF_BLENDING;
    gait->rates = ff_locomotion_clamp(space, FF_BLENDING, rates_of(s, f));
    ff_locomotion_find(space, FF_BLENDING, gait->rates, &gait->blend);
    gait->mode = stands ? FF_GAIT_STAND : FF_GAIT_STEP;
    gait->stand = stands ? 1.0 : 0.0;
    gait->hips_drop = gait->hips_speed = 0.0;
    gait->phase =
        stands ? 0.0 : phase_of(crowd, &gait->blend, (int)f->play->actions[s->play.step[0].action].support);
    if (!stands) gait->pace = 1.0 / gait->style.cadence; /* who walks on does not take a first step */
    place_feet(crowd, &at, gait);
    memset(&gait->offset, 0, sizeof gait->offset);
    body->position = at.root;
    body->heading = ff_wrap(at.heading);
    body->rates = gait->rates;
    ff_gait_root now = later_root(body, 0.0), later = later_root(body, LATER);
    ff_gait_advance(space, gait, &now, 0.0);
    ff_gait ahead = *gait;
    ff_gait_targets(space, gait, &now, &new[0]);
    ff_gait_advance(space, &ahead, &later, LATER);
    ff_gait_targets(space, &ahead, &later, &new[1]);
    ff_pose_switch change = {&old[0], &old[1], &new[0], &new[1], LATER, {1.0, 1.0}, {true, true}};
    ff_pose_offset_begin(&gait->offset, &change);
    ff_gait_advance(space, gait, &now, 0.0);
    ff_mind mind = ff_mind_new(body->heading);
    mind.command = mind.measured = mind.preferred = ff_body_velocity(body);
    crowd->minds[slot] = mind;
    s->moves = FF_PLANNER_VELOCITY;
    s->retry = 0.0;
    crowd->footsteps->bounds[slot] = FF_BOUNDS_NONE;
}

void ff_footsteps_change(ff_crowd *crowd)
{
    double time = ff_crowd_time(crowd);
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        const ff_stepper *s = &crowd->steppers[slot];
        if (crowd->alive[slot] && s->moves == FF_PLANNER_FOOTSTEPS && s->wanted == FF_PLANNER_VELOCITY &&
            s->landed)
            leave(crowd, slot, time);
    }
}

ff_status ff_crowd_set_planner(ff_crowd *crowd, ff_agent agent, ff_planner planner, ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK) status = ff_crowd_check_planner(crowd, planner, error);
    if (status != FF_OK) return status;
    if (planner == FF_PLANNER_CROWD) planner = crowd->def.planner;
    if (crowd->steppers) crowd->steppers[agent.slot].wanted = planner;
    return FF_OK;
}
