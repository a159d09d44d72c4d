/* scene_people.c - who is in a scene beside those that its kind places: groups in their regions, and those that spawners will
 * put in while it runs. */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/random.h"
#include "runtime/core/behave/behave.h"
#include "runtime/export/scene.h"

#include <string.h>

#define AGENTS_MOST 20000
#define PLACES 400     /* that are tried for one of a group */
#define GAP 0.05       /* m between two of them */
#define LATE_SHARE 1.3 /* spawners put in people at random: as many times more than expected, */
#define LATE_MORE 20.0 /* and so many */
#define STREAM_GROUP 3 /* of the scene's seed */

static bool is_free(const ff_scene *scene, ff_vec2 place, double radius)
{
    for (uint32_t i = 0; i < ff_scene_agent_count(scene); ++i) {
        const ff_scene_agent *other = &ff_scene_agents(scene)[i];
        double reach = radius + other->radius + GAP;
        ff_vec2 apart = ff_sub2(place, other->position);
        if (ff_dot2(apart, apart) < reach * reach) return false;
    }
    return true;
}

static ff_status place_one(const ff_scene_def *def, const ff_scene_group *group, uint32_t number,
                           ff_random *random, ff_scene *scene, ff_error *error)
{
    ff_scene_agent one = {.preferred_speed =
                              ff_clamp(ff_amount_draw(&group->preferred_speed, random), 0.1, 4.0),
                          .radius = ff_clamp(ff_amount_draw(&group->radius, random), 0.1, 1.0),
                          .goal_tolerance = def->goal_tolerance,
                          .machine = group->machine,
                          .group = number};
    bool found = false;
    for (int i = 0; i < PLACES && !found; ++i) {
        one.position = ff_region_point(&group->place, one.radius, random);
        found = is_free(scene, one.position, one.radius);
    }
    if (!found)
        return ff_fail(error, FF_ERR_ARGUMENT,
                       "no room for %u people in the place of group %u: make it larger, or them fewer",
                       group->count, number + 1);
    one.goal = one.position;
    one.heading = isnan(group->heading) ? ff_random_range(random, -FF_PI, FF_PI) : group->heading;
    ff_scene_agent *agent = ff_array_grow(&scene->agents, 1, sizeof *agent);
    if (!agent) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for groups of agents");
    *agent = one;
    return FF_OK;
}

static void count_most(ff_scene *scene)
{
    const ff_spawner_def *spawners = scene->behaviour.spawners.data;
    double most = (double)scene->agents.count, numbers = most;
    for (size_t i = 0; i < scene->behaviour.spawners.count; ++i) {
        double in_all = floor(LATE_SHARE * spawners[i].rate * scene->seconds + LATE_MORE);
        if (spawners[i].total > 0) in_all = ff_min(in_all, spawners[i].total);
        numbers += in_all;
        most += spawners[i].most > 0 ? ff_min(in_all, spawners[i].most) : in_all;
    }
    scene->most = (uint32_t)ff_min(most, 1e9);
    scene->most_numbers = (uint32_t)ff_min(numbers, 1e9);
}

ff_status ff_scene_place_people(const ff_scene_def *def, ff_scene *scene, ff_error *error)
{
    const ff_scene_group *groups = def->crowds.data;
    uint32_t first = 0;
    for (size_t i = 0; i < scene->agents.count; ++i)
        if (ff_scene_agents(scene)[i].group >= first) first = ff_scene_agents(scene)[i].group + 1;
    for (uint32_t g = 0; g < def->crowds.count; ++g) {
        ff_random random = {def->seed, STREAM_GROUP, (uint64_t)g << 32};
        for (uint32_t i = 0; i < groups[g].count; ++i) {
            ff_status status = place_one(def, &groups[g], first + g, &random, scene, error);
            if (status != FF_OK) return status;
        }
    }
    scene->groups = first + (uint32_t)(def->crowds.count + def->behaviour.spawners.count);
    count_most(scene);
    if (scene->most_numbers <= AGENTS_MOST) return FF_OK;
    return ff_fail(
        error, FF_ERR_RANGE,
        "with its spawners the scene may have %u people in all; at most %d can be kept: give spawners a "
        "\"total\", or let it run for fewer seconds",
        scene->most_numbers, AGENTS_MOST);
}

ff_status ff_scene_add_spawned(ff_scene *scene, const ff_agent_state *state, uint32_t spawner,
                               ff_error *error)
{
    uint32_t count = ff_scene_agent_count(scene), spawners = (uint32_t)scene->behaviour.spawners.count;
    if (state->number >= scene->most_numbers)
        return ff_fail(error, FF_ERR_RANGE,
                       "more than the %u people that the scene's spawners were expected to put in",
                       scene->most_numbers);
    ff_scene_agent row = {.position = state->position,
                          .goal = state->goal,
                          .heading = state->heading,
                          .radius = state->radius,
                          .group = spawner < spawners ? scene->groups - spawners + spawner : 0};
    /* Numbers before it may be of those who came at the same moment and are seen later, or had gone when a saved crowd
     * went on: rows without a radius. */
    if (state->number >= count) {
        size_t more = state->number + 1 - count;
        ff_scene_agent *blank = ff_array_grow(&scene->agents, more, sizeof *blank);
        if (!blank) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for another agent");
        memset(blank, 0, more * sizeof *blank);
    }
    ((ff_scene_agent *)scene->agents.data)[state->number] = row;
    return FF_OK;
}
