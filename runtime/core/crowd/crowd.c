/* Crowds: their memory, the velocities their pack allows, and walls. */
#include "runtime/core/crowd/crowd_def.h"
#include "runtime/core/plan/plan_solids.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>

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
    ff_status status = ff_crowd_check_def(pack, def, error);
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
