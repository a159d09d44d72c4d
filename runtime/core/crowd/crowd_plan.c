/* crowd_plan.c - whose turn it is to plan, the searches, and plans coming into force (algorithms B.8). */
#include "runtime/core/crowd/crowd_footsteps.h"
#include "runtime/core/crowd/crowd_state.h"

#include <string.h>

#define RETRY 0.15         /* s, after which is tried again what was in vain (footstep study, section 4.3) */
#define CLOSE_TO_STOP 0.5  /* s: who is so near to the stop at the end of its plan plans first */
#define VIEW 11.0          /* m: so far one walks before a stop at the end of a plan */
#define SURPRISE_VIEW 6.0  /* m, within which obstacles that the caller moves are seen */
#define LEAD 0.5           /* s: and where they will be by then, too */
#define GOAL_REACH 0.7     /* of the goal's tolerance, that a plan reaches into it */
#define WAYPOINT_REACH 0.6 /* m */
#define FACING                                                                                               \
    0.25 /* rad, that one who looks at something may face beside it: half of the smallest turn, and some */
#define IMMINENT 1.0 /* s */
#define BELIEVED 5.0 /* s, for which what is to be jumped or ducked is believed to go on */
#define EVADE_COST                                                                                           \
    20.0 /* J/kg, of a jump or a duck in danger: dearer than a few steps, cheaper than waiting for seconds */

/* Collision tests, which take most of a search's time: of a search that is not easy; fewest searches at a time. */
enum { USUAL_TESTS = 1000, AT_ONCE = 2 };
enum { FIRST, SOON, LATER }; /* urgency */
/* Something is in the way that nobody foresaw, or somebody who had to break off a step, or what is to be jumped or ducked. */
enum { URGENT = 1 << FF_EVENT_SURPRISE | 1 << FF_EVENT_NEARBY | 1 << FF_EVENT_DANGER };

/* ------------------------------------------------------------------------------------------------- whose turn */

static uint32_t urgency_of(const ff_stepper *s, double time)
{
    if (s->pending & URGENT) return FIRST;
    if (s->counts.plans == 0) return SOON;
    uint32_t stop = s->plan.stop < s->plan.count ? s->plan.stop : s->plan.count - 1;
    bool ends = s->plan.steps[stop].start - time < CLOSE_TO_STOP && s->at + 1 < s->plan.count;
    return ends ? SOON : LATER;
}

static bool before(const ff_plan_job *p, const ff_plan_job *q)
{
    if (p->urgency != q->urgency) return p->urgency < q->urgency;
    if (p->asked != q->asked) return p->asked < q->asked;
    return p->slot < q->slot;
}

/* The jobs of this step are the first job_max of all, in order of urgency, of waiting, of slots: nobody starves. */
static void line_up(ff_footsteps *f, const ff_plan_job *job)
{
    uint32_t at = f->job_count;
    if (at == f->job_max) {
        if (!before(job, &f->jobs[at - 1])) return;
        --at;
    } else {
        ++f->job_count;
    }
    for (; at > 0 && before(job, &f->jobs[at - 1]); --at) {
        f->jobs[at].slot = f->jobs[at - 1].slot;
        f->jobs[at].kind = f->jobs[at - 1].kind;
        f->jobs[at].urgency = f->jobs[at - 1].urgency;
        f->jobs[at].asked = f->jobs[at - 1].asked;
    }
    f->jobs[at].slot = job->slot;
    f->jobs[at].kind = job->kind;
    f->jobs[at].urgency = job->urgency;
    f->jobs[at].asked = job->asked;
}

static void choose_jobs(ff_crowd *crowd, double time)
{
    ff_footsteps *f = crowd->footsteps;
    f->job_count = 0;
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        if (!crowd->alive[slot]) continue;
        const ff_stepper *s = &crowd->steppers[slot];
        ff_plan_job job = {.slot = slot, .asked = s->asked};
        if (s->moves == FF_PLANNER_FOOTSTEPS) {
            if (s->pending == 0 || s->retry > time) continue;
            job.kind = FF_JOB_PLAN;
            job.urgency = urgency_of(s, time);
        } else {
            if (s->wanted != FF_PLANNER_FOOTSTEPS || s->retry > time) continue;
            job.kind = FF_JOB_ENTER;
            job.urgency = SOON;
        }
        line_up(f, &job);
    }
}

