/* Crowds: creation, agents, walls and questions. The step is in crowd_step.c. */
#include "runtime/core/crowd/crowd_behave.h"
#include "runtime/core/plan/plan_solids.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/random.h"

#include <stdlib.h>
#include <string.h>

#define CROWD_COOKIE 0x46464344u
#define AGENT_COOKIE 0x46464144u
#define AGENTS_MAX 1000000u
#define WALLS_MAX 1000000u
#define OBSTACLES_MAX 100000.0
#define NODES_MAX 20000.0
#define STEP_MIN 1e-5      /* s: below that speeds, which are differences over a step, are noise */
#define STEP_MAX 0.25      /* s: longer than that, people walk past each other unseen */
#define PLANE_MAX 1e6      /* m: millimetres must survive in a double many times over */
#define TOLERANCE_MIN 0.05 /* m */
#define STILL 0.2          /* m/s: who is slower and means to stand, stands */

ff_crowd_def ff_crowd_def_default(void)
{
    return (ff_crowd_def){.max_agents = 1000,
                          .max_walls = 1000,
                          .step = 1.0 / 30.0,
                          .seed = 1,
                          .threads = 1,
                          .keep_right = 0.30,
                          .navigation = FF_NAVIGATION_MCN,
                          .synthesis = FF_SYNTHESIS_HYBRID,
                          .mcn = {.hull = true,
                                  .sharp_turn = true,
                                  .stance = true,
                                  .forces = true,
                                  .density = true,
                                  .weighted = true,
                                  .gradual = true,
                                  .lean = true,
                                  .progress = true,
                                  .make_way = true,
                                  .facing = FF_FACING_HALFWAY,
                                  .padding = 0.02,
                                  .prediction = 0.3},
                          .planner = FF_PLANNER_VELOCITY,
                          .footsteps = {.nodes = 300, .expiry = 2.0, .expiry_actions = 3, .margin = 0.08},
                          .max_obstacles = 64,
                          .cookie = CROWD_COOKIE};
}

ff_agent_def ff_agent_def_default(void)
{
    return (ff_agent_def){.goal_tolerance = 0.5,
                          .machine = FF_NONE,
                          .preferred_speed = 1.3,
                          .radius = 0.3,
                          .cookie = AGENT_COOKIE};
}

static ff_status check_between(double value, double low, double high, const char *what, ff_error *error)
{
    if (value >= low && value <= high) return FF_OK;
    return ff_fail(error, isfinite(value) ? FF_ERR_RANGE : FF_ERR_NOT_FINITE, "%s is %g; expected %g to %g",
                   what, value, low, high);
}

static ff_status check_navigation(ff_navigation navigation, ff_error *error)
{
    if (navigation >= FF_NAVIGATION_CROWD && navigation <= FF_NAVIGATION_SF) return FF_OK;
    return ff_fail(error, FF_ERR_RANGE, "navigation is %d; expected one of FF_NAVIGATION_*", (int)navigation);
}

static ff_status check_synthesis(ff_synthesis synthesis, ff_error *error)
{
    if (synthesis >= FF_SYNTHESIS_CROWD && synthesis <= FF_SYNTHESIS_HYBRID) return FF_OK;
    return ff_fail(error, FF_ERR_RANGE, "synthesis is %d; expected one of FF_SYNTHESIS_*", (int)synthesis);
}

