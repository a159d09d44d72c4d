#include "runtime/core/crowd/crowd_footsteps.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/nav/nav_facing.h"
#include "runtime/core/plan/plan_set.h"
#include "runtime/core/plan/plan_solids.h"

#include <stdlib.h>
#include <string.h>

/* A second and agent: who crosses makes 0.65, where it is dense in 75 nodes; what is made at once makes a long frame
 * (study 4.7). */
#define PLANS_PER_SECOND 0.8
#define TESTS_PER_SECOND 600.0

/* ------------------------------------------------------------------------------------------------- memory */

bool ff_footsteps_wanted(const ff_crowd_def *def)
{
    return def->planner == FF_PLANNER_FOOTSTEPS || def->footsteps.mixed;
}

static uint32_t most_jobs(const ff_crowd_def *def)
{
    if (def->footsteps.plans > 0) return def->footsteps.plans;
    return (uint32_t)ceil(PLANS_PER_SECOND * def->step * def->max_agents) + 1;
}

static ff_plan_options options_of(const ff_footsteps_def *def)
{
    ff_plan_options options = ff_plan_options_default();
    options.nodes = def->nodes;
    options.seconds = def->seconds;
    options.margin = def->margin;
    options.proximity_cost = def->proximity_cost;
    if (def->paper) {
        options.margin = options.stand_margin = 0.0;
        options.inflation = 1.5;
        options.inflation_step = 0.0;
        options.time_horizon = 0.0;
        options.wait = 1.0;
        options.lazy = options.safe = options.table = 0;
    }
    return options;
}

static bool take_lanes(ff_footsteps *f, const ff_crowd_def *def, ff_error *error)
{
    f->lane_count = def->tasks ? FF_PLAN_LANES : def->threads;
    if (f->lane_count < 1) f->lane_count = 1;
    if (f->lane_count > FF_PLAN_LANES) f->lane_count = FF_PLAN_LANES;
    for (uint32_t i = 0; i < f->lane_count; ++i) {
        ff_plan_lane *lane = &f->lane[i];
        lane->tracks = ff_calloc(def->max_agents, sizeof *lane->tracks);
        lane->walkers = ff_calloc(def->max_agents, sizeof *lane->walkers);
        lane->shapes = ff_calloc(2 * (size_t)def->max_obstacles + 1, sizeof *lane->shapes);
        lane->movers = ff_calloc((size_t)def->max_obstacles + 1, sizeof *lane->movers);
        lane->paths = ff_calloc((size_t)def->max_obstacles + 1, sizeof *lane->paths);
        if (!lane->tracks || !lane->walkers || !lane->shapes || !lane->movers || !lane->paths) return false;
        if (ff_plan_scratch_create(f->actions, def->footsteps.nodes, &lane->scratch, error) != FF_OK)
            return false;
    }
    return true;
}

ff_status ff_footsteps_create(ff_crowd *crowd, ff_error *error)
{
    const ff_crowd_def *def = &crowd->def;
    ff_footsteps *f = ff_calloc(1, sizeof *f);
    if (!f) return ff_fail(error, FF_ERR_NO_MEMORY, "a crowd's footsteps");
    crowd->footsteps = f;
    f->options = options_of(&def->footsteps);
    f->job_max = most_jobs(def);
    f->test_max = (uint64_t)(TESTS_PER_SECOND * def->step * def->max_agents);
    ff_status status =
        ff_action_set_create_varied(crowd->pack, def->footsteps.actions, def->footsteps.speed_variations,
                                    FF_SPEED_VARIATIONS_MAX, &f->actions, error);
    if (status == FF_OK) status = ff_play_set_create(crowd->pack, crowd->space, &f->play, error);
    if (status == FF_OK) status = ff_solids_reserve(def->max_walls + def->max_obstacles, &f->solids, error);
    if (status != FF_OK) return status;
    f->jobs = ff_calloc(f->job_max, sizeof *f->jobs);
    f->bounds = ff_calloc(def->max_agents, sizeof *f->bounds);
    f->paths = ff_calloc(def->max_agents, sizeof *f->paths);
    f->glides = ff_calloc(def->max_agents, sizeof *f->glides);
    f->order = ff_calloc(f->job_max, sizeof *f->order);
    f->changed = ff_calloc((size_t)f->job_max + def->max_agents, sizeof *f->changed);
    f->movers = ff_calloc((size_t)def->max_obstacles + 1, sizeof *f->movers);
    if (!f->jobs || !f->order || !f->bounds || !f->paths || !f->glides || !f->changed || !f->movers ||
        !take_lanes(f, def, error))
        return ff_fail(error, FF_ERR_NO_MEMORY, "the footsteps of %u agents", def->max_agents);
    for (uint32_t slot = 0; slot < def->max_agents; ++slot)
        f->bounds[slot] = FF_BOUNDS_NONE;
    return FF_OK;
}

