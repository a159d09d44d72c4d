/* Spawners: people who come into a crowd by themselves. */
#include "runtime/core/crowd/crowd_behave.h"

#define KEYS 0x73706177u /* stream of the crowd's seed that spawners draw from */
#define PLACES 8         /* that are tried at a time */
#define GAP 0.1          /* m to others */
#define WALLS_WITHIN 0.05

static bool is_free(const ff_crowd *crowd, ff_vec2 place, double radius)
{
    const ff_wall *walls[FF_NEAR_WALLS_MAX];
    if (ff_walls_near(&crowd->walls, place, radius + WALLS_WITHIN, walls) > 0) return false;
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        if (!crowd->alive[slot]) continue;
        double reach = radius + crowd->traits[slot].radius + GAP;
        ff_vec2 apart = ff_sub2(place, crowd->bodies[slot].position);
        if (ff_dot2(apart, apart) < reach * reach) return false;
    }
    return true;
}

static bool may_put_in(const ff_crowd *crowd, const ff_spawner_def *def, const ff_spawning *spawning)
{
    return crowd->agent_count < crowd->def.max_agents && (def->total == 0 || spawning->put_in < def->total) &&
           (def->most == 0 || spawning->alive < def->most);
}

static bool put_in(ff_crowd *crowd, uint32_t spawner)
{
    const ff_spawner_def *def = &crowd->behaviour->def.spawners[spawner];
    ff_spawning *spawning = &crowd->behaviour->spawning[spawner];
    ff_random random = {crowd->def.seed, KEYS + spawner, spawning->draws};
    ff_agent_def agent = ff_agent_def_default();
    agent.preferred_speed = ff_clamp(ff_amount_draw(&def->preferred_speed, &random), 0.1, 4.0);
    agent.radius = ff_clamp(ff_amount_draw(&def->radius, &random), 0.05, 1.5);
    agent.heading = def->heading;
    agent.machine = def->machine;
    bool found = false;
    for (int i = 0; i < PLACES && !found; ++i) {
        agent.position = agent.goal = ff_region_point(&def->place, agent.radius, &random);
        found = is_free(crowd, agent.position, agent.radius);
    }
    spawning->draws = random.counter;
    ff_agent out;
    if (!found || ff_crowd_put(crowd, &agent, spawner, &out, NULL) != FF_OK) return false;
    ++spawning->put_in;
    ++spawning->alive;
    ++crowd->spawned;
    return true;
}

void ff_crowd_spawn(ff_crowd *crowd)
{
    for (uint32_t i = 0; i < crowd->behaviour->def.spawner_count; ++i) {
        const ff_spawner_def *def = &crowd->behaviour->def.spawners[i];
        ff_spawning *spawning = &crowd->behaviour->spawning[i];
        double expected = def->rate * crowd->def.step;
        ff_random random = {crowd->def.seed, KEYS + i, spawning->draws};
        if (def->regular) {
            spawning->due += expected;
        } else { /* at most one in a step: as often on average, and never two at one moment */
            spawning->due += ff_random_unit(&random) < expected;
            spawning->draws = random.counter;
        }
        /* Who finds no room waits; but nobody queues outside of a scene that has as many as it shall have. */
        while (spawning->due >= 1.0 && may_put_in(crowd, def, spawning) && put_in(crowd, i))
            spawning->due -= 1.0;
        if (!may_put_in(crowd, def, spawning)) spawning->due = ff_min(spawning->due, 1.0);
        spawning->due = ff_min(spawning->due, 1000.0);
    }
}