static ff_status check_navigation_def(const ff_crowd_def *def, ff_error *error)
{
    ff_status status = check_navigation(def->navigation, error);
    if (status == FF_OK) status = check_synthesis(def->synthesis, error);
    if (status == FF_OK)
        status = check_between(def->keep_right, -0.5 * FF_PI, 0.5 * FF_PI, "keep_right (rad)", error);
    if (status == FF_OK)
        status = check_between(def->baseline.keep_right, -0.5 * FF_PI, 0.5 * FF_PI,
                               "the baselines' keep_right (rad)", error);
    if (status == FF_OK) status = check_between(def->body_scale, 0.0, 0.15, "body_scale", error);
    if (status == FF_OK) status = check_between(def->mcn.padding, 0.0, 0.5, "padding", error);
    if (status == FF_OK)
        status = check_between(def->baseline.padding, 0.0, 0.5, "the baselines' padding", error);
    if (status == FF_OK) status = check_between(def->mcn.prediction, 0.0, 1.0, "prediction", error);
    if (status == FF_OK && (def->mcn.facing < FF_FACING_HALFWAY || def->mcn.facing > FF_FACING_COMMAND))
        status =
            ff_fail(error, FF_ERR_RANGE, "facing is %d; expected one of FF_FACING_*", (int)def->mcn.facing);
    return status;
}

static ff_status check_footsteps_def(const ff_crowd_def *def, ff_error *error)
{
    const ff_footsteps_def *f = &def->footsteps;
    if (def->planner < FF_PLANNER_CROWD || def->planner > FF_PLANNER_FOOTSTEPS)
        return ff_fail(error, FF_ERR_RANGE, "planner is %d; expected one of FF_PLANNER_*", (int)def->planner);
    ff_status status = check_between(f->nodes, 1.0, NODES_MAX, "footsteps.nodes", error);
    if (status == FF_OK) status = check_between(f->seconds, 0.0, 10.0, "footsteps.seconds", error);
    if (status == FF_OK) status = check_between(f->plans, 0.0, AGENTS_MAX, "footsteps.plans", error);
    if (status == FF_OK) status = check_between(f->expiry, 0.05, 1e3, "footsteps.expiry (s)", error);
    if (status == FF_OK)
        status = check_between(f->expiry_actions, 1.0, 1e3, "footsteps.expiry_actions", error);
    if (status == FF_OK) status = check_between(f->margin, 0.0, 1.0, "footsteps.margin (m)", error);
    if (status == FF_OK)
        status = check_between(f->proximity_cost, 0.0, 1e4, "footsteps.proximity_cost", error);
    for (int i = 0; status == FF_OK && i < FF_SPEED_VARIATIONS_MAX; ++i)
        if (f->speed_variations[i] != 0.0)
            status = check_between(f->speed_variations[i], 0.5, 1.5, "a footsteps.speed_variations", error);
    if (status == FF_OK)
        status = check_between(def->max_obstacles, 0.0, OBSTACLES_MAX, "max_obstacles", error);
    return status;
}

static ff_status check_crowd_def(const ff_pack *pack, const ff_crowd_def *def, ff_error *error)
{
    if (!pack || !def) return ff_fail(error, FF_ERR_ARGUMENT, "a crowd needs a pack and a definition");
    if (def->cookie != CROWD_COOKIE)
        return ff_fail(error, FF_ERR_ARGUMENT,
                       "the crowd's definition was not made by ff_crowd_def_default()");
    if (def->max_agents < 1 || def->max_agents > AGENTS_MAX)
        return ff_fail(error, FF_ERR_RANGE, "max_agents is %u; expected 1 to %u", def->max_agents,
                       AGENTS_MAX);
    if (def->max_walls > WALLS_MAX)
        return ff_fail(error, FF_ERR_RANGE, "max_walls is %u; expected at most %u", def->max_walls,
                       WALLS_MAX);
    ff_status status = check_between(def->step, STEP_MIN, STEP_MAX, "step (s)", error);
    if (status == FF_OK) status = check_footsteps_def(def, error);
    return status == FF_OK ? check_navigation_def(def, error) : status;
}

static size_t memory_needed(const ff_crowd_def *def)
{
    return ((size_t)def->max_obstacles + 1) * (sizeof(ff_crowd_obstacle) + sizeof(ff_nav_mover)) + 128 +
           ff_crowd_arrays_bytes(def) + ff_grid_bytes(def->max_agents) + ff_walls_bytes(def->max_walls);
}

