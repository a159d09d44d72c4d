/* crowd_saved.h - a small busy crowd, its saved bytes, and what is done with whatever the loader lets through. */
#ifndef FF_TEST_CROWD_SAVED_H
#define FF_TEST_CROWD_SAVED_H

#include "tests/core/behave_fair.h"
#include "tests/core/walker_pack.h"

#include "runtime/core/base/random.h"

/* A crowd at the fair that has people of all methods, walls, free slots and some seconds behind it. */
static inline ff_crowd *ff_saved_crowd(const ff_pack *pack)
{
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = 12;
    def.max_walls = 4;
    ff_behaviour_def behaviour = fair_behaviour();
    def.behaviour = &behaviour;
    ff_crowd *crowd;
    ff_agent agents[10];
    if (ff_crowd_create(pack, &def, &crowd, NULL) != FF_OK) abort();
    ff_crowd_add_wall(crowd, ff_v2(-1.0, 2.0), ff_v2(1.0, 2.0), NULL);
    ff_crowd_add_wall(crowd, ff_v2(1.0, 2.0), ff_v2(2.0, 3.0), NULL);
    for (int i = 0; i < 10; ++i) {
        ff_agent_def agent = ff_agent_def_default();
        agent.position = ff_scale2(ff_fwd2(FF_TAU * i / 10.0), 3.0);
        agent.goal = ff_scale2(agent.position, i == 3 ? 1.0 : -1.0);
        agent.heading = 0.3 * i;
        if (i < 4) agent.machine = FAIR_VISITOR;
        if (i == 5) agent.navigation = FF_NAVIGATION_ORCA;
        if (i == 6) agent.navigation = FF_NAVIGATION_SF;
        if (ff_crowd_add_agent(crowd, &agent, &agents[i], NULL) != FF_OK) abort();
    }
    for (int i = 0; i < 45; ++i)
        ff_crowd_step(crowd);
    ff_crowd_set_signal(crowd, 0, 1, NULL);
    ff_crowd_remove_agent(crowd, agents[2], NULL);
    ff_crowd_remove_agent(crowd, agents[7], NULL);
    return crowd;
}

/* Its bytes; free() them. */
static inline unsigned char *ff_saved_bytes(const ff_crowd *crowd, size_t *size)
{
    *size = ff_crowd_save_size(crowd);
    unsigned char *data = malloc(*size);
    if (!data || ff_crowd_save(crowd, data, *size, NULL) != FF_OK) abort();
    return data;
}

/* Go on for some steps, look at everybody, put somebody in and save again. False when a pose is not finite. */
static inline bool ff_saved_use(ff_crowd *crowd, int steps)
{
    ff_agent agents[64], added;
    ff_agent_def def = ff_agent_def_default();
    def.goal = ff_v2(3.0, 0.0);
    ff_crowd_add_agent(crowd, &def, &added, NULL);
    for (int i = 0; i < steps; ++i)
        ff_crowd_step(crowd);
    bool finite = true;
    uint32_t count = ff_crowd_agents(crowd, agents, 64);
    for (uint32_t i = 0; i < count && i < 64; ++i) {
        ff_vec3 hips;
        ff_quat rotations[FF_PACK_MAX_JOINTS];
        if (ff_crowd_agent_pose(crowd, agents[i], &hips, rotations, NULL) != FF_OK) return false;
        finite = finite && isfinite(hips.x + hips.y + hips.z);
    }
    size_t size;
    free(ff_saved_bytes(crowd, &size));
    return finite && size > 0 && ff_crowd_state_hash(crowd) != 0;
}

#endif