void ff_footsteps_destroy(ff_footsteps *f)
{
    if (!f) return;
    for (uint32_t i = 0; i < FF_PLAN_LANES; ++i) {
        ff_plan_scratch_destroy(f->lane[i].scratch);
        free(f->lane[i].tracks);
        free(f->lane[i].walkers);
        free(f->lane[i].shapes);
        free(f->lane[i].movers);
        free(f->lane[i].paths);
    }
    free(f->jobs);
    free(f->order);
    free(f->bounds);
    free(f->paths);
    free(f->glides);
    free(f->changed);
    free(f->movers);
    ff_solids_destroy(f->solids);
    ff_play_set_destroy(f->play);
    ff_action_set_destroy(f->actions);
    free(f);
}

/* ------------------------------------------------------------------------------------------------- one agent */

bool ff_is_stepper(const ff_crowd *crowd, uint32_t slot)
{
    return crowd->steppers && crowd->steppers[slot].moves == FF_PLANNER_FOOTSTEPS;
}

double ff_crowd_time(const ff_crowd *crowd)
{
    return (double)crowd->steps * crowd->def.step;
}

ff_play_order ff_order_of(const ff_footsteps *f, const ff_plan_step *step)
{
    return (ff_play_order){.action = ff_action_set_pack_index(f->actions, step->action),
                           .start = step->start,
                           .pace = ff_action_set_pace(f->actions, step->action),
                           .anchor = step->anchor,
                           .heading = step->heading};
}

static void show_root(ff_crowd *crowd, uint32_t slot, double time)
{
    ff_body *body = &crowd->bodies[slot];
    ff_play_root(crowd->footsteps->play, &crowd->steppers[slot].play, time, &body->position, &body->heading);
    body->heading = ff_wrap(body->heading);
}

void ff_stepper_begin(ff_crowd *crowd, uint32_t slot, double idle_time)
{
    ff_stepper *s = &crowd->steppers[slot];
    ff_footsteps *f = crowd->footsteps;
    double time = ff_crowd_time(crowd);
    const ff_body *body = &crowd->bodies[slot];
    memset(s, 0, sizeof *s);
    s->moves = s->wanted = FF_PLANNER_FOOTSTEPS;
    ff_plan_stand(f->actions, body->position, body->heading, time, &s->plan);
    ff_play_order stand = ff_order_of(f, &s->plan.steps[0]);
    ff_play_init(f->play, &s->play, &stand, time, idle_time);
    ff_plan_track(f->actions, &s->plan, time, &s->track);
    f->bounds[slot] = ff_track_bounds(&s->track);
    s->target = body->position;
    s->created = s->asked = time;
    show_root(crowd, slot, time);
    if (crowd->steps > 0) ff_stepper_tell(crowd, slot);
}

