/* What a crowd answers about itself and its agents. */
#include "runtime/core/crowd/crowd_state.h"

#include "runtime/core/base/fail.h"

#define STILL 0.2 /* m/s: who is slower and means to stand, stands */

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

double ff_crowd_plan_seconds(const ff_crowd *crowd, double share)
{
    return crowd->footsteps ? ff_plan_times_share(&crowd->footsteps->times, share) : 0.0;
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
