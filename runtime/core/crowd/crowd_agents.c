/* Agents: put in, taken out, told what to do. */
#include "runtime/core/crowd/crowd_behave.h"
#include "runtime/core/crowd/crowd_def.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/random.h"

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
    ff_status status = ff_agent_check_def(crowd, def, error);
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
    if (status == FF_OK) status = ff_check_between(speed, 0.1, 4.0, "preferred_speed", error);
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
