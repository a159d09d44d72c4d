#include "runtime/core/crowd/crowd_behave.h"

#include "runtime/core/base/fail.h"

#define STREAM_SPOT 4 /* of an agent's key */
#define STREAM_ACT 5
#define KEYS 0x62656861u /* stream of the crowd's seed that keys are drawn from */
#define LEAVES (FF_NONE - 1)
#define SPOTS 8        /* that are looked at */
#define SPOT_GAP 0.1   /* m between two who stand at one goal */
#define STAND_ROOM 0.5 /* m: one who shall stand may come to a stand within it */
#define SPEED_MIN 0.1  /* m/s, as agents may be put in */
#define SPEED_MAX 4.0
#define VALUE_MAX 1e9
#define SLOW 0.25 /* of the preferred speed: slower than that one is blocked */

static ff_behave_view view_of(const ff_crowd *crowd, uint32_t slot)
{
    return (ff_behave_view){.behaviour = crowd->behaviour,
                            .conduct = &crowd->conducts[slot],
                            .step = crowd->steps,
                            .dt = crowd->def.step,
                            .position = crowd->bodies[slot].position,
                            .speed = ff_length2(crowd->velocity[slot]),
                            .radius = crowd->traits[slot].radius,
                            .settled = crowd->minds[slot].standing == FF_SETTLED};
}

/* -------------------------------------------------------------------------------------------- first part */

static bool leaves(const ff_behave_view *view, double tolerance)
{
    const ff_conduct *conduct = view->conduct;
    const ff_behaviour_def *def = &view->behaviour->def;
    if (conduct->goal == FF_NONE || conduct->set == FF_NONE || !def->sets[conduct->set].exit) return false;
    if (def->states[conduct->state].motion != FF_MOTION_GOAL) return false;
    const ff_region *place = &def->goals[conduct->goal].place;
    double reach = place->shape == FF_REGION_POINT ? tolerance : 0.0;
    return view->settled || ff_region_distance(place, view->position) <= reach;
}

/* Writes the agent's own records only. */
static void look(ff_crowd *crowd, uint32_t slot)
{
    ff_conduct *conduct = &crowd->conducts[slot];
    ff_traits *traits = &crowd->traits[slot];
    crowd->firing[slot] = FF_NONE;
    if (conduct->state == FF_NONE) return;
    ff_behave_view view = view_of(crowd, slot);
    /* One who shall stand does so where he comes to a stand: nobody walks back half a step. */
    bool stops = crowd->behaviour->def.states[conduct->state].motion == FF_MOTION_STAND;
    if (stops && crowd->minds[slot].standing == FF_WALKS) traits->goal = view.position;
    bool slow = view.speed < SLOW * traits->preferred_speed;
    bool there = ff_length2(ff_sub2(traits->goal, view.position)) <= traits->goal_tolerance;
    bool goes = crowd->minds[slot].standing == FF_WALKS && !there;
    conduct->blocked = goes && slow ? conduct->blocked + crowd->def.step : 0.0;
    crowd->firing[slot] = leaves(&view, traits->goal_tolerance) ? LEAVES : ff_behave_find(&view, 0);
}

static void look_chunk(void *context, uint32_t chunk)
{
    ff_crowd *crowd = context;
    for (uint32_t i = 0; i < FF_CROWD_CHUNK; ++i) {
        uint32_t slot = chunk * FF_CROWD_CHUNK + i;
        if (slot < crowd->slot_count && crowd->alive[slot]) look(crowd, slot);
    }
}

/* ----------------------------------------------------------------------------------------- entering a state */

/* Where at a goal: of a few places drawn, the first that is away from all others' who have taken it, or the one that
 * is farthest from them. */