void ff_stepper_tell(ff_crowd *crowd, uint32_t slot)
{
    ff_footsteps *f = crowd->footsteps;
    if (crowd->steppers[slot].changed) return;
    crowd->steppers[slot].changed = 1;
    f->changed[f->changed_count++] = slot;
}

void ff_stepper_adopt(ff_crowd *crowd, uint32_t slot, const ff_plan_job *job, double time)
{
    ff_stepper *s = &crowd->steppers[slot];
    s->plan = job->plan;
    s->track = job->track;
    crowd->footsteps->bounds[slot] = job->bounds;
    s->target = job->target;
    s->created = time;
    s->pending = s->at = s->consumed = 0;
    ff_stepper_tell(crowd, slot);
    if (job->kind != FF_JOB_REACT) return;
    ff_play_order order = ff_order_of(crowd->footsteps, &s->plan.steps[0]);
    if (s->plan.steps[0].hold) order.action = FF_PLAY_STAND;
    ff_play_cut(crowd->footsteps->play, &s->play, &order, time);
}

void ff_stepper_forget(ff_crowd *crowd, uint32_t slot, ff_planner moves)
{
    memset(&crowd->steppers[slot], 0, sizeof crowd->steppers[slot]);
    crowd->steppers[slot].moves = crowd->steppers[slot].wanted = moves;
    crowd->footsteps->bounds[slot] = FF_BOUNDS_NONE;
}

void ff_footsteps_restore(ff_crowd *crowd)
{
    ff_footsteps *f = crowd->footsteps;
    for (uint32_t slot = 0; slot < crowd->slot_count && f; ++slot) {
        f->bounds[slot] = FF_BOUNDS_NONE;
        if (!crowd->alive[slot]) continue;
        if (ff_is_stepper(crowd, slot)) f->bounds[slot] = ff_track_bounds(&crowd->steppers[slot].track);
        if (crowd->steppers[slot].changed) f->changed[f->changed_count++] = slot;
    }
}

ff_vec2 ff_stepper_target(const ff_crowd *crowd, uint32_t slot)
{
    const ff_stepper *s = &crowd->steppers[slot];
    ff_vec2 goal = crowd->traits[slot].goal, out;
    if (s->waypoint_next < s->waypoint_count) return s->waypoint[s->waypoint_next];
    ff_agent agent = {slot, crowd->generation[slot]};
    if (crowd->def.waypoint &&
        crowd->def.waypoint(crowd->def.waypoint_context, agent, crowd->bodies[slot].position, goal, &out))
        return out;
    return goal;
}

/* It is done with its plan, which ends in a stand. */
static bool stands(const ff_stepper *s)
{
    return s->at + 1 == s->plan.count;
}

bool ff_stepper_arrived(const ff_crowd *crowd, uint32_t slot)
{
    const ff_traits *traits = &crowd->traits[slot];
    return stands(&crowd->steppers[slot]) &&
           ff_length2(ff_sub2(traits->goal, crowd->bodies[slot].position)) <= traits->goal_tolerance;
}

double ff_stepper_turns(const ff_crowd *crowd, uint32_t slot, double *heading)
{
    const ff_traits *traits = &crowd->traits[slot];
    const ff_body *body = &crowd->bodies[slot];
    if (traits->face == FF_FACE_FREE || !ff_stepper_arrived(crowd, slot)) return 0.0;
    *heading = ff_nav_face(traits->face, traits->face_at, body->position, body->heading);
    return fabs(ff_wrap(*heading - body->heading));
}

/* The next step of the plan is due. */
static void next_step(const ff_footsteps *f, ff_stepper *s)
{
    const ff_plan_step *step = &s->plan.steps[++s->at];
    s->counts.dodges += !step->hold && ff_action_is_platform(ff_action_set_record(f->actions, step->action));
    ff_play_order order = ff_order_of(f, step);
    if (step->hold) order.action = FF_PLAY_STAND;
    ff_play_next(f->play, &s->play, &order);
    ff_play_advance(f->play, &s->play, step->start);
    s->consumed += !step->hold;
    s->landed = 1;
}

