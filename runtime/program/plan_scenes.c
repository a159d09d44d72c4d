#include "runtime/program/plan_scenes.h"

#include "runtime/core/base/fail.h"
#include "runtime/export/plan_picture.h"

#include <stdio.h>

enum { SCENES = 4, WALLS = 4, TEXT = 96 };

/* What is drawn, with the text that it owns. */
typedef struct sheet {
    ff_plan_scene scene[SCENES];
    char subtitle[SCENES][TEXT];
} sheet;

static bool add_print(ff_array *to, ff_vec2 at, double yaw, uint32_t agent, uint32_t foot)
{
    ff_stood_print *print = ff_array_grow(to, 1, sizeof *print);
    if (print) *print = (ff_stood_print){at, yaw, agent, foot};
    return print != NULL;
}

/* Landings of the steps from `first` on. */
static bool add_plan(ff_array *to, const ff_action_set *set, const ff_plan *plan, uint32_t first,
                     uint32_t agent)
{
    bool good = true;
    for (uint32_t i = first; i < plan->count && good; ++i) {
        const ff_plan_step *step = &plan->steps[i];
        if (step->hold && i > 0) continue;
        ff_footprint print = ff_plan_landing(set, step);
        good = add_print(to, print.ball, print.yaw, agent, ff_action_set_record(set, step->action)->swing);
    }
    return good;
}

/* Plans on and on until the goal, drawn as one way of agent 0. */
static bool walk(ff_plan_scene *scene, char *subtitle, const ff_plan_street *street,
                 const ff_plan_world *world, const ff_plan_goal *goal)
{
    ff_plan plan;
    ff_plan_options options = ff_plan_options_default();
    if (goal->field) options.inflation = 3.0;
    ff_plan_stand(street->set, ff_v2(0.0, 0.0), 0.0, -1.0, &plan);
    bool good = add_print(&scene->goals, goal->at, 0.0, 0, 0) &&
                add_print(&scene->bodies, ff_v2(0.0, 0.0), 0.0, 0, 0);
    uint32_t expanded = 0, plans = 0;
    double time = 0.0;
    for (; plans < 20 && good; ++plans) {
        ff_plan_result result =
            ff_plan_search(street->set, world, &plan, time, goal, &options, street->scratch, &plan);
        expanded += result.expanded;
        bool last = result.outcome == FF_PLAN_REACHED || result.outcome == FF_PLAN_NONE || plan.stop == 0;
        ff_plan part = plan;
        if (!last) part.count = plan.stop;
        good = add_plan(&scene->planned, street->set, &part, plans > 0, 0);
        if (last) break;
        time = plan.steps[plan.stop - 1].start + 0.01;
    }
    snprintf(subtitle, TEXT, "%u plans one after the other, %u nodes", plans + 1, expanded);
    return good;
}

static ff_status draw_walled(sheet *s, int number, const ff_plan_street *street, const ff_vec2 (*walls)[2],
                             uint32_t count, ff_vec2 to, ff_error *error)
{
    ff_solids *solids = NULL;
    ff_field *field = NULL;
    ff_plan_scene *scene = &s->scene[number];
    ff_vec2(*drawn)[2] = ff_array_grow(&scene->walls, count, sizeof *drawn);
    if (!drawn) return ff_fail(error, FF_ERR_NO_MEMORY, "a drawing of plans");
    for (uint32_t i = 0; i < 2 * count; ++i)
        drawn[i / 2][i % 2] = walls[i / 2][i % 2];
    ff_status status = ff_solids_create(walls, count, NULL, 0, &solids, error);
    if (status == FF_OK) status = ff_field_create(solids, to, 12.0, 0.5, &field, error);
    ff_plan_goal goal = ff_plan_goal_at(to);
    goal.field = field;
    if (status == FF_OK &&
        !walk(scene, s->subtitle[number], street, &(ff_plan_world){.solids = solids}, &goal))
        status = ff_fail(error, FF_ERR_NO_MEMORY, "a drawing of plans");
    ff_field_destroy(field);
    ff_solids_destroy(solids);
    return status;
}

static ff_status draw_street(sheet *s, int number, const ff_plan_street *street, ff_error *error)
{
    ff_plan_scene *scene = &s->scene[number];
    ff_plan_goal goal = ff_plan_goal_at(ff_v2(5.0, 0.0));
    const ff_plan_world world = {.tracks = street->list, .track_count = street->count};
    bool good = walk(scene, s->subtitle[number], street, &world, &goal);
    for (uint32_t i = 0; i < street->count && good; ++i)
        good = add_plan(&scene->planned, street->set, &street->plans[i], 0, i + 1);
    return good ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "a drawing of plans");
}

ff_status ff_plan_scenes_write(const char *path, const ff_plan_street *empty, const ff_plan_street *few,
                               const ff_plan_street *many, ff_error *error)
{
    static const ff_vec2 slalom[WALLS][2] = {{{1.6, -3.5}, {1.6, 0.3}},
                                             {{1.6, 1.8}, {1.6, 3.5}},
                                             {{3.4, -3.5}, {3.4, -1.8}},
                                             {{3.4, -0.3}, {3.4, 3.5}}};
    static const ff_vec2 trap[][2] = {
        {{-1.2, -1.7}, {1.5, -1.7}}, {{1.5, -1.7}, {1.5, 1.7}}, {{1.5, 1.7}, {-1.2, 1.7}}};
    static const char *const titles[SCENES] = {"Through two gaps of 1.5 m",
                                               "Out of a trap, by the distance field",
                                               "Among 8 people who walk", "Among 64"};
    sheet s = {0};
    for (int i = 0; i < SCENES; ++i) {
        s.scene[i].title = titles[i];
        s.scene[i].subtitle = s.subtitle[i];
    }
    ff_status status = draw_walled(&s, 0, empty, slalom, WALLS, ff_v2(5.0, 0.0), error);
    if (status == FF_OK) status = draw_walled(&s, 1, empty, trap, 3, ff_v2(4.0, 0.0), error);
    if (status == FF_OK) status = draw_street(&s, 2, few, error);
    if (status == FF_OK) status = draw_street(&s, 3, many, error);
    if (status == FF_OK) status = ff_plan_picture_write(path, s.scene, SCENES, error);
    for (int i = 0; i < SCENES; ++i)
        ff_plan_scene_free(&s.scene[i]);
    return status;
}
