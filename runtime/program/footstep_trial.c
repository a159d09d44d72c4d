#define _POSIX_C_SOURCE 199309L
#include "runtime/program/footstep_trial.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/random.h"

#include <stdlib.h>
#include <time.h>

#define APART 1.2     /* m, between starting places of a crossing, less where it is dense */
#define FOUR_FAR 4.0  /* m from the middle */
#define FOUR_OFF 0.6  /* m, by which starts and goals of the four are off */
#define GOAL_NEAR 0.1 /* m: nearer than that there is no direction to the goal */
#define TRIES 400     /* for a free starting place */
#define ABREAST 6     /* of a stream */
#define ROW_GAP 1.1   /* m, of a stream both ways, give or take ROW_OFF */
#define ROW_OFF 0.15
#define STREAM_FAR 3.0    /* m from the middle to the front row */
#define DRAWN_SECONDS 8.0 /* by then everybody in a picture has met everybody */

typedef struct walker {
    ff_agent agent;
    ff_vec2 start, goal;
    double arrived; /* s; < 0: not yet */
} walker;

typedef struct run {
    const ff_walk_trial *trial;
    const ff_pack *pack;
    const ff_figure *figure;
    ff_crowd *crowd;
    walker *walkers;
    ff_paired_body *bodies;
    double *frame; /* s, per step */
    double *work;  /* s of the processors, per step: what a frame takes whatever else the machine does */
    ff_matrix *matrices;
    ff_random random;
    double side; /* m, of a crossing */
    ff_walk_measures out;
    double walked[2], toward[2]; /* by velocity, on footsteps */
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

/* Every other one comes from the other side; the front row of one is the front row of the other when they have passed. */
static void place_in_stream(run *r, uint32_t i)
{
    walker *w = &r->walkers[i];
    uint32_t row = i / 2 / ABREAST, rows = (r->trial->agents / 2 + ABREAST - 1) / ABREAST;
    double across = ROW_GAP * (i / 2 % ABREAST - 0.5 * (ABREAST - 1)), side = i % 2 == 0 ? -1.0 : 1.0;
    ff_vec2 off =
        ff_v2(ff_random_range(&r->random, -ROW_OFF, ROW_OFF), ff_random_range(&r->random, -ROW_OFF, ROW_OFF));
    w->start = ff_add2(ff_v2(side * (STREAM_FAR + ROW_GAP * row), across), off);
    w->goal = ff_sub2(w->start, ff_v2(side * (2.0 * STREAM_FAR + ROW_GAP * (rows - 1)), 0.0));
}

static void place_walker(run *r, uint32_t i)
{
    const ff_walk_trial *t = r->trial;
    walker *w = &r->walkers[i];
    if (t->scene == FF_WALK_STREAMS) {
        place_in_stream(r, i);
        return;
    }
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

/* Whether the next one goes by velocity; *left: how many of the rest do. */
static bool by_velocity(run *r, uint32_t i, uint32_t *left)
{
    if (r->trial->mix == FF_MIX_NONE) return false;
    if (r->trial->mix == FF_MIX_SIDES) return i % 2 == 1;
    bool drawn = ff_random_range(&r->random, 0.0, r->trial->agents - i) < *left;
    *left -= drawn;
    return drawn;
}

static ff_status add_walkers(run *r, ff_error *error)
{
    ff_status status = FF_OK;
    uint32_t left = r->trial->agents / 2;
    for (uint32_t i = 0; i < r->trial->agents && status == FF_OK; ++i) {
        walker *w = &r->walkers[i];
        place_walker(r, i);
        ff_agent_def def = ff_agent_def_default();
        ff_vec2 way = ff_sub2(w->goal, w->start);
        def.position = w->start;
        def.goal = w->goal;
        def.heading = ff_atan2(way.b, way.a);
        if (by_velocity(r, i, &left)) def.planner = FF_PLANNER_VELOCITY;
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

/* The capsules of a body, and how far from its place they get. */
static void look_at_body(const run *r, ff_paired_body *b, const ff_vec3 *joints, const ff_quat *turned)
{
    ff_body_capsules(r->pack, joints, turned, b->capsules);
    for (int i = 0; i < FF_BODY_CAPSULES; ++i) {
        const ff_body_capsule *c = &b->capsules[i];
        double from = ff_length2(ff_sub2(ff_plane(c->from), b->position));
        double to = ff_length2(ff_sub2(ff_plane(c->to), b->position));
        b->reach = ff_max(b->reach, ff_max(from, to) + c->radius);
    }
}

static void look_at(run *r, uint32_t i, double time)
{
    walker *w = &r->walkers[i];
    ff_agent_state state;
    ff_vec3 hips, joints[FF_FIGURE_MAX_JOINTS];
    ff_quat rotations[FF_FIGURE_MAX_JOINTS], turned[FF_FIGURE_MAX_JOINTS];
    ff_crowd_agent_state(r->crowd, w->agent, &state, NULL);
    ff_crowd_agent_pose(r->crowd, w->agent, &hips, rotations, NULL);
    ff_figure_place(r->figure, hips, rotations, joints, turned);
    bool plans = state.planner == FF_PLANNER_FOOTSTEPS;
    r->bodies[i] = (ff_paired_body){.body = ff_cylinders_of_colliders(r->pack, joints, turned),
                                    .position = state.position,
                                    .radius = ff_agent_def_default().radius,
                                    .plans = plans};
    if (r->trial->bodies) look_at_body(r, &r->bodies[i], joints, turned);
    r->out.agent_seconds += r->trial->step;
    if (state.reached && w->arrived < 0.0) w->arrived = time;
    if (state.reached && r->trial->scene == FF_WALK_CROSSING) {
        w->goal = somewhere(r);
        ff_crowd_set_goal(r->crowd, w->agent, w->goal, NULL);
    }
    ff_vec2 way = ff_sub2(state.goal, state.position);
    double far = ff_length2(way);
    if (state.reached || far < GOAL_NEAR) return;
    r->walked[plans] += r->trial->step;
    r->toward[plans] += ff_dot2(state.velocity, way) / far * r->trial->step;
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
        look_at(r, i, (step + 1) * r->trial->step);
    if (status == FF_OK)
        status = ff_pair_contacts_count(r->bodies, r->trial->agents, r->trial->step, r->out.pairs, error);
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
    out->plan_ms_median = 1e3 * ff_crowd_plan_seconds(r->crowd, 0.5);
    out->plan_ms_p99 = 1e3 * ff_crowd_plan_seconds(r->crowd, 0.99);
    for (int kind = 0; kind < FF_PAIR_KINDS; ++kind) {
        const ff_pair_contacts *pairs = &out->pairs[kind];
        out->overlap += 100.0 * pairs->seconds / out->agent_seconds;
        out->deepest = ff_max(out->deepest, pairs->deepest);
        out->body_overlap += 100.0 * pairs->body_seconds / out->agent_seconds;
        out->body_deepest = ff_max(out->body_deepest, pairs->body_deepest);
    }
    double walked = r->walked[0] + r->walked[1];
    out->speed_to_goal = walked > 0.0 ? (r->toward[0] + r->toward[1]) / walked : 0.0;
    for (int plans = 0; plans < 2; ++plans)
        out->speed_by[plans] = r->walked[plans] > 0.0 ? r->toward[plans] / r->walked[plans] : 0.0;
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
    r.bodies = ff_calloc(trial->agents, sizeof *r.bodies);
    r.frame = ff_calloc(steps, sizeof *r.frame);
    r.work = ff_calloc(steps, sizeof *r.work);
    r.matrices = ff_calloc((size_t)trial->agents * ff_pack_joint_count(pack), sizeof *r.matrices);
    ff_status status = FF_OK;
    if (!r.walkers || !r.bodies || !r.frame || !r.work || !r.matrices)
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
    free(r.bodies);
    free(r.frame);
    free(r.work);
    free(r.matrices);
    return status;
}

ff_status ff_walk_trial_draw(const ff_pack *pack, const ff_figure *figure, ff_walk_trial trial,
                             const char *title, const char *const when[FF_WALK_SHOTS], const char *path,
                             ff_error *error)
{
    ff_plan_scene shots[FF_WALK_SHOTS] = {{0}};
    ff_walk_measures measures;
    for (int i = 0; i < FF_WALK_SHOTS; ++i) {
        shots[i].title = title;
        shots[i].subtitle = when ? when[i] : NULL;
    }
    trial.seconds = DRAWN_SECONDS;
    trial.shots = shots;
    trial.shot_count = FF_WALK_SHOTS;
    ff_status status = ff_walk_trial_run(pack, figure, &trial, &measures, error);
    if (status == FF_OK) status = ff_plan_picture_write(path, shots, FF_WALK_SHOTS, error);
    for (int i = 0; i < FF_WALK_SHOTS; ++i)
        ff_plan_scene_free(&shots[i]);
    return status;
}