/* ------------------------------------------------------------------------------------------------- the world */

static void see_steppers(const ff_crowd *crowd, uint32_t slot, ff_plan_lane *lane, ff_plan_world *world)
{
    const ff_footsteps *f = crowd->footsteps;
    ff_vec2 here = crowd->bodies[slot].position, reach = ff_v2(VIEW, VIEW);
    ff_bounds view = {ff_sub2(here, reach), ff_add2(here, reach)};
    for (uint32_t i = 0; i < crowd->slot_count; ++i)
        if (i != slot && ff_bounds_meet(&f->bounds[i], &view))
            lane->tracks[world->track_count++] = &crowd->steppers[i].track;
    world->tracks = lane->tracks;
}

/* Obstacles that the caller moves are seen where they are, and, if they move, where they will be shortly. */
static void see_obstacles(const ff_crowd *crowd, uint32_t slot, ff_plan_lane *lane, ff_plan_world *world)
{
    ff_vec2 here = crowd->bodies[slot].position;
    world->shapes = lane->shapes;
    for (uint32_t i = 0; i < crowd->obstacle_count; ++i) {
        const ff_crowd_obstacle *obstacle = &crowd->obstacles[i];
        if (obstacle->kind != FF_OBSTACLE_FREE || ff_obstacle_is_evaded(obstacle)) continue;
        double far = ff_length2(ff_sub2(obstacle->shape.centre, here)) - obstacle->shape.half_length -
                     obstacle->shape.half_width - obstacle->shape.radius;
        if (far > SURPRISE_VIEW) continue;
        lane->shapes[world->shape_count++] = obstacle->shape;
        if (ff_dot2(obstacle->velocity, obstacle->velocity) == 0.0) continue;
        ff_shape *ahead = &lane->shapes[world->shape_count++];
        *ahead = obstacle->shape;
        ahead->centre = ff_madd2(ahead->centre, obstacle->velocity, LEAD);
    }
}

/* Something low enough to jump, or high enough to duck, is to be got past while it passes: where it will be when counts. */
static void see_evaded(const ff_crowd *crowd, ff_plan_lane *lane, ff_plan_world *world)
{
    const ff_footsteps *f = crowd->footsteps;
    double time = ff_crowd_time(crowd);
    world->movers = lane->movers;
    for (uint32_t i = 0; i < f->mover_count; ++i)
        lane->movers[i] = f->movers[i];
    for (uint32_t i = 0; i < crowd->obstacle_count; ++i) {
        const ff_crowd_obstacle *obstacle = &crowd->obstacles[i];
        if (!ff_obstacle_is_evaded(obstacle)) continue;
        ff_path_point *path = lane->paths[i];
        path[0] = (ff_path_point){0.0, obstacle->shape.centre};
        path[1] = (ff_path_point){BELIEVED, ff_madd2(path[0].at, obstacle->velocity, BELIEVED)};
        ff_mover *mover = &lane->movers[world->mover_count++];
        *mover = (ff_mover){.shape = obstacle->shape, .path = path, .count = 2, .start = time};
        mover->shape.centre = ff_v2(0.0, 0.0);
    }
}

static ff_plan_world world_of(const ff_crowd *crowd, uint32_t slot, ff_plan_lane *lane)
{
    const ff_footsteps *f = crowd->footsteps;
    ff_plan_world world = {.solids = f->solids, .movers = f->movers, .mover_count = f->mover_count};
    see_steppers(crowd, slot, lane, &world);
    ff_walkers_see(crowd, slot, lane, &world);
    see_obstacles(crowd, slot, lane, &world);
    see_evaded(crowd, lane, &world);
    return world;
}

/* ------------------------------------------------------------------------------------------------- searching */

bool ff_job_free(const ff_crowd *crowd, const ff_plan_job *job, uint32_t slot, double time)
{
    if (slot == job->slot || !ff_bounds_meet(&crowd->footsteps->bounds[slot], &job->bounds)) return true;
    const ff_stepper *other = &crowd->steppers[slot], *own = &crowd->steppers[job->slot];
    double when, before;
    if (!ff_track_conflict(&job->track, &other->track, time, 0.0, &when)) return true;
    /* Those who are in each other's way already do what they can: who meets the other no sooner. */
    return ff_is_stepper(crowd, job->slot) &&
           ff_track_conflict(&own->track, &other->track, time, 0.0, &before) &&
           (when > before || before <= time);
}