/* Everything that is sized by the definition. */
static bool take_memory(ff_crowd *crowd)
{
    const ff_crowd_def *def = &crowd->def;
    crowd->obstacles =
        ff_arena_push(&crowd->arena, (size_t)def->max_obstacles + 1, sizeof *crowd->obstacles, 64);
    crowd->movers = ff_arena_push(&crowd->arena, (size_t)def->max_obstacles + 1, sizeof *crowd->movers, 64);
    return crowd->obstacles && crowd->movers && ff_crowd_arrays_init(crowd, &crowd->arena) &&
           ff_grid_init(&crowd->grid, def->max_agents, &crowd->arena) &&
           ff_walls_init(&crowd->walls, def->max_walls, &crowd->arena);
}

/* Back-pedalling, if it is allowed, as far as the pack can walk backwards; the pack's own hull faces forward. */
static ff_status make_hull(ff_crowd *crowd, ff_error *error)
{
    const ff_pack *pack = crowd->pack;
    if (!crowd->def.mcn.back_pedal) {
        ff_hull_make(pack->hull, pack->hull_count, &crowd->hull);
        return FF_OK;
    }
    ff_pack_point2 *points = ff_calloc((size_t)pack->hull_count + pack->example_count + 1, sizeof *points);
    if (!points) return ff_fail(error, FF_ERR_NO_MEMORY, "the velocities of a crowd");
    uint32_t count = 0;
    for (; count < pack->hull_count; ++count)
        points[count] = pack->hull[count];
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        const ff_pack_example *example = &pack->examples[i];
        if (example->v_forward < 0.0f)
            points[count++] = (ff_pack_point2){example->v_forward, example->v_left};
    }
    ff_hull_make(points, count, &crowd->hull);
    free(points);
    return FF_OK;
}

/* The semi-procedural clip's ellipses; FF_HULL_MAX corners at most, forwards only unless back-pedalling is allowed. */
static void make_clip_hull(ff_crowd *crowd)
{
    ff_pack_point2 points[FF_HULL_MAX];
    bool back = crowd->def.mcn.back_pedal;
    for (int i = 0; i < FF_HULL_MAX; ++i) {
        double part = (double)i / (back ? FF_HULL_MAX : FF_HULL_MAX - 1),
               angle = (back ? FF_TAU : FF_PI) * part;
        ff_vec2 at = ff_fwd2(angle - 0.5 * FF_PI);
        double ahead = at.a < 0.0 ? FF_MODEL_BACKWARD : crowd->space->model.fastest;
        points[i] = (ff_pack_point2){(float)(ahead * at.a), (float)(FF_MODEL_SIDEWAYS * at.b)};
    }
    ff_hull_make(points, FF_HULL_MAX, &crowd->clip_hull);
}