void ff_footsteps_play(ff_crowd *crowd, uint32_t slot)
{
    ff_stepper *s = &crowd->steppers[slot];
    ff_body *body = &crowd->bodies[slot];
    double time = (double)(crowd->steps + 1) * crowd->def.step, rate = 1.0 / crowd->def.step;
    ff_vec2 before = body->position;
    double heading = body->heading;
    s->landed = stands(s);
    while (s->at + 1 < s->plan.count && s->plan.steps[s->at + 1].start <= time)
        next_step(crowd->footsteps, s);
    ff_play_advance(crowd->footsteps->play, &s->play, time);
    show_root(crowd, slot, time);
    ff_vec2 velocity = ff_scale2(ff_sub2(body->position, before), rate);
    ff_vec2 local = ff_to_frame2(ff_fwd2(body->heading), velocity);
    crowd->velocity[slot] = velocity;
    body->rates = (ff_rates){local.a, local.b, ff_wrap(body->heading - heading) * rate};
    ff_mind *mind = &crowd->minds[slot];
    mind->command = mind->measured = velocity;
    mind->preferred = velocity;
    mind->facing = body->heading;
    mind->standing = stands(s) ? FF_STANDS : FF_WALKS;
}

#define SHOWN                                                                                                \
    2 /* points of a path, over which a velocity is taken: a step, as roots sway and jump at joints */

ff_vec2 ff_stepper_shows(const ff_crowd *crowd, uint32_t slot)
{
    const ff_track *track = &crowd->steppers[slot].track;
    ff_path *path = &crowd->footsteps->paths[slot];
    double now = ff_crowd_time(crowd) / FF_TRACK_STEP - (double)track->first;
    for (int i = 0; i < FF_PATH_POINTS; ++i) {
        double k = ff_clamp(now + i * (FF_PATH_STEP / FF_TRACK_STEP), 0.0, track->count - 1.0);
        const ff_knot *from = &track->knots[(uint32_t)k], *to = from + ((uint32_t)k + 1 < track->count);
        double share = k - floor(k);
        ff_vec2 p = ff_v2((double)from->a[FF_COLLIDER_ROOT], (double)from->b[FF_COLLIDER_ROOT]);
        ff_vec2 q = ff_v2((double)to->a[FF_COLLIDER_ROOT], (double)to->b[FF_COLLIDER_ROOT]);
        path->at[i] = ff_add2(track->origin, ff_madd2(p, ff_sub2(q, p), share));
    }
    return ff_scale2(ff_sub2(path->at[SHOWN], path->at[0]), 1.0 / (SHOWN * FF_PATH_STEP));
}

/* ------------------------------------------------------------------------------------------------- questions */

void ff_stepper_state(const ff_crowd *crowd, uint32_t slot, ff_agent_state *out)
{
    ff_play_targets at;
    ff_play_targets_at(crowd->footsteps->play, &crowd->steppers[slot].play, ff_crowd_time(crowd), &at);
    out->planner = FF_PLANNER_FOOTSTEPS;
    out->reached = ff_stepper_arrived(crowd, slot);
    for (int foot = 0; foot < 2; ++foot)
        out->planted[foot] = (uint8_t)at.planted[foot];
}

ff_status ff_crowd_check_planner(const ff_crowd *crowd, ff_planner planner, ff_error *error)
{
    if (planner < FF_PLANNER_CROWD || planner > FF_PLANNER_FOOTSTEPS)
        return ff_fail(error, FF_ERR_RANGE, "planner is %d; expected one of FF_PLANNER_*", (int)planner);
    if (planner == FF_PLANNER_FOOTSTEPS && !crowd->footsteps)
        return ff_fail(
            error, FF_ERR_UNSUPPORTED,
            "the crowd has no memory for footsteps; create it with footsteps.mixed or that planner");
    return FF_OK;
}