/* The track, and whether it is free of all plans in force, and of where those who go by velocity stop. */
static void finish_job(const ff_crowd *crowd, ff_plan_job *job, double time)
{
    ff_plan_track(crowd->footsteps->actions, &job->plan, time, &job->track);
    job->bounds = ff_track_bounds(&job->track);
    job->good = 1;
    for (uint32_t i = 0; i < crowd->slot_count && job->good && !crowd->def.footsteps.paper; ++i)
        job->good = ff_job_free(crowd, job, i, time);
    if (job->good) job->good = ff_glides_allow(crowd, job, time);
    if (!job->good) ++job->counts.conflicting;
}

static ff_plan_goal goal_of(const ff_crowd *crowd, uint32_t slot, ff_vec2 target)
{
    const ff_traits *traits = &crowd->traits[slot];
    ff_plan_goal goal = ff_plan_goal_at(target);
    bool last = target.a == traits->goal.a && target.b == traits->goal.b;
    goal.radius = last ? GOAL_REACH * traits->goal_tolerance : WAYPOINT_REACH;
    /* Who is there turns on the spot. */
    if (last && ff_stepper_turns(crowd, slot, &goal.heading) > 0.0) {
        goal.radius = traits->goal_tolerance;
        goal.tolerance = FACING;
    }
    return goal;
}

static bool meets_soon(const ff_crowd *crowd, const ff_plan_world *world, const ff_plan_job *job, double time)
{
    for (uint32_t i = 0; i < world->shape_count; ++i)
        if (ff_track_meets(&job->track, time, IMMINENT, &world->shapes[i], ff_v2(0.0, 0.0), 0.0, NULL))
            return true;
    return ff_glides_met(crowd, job->slot, &job->track, &job->bounds, time, FF_WALKER_IMMINENT) < INFINITY;
}

/* What one can do without the help of those who go by velocity; or else what they leave room for. */
static ff_plan_outcome find_plan(ff_crowd *crowd, ff_plan_job *job, ff_plan_lane *lane,
                                 const ff_plan_world *world, const ff_plan *current)
{
    const ff_footsteps *f = crowd->footsteps;
    const ff_stepper *s = &crowd->steppers[job->slot];
    ff_plan_goal goal = goal_of(crowd, job->slot, job->target);
    ff_plan_options options = f->options;
    if (s->pending >> FF_EVENT_DANGER & 1u) {
        options.reactive = (uint8_t)s->evasions;
        options.reactive_cost = EVADE_COST;
    }
    ff_plan_result result = {.outcome = FF_PLAN_NONE};
    int tries = world->walker_count > 0 && job->kind == FF_JOB_PLAN ? 2 : 1;
    for (int i = 0; i < tries && result.outcome == FF_PLAN_NONE; ++i) {
        if (i > 0) ff_walkers_believe(lane, world);
        result = ff_plan_search(f->actions, world, current, ff_crowd_time(crowd), &goal, &options,
                                lane->scratch, &job->plan);
        job->counts.nodes += result.expanded;
        job->tests += result.tested;
    }
    job->counts.searches = 1;
    return result.outcome;
}

static void search(ff_crowd *crowd, ff_plan_job *job, ff_plan_lane *lane)
{
    const ff_stepper *s = &crowd->steppers[job->slot];
    double time = ff_crowd_time(crowd);
    ff_plan current = s->plan;
    job->good = job->forced = 0;
    job->tests = 0;
    memset(&job->counts, 0, sizeof job->counts);
    if (job->kind == FF_JOB_ENTER && !ff_stepper_enters(crowd, job->slot, time, &current)) return;
    ff_plan_world world = world_of(crowd, job->slot, lane);
    job->target = ff_stepper_target(crowd, job->slot);
    if (find_plan(crowd, job, lane, &world, &current) == FF_PLAN_NONE)
        ++job->counts.failed;
    else
        finish_job(crowd, job, time);
    if (job->kind == FF_JOB_PLAN && s->pending & URGENT &&
        (!job->good || meets_soon(crowd, &world, job, time)))
        ff_stepper_react(crowd, job->slot, &world, time, job);
}