ff_status ff_crowd_create(const ff_pack *pack, const ff_crowd_def *def, ff_crowd **out, ff_error *error)
{
    if (!out) return ff_fail(error, FF_ERR_ARGUMENT, "nowhere to put the crowd");
    *out = NULL;
    ff_status status = check_crowd_def(pack, def, error);
    if (status != FF_OK) return status;
    ff_crowd *crowd = ff_calloc(1, sizeof *crowd);
    if (!crowd) return ff_fail(error, FF_ERR_NO_MEMORY, "a crowd");
    crowd->pack = pack;
    crowd->def = *def;
    if (def->planner == FF_PLANNER_CROWD) crowd->def.planner = FF_PLANNER_VELOCITY;
    if (def->navigation == FF_NAVIGATION_CROWD) crowd->def.navigation = FF_NAVIGATION_MCN;
    if (def->synthesis == FF_SYNTHESIS_CROWD) crowd->def.synthesis = ff_crowd_def_default().synthesis;
    status = make_hull(crowd, error);
    if (status == FF_OK) status = ff_blend_space_create(pack, &crowd->space, error);
    if (status == FF_OK) make_clip_hull(crowd);
    if (status == FF_OK && def->behaviour) {
        status = ff_behaviour_create(def->behaviour, &crowd->behaviour, error);
        crowd->def.behaviour = crowd->behaviour ? &crowd->behaviour->def : NULL;
    }
    if (status == FF_OK && !def->tasks) status = ff_tasks_create(def->threads, &crowd->own_tasks, error);
    if (status == FF_OK) status = ff_arena_create(&crowd->arena, memory_needed(&crowd->def), error);
    if (status == FF_OK && !take_memory(crowd))
        status = ff_fail(error, FF_ERR_NO_MEMORY, "a crowd of %u agents", def->max_agents);
    if (status == FF_OK && ff_footsteps_wanted(&crowd->def)) status = ff_footsteps_create(crowd, error);
    if (status != FF_OK) {
        ff_crowd_destroy(crowd);
        return status;
    }
    *out = crowd;
    return FF_OK;
}

void ff_crowd_destroy(ff_crowd *crowd)
{
    if (!crowd) return;
    ff_footsteps_destroy(crowd->footsteps);
    ff_arena_destroy(&crowd->arena);
    ff_tasks_destroy(crowd->own_tasks);
    ff_blend_space_destroy(crowd->space);
    ff_behaviour_destroy(crowd->behaviour);
    free(crowd);
}

/* ------------------------------------------------------------------------------------------------- agents */

static bool is_place(ff_vec2 p)
{
    return fabs(p.a) <= PLANE_MAX && fabs(p.b) <= PLANE_MAX; /* false for nan */
}

ff_status ff_crowd_check_place(ff_vec2 p, const char *what, ff_error *error)
{
    if (is_place(p)) return FF_OK;
    bool finite = isfinite(p.a) && isfinite(p.b);
    return ff_fail(error, finite ? FF_ERR_RANGE : FF_ERR_NOT_FINITE, "%s is (%g, %g) m; expected within %g m",
                   what, p.a, p.b, PLANE_MAX);
}

static ff_status check_machine(const ff_crowd *crowd, uint32_t machine, ff_error *error)
{
    uint32_t count = crowd->behaviour ? crowd->behaviour->def.machine_count : 0;
    if (machine == FF_NONE || machine < count) return FF_OK;
    return ff_fail(error, FF_ERR_RANGE, "machine %u of a crowd whose behaviour has %u", machine, count);
}

static ff_status check_agent_def(const ff_crowd *crowd, const ff_agent_def *def, ff_error *error)
{
    if (!def || def->cookie != AGENT_COOKIE)
        return ff_fail(error, FF_ERR_ARGUMENT,
                       "the agent's definition was not made by ff_agent_def_default()");
    ff_status status = ff_crowd_check_place(def->position, "position", error);
    if (status == FF_OK) status = ff_crowd_check_place(def->goal, "goal", error);
    if (status == FF_OK) status = check_between(def->heading, -1e3, 1e3, "heading", error);
    if (status == FF_OK)
        status = check_between(def->goal_tolerance, TOLERANCE_MIN, 1e3, "goal_tolerance", error);
    if (status == FF_OK) status = check_between(def->preferred_speed, 0.1, 4.0, "preferred_speed", error);
    if (status == FF_OK) status = check_between(def->radius, 0.05, 1.5, "radius", error);
    if (status == FF_OK) status = check_navigation(def->navigation, error);
    if (status == FF_OK) status = check_synthesis(def->synthesis, error);
    if (status == FF_OK) status = check_machine(crowd, def->machine, error);
    return status;
}

/* Free slots are taken last in, first out, then new ones. */
static uint32_t take_slot(ff_crowd *crowd)
{
    if (crowd->free_first == 0) return crowd->slot_count++;
    uint32_t slot = crowd->free_first - 1;
    crowd->free_first = crowd->next_free[slot];
    crowd->next_free[slot] = 0;
    return slot;
}

