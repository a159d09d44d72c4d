/* crowd_state.h - all of a crowd's memory, taken from one arena at creation.
 *
 * State is arrays, grouped by the phase that touches them (all of one agent's navigation memory is read together, so it
 * is one record). Agents of the last step are seen through grid.seen only, a copy; each phase writes its own agent's
 * records and nothing else, so the order of agents and the number of threads cannot matter.
 */
#ifndef FF_CROWD_STATE_H
#define FF_CROWD_STATE_H

#include "runtime/core/base/tasks.h"
#include "runtime/core/body.h"
#include "runtime/core/nav.h"

struct ff_crowd {
    const ff_pack *pack;
    ff_crowd_def def;
    ff_blend_space *space;
    ff_tasks *own_tasks; /* NULL when the caller's scheduler is used */
    ff_arena arena;
    ff_hull hull;
    ff_walls walls;
    ff_grid grid;
    size_t gait_size;
    ff_crowd_timings timings;

    uint64_t steps;
    uint32_t agent_count;
    uint32_t slot_count; /* slots ever used; the others are untouched */
    uint32_t free_count;
    uint32_t *free_slots;

    /* per slot */
    uint32_t *generation;
    uint32_t *alive;
    ff_traits *traits;
    ff_mind *minds;
    ff_body *bodies;
    ff_vec2 *velocity; /* m/s, of the root over the last step */
    unsigned char *gaits;

    /* per agent of this step, in the grid's order */
    ff_seen *unsorted; /* in slot order */
    ff_neighbour (*neighbours)[FF_NEIGHBOURS_MAX];
    uint32_t *neighbour_count;
};

static inline ff_gait *ff_crowd_gait(const ff_crowd *crowd, uint32_t slot)
{
    return (ff_gait *)(void *)(crowd->gaits + slot * crowd->gait_size);
}

#endif