static void timed_search(ff_crowd *crowd, ff_plan_job *job, ff_plan_lane *lane)
{
    double begun = ff_thread_seconds();
    search(crowd, job, lane);
    job->seconds = ff_thread_seconds() - begun;
}

typedef struct lane_work {
    ff_crowd *crowd;
} lane_work;

/* Takes the next search as long as there are any: which thread does which has no influence on what comes out. */
static void run_lane(void *context, uint32_t index)
{
    ff_crowd *crowd = ((lane_work *)context)->crowd;
    ff_footsteps *f = crowd->footsteps;
    for (uint32_t i; (i = atomic_fetch_add(&f->next_job, 1u)) < f->job_end;)
        timed_search(crowd, &f->jobs[i], &f->lane[index]);
}

/* A few at a time, until all are done or have made as many tests as a step may: so no frame is much longer than the others, and
 * which are done does not depend on the number of threads. The others ask again in the next step. */
static void search_all(ff_crowd *crowd)
{
    ff_footsteps *f = crowd->footsteps;
    lane_work work = {crowd};
    uint64_t tests = 0;
    uint32_t done = 0;
    while (done < f->job_count && (done == 0 || tests < f->test_max)) {
        uint64_t count = (f->test_max > tests ? f->test_max - tests : 0) / USUAL_TESTS;
        if (count < AT_ONCE) count = AT_ONCE;
        f->job_end = count < f->job_count - done ? done + (uint32_t)count : f->job_count;
        atomic_store(&f->next_job, done);
        if (crowd->def.tasks)
            crowd->def.tasks(crowd->def.task_pool, f->lane_count, run_lane, &work);
        else
            ff_tasks_for(crowd->own_tasks, f->lane_count, 1, run_lane, &work);
        for (; done < f->job_end; ++done) {
            tests += f->jobs[done].tests;
            ff_plan_times_add(&f->times, f->jobs[done].seconds);
        }
    }
    f->job_count = done;
}

/* ------------------------------------------------------------------------------------------------- in force */

static void add_counts(ff_plan_counts *sum, const ff_plan_counts *add)
{
    sum->searches += add->searches;
    sum->failed += add->failed;
    sum->conflicting += add->conflicting;
    sum->reactions += add->reactions;
    sum->dodges += add->dodges;
    sum->nodes += add->nodes;
}

/* In the order of slots, each plan is checked against those that have come into force before it in this step. */
static void put_in_force(ff_crowd *crowd, ff_plan_job *job, double time)
{
    ff_footsteps *f = crowd->footsteps;
    ff_stepper *s = &crowd->steppers[job->slot];
    bool was_good = job->good;
    for (uint32_t i = 0; i < f->changed_count && job->good && !crowd->def.footsteps.paper; ++i)
        job->good = job->forced || ff_job_free(crowd, job, f->changed[i], time);
    if (was_good && !job->good) ++job->counts.conflicting;
    add_counts(&s->counts, &job->counts);
    if (!job->good) {
        /* One that came second may try again at once; what was not found will not be there so soon. */
        s->retry = was_good ? time : time + RETRY;
        if (s->pending & URGENT) s->retry = time;
        return;
    }
    if (job->kind == FF_JOB_ENTER)
        ff_stepper_enter(crowd, job->slot, job, time);
    else
        ff_stepper_adopt(crowd, job->slot, job, time);
    ++s->counts.plans;
}

static void sort_by_slot(ff_footsteps *f, uint32_t *order)
{
    for (uint32_t i = 0; i < f->job_count; ++i) {
        uint32_t at = i;
        for (; at > 0 && f->jobs[order[at - 1]].slot > f->jobs[i].slot; --at)
            order[at] = order[at - 1];
        order[at] = i;
    }
}

double ff_footsteps_plan(ff_crowd *crowd)
{
    ff_footsteps *f = crowd->footsteps;
    double time = ff_crowd_time(crowd);
    for (uint32_t i = 0; i < f->changed_count; ++i)
        crowd->steppers[f->changed[i]].changed = 0;
    f->changed_count = 0;
    choose_jobs(crowd, time);
    search_all(crowd);
    sort_by_slot(f, f->order);
    for (uint32_t i = 0; i < f->job_count; ++i)
        put_in_force(crowd, &f->jobs[f->order[i]], time);
    return ff_crowd_clock(crowd);
}