static void free_slot(ff_crowd *crowd, uint32_t slot)
{
    if (crowd->steppers) ff_stepper_forget(crowd, slot, FF_PLANNER_CROWD);
    crowd->alive[slot] = 0;
    --crowd->agent_count;
    crowd->next_free[slot] = crowd->free_first;
    crowd->free_first = slot + 1;
}

/* Standing, with a style of its own. */
static void place_body(ff_crowd *crowd, uint32_t slot, ff_vec2 position, double heading)
{
    ff_random random = {crowd->def.seed, slot, (uint64_t)crowd->generation[slot] << 8};
    crowd->minds[slot] = ff_mind_new(heading);
    crowd->choices[slot] = (ff_choice){0.0, 0, 0};
    crowd->bodies[slot] =
        (ff_body){.position = position, .heading = heading, .phase = ff_random_unit(&random)};
    crowd->velocity[slot] = ff_v2(0.0, 0.0);
    ff_gait_init(crowd->space, &crowd->gaits[slot], position, heading, ff_random_next(&random));
    double most = crowd->steppers ? 0.0 : crowd->def.body_scale;
    double larger = ff_clamp(0.5 * most * ff_random_normal(&random), -most, most);
    if (most > 0.0) ff_gait_set_scale(crowd->space, &crowd->gaits[slot], position, heading, 1.0 + larger);
}

ff_status ff_crowd_put(ff_crowd *crowd, const ff_agent_def *def, uint32_t spawner, ff_agent *out,
                       ff_error *error)
{
    ff_status status = check_agent_def(crowd, def, error);
    if (status == FF_OK) status = ff_crowd_check_planner(crowd, def->planner, error);
    if (status != FF_OK) return status;
    if (crowd->agent_count == crowd->def.max_agents)
        return ff_fail(error, FF_ERR_RANGE, "the crowd is full: %u agents; raise max_agents",
                       crowd->agent_count);
    uint32_t slot = take_slot(crowd);
    uint32_t generation = ++crowd->generation[slot];
    crowd->alive[slot] = 1;
    ++crowd->agent_count;

    crowd->number[slot] = (uint32_t)crowd->added;
    ff_navigation navigation = def->navigation ? def->navigation : crowd->def.navigation;
    ff_synthesis synthesis = def->synthesis ? def->synthesis : crowd->def.synthesis;
    crowd->traits[slot] = (ff_traits){.goal = def->goal,
                                      .goal_tolerance = def->goal_tolerance,
                                      .preferred_speed = def->preferred_speed,
                                      .radius = def->radius,
                                      .navigation = navigation,
                                      .synthesis = synthesis};
    place_body(crowd, slot, def->position, ff_wrap(def->heading));
    if (crowd->behaviour && !ff_crowd_behave_start(crowd, slot, def->machine, spawner)) {
        free_slot(crowd, slot);
        return ff_fail(error, FF_ERR_RANGE,
                       "no goal of the first state of machine %s is free: raise a capacity, or put in fewer",
                       crowd->behaviour->def.machines[def->machine].name);
    }
    ff_vec2 way = ff_sub2(crowd->traits[slot].goal, def->position);
    if (spawner != FF_NONE && ff_dot2(way, way) > 0.0)
        place_body(crowd, slot, def->position, ff_atan2(way.b, way.a));
    if (crowd->steppers) {
        ff_planner planner = def->planner ? def->planner : crowd->def.planner;
        ff_stepper_forget(crowd, slot, FF_PLANNER_VELOCITY);
        if (planner == FF_PLANNER_FOOTSTEPS) ff_stepper_begin(crowd, slot, crowd->gaits[slot].idle_time);
    }
    ++crowd->added;
    *out = (ff_agent){slot, generation};
    return FF_OK;
}

