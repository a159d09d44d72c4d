#define _POSIX_C_SOURCE 199309L
#include "runtime/program/footstep_trial.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/random.h"
#include "runtime/core/plan_body.h"
#include "runtime/export/body_contacts.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#define APART 1.2     /* m, between starting places of a crossing, less where it is dense */
#define NEAR 2.2      /* m between roots, beyond which bodies do not touch */
#define FOUR_FAR 4.0  /* m from the middle */
#define FOUR_OFF 0.6  /* m, by which starts and goals of the four are off */
#define GOAL_NEAR 0.1 /* m: nearer than that there is no direction to the goal */
#define TRIES 400     /* for a free starting place */

typedef struct walker {
    ff_agent agent;
    ff_vec2 start, goal;
    double arrived; /* s; < 0: not yet */
    ff_vec2 position;
    ff_cylinders body;
    ff_body_capsule capsules[FF_BODY_CAPSULES];
    double reach; /* m, from the position, of all capsules */
} walker;

typedef struct run {
    const ff_walk_trial *trial;
    const ff_pack *pack;
    const ff_figure *figure;
    ff_crowd *crowd;
    walker *walkers;
    double *frame; /* s, per step */
    double *work;  /* s of the processors, per step: what a frame takes whatever else the machine does */
    ff_matrix *matrices;
    ff_random random;
    double side; /* m, of a crossing */
    ff_walk_measures out;
    double walked, toward, contact, body_contact;
} run;

