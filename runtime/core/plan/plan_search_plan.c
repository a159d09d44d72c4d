/* From plans to nodes of a search and back: plan_search.h. */
#include "runtime/core/plan/plan_search.h"

/* The start: the joint at the end of the step that is being done. */
ff_search_node ff_search_start(const ff_search *s, const ff_plan_step *step, double end)
{
    const ff_set_action *a = &s->set->actions[step->action];
    ff_vec2 axis = ff_fwd2(step->heading), turned = ff_fwd2(step->heading + (double)a->theta);
    ff_vec2 other = ff_sub2(step->anchor, s->memory->sight.origin);
    ff_vec2 at = ff_add2(other, ff_from_frame2(axis, ff_v2((double)a->land[0], (double)a->land[1])));
    ff_search_node n = {.at = {(float)at.a, (float)at.b},
                        .other = {(float)other.a, (float)other.b},
                        .cosine = (float)turned.a,
                        .sine = (float)turned.b,
                        .heading = (float)(step->heading + (double)a->theta),
                        .time = (float)(end - (double)s->memory->sight.first_knot * FF_TRACK_STEP),
                        .parent = FF_SEARCH_NONE,
                        .action = (uint16_t)step->action,
                        .flags = (uint8_t)(FF_NODE_TESTED | (step->hold ? FF_NODE_HELD : 0))};
    return n;
}

/* Seeds the queue with what the current plan says from here on, as far as it is still free. Its last node becomes the best
 * plan if it is at the goal. */
void ff_search_follow(ff_search *s, const ff_plan *plan, uint32_t step)
{
    uint32_t at = 0;
    bool again;
    for (uint32_t i = step + 1; i < plan->stop && at != FF_SEARCH_NONE; ++i) {
        const ff_set_action *a = &s->set->actions[s->memory->nodes[at].action];
        ff_search_node child;
        uint16_t k = 0;
        if (plan->steps[i].hold)
            child = ff_search_waiting(s, at, (float)(ff_plan_step_end(plan, i) - plan->steps[i].start));
        else {
            while (k < a->next_count && s->set->next[a->first_next + k].action != plan->steps[i].action)
                ++k;
            if (k == a->next_count) return;
            child = ff_search_child(s, at, k);
        }
        if (child.depth > s->options.horizon || child.time > s->latest || !ff_search_is_free(s, &child))
            return;
        const ff_search_look look = ff_search_ask(s, &child);
        ff_search_guess(s, &child, &look);
        at = ff_search_add(s, &child);
        if (at == FF_SEARCH_NONE) return;
        ff_search_push(s, at);
        if (ff_search_at_goal(s, &child) && ff_search_is_safe(s, at) && ff_search_take_place(s, at, &again)) {
            s->best = at;
            s->best_cost = s->memory->nodes[at].g;
            s->result.outcome = FF_PLAN_REACHED;
        }
    }
}

/* Appends a step after the last one. */
static void append(const ff_action_set *set, ff_plan *plan, uint16_t action, bool other, bool hold,
                   double seconds, double *end)
{
    const ff_plan_step *last = &plan->steps[plan->count - 1];
    const ff_set_action *a = &set->actions[last->action];
    ff_plan_step step = *last;
    step.start = *end;
    step.hold = hold;
    if (!hold) {
        if (!other)
            step.anchor =
                ff_add2(last->anchor, ff_from_frame2(ff_fwd2(last->heading),
                                                     ff_v2((double)a->land[0], (double)a->land[1])));
        step.heading = last->heading + (double)a->theta;
        step.action = action;
        seconds = (double)set->actions[action].duration;
    }
    *end += seconds;
    plan->steps[plan->count++] = step;
}

static void append_node(const ff_search *s, const ff_search_node *n, ff_plan *plan, double *end)
{
    const ff_search_node *parent = &s->memory->nodes[n->parent];
    bool other = !(n->flags & FF_NODE_HELD) &&
                 s->set->next[s->set->actions[parent->action].first_next + n->next].other;
    append(s->set, plan, n->action, other, (n->flags & FF_NODE_HELD) != 0, (double)(n->time - parent->time),
           end);
}

static void append_stop(const ff_search *s, const ff_search_node *n, ff_plan *plan, double *end)
{
    plan->stop = plan->count;
    const ff_set_action *a = &s->set->actions[n->action];
    if (n->stop != FF_SET_NO_STOP) {
        const ff_set_stop *stop = &s->set->stops[a->first_stop + n->stop];
        for (int i = 0; i < 2 && stop->next[i] != FF_SET_NO_STOP; ++i) {
            const ff_set_next *next = &s->set->next[a->first_next + stop->next[i]];
            append(s->set, plan, next->action, next->other, false, 0.0, end);
            a = &s->set->actions[next->action];
        }
    }
    append(s->set, plan, 0, false, true, 0.0, end);
}

/* From the current plan's step, through the nodes, to the stop. */
void ff_search_write(const ff_search *s, const ff_plan *current, uint32_t step, double end, uint32_t last,
                     ff_plan *out)
{
    uint32_t path[FF_SEARCH_HORIZON_MAX + 2], n = 0;
    for (uint32_t i = last; i != 0; i = s->memory->nodes[i].parent)
        path[n++] = i;
    ff_plan plan = {.from = step > 0 ? current->steps[step - 1] : current->from};
    plan.steps[plan.count++] = current->steps[step];
    plan.own = 1;
    while (n > 0)
        append_node(s, &s->memory->nodes[path[--n]], &plan, &end);
    append_stop(s, &s->memory->nodes[last], &plan, &end);
    plan.cost = s->result.cost;
    *out = plan;
}
