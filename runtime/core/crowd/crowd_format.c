#include "runtime/core/crowd/crowd_format.h"

#include <string.h>

static ff_section_kind optional(const char *name, size_t size)
{
    uint32_t tag;
    memcpy(&tag, name, sizeof tag);
    return (ff_section_kind){tag, (uint32_t)size, 0, 0};
}

uint32_t ff_crowd_section_kinds(ff_section_kind kinds[FF_SECTIONS_MAX])
{
    uint32_t count = 0;
    kinds[count++] = (ff_section_kind){FF_SECTION_CROWD_HEAD, sizeof(ff_saved_head), 1, 1};
    kinds[count++] = (ff_section_kind){FF_SECTION_CROWD_DEF, sizeof(ff_saved_def), 1, 1};
    kinds[count++] = (ff_section_kind){FF_SECTION_CROWD_WALL, sizeof(ff_saved_wall), 0, 1};
    kinds[count++] = (ff_section_kind){FF_SECTION_CROWD_SPAWN, sizeof(ff_spawning), 0, 0};
    kinds[count++] = (ff_section_kind){FF_SECTION_CROWD_SHOWN, sizeof(uint32_t), 0, 0};
    kinds[count++] = (ff_section_kind){FF_SECTION_CROWD_OBST, sizeof(ff_crowd_obstacle), 0, 0};
    for (uint32_t i = 0; i < FF_BEHAVIOUR_ARRAYS; ++i)
        kinds[count++] = optional(ff_behaviour_arrays[i].name, ff_behaviour_arrays[i].size);
    for (uint32_t i = 0; i < ff_crowd_array_count(); ++i) {
        const ff_crowd_array *array = ff_crowd_array_at(i);
        if (array->kind == FF_ARRAY_STEP) continue;
        kinds[count++] = optional(array->name, array->size);
    }
    return count;
}

ff_section_format ff_crowd_file_format(const ff_section_kind *kinds, uint32_t count)
{
    return (ff_section_format){FF_CROWD_MAGIC,
                               FF_CROWD_VERSION,
                               kinds,
                               count,
                               "saved crowd",
                               "FOOTDCRW",
                               "make one with footfall-crowd run --save",
                               "save it again with this program",
                               "copy or save it again"};
}

/* ------------------------------------------------------------------------------------------- definition */

/* A member more or less: save and load it here, then put the new size. */
_Static_assert(sizeof(void *) != 8 || sizeof(ff_crowd_def) == 264, "is all of a definition saved?");

enum { MCN_PARTS = 11 };

static void mcn_switches(ff_mcn_def *mcn, bool *out[MCN_PARTS])
{
    bool *all[MCN_PARTS] = {&mcn->hull,    &mcn->sharp_turn, &mcn->stance,  &mcn->forces,
                            &mcn->density, &mcn->weighted,   &mcn->gradual, &mcn->back_pedal,
                            &mcn->lean,    &mcn->progress,   &mcn->make_way};
    memcpy(out, all, sizeof all);
}

ff_saved_def ff_crowd_def_pack(const ff_crowd_def *def)
{
    ff_saved_def saved = {.step = def->step,
                          .seed = def->seed,
                          .max_agents = def->max_agents,
                          .max_walls = def->max_walls,
                          .navigation = def->navigation,
                          .synthesis = def->synthesis,
                          .facing = def->mcn.facing,
                          .model_velocity = def->baseline.model_velocity,
                          .behaviour = def->behaviour != NULL,
                          .keep_right = def->keep_right,
                          .body_scale = def->body_scale,
                          .padding = def->mcn.padding,
                          .prediction = def->mcn.prediction,
                          .baseline_keep_right = def->baseline.keep_right,
                          .baseline_padding = def->baseline.padding,
                          .plan_seconds = def->footsteps.seconds,
                          .plan_expiry = def->footsteps.expiry,
                          .plan_margin = def->footsteps.margin,
                          .proximity_cost = def->footsteps.proximity_cost,
                          .planner = def->planner,
                          .footsteps = (uint32_t)def->footsteps.mixed | (uint32_t)def->footsteps.paper << 1,
                          .nodes = def->footsteps.nodes,
                          .plans = def->footsteps.plans,
                          .actions = def->footsteps.actions,
                          .expiry_actions = def->footsteps.expiry_actions,
                          .max_obstacles = def->max_obstacles};
    memcpy(saved.speed_variations, def->footsteps.speed_variations, sizeof saved.speed_variations);
    ff_mcn_def mcn = def->mcn;
    bool *parts[MCN_PARTS];
    mcn_switches(&mcn, parts);
    for (uint32_t i = 0; i < MCN_PARTS; ++i)
        saved.mcn_parts |= (uint32_t)*parts[i] << i;
    return saved;
}

bool ff_crowd_def_unpack(const ff_saved_def *saved, ff_crowd_def *out)
{
    if (saved->navigation > FF_NAVIGATION_SF || saved->synthesis > FF_SYNTHESIS_HYBRID ||
        saved->facing > FF_FACING_COMMAND || saved->mcn_parts >> MCN_PARTS != 0 ||
        saved->planner > FF_PLANNER_FOOTSTEPS || saved->footsteps > 3 || saved->model_velocity > 1 ||
        saved->behaviour > 1)
        return false;
    *out = ff_crowd_def_default();
    out->max_agents = saved->max_agents;
    out->max_walls = saved->max_walls;
    out->step = saved->step;
    out->seed = saved->seed;
    out->keep_right = saved->keep_right;
    out->body_scale = saved->body_scale;
    out->navigation = (ff_navigation)saved->navigation;
    out->synthesis = (ff_synthesis)saved->synthesis;
    out->baseline =
        (ff_baseline_def){saved->baseline_keep_right, saved->baseline_padding, saved->model_velocity != 0};
    bool *parts[MCN_PARTS];
    mcn_switches(&out->mcn, parts);
    for (uint32_t i = 0; i < MCN_PARTS; ++i)
        *parts[i] = (saved->mcn_parts >> i & 1u) != 0;
    out->mcn.facing = (ff_facing)saved->facing;
    out->mcn.padding = saved->padding;
    out->mcn.prediction = saved->prediction;
    out->planner = (ff_planner)saved->planner;
    out->footsteps = (ff_footsteps_def){.mixed = (saved->footsteps & 1u) != 0,
                                        .paper = (saved->footsteps & 2u) != 0,
                                        .nodes = saved->nodes,
                                        .seconds = saved->plan_seconds,
                                        .plans = saved->plans,
                                        .actions = saved->actions,
                                        .expiry = saved->plan_expiry,
                                        .expiry_actions = saved->expiry_actions,
                                        .margin = saved->plan_margin,
                                        .proximity_cost = saved->proximity_cost};
    memcpy(out->footsteps.speed_variations, saved->speed_variations, sizeof saved->speed_variations);
    out->max_obstacles = saved->max_obstacles;
    return true;
}