ff_status ff_crowd_add_agent(ff_crowd *crowd, const ff_agent_def *def, ff_agent *out, ff_error *error)
{
    if (!crowd || !out) return ff_fail(error, FF_ERR_ARGUMENT, "no crowd to add an agent to");
    return ff_crowd_put(crowd, def, FF_NONE, out, error);
}

ff_status ff_crowd_check_agent(const ff_crowd *crowd, ff_agent agent, ff_error *error)
{
    if (crowd && agent.slot < crowd->slot_count && crowd->alive[agent.slot] &&
        crowd->generation[agent.slot] == agent.generation)
        return FF_OK;
    return ff_fail(error, FF_ERR_ARGUMENT, "agent {%u, %u} does not live in this crowd", agent.slot,
                   agent.generation);
}

void ff_crowd_take_out(ff_crowd *crowd, uint32_t slot)
{
    if (crowd->behaviour) ff_crowd_behave_end(crowd, slot);
    free_slot(crowd, slot);
}

ff_status ff_crowd_remove_agent(ff_crowd *crowd, ff_agent agent, ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status != FF_OK) return status;
    ff_crowd_take_out(crowd, agent.slot);
    return FF_OK;
}

ff_status ff_crowd_set_goal(ff_crowd *crowd, ff_agent agent, ff_vec2 goal, ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK) status = ff_crowd_check_place(goal, "goal", error);
    if (status != FF_OK) return status;
    crowd->traits[agent.slot].goal = goal;
    ff_mind_forget_goal(&crowd->minds[agent.slot]);
    return FF_OK;
}

ff_status ff_crowd_set_preferred_speed(ff_crowd *crowd, ff_agent agent, double speed, ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK) status = check_between(speed, 0.1, 4.0, "preferred_speed", error);
    if (status != FF_OK) return status;
    crowd->traits[agent.slot].preferred_speed = speed;
    if (crowd->behaviour) ff_crowd_behave_speed(crowd, agent.slot, speed);
    return FF_OK;
}

ff_status ff_crowd_set_facing(ff_crowd *crowd, ff_agent agent, ff_face face, ff_vec2 at, ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK) status = ff_crowd_check_place(at, "what is looked at", error);
    if (status == FF_OK && !(face >= FF_FACE_FREE && face <= FF_FACE_HEADING))
        status = ff_fail(error, FF_ERR_ARGUMENT, "face is %d; expected FF_FACE_FREE, _POINT or _HEADING",
                         (int)face);
    if (status != FF_OK) return status;
    crowd->traits[agent.slot].face = face;
    crowd->traits[agent.slot].face_at = at;
    return FF_OK;
}

ff_status ff_crowd_put_wall(ff_crowd *crowd, ff_vec2 p, ff_vec2 q, bool of_obstacle, ff_error *error)
{
    if (!crowd) return ff_fail(error, FF_ERR_ARGUMENT, "no crowd to add a wall to");
    ff_status status = ff_crowd_check_place(p, "the wall's start", error);
    if (status == FF_OK) status = ff_crowd_check_place(q, "the wall's end", error);
    if (status != FF_OK) return status;
    if (crowd->steps > 0)
        return ff_fail(error, FF_ERR_ARGUMENT, "walls are fixed once the first step was taken");
    if (crowd->walls.count == crowd->def.max_walls)
        return ff_fail(error, FF_ERR_RANGE, "there are %u walls already; raise max_walls",
                       crowd->walls.count);
    if (ff_length2(ff_sub2(q, p)) < 1e-6)
        return ff_fail(error, FF_ERR_ARGUMENT, "the wall from (%g, %g) has no length", p.a, p.b);
    ff_walls_add(&crowd->walls, p, q);
    if (crowd->footsteps && !of_obstacle) ff_solids_add(crowd->footsteps->solids, ff_solid_of_wall(p, q));
    return FF_OK;
}