static ff_vec2 spot_at(const ff_crowd *crowd, uint32_t slot, uint32_t goal)
{
    const ff_region *place = &crowd->behaviour->def.goals[goal].place;
    ff_conduct *conduct = &crowd->conducts[slot];
    double radius = crowd->traits[slot].radius, nearest[SPOTS];
    if (place->shape == FF_REGION_POINT) return place->centre;
    ff_random random = {conduct->key, STREAM_SPOT, conduct->draws++ << 8};
    ff_vec2 spot[SPOTS];
    for (int i = 0; i < SPOTS; ++i) {
        spot[i] = ff_region_point(place, radius, &random);
        nearest[i] = INFINITY;
    }
    for (uint32_t other = 0; other < crowd->slot_count; ++other) {
        if (!crowd->alive[other] || other == slot || crowd->conducts[other].goal != goal) continue;
        for (int i = 0; i < SPOTS; ++i) {
            double gap = ff_length2(ff_sub2(crowd->conducts[other].place, spot[i]));
            nearest[i] = ff_min(nearest[i], gap - crowd->traits[other].radius);
        }
    }
    int best = 0;
    for (int i = 0; i < SPOTS && nearest[best] < radius + SPOT_GAP; ++i)
        if (nearest[i] > nearest[best]) best = i;
    return spot[best];
}

static void take_goal(ff_crowd *crowd, uint32_t slot, const ff_pick *pick)
{
    ff_conduct *conduct = &crowd->conducts[slot];
    uint32_t *taken = crowd->behaviour->taken;
    bool same = pick->goal == conduct->goal;
    if (!same && conduct->goal != FF_NONE) --taken[conduct->goal];
    if (!same && pick->goal != FF_NONE) ++taken[pick->goal];
    conduct->goal = pick->goal;
    conduct->set = pick->set;
    if (pick->goal == FF_NONE)
        conduct->place = pick->place;
    else if (!same)
        conduct->place = spot_at(crowd, slot, pick->goal);
    if (pick->goal != FF_NONE) conduct->last = pick->goal;
}

static void act(ff_crowd *crowd, uint32_t slot, uint32_t first, uint32_t count)
{
    ff_conduct *conduct = &crowd->conducts[slot];
    for (uint32_t i = first; i < first + count; ++i) {
        const ff_act_def *def = &crowd->behaviour->def.acts[i];
        bool speed = def->property == FF_PROPERTY_PREFERRED_SPEED;
        double *value = speed ? &conduct->speed : &conduct->variable[def->property - FF_PROPERTY_VARIABLE];
        ff_random random = {conduct->key, STREAM_ACT, conduct->draws++ << 8};
        double amount = ff_amount_draw(&def->amount, &random);
        double next =
            def->kind == FF_ACT_SET ? amount : (def->kind == FF_ACT_ADD ? *value + amount : *value * amount);
        *value = speed ? ff_clamp(next, SPEED_MIN, SPEED_MAX) : ff_clamp(next, -VALUE_MAX, VALUE_MAX);
    }
}

/* Tell navigation where to go now. */
static void direct(ff_crowd *crowd, uint32_t slot, bool stood)
{
    const ff_conduct *conduct = &crowd->conducts[slot];
    const ff_state_def *state = &crowd->behaviour->def.states[conduct->state];
    ff_traits *traits = &crowd->traits[slot];
    ff_mind *mind = &crowd->minds[slot];
    traits->preferred_speed = ff_clamp(conduct->speed * state->speed, SPEED_MIN, SPEED_MAX);
    traits->face = state->face;
    traits->face_at = state->face_at;
    if (state->face == FF_FACE_GOAL) {
        bool has = conduct->goal != FF_NONE;
        traits->face = has ? FF_FACE_POINT : FF_FACE_FREE;
        if (has) traits->face_at = crowd->behaviour->def.goals[conduct->goal].look_at;
    }
    if (state->motion == FF_MOTION_STAND) {
        if (stood) return;
        bool still = mind->standing != FF_WALKS;
        traits->goal = crowd->bodies[slot].position;
        traits->goal_tolerance = STAND_ROOM;
        ff_mind_forget_goal(mind);
        if (still) mind->standing = FF_STANDS;
        return;
    }
    double tolerance = crowd->behaviour->tolerance[conduct->state];
    traits->goal_tolerance = tolerance > 0.0 ? tolerance : conduct->tolerance;
    if (traits->goal.a == conduct->place.a && traits->goal.b == conduct->place.b) return;
    traits->goal = conduct->place;
    ff_mind_forget_goal(mind);
}