ff_status ff_crowd_set_waypoints(ff_crowd *crowd, ff_agent agent, const ff_vec2 *points, uint32_t count,
                                 ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK && (count > FF_WAYPOINTS_MAX || (count > 0 && !points)))
        status = ff_fail(error, FF_ERR_RANGE, "%u waypoints; expected at most %d", count, FF_WAYPOINTS_MAX);
    if (status == FF_OK && !crowd->steppers)
        status =
            ff_fail(error, FF_ERR_UNSUPPORTED, "the crowd has no memory for footsteps, nor for waypoints");
    for (uint32_t i = 0; status == FF_OK && i < count; ++i)
        status = ff_crowd_check_place(points[i], "a waypoint", error);
    if (status != FF_OK) return status;
    ff_stepper *s = &crowd->steppers[agent.slot];
    memset(s->waypoint, 0, sizeof s->waypoint);
    for (uint32_t i = 0; i < count; ++i)
        s->waypoint[i] = points[i];
    s->waypoint_count = count;
    s->waypoint_next = 0;
    return FF_OK;
}

/* Prints are put at capacity at most; all are counted. */
typedef struct print_list {
    ff_planned_print *out;
    uint32_t capacity, count;
} print_list;

static void put_print(print_list *list, const ff_play_foot *foot, int which, double time, uint32_t action)
{
    if (list->count < list->capacity)
        list->out[list->count] =
            (ff_planned_print){{foot->a, foot->b}, ff_wrap(foot->yaw), time, (uint32_t)which, action};
    ++list->count;
}

ff_status ff_crowd_agent_plan(const ff_crowd *crowd, ff_agent agent, ff_planned_print *out, uint32_t capacity,
                              uint32_t *count, ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK && (!count || (capacity > 0 && !out)))
        status = ff_fail(error, FF_ERR_ARGUMENT, "nowhere to put the plan");
    if (status != FF_OK) return status;
    *count = 0;
    if (!ff_is_stepper(crowd, agent.slot)) return FF_OK;
    const ff_footsteps *f = crowd->footsteps;
    const ff_stepper *s = &crowd->steppers[agent.slot];
    print_list list = {out, capacity, 0};
    ff_play play = s->play;
    for (int foot = 0; foot < 2; ++foot)
        if (play.step[0].foot[foot].planted)
            put_print(&list, &play.step[0].foot[foot], foot, play.step[0].start, UINT32_MAX);
    for (uint32_t i = s->at; i < s->plan.count; ++i) {
        const ff_plan_step *step = &s->plan.steps[i];
        if (i > s->at && !step->hold) {
            ff_play_order order = ff_order_of(f, step);
            ff_play_next(f->play, &play, &order);
            play.step[0] = play.step[1];
        }
        if (step->hold || play.step[0].action == FF_PLAY_STAND) continue;
        ff_play_foot feet[2];
        ff_play_feet_after(f->play, &play.step[0], feet);
        for (int foot = 0; foot < 2; ++foot) {
            const ff_play_foot *was = &play.step[0].foot[foot];
            bool moved = !was->planted || was->a != feet[foot].a || was->b != feet[foot].b;
            if (feet[foot].planted && moved)
                put_print(&list, &feet[foot], foot, ff_play_landing(f->play, &play.step[0], foot),
                          play.step[0].action);
        }
    }
    *count = list.count;
    return FF_OK;
}

ff_status ff_crowd_agent_plan_counts(const ff_crowd *crowd, ff_agent agent, ff_plan_counts *out,
                                     ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK && !out) status = ff_fail(error, FF_ERR_ARGUMENT, "nowhere to put the counts");
    if (status != FF_OK) return status;
    memset(out, 0, sizeof *out);
    if (crowd->steppers) *out = crowd->steppers[agent.slot].counts;
    return FF_OK;
}
