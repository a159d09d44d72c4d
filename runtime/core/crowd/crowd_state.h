/* crowd_state.h - all of a crowd's memory, taken from one arena at creation.
 *
 * State is arrays, grouped by the phase that touches them (all of one agent's navigation memory is read together, so it
 * is one record). Agents of the last step are seen through grid.seen only, a copy; each phase writes its own agent's
 * records and nothing else, so the order of agents and the number of threads cannot matter.
 */
#ifndef FF_CROWD_STATE_H
#define FF_CROWD_STATE_H

#include "runtime/core/base/tasks.h"
#include "runtime/core/behave/behave.h"
#include "runtime/core/crowd/crowd_arrays.h"
#include "runtime/core/crowd/crowd_footsteps.h"
#include "runtime/core/gait/body.h"
#include "runtime/core/gait/synth_choice.h"
#include "runtime/core/gait/synth_state.h"
#include "runtime/core/nav/nav.h"

struct ff_crowd {
    const ff_pack *pack;
    ff_crowd_def def;
    ff_blend_space *space;
    ff_tasks *own_tasks; /* NULL when the caller's scheduler is used */
    ff_arena arena;
    ff_hull hull;
    ff_hull clip_hull; /* of those who walk on the semi-procedural clip */
    ff_walls walls;
    ff_grid grid;
    ff_behaviour *behaviour;      /* NULL: agents have goals only */
    ff_footsteps *footsteps;      /* NULL: nobody moves by footsteps */
    ff_crowd_obstacle *obstacles; /* [max_obstacles] */
    ff_nav_mover *movers;         /* [max_obstacles], of this step: those that are not fixed */
    uint32_t mover_count;
    uint32_t obstacle_count;
    uint32_t stepper_count; /* agents who move by footsteps in this step */
    ff_crowd_timings timings;

    uint64_t steps;
    uint32_t agent_count;
    uint32_t slot_count; /* slots ever used; the others are untouched */
    uint32_t free_first; /* slot + 1 of the free slot that is taken next; 0 = none, a new one is */
    uint32_t unused;
    uint64_t added, spawned, left; /* as in ff_crowd_counts */

    /* Arrays of max_agents elements: each has a row in crowd_arrays.c. Per slot: */
    uint32_t *generation;
    uint32_t *alive;
    uint32_t *next_free; /* as free_first */
    uint32_t *number;    /* of agents added before */
    ff_traits *traits;
    ff_mind *minds;
    ff_choice *choices;
    ff_body *bodies;
    ff_vec2 *velocity; /* m/s, of the root over the last step */
    ff_gait *gaits;
    ff_rates *rates;      /* of this step, as the body realised them */
    ff_conduct *conducts; /* of a crowd with behaviour */
    ff_stepper *steppers; /* NULL: nobody moves by footsteps */

    uint32_t *firing; /* per slot, of this step, with behaviour: transition of its state, or FF_NONE */
    /* per agent of this step, in the grid's order */
    ff_seen *unsorted; /* in slot order */
    ff_neighbour (*neighbours)[FF_NEIGHBOURS_MAX];
    uint32_t *neighbour_count;

    uint32_t *live; /* slots of the live agents, in slot order: that is how memory is read the fastest */
};

/* Call run(context, chunk) for all chunks of FF_CROWD_CHUNK of count agents, on the crowd's threads. */
#define FF_CROWD_CHUNK 16
void ff_crowd_for_chunks(ff_crowd *crowd, uint32_t count, void (*run)(void *context, uint32_t chunk),
                         void *context);

/* s: processor time of a crowd on one thread, which others on the machine do not change, else wall clock. For reports
 * only. */
double ff_crowd_clock(const ff_crowd *crowd);

/* An error unless the point is within what a crowd can compute with. */
ff_status ff_crowd_check_place(ff_vec2 p, const char *what, ff_error *error);
/* FF_ERR_ARGUMENT unless the agent lives in the crowd. */
ff_status ff_crowd_check_agent(const ff_crowd *crowd, ff_agent agent, ff_error *error);
/* A wall; of_obstacle: one that stands for an obstacle, which those who plan see as it is. */
ff_status ff_crowd_put_wall(ff_crowd *crowd, ff_vec2 p, ff_vec2 q, bool of_obstacle, ff_error *error);
/* One that is known, and that the crowd has memory for (crowd_footsteps.c). */
ff_status ff_crowd_check_planner(const ff_crowd *crowd, ff_planner planner, ff_error *error);

#endif