static bool enter(ff_crowd *crowd, uint32_t slot, uint32_t next)
{
    const ff_behaviour_def *def = &crowd->behaviour->def;
    ff_conduct *conduct = &crowd->conducts[slot];
    ff_pick pick;
    if (!ff_behave_choose(crowd->behaviour, &def->states[next], crowd->bodies[slot].position, conduct, &pick))
        return false;
    bool stood = false;
    if (conduct->state != FF_NONE) {
        const ff_state_def *before = &def->states[conduct->state];
        stood = before->motion == FF_MOTION_STAND;
        act(crowd, slot, before->first_exit, before->exit_count);
    }
    take_goal(crowd, slot, &pick);
    conduct->state = next;
    conduct->entered = crowd->steps;
    conduct->blocked = 0.0;
    ++conduct->entries;
    act(crowd, slot, def->states[next].first_enter, def->states[next].enter_count);
    direct(crowd, slot, stood);
    return true;
}

bool ff_crowd_behave_start(ff_crowd *crowd, uint32_t slot, uint32_t machine, uint32_t spawner)
{
    const ff_traits *traits = &crowd->traits[slot];
    ff_conduct *conduct = &crowd->conducts[slot];
    *conduct = (ff_conduct){.place = crowd->bodies[slot].position,
                            .speed = traits->preferred_speed,
                            .tolerance = traits->goal_tolerance,
                            .key = ff_random_at(crowd->def.seed, KEYS, crowd->added),
                            .born = crowd->steps,
                            .entered = crowd->steps,
                            .state = FF_NONE,
                            .machine = machine,
                            .goal = FF_NONE,
                            .set = FF_NONE,
                            .last = FF_NONE,
                            .spawner = spawner};
    if (machine == FF_NONE) return true;
    const ff_behaviour_def *def = &crowd->behaviour->def;
    for (uint32_t i = 0; i < def->variable_count; ++i)
        conduct->variable[i] = def->variables[i].start;
    return enter(crowd, slot, def->machines[machine].start);
}

void ff_crowd_behave_speed(ff_crowd *crowd, uint32_t slot, double speed)
{
    ff_conduct *conduct = &crowd->conducts[slot];
    conduct->speed = speed;
    if (conduct->state == FF_NONE) return;
    double factor = crowd->behaviour->def.states[conduct->state].speed;
    crowd->traits[slot].preferred_speed = ff_clamp(speed * factor, SPEED_MIN, SPEED_MAX);
}

void ff_crowd_behave_end(ff_crowd *crowd, uint32_t slot)
{
    const ff_conduct *conduct = &crowd->conducts[slot];
    if (conduct->goal != FF_NONE) --crowd->behaviour->taken[conduct->goal];
    if (conduct->spawner != FF_NONE) --crowd->behaviour->spawning[conduct->spawner].alive;
}

void ff_crowd_behave_recount(ff_crowd *crowd)
{
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        if (!crowd->alive[slot]) continue;
        const ff_conduct *conduct = &crowd->conducts[slot];
        if (conduct->goal != FF_NONE) ++crowd->behaviour->taken[conduct->goal];
        if (conduct->spawner != FF_NONE) ++crowd->behaviour->spawning[conduct->spawner].alive;
    }
}

/* ------------------------------------------------------------------------------------------- second part */

/* One of the transition's targets, by weight. */
static uint32_t draw_target(const ff_behaviour_def *def, const ff_transition_def *transition,
                            ff_conduct *conduct)
{
    const ff_target_def *target = &def->targets[transition->first_target];
    if (transition->target_count == 1) return target->state;
    double sum = 0.0;
    for (uint32_t i = 0; i < transition->target_count; ++i)
        sum += target[i].weight;
    ff_random random = {conduct->key, 0, conduct->draws++};
    double left = sum * ff_random_unit(&random);
    uint32_t i = 0;
    for (; i + 1 < transition->target_count && left >= target[i].weight; ++i)
        left -= target[i].weight;
    return target[i].state;
}

/* What begins with this transition of its state: it may go through several states at one moment. One into a state whose
 * goals are all full does not happen, and the next is tried. */
