/* crowd_react.c - a step is broken off because something that nobody foresaw is in its way (algorithms B.8, event 3).
 *
 * Other actions that begin as this one did, on the same foot in the same place, have as much of them behind them: one passes to such a
 * one where it is, and from its end to a stand. The one that meets something last is taken, plans in force included: their
 * owners are told, and plan anew, or break off a step as well.
 */
#include "runtime/core/crowd/crowd_footsteps.h"
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/plan/plan_set.h"
#include "runtime/core/plan/plan_solids.h"

#include <string.h>

#define LATEST 0.6 /* of an action: later on it is finished */
#define HARDLY_BEGUN 0.25
#define LOOK 1.5   /* s ahead */
#define SUDDEN 0.4 /* s: what is met so soon in spite of everything lets one stop dead */
#define MOST 48    /* ways that are tried */

/* How bad: the sooner something is met, the worse. What is really there comes first, then people, whether they plan or go by
 * velocity: both can make way, if there is time. */
typedef struct outcome {
    double surprise, others, walkers; /* s until met; INFINITY: never */
    double stand;                     /* s, until it stands */
} outcome;

static bool better(const outcome *p, const outcome *q)
{
    if (p->surprise != q->surprise) return p->surprise > q->surprise;
    double mine = ff_min(p->others, p->walkers), theirs = ff_min(q->others, q->walkers);
    if (mine != theirs) return mine > theirs;
    if (p->others != q->others) return p->others > q->others;
    if (p->walkers != q->walkers) return p->walkers > q->walkers;
    return p->stand < q->stand;
}

/* The step after an action, by its place in the action's list. */
static ff_plan_step follow(const ff_action_set *set, const ff_plan_step *step, uint32_t k)
{
    const ff_set_action *a = &set->actions[step->action];
    const ff_set_next *next = &set->next[a->first_next + k];
    ff_vec2 land = next->other ? ff_v2(0.0, 0.0) : ff_v2((double)a->land[0], (double)a->land[1]);
    return (ff_plan_step){.anchor = ff_add2(step->anchor, ff_from_frame2(ff_fwd2(step->heading), land)),
                          .heading = step->heading + (double)a->theta,
                          .start = step->start + (double)a->duration,
                          .action = next->action};
}

/* A step, then its way of stopping, then standing. */
static void stop_after(const ff_action_set *set, const ff_plan_step *step, const ff_plan_step *from,
                       const ff_set_stop *stop, ff_plan *out)
{
    memset(out, 0, sizeof *out);
    out->from = *from;
    out->steps[out->count++] = *step;
    for (int i = 0; stop && i < 2 && stop->next[i] != FF_SET_NO_STOP; ++i) {
        out->steps[out->count] = follow(set, &out->steps[out->count - 1], stop->next[i]);
        ++out->count;
    }
    ff_plan_step last = out->steps[out->count - 1];
    if (!last.hold) {
        last.start += (double)set->actions[last.action].duration;
        last.hold = 1;
        out->steps[out->count++] = last;
    }
    out->own = 0;
    out->stop = out->count - 1;
}

static outcome judge(const ff_crowd *crowd, const ff_plan_world *world, double time, const ff_plan_job *job)
{
    outcome out = {INFINITY, INFINITY, INFINITY, job->plan.steps[job->plan.count - 1].start - time};
    double when;
    for (uint32_t i = 0; i < world->shape_count; ++i)
        if (ff_track_meets(&job->track, time, LOOK, &world->shapes[i], ff_v2(0.0, 0.0), 0.0, &when))
            out.surprise = ff_min(out.surprise, when - time);
    for (uint32_t i = 0; i < crowd->obstacle_count; ++i) {
        const ff_crowd_obstacle *obstacle = &crowd->obstacles[i];
        if ((obstacle->kind == FF_OBSTACLE_PATH || ff_obstacle_is_evaded(obstacle)) &&
            ff_track_meets(&job->track, time, LOOK, &obstacle->shape, obstacle->velocity, 0.0, &when))
            out.surprise = ff_min(out.surprise, when - time);
    }
    ff_bounds bounds = ff_track_bounds(&job->track);
    out.walkers = ff_glides_met(crowd, job->slot, &job->track, &bounds, time, LOOK);
    if (ff_solids_hit(world->solids, job->track.origin, 10.0, job->track.origin, job->track.knots,
                      job->track.count, job->track.radii, 0.0))
        out.surprise = ff_min(out.surprise, out.stand);
    for (uint32_t i = 0; i < world->track_count; ++i)
        if (ff_track_conflict(&job->track, world->tracks[i], time, 0.0, &when))
            out.others = ff_min(out.others, when - time);
    return out;
}

typedef struct ways {
    const ff_crowd *crowd;
    const ff_plan_world *world;
    ff_plan_job *best; /* what is kept */
    outcome outcome;
    double time;
    uint32_t slot, tried;
    bool found;
    bool forced;   /* what is really there is about to be met: plans in force come second */
    double others; /* s until what is done now meets a plan in force */
} ways;

/* People can make way: for their sake no plan comes into force that crosses another one in force, or crosses it sooner than what
 * is done now. Two whose plans cross once may do what they can, and walk through each other. */
