/* crowd_behave.h - the behaviour of a crowd's agents, as a part of its step (behave.h). */
#ifndef FF_CROWD_BEHAVE_H
#define FF_CROWD_BEHAVE_H

#include "runtime/core/crowd/crowd_state.h"

/* Start an agent that was just put in on its machine. False when no goal of the first state has room. */
bool ff_crowd_behave_start(ff_crowd *crowd, uint32_t slot, uint32_t machine, uint32_t spawner);
/* It goes: its goal is free for another. */
void ff_crowd_behave_end(ff_crowd *crowd, uint32_t slot);

/* A step: change states, take out those who left, put in others. */
void ff_crowd_behave(ff_crowd *crowd);
/* The last part of it (crowd_spawn.c). */
void ff_crowd_spawn(ff_crowd *crowd);

/* It is told another preferred speed: the state's factor stays. */
void ff_crowd_behave_speed(ff_crowd *crowd, uint32_t slot, double speed);

/* Count goals that are taken and people of spawners anew, of a crowd that was loaded. */
void ff_crowd_behave_recount(ff_crowd *crowd);

/* Put in and take out (crowd_agents.c). A spawned one faces its goal. NULL error is fine. */
ff_status ff_crowd_put(ff_crowd *crowd, const ff_agent_def *def, uint32_t spawner, ff_agent *out,
                       ff_error *error);
void ff_crowd_take_out(ff_crowd *crowd, uint32_t slot);

#endif
