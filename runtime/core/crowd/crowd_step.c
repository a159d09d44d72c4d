/* One step of a crowd, in phases; each is a loop over agents that reads the last step's state and writes its own
 * agent's records only (algorithms E). */
#define _POSIX_C_SOURCE 199309L
#include "runtime/core/crowd/crowd_behave.h"

#include <time.h>

#define DOUBLE_SUPPORT 0.24 /* of a step */
#define RUN_SUPPORT 0.4     /* of a running step: pushing off is over when the foot leaves, then it flies */
#define STEPPER_REACH                                                                                        \
    0.1 /* m: whose steps are planned swings hands and feet where it will, and gives no way */
#define WALLS_WITHIN 1.5 /* m: a second away for who walks fast */
/* s: a low-pass as late as the displacement over 0.25 s (algorithms E, 9), for those who are not told the rates */
#define SEEN_DELAY 0.125

double ff_crowd_clock(const ff_crowd *crowd)
{
    struct timespec time;
    bool alone = crowd->def.threads == 1 && !crowd->def.tasks;
    clock_gettime(alone ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* ----------------------------------------------------------------------------------------------- parallel */

void ff_crowd_for_chunks(ff_crowd *crowd, uint32_t count, void (*run)(void *context, uint32_t chunk),
                         void *context)
{
    uint32_t chunks = (count + FF_CROWD_CHUNK - 1) / FF_CROWD_CHUNK;
    if (crowd->def.tasks)
        crowd->def.tasks(crowd->def.task_pool, chunks, run, context);
    else
        ff_tasks_for(crowd->own_tasks, chunks, 1, run, context);
}

typedef struct agent_loop {
    ff_crowd *crowd;
    void (*agent)(ff_crowd *crowd, uint32_t index); /* into grid.seen, or into live */
} agent_loop;

static void run_chunk(void *context, uint32_t chunk)
{
    const agent_loop *loop = context;
    uint32_t end = (chunk + 1) * FF_CROWD_CHUNK, count = loop->crowd->grid.count;
    if (end > count) end = count;
    for (uint32_t i = chunk * FF_CROWD_CHUNK; i < end; ++i)
        loop->agent(loop->crowd, i);
}

/* Returns when it was done. */
static double run_phase(ff_crowd *crowd, void (*agent)(ff_crowd *crowd, uint32_t index))
{
    agent_loop loop = {crowd, agent};
    ff_crowd_for_chunks(crowd, crowd->grid.count, run_chunk, &loop);
    return ff_crowd_clock(crowd);
}

/* ------------------------------------------------------------------------------------------------- phases */

static bool baseline(const ff_crowd *crowd, uint32_t slot)
{
    return crowd->traits[slot].navigation != FF_NAVIGATION_MCN;
}

static void snapshot(ff_crowd *crowd)
{
    uint32_t count = 0;
    crowd->stepper_count = 0;
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        if (!crowd->alive[slot]) continue;
        const ff_body *body = &crowd->bodies[slot];
        const ff_mind *mind = &crowd->minds[slot];
        bool outside = baseline(crowd, slot) && !crowd->def.baseline.model_velocity;
        ff_vec2 velocity = outside ? mind->measured : ff_body_velocity(body);
        /* Study 4, 4; ORCA alone knows no command but what is seen. */
        ff_vec2 reference = baseline(crowd, slot) ? velocity
                                                  : ff_nav_reference(&crowd->def.mcn, &crowd->traits[slot],
                                                                     mind, body->position, velocity);
        bool firm = ff_is_stepper(crowd, slot);
        if (firm) velocity = reference = ff_stepper_shows(crowd, slot);
        crowd->live[count] = slot;
        crowd->unsorted[count++] =
            (ff_seen){.position = body->position,
                      .velocity = velocity,
                      .reference = reference,
                      .preferred = mind->preferred,
                      .goal = crowd->traits[slot].goal,
                      .radius = crowd->traits[slot].radius + (firm ? STEPPER_REACH : 0.0),
                      .slot = slot,
                      .standing = mind->standing,
                      .firm = firm};
        crowd->stepper_count += firm;
    }
    ff_grid_fill(&crowd->grid, crowd->unsorted, count);
}

static void find_neighbours(ff_crowd *crowd, uint32_t index)
{
    uint32_t slot = crowd->grid.seen[index].slot;
    if (ff_is_stepper(crowd, slot)) return;
    double padding = baseline(crowd, slot) ? crowd->def.baseline.padding : crowd->def.mcn.padding;
    crowd->neighbour_count[index] =
        ff_grid_neighbours(&crowd->grid, index, padding, crowd->neighbours[index]);
}

/* By which way it shall move from now on (FbCrowd eq 1). */
static void choose(ff_crowd *crowd, uint32_t index)
{
    const ff_seen *me = &crowd->grid.seen[index];
    const ff_traits *traits = &crowd->traits[me->slot];
    ff_gait *gait = &crowd->gaits[me->slot];
    ff_choice_view view = {
        .step = crowd->def.step,
        .time = INFINITY,
        .ahead = ff_dot2(crowd->minds[me->slot].command, ff_fwd2(crowd->bodies[me->slot].heading)),
        .since_switch = gait->since_switch,
        .hurries = traits->preferred_speed > FF_RUN_PREFERRED};
    if (traits->synthesis == FF_SYNTHESIS_HYBRID) {
        const ff_wall *walls[FF_NEAR_WALLS_MAX];
        uint32_t wall_count =
            ff_walls_near(&crowd->walls, me->position, traits->radius + WALLS_WITHIN, walls);
        view.time =
            ff_choice_time(me, crowd->neighbours[index], crowd->neighbour_count[index], walls, wall_count);
        view.density = ff_choice_density(&crowd->grid, index);
    }
    bool urgent;
    ff_locomotion way =
        ff_choose_locomotion((ff_synthesis)traits->synthesis, &view, &crowd->choices[me->slot], &urgent);
    ff_gait_want(crowd->space, gait, way, urgent);
}

/* Agents near each other may be anywhere in memory: have what is read of the next ones brought near. */
#define AHEAD 3
static void fetch_ahead(const ff_crowd *crowd, uint32_t index)
{
#ifdef __GNUC__
    if (index + AHEAD >= crowd->grid.count) return;
    uint32_t slot = crowd->grid.seen[index + AHEAD].slot;
    const ff_gait *gait = &crowd->gaits[slot];
    const char *mind = (const char *)&crowd->minds[slot];
    for (size_t line = 0; line < sizeof *crowd->minds; line += 64)
        __builtin_prefetch(mind + line, 1);
    __builtin_prefetch(&gait->foot[0].planted);
    __builtin_prefetch(&gait->foot[1].planted);
    __builtin_prefetch(&gait->blend.way);
    __builtin_prefetch(&crowd->traits[slot]);
    __builtin_prefetch(&crowd->bodies[slot]);
#else
    (void)crowd, (void)index;
#endif
}

static void navigate(ff_crowd *crowd, uint32_t index)
{
    uint32_t slot = crowd->grid.seen[index].slot;
    fetch_ahead(crowd, index);
    if (ff_is_stepper(crowd, slot)) return;
    const ff_crowd_def *def = &crowd->def;
    bool clip = crowd->gaits[slot].blend.way == FF_SEMI_PROCEDURAL &&
                crowd->traits[slot].preferred_speed <= FF_RUN_PREFERRED;
    const ff_hull *hull = clip ? &crowd->clip_hull : &crowd->hull;
    ff_nav_world world = {&crowd->grid,    &crowd->walls,    hull, &def->mcn,     def->step,
                          def->keep_right, def->mcn.padding, NULL, crowd->movers, crowd->mover_count};
    if (crowd->footsteps) world.paths = crowd->footsteps->paths;
    if (baseline(crowd, slot)) {
        world.keep_right = def->baseline.keep_right;
        world.padding = def->baseline.padding;
    }
    ff_nav_body body = {.heading = crowd->bodies[slot].heading};
    body.stance.foot = ff_gait_stance(&crowd->gaits[slot], &body.stance.ball, &body.stance.heading);
    ff_nav_step(&world, index, crowd->neighbours[index], crowd->neighbour_count[index], &crowd->traits[slot],
                &body, &crowd->minds[slot]);
    if (crowd->footsteps) ff_glide_choose(crowd, index);
    choose(crowd, index);
}

typedef struct gait_of {
    const ff_blend_space *space;
    const ff_gait *gait;
} gait_of;

static ff_rates clamp_to_gait(const void *context, ff_rates target)
{
    const gait_of *of = context;
    return ff_gait_clamp(of->space, of->gait, target);
}

/* Where in a step the legs are: 0 at a contact, DOUBLE_SUPPORT when the other foot leaves (key phases, synthesis study
 * 2). The body pushes off and brakes on the plants that are really seen. */
static double step_phase(const ff_gait *gait)
{
    if (gait->mode == FF_GAIT_STAND) return 0.0;
    double key = gait->phase - 2.0 * floor(0.5 * gait->phase);
    if (gait->blend.way == FF_RUNNING)
        return key < 1.0 ? RUN_SUPPORT * key : RUN_SUPPORT + (1.0 - RUN_SUPPORT) * (key - 1.0);
    return key < 1.0 ? DOUBLE_SUPPORT * key : DOUBLE_SUPPORT + (1.0 - DOUBLE_SUPPORT) * (key - 1.0);
}

static void move(ff_crowd *crowd, uint32_t index)
{
    uint32_t slot = crowd->live[index];
    if (ff_is_stepper(crowd, slot)) {
        ff_footsteps_play(crowd, slot);
        return;
    }
    ff_body *body = &crowd->bodies[slot];
    const ff_mind *mind = &crowd->minds[slot];
    const ff_wall *walls[FF_NEAR_WALLS_MAX];
    double radius = crowd->traits[slot].radius, dt = crowd->def.step;
    ff_vec2 before = body->position;
    ff_gait *gait = &crowd->gaits[slot];
    gait_of of = {crowd->space, gait};
    ff_body_limits limits = {
        clamp_to_gait, &of, walls, 0, radius, crowd->def.mcn.back_pedal || mind->standing};
    limits.wall_count = ff_walls_near(&crowd->walls, before, radius + WALLS_WITHIN, walls);
    body->phase = step_phase(gait);
    crowd->rates[slot] = ff_body_step(body, mind->command, mind->facing, dt, &limits);
    crowd->velocity[slot] = ff_scale2(ff_sub2(body->position, before), 1.0 / dt);
    if (baseline(crowd, slot)) {
        ff_mind *seen = &crowd->minds[slot];
        double share = 1.0 - ff_exp(-dt / SEEN_DELAY);
        seen->measured = ff_madd2(seen->measured, ff_sub2(crowd->velocity[slot], seen->measured), share);
    }
}

static void synthesise(ff_crowd *crowd, uint32_t index)
{
    uint32_t slot = crowd->live[index];
    if (ff_is_stepper(crowd, slot)) return;
    const ff_body *body = &crowd->bodies[slot];
    ff_gait_step(crowd->space, &crowd->gaits[slot], body->position, body->heading, crowd->rates[slot],
                 crowd->def.step);
}

void ff_crowd_step(ff_crowd *crowd)
{
    ff_crowd_timings *spent = &crowd->timings;
    double start = ff_crowd_clock(crowd);
    if (crowd->behaviour) ff_crowd_behave(crowd);
    double behaved = ff_crowd_clock(crowd);
    if (crowd->footsteps) ff_footsteps_change(crowd);
    ff_obstacles_step(crowd);
    snapshot(crowd);
    double seen = ff_crowd_clock(crowd);
    double found = run_phase(crowd, find_neighbours);
    double decided = run_phase(crowd, navigate);
    double planned = decided;
    if (crowd->footsteps) {
        run_phase(crowd, ff_footsteps_watch);
        planned = ff_footsteps_plan(crowd);
    }
    double moved = run_phase(crowd, move);
    double stepped = run_phase(crowd, synthesise);
    ++crowd->steps;
    spent->behaviour += behaved - start;
    spent->snapshot += seen - behaved;
    spent->neighbours += found - seen;
    spent->navigation += decided - found;
    spent->planning += planned - decided;
    spent->bodies += moved - planned;
    spent->synthesis += stepped - moved;
    spent->total += stepped - start;
}