static bool crosses(const ways *w, const outcome *result)
{
    return !w->forced && result->others < INFINITY && result->others <= w->others;
}

/* Try a step with each of its ways of stopping. */
static void try_step(ways *w, const ff_plan_step *step, const ff_plan_step *from, bool cut)
{
    const ff_action_set *set = w->crowd->footsteps->actions;
    const ff_set_action *a = &set->actions[step->action];
    bool stands = step->hold || (a->flags & FF_SET_TO_STANDING) != 0;
    uint32_t count = stands ? 1 : a->stop_count;
    for (uint32_t k = 0; k < count && w->tried < MOST; ++k, ++w->tried) {
        ff_plan_job job = {.slot = w->slot};
        stop_after(set, step, from, stands ? NULL : &set->stops[a->first_stop + k], &job.plan);
        ff_plan_track(set, &job.plan, w->time, &job.track);
        outcome result = judge(w->crowd, w->world, w->time, &job);
        if (crosses(w, &result) || (w->found && !better(&result, &w->outcome))) continue;
        w->found = true;
        w->outcome = result;
        w->best->plan = job.plan;
        w->best->track = job.track;
        w->best->kind = cut ? FF_JOB_REACT : FF_JOB_PLAN;
    }
}

/* The last resort: stop dead. Nobody walks through a wall, however suddenly it came. */
static void try_freezing(ways *w)
{
    const ff_body *body = &w->crowd->bodies[w->slot];
    ff_plan_job job = {.slot = w->slot};
    ff_plan_stand(w->crowd->footsteps->actions, body->position, body->heading, w->time, &job.plan);
    ff_plan_track(w->crowd->footsteps->actions, &job.plan, w->time, &job.track);
    outcome result = judge(w->crowd, w->world, w->time, &job);
    if (crosses(w, &result) || !better(&result, &w->outcome)) return;
    w->outcome = result;
    w->best->plan = job.plan;
    w->best->track = job.track;
    w->best->kind = FF_JOB_REACT;
}

/* What was found becomes the job's, if it is better than what there was. */
static bool take_best(const ff_crowd *crowd, uint32_t slot, const ways *w, const outcome *old,
                      ff_plan_job *job)
{
    if (!better(&w->outcome, old)) return false;
    /* Who goes by velocity keeps off the plan in force: what only meets him later takes him by surprise as well. */
    if (old->surprise == INFINITY && old->others == INFINITY && w->outcome.walkers < INFINITY) return false;
    job->plan = w->best->plan;
    job->track = w->best->track;
    job->kind = w->best->kind;
    job->bounds = ff_track_bounds(&job->track);
    job->target = ff_stepper_target(crowd, slot);
    job->good = 1;
    job->forced = w->forced;
    job->counts.reactions = job->kind == FF_JOB_REACT;
    return true;
}

bool ff_stepper_react(const ff_crowd *crowd, uint32_t slot, const ff_plan_world *world, double time,
                      ff_plan_job *job)
{
    const ff_stepper *s = &crowd->steppers[slot];
    const ff_action_set *set = crowd->footsteps->actions;
    const ff_plan_step *now = &s->plan.steps[s->at], *from = s->at > 0 ? now - 1 : &s->plan.from;
    if (now->hold && s->at + 1 == s->plan.count) return false; /* stands already */
    ff_plan_job best; /* the job keeps what the search found, unless there is something better */
    ways w = {.crowd = crowd, .world = world, .best = &best, .time = time, .slot = slot};
    /* What the plan in force, or the one just found, would meet. */
    ff_plan_job keep = {
        .slot = slot, .plan = job->good ? job->plan : s->plan, .track = job->good ? job->track : s->track};
    w.outcome = judge(crowd, world, time, &keep);
    w.found = true;
    w.forced = w.outcome.surprise < INFINITY;
    w.others = w.outcome.others;
    if (w.outcome.surprise == INFINITY && w.outcome.walkers > FF_WALKER_IMMINENT &&
        w.outcome.others == INFINITY)
        return false;
    outcome old = w.outcome;
    try_step(&w, now, from, false);
    if (now->hold) return take_best(crowd, slot, &w, &old, job);
    double done = (time - now->start) / (double)set->actions[now->action].duration;
    const ff_set_action *before = &set->actions[from->action];
    /* In danger a step may become a leap, as long as it has hardly begun. */
    bool leaps = s->pending >> FF_EVENT_DANGER & 1u && done < HARDLY_BEGUN;
    for (uint32_t n = 0, count = leaps ? before->next_count : before->step_count; n < count && done < LATEST;
         ++n) {
        uint32_t k = leaps ? (n + before->step_count) % count : n; /* leaps first */
        const ff_set_next *next = &set->next[before->first_next + k];
        const ff_set_action *b = &set->actions[next->action];
        if (next->action == now->action || !ff_set_allows(b, s->evasions) ||
            b->support != set->actions[now->action].support)
            continue;
        ff_plan_step step = *now;
        step.action = next->action;
        step.start = time - done * (double)b->duration;
        try_step(&w, &step, from, true);
    }
    if (w.outcome.surprise < SUDDEN)
        try_freezing(&w); /* not before people, who may be about to pass behind */
    return take_best(crowd, slot, &w, &old, job);
}