static void change(ff_crowd *crowd, uint32_t slot, uint32_t firing)
{
    const ff_behaviour_def *def = &crowd->behaviour->def;
    ff_conduct *conduct = &crowd->conducts[slot];
    ff_fault *fault = &crowd->behaviour->fault;
    uint32_t changes = 0;
    while (firing != FF_NONE) {
        if (changes == FF_ZERO_TIME_MAX) {
            if (fault->number == FF_NONE)
                *fault = (ff_fault){crowd->number[slot], conduct->state, crowd->steps};
            return;
        }
        const ff_state_def *state = &def->states[conduct->state];
        const ff_transition_def *transition = &def->transitions[state->first_transition + firing];
        bool entered = enter(crowd, slot, draw_target(def, transition, conduct));
        changes += entered;
        ff_behave_view view = view_of(crowd, slot);
        firing = ff_behave_find(&view, entered ? 0 : firing + 1);
    }
}

void ff_crowd_behave(ff_crowd *crowd)
{
    ff_crowd_for_chunks(crowd, crowd->slot_count, look_chunk, crowd);
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        if (!crowd->alive[slot] || crowd->firing[slot] == FF_NONE) continue;
        if (crowd->firing[slot] == LEAVES) {
            ff_crowd_take_out(crowd, slot);
            ++crowd->left;
        } else {
            change(crowd, slot, crowd->firing[slot]);
        }
    }
    ff_crowd_spawn(crowd);
}

/* ----------------------------------------------------------------------------------------------- questions */

ff_status ff_crowd_fault(const ff_crowd *crowd, ff_error *error)
{
    const ff_behaviour *behaviour = crowd->behaviour;
    if (!behaviour || behaviour->fault.number == FF_NONE) return FF_OK;
    return ff_fail(
        error, FF_ERR_RANGE,
        "agent %u went through more than %u states at %.2f s and is in \"%s\": its transitions lead round "
        "and round without any time passing; give one of them a timer or another condition",
        behaviour->fault.number, FF_ZERO_TIME_MAX, (double)behaviour->fault.step * crowd->def.step,
        behaviour->def.states[behaviour->fault.state].name);
}

ff_status ff_crowd_agent_behaviour(const ff_crowd *crowd, ff_agent agent, ff_agent_behaviour *out,
                                   ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK && !out)
        status = ff_fail(error, FF_ERR_ARGUMENT, "nowhere to put what an agent is at");
    if (status != FF_OK) return status;
    *out = (ff_agent_behaviour){FF_NONE, FF_NONE, FF_NONE, FF_NONE, 0.0};
    if (!crowd->behaviour) return FF_OK;
    const ff_conduct *conduct = &crowd->conducts[agent.slot];
    double seconds = (double)(crowd->steps - conduct->entered) * crowd->def.step;
    *out = (ff_agent_behaviour){conduct->machine, conduct->state, conduct->goal, conduct->spawner, seconds};
    return FF_OK;
}

uint32_t ff_crowd_goal_taken(const ff_crowd *crowd, uint32_t goal)
{
    const ff_behaviour *behaviour = crowd->behaviour;
    return behaviour && goal < behaviour->def.goal_count ? behaviour->taken[goal] : 0;
}

uint32_t ff_crowd_signal_phase(const ff_crowd *crowd, uint32_t signal)
{
    if (!crowd->behaviour || signal >= crowd->behaviour->def.signal_count) return FF_NONE;
    return ff_behave_phase(crowd->behaviour, signal, (double)crowd->steps * crowd->def.step);
}

ff_status ff_crowd_set_signal(ff_crowd *crowd, uint32_t signal, uint32_t phase, ff_error *error)
{
    const ff_behaviour_def *def = crowd && crowd->behaviour ? &crowd->behaviour->def : NULL;
    if (!def || signal >= def->signal_count ||
        (phase != FF_NONE && phase >= def->signals[signal].phase_count))
        return ff_fail(error, FF_ERR_ARGUMENT, "the crowd has no signal %u with a phase %u", signal, phase);
    crowd->behaviour->shown[signal] = phase;
    return FF_OK;
}
