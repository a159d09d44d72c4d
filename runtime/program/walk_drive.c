#include "runtime/program/walk_drive.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/base/random.h"
#include "runtime/core/gait/body.h"
#include "runtime/core/pack/joints.h"

#include <stdlib.h>

#define SPEED_UP 2.0 /* m/s2 and rad/s2 of given rates (gait facts: starts peak at 1.5 to 2.4 m/s2) */
#define TURN_UP 4.0
#define RUN 2.0    /* m/s, that nobody walks at */
#define CHANGE 1.3 /* s between changes, on average */

static const ff_course courses[] = {
    {"straight 0.4", FF_COURSE_STEADY, {0.4, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"straight 0.6", FF_COURSE_STEADY, {0.6, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"straight 0.8", FF_COURSE_STEADY, {0.8, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"straight 1.0", FF_COURSE_STEADY, {1.0, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"straight 1.2", FF_COURSE_STEADY, {1.2, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"straight 1.4", FF_COURSE_STEADY, {1.4, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"straight 1.6", FF_COURSE_STEADY, {1.6, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"straight 1.8", FF_COURSE_STEADY, {1.8, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"curve", FF_COURSE_STEADY, {1.2, 0.0, 0.5}, 0.0, 2, 0.0, false},
    {"tight curve", FF_COURSE_STEADY, {0.7, 0.0, -1.2}, 0.0, 2, 0.0, false},
    {"turning slowly", FF_COURSE_STEADY, {0.0, 0.0, 0.7}, 0.0, 2, 0.0, false},
    {"turning", FF_COURSE_STEADY, {0.0, 0.0, -1.5}, 0.0, 2, 0.0, false},
    {"side step 0.3", FF_COURSE_STEADY, {0.0, 0.3, 0.0}, 0.0, 2, 0.0, false},
    {"side step 0.6", FF_COURSE_STEADY, {0.0, -0.6, 0.0}, 0.0, 2, 0.0, false},
    {"diagonal", FF_COURSE_STEADY, {0.8, 0.35, 0.0}, 0.0, 2, 0.0, false},
    {"backward 0.4", FF_COURSE_STEADY, {-0.4, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"backward 0.7", FF_COURSE_STEADY, {-0.7, 0.0, 0.0}, 0.0, 2, 0.0, false},
    {"starts, stops", FF_COURSE_STOPS, {1.3, 0.0, 0.0}, 4.3, 2, 0.0, false},
    {"slow starts", FF_COURSE_STOPS, {0.5, 0.0, 0.0}, 5.1, 2, 0.0, false},
    {"fast starts", FF_COURSE_STOPS, {1.8, 0.0, 0.0}, 4.7, 2, 0.0, false},
    {"turns, stops", FF_COURSE_STOPS, {0.0, 0.0, 1.5}, 3.1, 2, 0.0, false},
    {"side, stops", FF_COURSE_STOPS, {0.0, 0.5, 0.0}, 3.7, 2, 0.0, false},
    {"back, stops", FF_COURSE_STOPS, {-0.6, 0.0, 0.0}, 4.1, 2, 0.0, false},
    {"dodging", FF_COURSE_WAVES, {0.8, 0.25, 0.9}, 3.0, 2, 0.0, false},
    {"commands", FF_COURSE_COMMANDS, {1.8, 0.6, 0.0}, 2.0, 2, 0.0, false},
    {"hasty commands", FF_COURSE_COMMANDS, {1.8, 0.6, 0.0}, 0.7, 2, 0.0, false},
    {"goals", FF_COURSE_GOALS, {2.0, 0.0, 0.0}, 8.0, 2, 12.0, false},
    {"crowd", FF_COURSE_GOALS, {1.6, 0.0, 0.0}, 8.0, 24, 8.0, false},
    {"run 2.4", FF_COURSE_STEADY, {2.4, 0.0, 0.0}, 0.0, 2, 0.0, true},
    {"run 3.0", FF_COURSE_STEADY, {3.0, 0.0, 0.0}, 0.0, 2, 0.0, true},
    {"run a curve", FF_COURSE_STEADY, {2.6, 0.0, 0.5}, 0.0, 2, 0.0, true},
    {"run, stops", FF_COURSE_STOPS, {2.8, 0.0, 0.0}, 6.1, 2, 0.0, true},
    {"run, walk", FF_COURSE_WAVES, {2.0, 0.0, 0.4}, 9.0, 2, 0.0, true},
    {"running goals", FF_COURSE_GOALS, {3.2, 0.0, 0.0}, 8.0, 2, 24.0, true},
};

const ff_course *ff_courses(uint32_t *count)
{
    *count = sizeof courses / sizeof *courses;
    return courses;
}

/* ------------------------------------------------------------------------------------------ one walker by rates */

typedef struct walker {
    const ff_course *course;
    const ff_walk_def *def;
    const ff_blend_space *space;
    ff_gait *gait;
    ff_body body;
    ff_random random;
    ff_vec2 command; /* m/s, of a body */
    double facing, until;
    double change; /* s, when the way of moving changes */
    bool control;
} walker;

static double towards(double now, double wanted, double most)
{
    return now + ff_clamp(wanted - now, -most, most);
}

static ff_rates scaled(ff_rates rates, double share)
{
    return (ff_rates){rates.forward * share, rates.left * share, rates.turn * share};
}

static ff_rates wanted_rates(const ff_course *course, double time)
{
    ff_rates rates = course->rates;
    double turns = time / course->period;
    switch (course->kind) {
    case FF_COURSE_STOPS:
        return turns - floor(turns) < 0.6 ? rates : scaled(rates, 0.0);
    case FF_COURSE_WAVES:
        return (ff_rates){rates.forward *
                              (1.0 + 0.6 * ff_sin(FF_TAU * turns) + 0.3 * ff_sin(FF_TAU * 2.4 * turns)),
                          rates.left * ff_sin(FF_TAU * 0.8 * turns + 2.0),
                          rates.turn * (ff_sin(FF_TAU * 0.6 * turns) + 0.4 * ff_sin(FF_TAU * 1.9 * turns))};
    default:
        return rates;
    }
}

static ff_rates clamp_to_gait(const void *context, ff_rates target)
{
    const walker *w = context;
    return ff_gait_clamp(w->space, w->gait, target);
}

/* Which way to move: of a hybrid walker now this, now that; whoever is asked for more than a walk runs. */
static void choose_way(walker *w, double time, double speed)
{
    if (w->def->synthesis == FF_SYNTHESIS_HYBRID && time >= w->change) {
        w->change = time + CHANGE * ff_random_range(&w->random, 0.4, 1.6);
        w->control = !w->control;
    }
    ff_locomotion way = w->control ? FF_SEMI_PROCEDURAL : FF_BLENDING;
    ff_gait_want(w->space, w->gait, speed > RUN ? FF_RUNNING : way, false);
}

/* Rates change no faster than people's, and are held to what the examples can do. */
static ff_rates follow_rates(walker *w, double time, double step)
{
    ff_rates asked = wanted_rates(w->course, time);
    choose_way(w, time, asked.forward);
    ff_rates wanted = clamp_to_gait(w, asked), now = w->body.rates;
    now.forward = towards(now.forward, wanted.forward, SPEED_UP * step);
    now.left = towards(now.left, wanted.left, SPEED_UP * step);
    now.turn = towards(now.turn, wanted.turn, TURN_UP * step);
    now = clamp_to_gait(w, now);
    ff_vec2 ahead = ff_fwd2(w->body.heading + 0.5 * now.turn * step);
    w->body.position = ff_madd2(w->body.position, ff_from_frame2(ahead, ff_v2(now.forward, now.left)), step);
    w->body.heading = ff_wrap(w->body.heading + now.turn * step);
    w->body.rates = now;
    return now;
}

/* Now and then another way to go and to look: mostly ahead, sometimes aside or back, sometimes nowhere. */
static ff_rates follow_commands(walker *w, double time, double step)
{
    if (time >= w->until) {
        w->until = time + w->course->period * ff_random_range(&w->random, 0.3, 1.7);
        double what = ff_random_unit(&w->random), turn = ff_random_range(&w->random, -2.5, 2.5);
        w->facing = ff_wrap(w->body.heading + (what < 0.3 ? turn : 0.3 * turn));
        double speed = ff_random_range(&w->random, 0.0, w->course->rates.forward), way = w->facing;
        if (what > 0.7) {
            speed *= 0.4;
            way += ff_random_range(&w->random, -FF_PI, FF_PI);
        }
        w->command = what > 0.6 && what < 0.7 ? ff_v2(0.0, 0.0) : ff_scale2(ff_fwd2(way), speed);
    }
    choose_way(w, time, 0.0);
    ff_body_limits limits = {.clamp = clamp_to_gait, .context = w, .radius = 0.3, .back_pedal = true};
    return ff_body_step(&w->body, w->command, w->facing, step, &limits);
}

static ff_status show(const walker *w, uint32_t index, ff_vec2 velocity, ff_walk_visit *visit, void *context,
                      ff_error *error)
{
    ff_quat rotations[FF_JOINT_COUNT];
    ff_walk_pose pose = {.walker = index, .rotations = rotations};
    pose.state.position = w->body.position;
    pose.state.velocity = velocity;
    pose.state.heading = w->body.heading;
    pose.state.turn_rate = w->body.rates.turn;
    for (int foot = 0; foot < 2; ++foot)
        pose.state.planted[foot] = (uint8_t)ff_gait_planted(w->gait, foot);
    ff_gait_pose(w->space, w->gait, w->body.position, w->body.heading, &pose.hips, rotations);
    return visit(context, &pose, error);
}

static ff_status walk_one(walker *w, uint32_t index, ff_walk_visit *visit, void *context, ff_error *error)
{
    double step = w->def->step;
    uint64_t count = (uint64_t)(w->def->seconds / step + 0.5);
    ff_gait_init(w->space, w->gait, w->body.position, w->body.heading, ff_random_next(&w->random));
    ff_status status = show(w, index, ff_v2(0.0, 0.0), visit, context, error);
    for (uint64_t k = 0; k < count && status == FF_OK; ++k) {
        double time = (double)k * step;
        ff_vec2 before = w->body.position;
        ff_rates rates = w->course->kind == FF_COURSE_COMMANDS ? follow_commands(w, time, step)
                                                               : follow_rates(w, time, step);
        ff_gait_step(w->space, w->gait, w->body.position, w->body.heading, rates, step);
        ff_vec2 velocity = ff_scale2(ff_sub2(w->body.position, before), 1.0 / step);
        status = show(w, index, velocity, visit, context, error);
    }
    return status;
}

static ff_status walk_each(const ff_pack *pack, const ff_course *course, const ff_walk_def *def,
                           ff_walk_visit *visit, void *context, ff_error *error)
{
    ff_blend_space *space;
    ff_status status = ff_blend_space_create(pack, &space, error);
    if (status != FF_OK) return status;
    ff_gait *gait = ff_calloc(1, ff_gait_size());
    if (!gait) status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a walker");
    for (uint32_t i = 0; i < course->walkers && status == FF_OK; ++i) {
        walker w = {.course = course,
                    .def = def,
                    .space = space,
                    .gait = gait,
                    .random = {def->seed, i, 0},
                    .control = def->synthesis == FF_SYNTHESIS_SEMI_PROCEDURAL};
        status = walk_one(&w, i, visit, context, error);
    }
    free(gait);
    ff_blend_space_destroy(space);
    return status;
}

/* ---------------------------------------------------------------------------------------------- a crowd by goals */

static ff_vec2 somewhere(const ff_course *course, ff_random *random)
{
    double half = 0.5 * course->side;
    double a = ff_random_range(random, -half, half);
    return ff_v2(a, ff_random_range(random, -half, half));
}

static ff_status show_crowd(const ff_crowd *crowd, const ff_agent *agents, uint32_t count,
                            ff_walk_visit *visit, void *context, ff_error *error)
{
    ff_quat rotations[FF_JOINT_COUNT];
    ff_status status = FF_OK;
    for (uint32_t i = 0; i < count && status == FF_OK; ++i) {
        ff_walk_pose pose = {.walker = i, .rotations = rotations};
        status = ff_crowd_agent_state(crowd, agents[i], &pose.state, error);
        if (status == FF_OK) status = ff_crowd_agent_pose(crowd, agents[i], &pose.hips, rotations, error);
        if (status == FF_OK) status = visit(context, &pose, error);
    }
    return status;
}

static ff_status populate(ff_crowd *crowd, const ff_course *course, ff_random *random, ff_agent *agents,
                          ff_error *error)
{
    uint32_t row = (uint32_t)ceil(sqrt((double)course->walkers));
    ff_status status = FF_OK;
    for (uint32_t i = 0; i < course->walkers && status == FF_OK; ++i) {
        ff_agent_def def = ff_agent_def_default();
        def.position =
            ff_scale2(ff_v2(i / row + 0.5 - 0.5 * row, i % row + 0.5 - 0.5 * row), course->side / row);
        def.goal = somewhere(course, random);
        def.heading = ff_random_range(random, -FF_PI, FF_PI);
        def.preferred_speed = ff_random_range(random, 0.5, course->rates.forward);
        status = ff_crowd_add_agent(crowd, &def, &agents[i], error);
    }
    return status;
}

static ff_status walk_crowd(const ff_pack *pack, const ff_course *course, const ff_walk_def *walk,
                            ff_walk_visit *visit, void *context, ff_error *error)
{
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = course->walkers;
    def.step = walk->step;
    def.seed = walk->seed;
    def.synthesis = walk->synthesis;
    ff_random random = {walk->seed, 0, 0};
    ff_agent *agents = ff_calloc(course->walkers, sizeof *agents);
    if (!agents) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u walkers", course->walkers);
    ff_status status = ff_crowd_create(pack, &def, &crowd, error);
    if (status == FF_OK) status = populate(crowd, course, &random, agents, error);
    if (status == FF_OK) status = show_crowd(crowd, agents, course->walkers, visit, context, error);
    uint64_t count = (uint64_t)(walk->seconds / walk->step + 0.5);
    for (uint64_t k = 0; k < count && status == FF_OK; ++k) {
        for (uint32_t i = 0; i < course->walkers && status == FF_OK; ++i)
            if (ff_random_unit(&random) < walk->step / course->period)
                status = ff_crowd_set_goal(crowd, agents[i], somewhere(course, &random), error);
        ff_crowd_step(crowd);
        if (status == FF_OK) status = show_crowd(crowd, agents, course->walkers, visit, context, error);
    }
    ff_crowd_destroy(crowd);
    free(agents);
    return status;
}

ff_status ff_walk_drive(const ff_pack *pack, const ff_course *course, const ff_walk_def *def,
                        ff_walk_visit *visit, void *context, ff_error *error)
{
    return course->kind == FF_COURSE_GOALS ? walk_crowd(pack, course, def, visit, context, error)
                                           : walk_each(pack, course, def, visit, context, error);
}
