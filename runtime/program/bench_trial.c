#include "runtime/program/bench_trial.h"

#include "runtime/core/base/tasks.h"
#include "runtime/tool/progress.h"

#include <stdio.h>

ff_scene_navigation ff_contender_navigation(const ff_contender *contender)
{
    ff_scene_navigation navigation = ff_scene_navigation_default();
    navigation.method = contender->method;
    if (contender->aided)
        navigation.baseline =
            (ff_baseline_def){navigation.keep_right, navigation.mcn.padding, .model_velocity = true};
    return navigation;
}

static ff_status simulate(const ff_trial_set *set, const ff_scene_def *def, ff_scene *scene,
                          ff_simulation *simulation, ff_error *error)
{
    *simulation = (ff_simulation){.pack = set->pack,
                                  .scene = scene,
                                  .figure = set->figure,
                                  .threads = 1,
                                  .quiet = true,
                                  .tracks_only = true,
                                  .leave_walking = true};
    ff_status status = ff_scene_create(def, scene, error);
    return status == FF_OK ? ff_simulate(simulation, error) : status;
}

ff_status ff_trial_record(const ff_trial_set *set, const ff_scene_def *def, ff_scene *scene,
                          ff_simulation *simulation, ff_error *error)
{
    return simulate(set, def, scene, simulation, error);
}

static ff_status run_trial(const ff_trial_set *set, ff_trial *trial, ff_error *error)
{
    ff_scene scene;
    ff_simulation simulation;
    ff_status status = simulate(set, &trial->def, &scene, &simulation, error);
    if (status == FF_OK)
        status = ff_measures_take(&simulation.watch, &simulation.recording, &trial->measures, error);
    if (status == FF_OK) {
        const ff_crowd_timings *spent = &simulation.timings;
        double steps = ff_max(simulation.recording.step_count - 1.0, 1.0);
        double agent_steps = ff_max((double)simulation.watch.collisions.agent_steps, 1.0);
        trial->navigation_ms = 1e3 * (spent->snapshot + spent->neighbours + spent->navigation) / steps;
        trial->total_us = 1e6 * spent->total / agent_steps;
    }
    ff_simulation_free(&simulation);
    ff_scene_free(&scene);
    return status;
}

typedef struct trial_loop {
    const ff_trial_set *set;
    ff_trial *trials;
    ff_progress *progress;
} trial_loop;

static void run_one(void *context, uint32_t index)
{
    const trial_loop *loop = context;
    ff_trial *trial = &loop->trials[index];
    trial->status = run_trial(loop->set, trial, &trial->error);
    char item[96];
    snprintf(item, sizeof item, "%s, %lld agents, %s, seed %llu", ff_scene_kind_name(trial->def.kind),
             (long long)trial->def.agents, ff_navigation_name(trial->def.navigation.method),
             (unsigned long long)trial->def.seed);
    ff_progress_step(loop->progress, item);
}

ff_status ff_trials_run(const ff_trial_set *set, ff_trial *trials, uint32_t count, ff_error *error)
{
    ff_tasks *tasks = NULL;
    ff_status status = ff_tasks_create(set->threads, &tasks, error);
    if (status != FF_OK) return status;
    trial_loop loop = {set, trials, ff_progress_start("walking", count, set->quiet)};
    ff_tasks_for(tasks, count, 1, run_one, &loop);
    ff_progress_end(loop.progress);
    ff_tasks_destroy(tasks);
    for (uint32_t i = 0; i < count; ++i) {
        if (trials[i].status == FF_OK) continue;
        if (error) *error = trials[i].error;
        return trials[i].status;
    }
    return FF_OK;
}

ff_trial_mean ff_trials_mean(const ff_trial *trials, uint32_t count)
{
    ff_trial_mean out = {0};
    double share = count > 0 ? 1.0 / count : 0.0;
    for (uint32_t i = 0; i < count; ++i) {
        const ff_measures *m = &trials[i].measures;
        out.agents += m->agents;
        out.arrived += m->arrived;
        out.collision_rate += share * m->collision_rate;
        out.raw += share * m->raw;
        out.filtered += share * m->filtered;
        out.route += share * m->route;
        out.route_all += share * m->route_all;
        out.mean_arrival += share * m->mean_arrival;
        out.last_arrival += share * m->last_arrival;
        out.last_worst = ff_max(out.last_worst, m->last_arrival);
        out.deepest = ff_max(out.deepest, m->deepest);
        out.body_deepest = ff_max(out.body_deepest, m->body_deepest);
        out.pairs += share * (double)m->pairs;
        out.body_pairs += share * (double)m->body_pairs;
        out.slide_median += share * m->planted.median;
        out.slide_p95 += share * m->planted.p95;
        out.joint_speed = ff_max(out.joint_speed, m->joint_speed);
        out.navigation_ms += share * trials[i].navigation_ms;
        out.total_us += share * trials[i].total_us;
    }
    return out;
}