static double now(clockid_t clock)
{
    struct timespec time;
    clock_gettime(clock, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* ------------------------------------------------------------------------------------------------- people */

static ff_vec2 somewhere(run *r)
{
    double a = ff_random_range(&r->random, -0.5, 0.5);
    return ff_v2(r->side * a, r->side * ff_random_range(&r->random, -0.5, 0.5));
}

static ff_vec2 free_place(run *r, uint32_t count)
{
    double apart = ff_min(APART, 0.55 / sqrt(r->trial->density));
    ff_vec2 at = somewhere(r);
    for (int k = 0; k < TRIES; ++k, at = somewhere(r)) {
        bool free_one = true;
        for (uint32_t i = 0; i < count && free_one; ++i)
            free_one = ff_length2(ff_sub2(r->walkers[i].start, at)) >= apart;
        if (free_one) break;
    }
    return at;
}

static void place_walker(run *r, uint32_t i)
{
    const ff_walk_trial *t = r->trial;
    walker *w = &r->walkers[i];
    if (t->scene == FF_WALK_CROSSING) {
        w->start = free_place(r, i);
        w->goal = somewhere(r);
        return;
    }
    bool four = t->scene == FF_WALK_FOUR;
    double radius = four ? FOUR_FAR : ff_max(4.0, 0.16 * t->agents), off = four ? FOUR_OFF / radius : 0.01;
    double angle = FF_TAU * i / t->agents + ff_random_range(&r->random, -off, off);
    double turn = four ? ff_random_range(&r->random, -off, off) : 0.0;
    w->start = ff_scale2(ff_fwd2(angle), radius);
    w->goal = ff_scale2(ff_fwd2(angle + FF_PI + turn), radius);
}

static ff_status add_walkers(run *r, ff_error *error)
{
    ff_status status = FF_OK;
    for (uint32_t i = 0; i < r->trial->agents && status == FF_OK; ++i) {
        walker *w = &r->walkers[i];
        place_walker(r, i);
        ff_agent_def def = ff_agent_def_default();
        ff_vec2 way = ff_sub2(w->goal, w->start);
        def.position = w->start;
        def.goal = w->goal;
        def.heading = ff_atan2(way.b, way.a);
        if (r->trial->mixed && i % 2 == 1) def.planner = FF_PLANNER_VELOCITY;
        w->arrived = -1.0;
        status = ff_crowd_add_agent(r->crowd, &def, &w->agent, error);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------- measuring */

static int by_place(const void *x, const void *y)
{
    double p = *(const double *)x, q = *(const double *)y;
    return (p > q) - (p < q);
}

typedef struct placed {
    double a;
    uint32_t index;
} placed;

/* The capsules of a body, and how far from its place they get. */
static void look_at_body(const run *r, walker *w, const ff_vec3 *joints, const ff_quat *turned)
{
    w->reach = 0.0;
    ff_body_capsules(r->pack, joints, turned, w->capsules);
    for (int i = 0; i < FF_BODY_CAPSULES; ++i) {
        const ff_body_capsule *c = &w->capsules[i];
        double from = ff_length2(ff_sub2(ff_plane(c->from), w->position));
        double to = ff_length2(ff_sub2(ff_plane(c->to), w->position));
        w->reach = ff_max(w->reach, ff_max(from, to) + c->radius);
    }
}

static void count_contact(run *r, const walker *p, const walker *q)
{
    double deep = ff_cylinders_overlap(&p->body, &q->body);
    if (deep > 0.0) r->contact += r->trial->step;
    r->out.deepest = ff_max(r->out.deepest, deep);
    double apart = ff_length2(ff_sub2(p->position, q->position));
    if (!r->trial->bodies || apart >= p->reach + q->reach) return;
    deep = -ff_bodies_gap(p->capsules, q->capsules);
    if (deep > 0.0) r->body_contact += r->trial->step;
    r->out.body_deepest = ff_max(r->out.body_deepest, deep);
}

/* Pairs whose bodies touch, by a sweep along one axis. */
static ff_status count_contacts(run *r, ff_error *error)
{
    uint32_t n = r->trial->agents;
    placed *order = ff_calloc(n, sizeof *order);
    if (!order) return ff_fail(error, FF_ERR_NO_MEMORY, "a trial of %u agents", n);
    for (uint32_t i = 0; i < n; ++i)
        order[i] = (placed){r->walkers[i].position.a, i};
    qsort(order, n, sizeof *order, by_place);
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = i + 1; j < n && order[j].a - order[i].a < NEAR; ++j) {
            const walker *p = &r->walkers[order[i].index], *q = &r->walkers[order[j].index];
            if (fabs(p->position.b - q->position.b) < NEAR) count_contact(r, p, q);
        }
    free(order);
    return FF_OK;
}

static void look_at(run *r, walker *w, double time)
{
    ff_agent_state state;
    ff_vec3 hips, joints[FF_FIGURE_MAX_JOINTS];
    ff_quat rotations[FF_FIGURE_MAX_JOINTS], turned[FF_FIGURE_MAX_JOINTS];
    ff_crowd_agent_state(r->crowd, w->agent, &state, NULL);
    ff_crowd_agent_pose(r->crowd, w->agent, &hips, rotations, NULL);
    ff_figure_place(r->figure, hips, rotations, joints, turned);
    w->body = ff_cylinders_of_colliders(r->pack, joints, turned);
    w->position = state.position;
    if (r->trial->bodies) look_at_body(r, w, joints, turned);
    r->out.agent_seconds += r->trial->step;
    if (state.reached && w->arrived < 0.0) w->arrived = time;
    if (state.reached && r->trial->scene == FF_WALK_CROSSING) {
        w->goal = somewhere(r);
        ff_crowd_set_goal(r->crowd, w->agent, w->goal, NULL);
    }
    ff_vec2 way = ff_sub2(state.goal, state.position);
    double far = ff_length2(way);
    if (state.reached || far < GOAL_NEAR) return;
    r->walked += r->trial->step;
    r->toward += ff_dot2(state.velocity, way) / far * r->trial->step;
}

static ff_status take_shot(run *r, uint32_t step, uint32_t steps, ff_error *error)
{
    const ff_walk_trial *t = r->trial;
    for (uint32_t i = 0; i < t->shot_count; ++i) {
        uint32_t until = (uint32_t)((uint64_t)steps * (i + 1) / (t->shot_count + 1));
        if (step > until) continue;
        ff_agent *agents = ff_calloc(t->agents, sizeof *agents);
        if (!agents) return ff_fail(error, FF_ERR_NO_MEMORY, "a picture of %u agents", t->agents);
        for (uint32_t k = 0; k < t->agents; ++k)
            agents[k] = r->walkers[k].agent;
        ff_status status = ff_plan_scene_look(&t->shots[i], r->crowd, agents, t->agents, error);
        free(agents);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

static ff_status step_crowd(run *r, uint32_t step, uint32_t steps, ff_error *error)
{
    static const ff_vec2 origin = {0.0, 0.0};
    double start = now(CLOCK_MONOTONIC), began = now(CLOCK_PROCESS_CPUTIME_ID);
    ff_crowd_step(r->crowd);
    ff_status status = ff_crowd_matrices(r->crowd, origin, r->matrices, r->trial->agents, error);
    r->work[step] = now(CLOCK_PROCESS_CPUTIME_ID) - began;
    r->frame[step] = now(CLOCK_MONOTONIC) - start;
    for (uint32_t i = 0; i < r->trial->agents && status == FF_OK; ++i)
        look_at(r, &r->walkers[i], (step + 1) * r->trial->step);
    if (status == FF_OK) status = count_contacts(r, error);
    if (status == FF_OK && r->trial->shots) status = take_shot(r, step, steps, error);
    return status;
}

static void sum_counts(const run *r, ff_plan_counts *sum)
{
    for (uint32_t i = 0; i < r->trial->agents; ++i) {
        ff_plan_counts one;
        ff_crowd_agent_plan_counts(r->crowd, r->walkers[i].agent, &one, NULL);
        for (int e = 0; e < FF_EVENT_PLAN_COUNT; ++e)
            sum->events[e] += one.events[e];
        sum->searches += one.searches;
        sum->plans += one.plans;
        sum->failed += one.failed;
        sum->conflicting += one.conflicting;
        sum->reactions += one.reactions;
        sum->nodes += one.nodes;
        sum->without_plan += one.without_plan;
    }
}

/* ms; sorts them. */
static ff_walk_times times_of(double *seconds, uint32_t steps)
{
    double total = 0.0;
    for (uint32_t i = 0; i < steps; ++i)
        total += seconds[i];
    qsort(seconds, steps, sizeof *seconds, by_place);
    return (ff_walk_times){1e3 * total / steps, 1e3 * seconds[(uint32_t)(0.99 * (steps - 1))],
                           1e3 * seconds[steps - 1]};
}

static void finish(run *r, uint32_t steps)
{
    ff_walk_measures *out = &r->out;
    out->frame_ms = times_of(r->frame, steps);
    out->work_ms = times_of(r->work, steps);
    out->plan_ms_mean = 1e3 * ff_crowd_time_spent(r->crowd).planning / steps;
    out->overlap = 100.0 * r->contact / out->agent_seconds;
    out->body_overlap = 100.0 * r->body_contact / out->agent_seconds;
    out->speed_to_goal = r->walked > 0.0 ? r->toward / r->walked : 0.0;
    for (uint32_t i = 0; i < r->trial->agents; ++i) {
        if (r->walkers[i].arrived < 0.0) continue;
        ++out->arrived;
        out->mean_arrival += r->walkers[i].arrived;
        out->last_arrival = ff_max(out->last_arrival, r->walkers[i].arrived);
    }
    if (out->arrived > 0) out->mean_arrival /= out->arrived;
    sum_counts(r, &out->counts);
    out->no_plan = out->counts.without_plan;
}

ff_status ff_walk_trial_run(const ff_pack *pack, const ff_figure *figure, const ff_walk_trial *trial,
                            ff_walk_measures *out, ff_error *error)
{
    uint32_t steps = (uint32_t)(trial->seconds / trial->step + 0.5);
    run r = {.trial = trial, .pack = pack, .figure = figure, .random = {trial->seed, 0x666f6f74u, 0}};
    r.side = sqrt(trial->agents / ff_max(trial->density, 1e-3));
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = trial->agents;
    def.step = trial->step;
    def.seed = trial->seed;
    def.threads = trial->threads;
    def.planner = trial->planner;
    def.footsteps = trial->footsteps;
    r.walkers = ff_calloc(trial->agents, sizeof *r.walkers);
    r.frame = ff_calloc(steps, sizeof *r.frame);
    r.work = ff_calloc(steps, sizeof *r.work);
    r.matrices = ff_calloc((size_t)trial->agents * ff_pack_joint_count(pack), sizeof *r.matrices);
    ff_status status = FF_OK;
    if (!r.walkers || !r.frame || !r.work || !r.matrices)
        status = ff_fail(error, FF_ERR_NO_MEMORY, "a trial of %u agents", trial->agents);
    if (status == FF_OK) status = ff_crowd_create(pack, &def, &r.crowd, error);
    if (status == FF_OK) status = add_walkers(&r, error);
    for (uint32_t i = 0; i < steps && status == FF_OK; ++i)
        status = step_crowd(&r, i, steps, error);
    if (status == FF_OK) {
        finish(&r, steps);
        *out = r.out;
    }
    ff_crowd_destroy(r.crowd);
    free(r.walkers);
    free(r.frame);
    free(r.work);
    free(r.matrices);
    return status;
}