ff_status ff_crowd_add_wall(ff_crowd *crowd, ff_vec2 p, ff_vec2 q, ff_error *error)
{
    return ff_crowd_put_wall(crowd, p, q, false, error);
}

/* ---------------------------------------------------------------------------------------------- questions */

uint32_t ff_crowd_agent_count(const ff_crowd *crowd)
{
    return crowd->agent_count;
}

ff_crowd_def ff_crowd_definition(const ff_crowd *crowd)
{
    return crowd->def;
}

ff_crowd_counts ff_crowd_count(const ff_crowd *crowd)
{
    return (ff_crowd_counts){crowd->added, crowd->spawned, crowd->left};
}

uint64_t ff_crowd_step_count(const ff_crowd *crowd)
{
    return crowd->steps;
}

ff_crowd_timings ff_crowd_time_spent(const ff_crowd *crowd)
{
    return crowd->timings;
}

uint32_t ff_crowd_agents(const ff_crowd *crowd, ff_agent *out, uint32_t capacity)
{
    uint32_t count = 0;
    for (uint32_t slot = 0; slot < crowd->slot_count && count < capacity; ++slot)
        if (crowd->alive[slot]) out[count++] = (ff_agent){slot, crowd->generation[slot]};
    return crowd->agent_count;
}

ff_status ff_crowd_agent_state(const ff_crowd *crowd, ff_agent agent, ff_agent_state *out, ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status != FF_OK) return status;
    const ff_body *body = &crowd->bodies[agent.slot];
    const ff_mind *mind = &crowd->minds[agent.slot];
    const ff_traits *traits = &crowd->traits[agent.slot];
    const ff_gait *gait = &crowd->gaits[agent.slot];
    bool still = ff_length2(crowd->velocity[agent.slot]) <= STILL;
    bool near = ff_length2(ff_sub2(traits->goal, body->position)) <= traits->goal_tolerance;
    *out = (ff_agent_state){.position = body->position,
                            .velocity = crowd->velocity[agent.slot],
                            .heading = body->heading,
                            .turn_rate = body->rates.turn,
                            .command = mind->command,
                            .goal = traits->goal,
                            .radius = traits->radius,
                            .scale = gait->style.scale,
                            .reached = mind->standing && near && still,
                            .planted = {(uint8_t)ff_gait_planted(gait, 0), (uint8_t)ff_gait_planted(gait, 1)},
                            .planner = FF_PLANNER_VELOCITY,
                            .way = (uint8_t)gait->blend.way,
                            .number = crowd->number[agent.slot]};
    if (ff_is_stepper(crowd, agent.slot)) ff_stepper_state(crowd, agent.slot, out);
    return FF_OK;
}

static void add_counts(const ff_gait *gait, ff_synthesis_counts *out)
{
    out->blending_s += gait->seconds[FF_BLENDING];
    out->semi_procedural_s += gait->seconds[FF_SEMI_PROCEDURAL];
    out->running_s += gait->seconds[FF_RUNNING];
    out->transitions += gait->switches;
    out->urgent += gait->urgent_switches;
}

ff_status ff_crowd_synthesis_counts(const ff_crowd *crowd, ff_agent agent, ff_synthesis_counts *out,
                                    ff_error *error)
{
    bool all = crowd && agent.slot == 0 && agent.generation == 0;
    ff_status status = all ? FF_OK : ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK && !out) status = ff_fail(error, FF_ERR_ARGUMENT, "nowhere to put the counts");
    if (status != FF_OK) return status;
    *out = (ff_synthesis_counts){0.0, 0.0, 0.0, 0, 0};
    if (!all) add_counts(&crowd->gaits[agent.slot], out);
    for (uint32_t slot = 0; all && slot < crowd->slot_count; ++slot)
        if (crowd->alive[slot]) add_counts(&crowd->gaits[slot], out);
    return FF_OK;
}
