/* gait.c - standing, stepping and the change between them; the clock of the steps. */
#include "runtime/core/base/random.h"
#include "runtime/core/gait/foot_lock.h"
#include "runtime/core/gait/gait_arms.h"
#include "runtime/core/gait/gait_hips.h"
#include "runtime/core/gait/gait_switch.h"

#include <string.h>

#define RATE_SMOOTHING                                                                                       \
    0.10                  /* s: the blend follows the root's rates with this lag, the feet take up the rest */
#define WEIGHT_SPEED 10.0 /* 1/s, of all weights of the blend together: 0.2 s from one to quite another ... */
#define RUN_WEIGHT_SPEED 20.0 /* ... and of runs, which are alike */
#define HARDLY_MOVES 0.25     /* m/s, turning counted as in the blend space */
#define STAND_TIME 0.35       /* s from the walking to the standing pose and back */
#define SETTLED 0.8           /* of the way to the standing pose, from where on a step may begin */
#define START_SPEED 0.12      /* m/s and rad/s above which a standing body begins to step ... */
#define START_TURN 0.35
#define STOP_SPEED 0.08 /* ... and below both of which a stepping one comes to a stand */
#define STOP_TURN 0.20
#define STAND_AHEAD 0.10 /* m, rad: how far from its place a foot may be for standing */
#define STAND_ASIDE 0.06
#define STAND_YAW (20.0 * FF_DEG)
#define DRIFT_AHEAD                                                                                          \
    0.15 /* m, rad: how far from its place the body may drift before a standing foot steps after it */
#define DRIFT_YAW (28.0 * FF_DEG)
#define STRETCH_FROM 0.10 /* m between a planted foot and the clip's from where on steps quicken ... */
#define STRETCH_TO 0.30   /* ... to the most, and the foot steps as soon as the other stands */
#define MOST_TEMPO 1.5
#define RUN_MOST_TEMPO 1.2 /* who runs has legs that are about as fast as they get ... */
#define RUN_LIFTS                                                                                            \
    (3.0 * FF_DEG) /* ... and lets go of the ground, by as much, once a heel must rise to be in reach */
#define STRETCH_YAW (40.0 * FF_DEG)
#define PACE_TIME 0.08 /* s, in which the clock of the steps takes up a new pace ... */
#define FIRST_PACE 0.2 /* ... and what it begins with: a foot that has stood sets off slowly */
#define EARLY_LIFT                                                                                           \
    0.6 /* u: how much of its stance a foot that is left behind may skip; more, and it would hang in the air */
#define LEAST_SWING 0.3 /* u: a swing that would be shorter is left out */

size_t ff_gait_size(void)
{
    return sizeof(ff_gait);
}

int ff_gait_planted(const ff_gait *gait, int foot)
{
    return (int)gait->foot[foot].planted;
}

int ff_gait_stance(const ff_gait *gait, ff_vec2 *ball, double *heading)
{
    if (gait->foot[0].planted == gait->foot[1].planted) return -1;
    int foot = gait->foot[0].planted ? 0 : 1;
    const ff_foothold *lock = &gait->foot[foot].lock;
    *ball = ff_scale2(ff_v2(lock->a, lock->b), gait->style.scale);
    *heading = lock->yaw;
    return foot;
}

static void draw_style(ff_gait *gait, uint64_t variation)
{
    ff_random random = {variation, 0x67616974u, 0};
    gait->style.cadence = ff_clamp(1.0 + 0.02 * ff_random_normal(&random), 0.95, 1.05);
    gait->style.arms = ff_clamp(1.0 + 0.2 * ff_random_normal(&random), 0.6, 1.4);
    gait->style.stoop = ff_clamp(0.02 * ff_random_normal(&random), -0.05, 0.05);
    gait->idle_time = 20.0 * ff_random_unit(&random);
    gait->style.scale = 1.0;
    gait->first_foot = (uint32_t)(ff_random_next(&random) & 1u);
}

/* The smoothed rates lag by RATE_SMOOTHING, so what is missing of them is that much of the acceleration. */
static ff_foot_scene scene_of(const ff_blend_space *space, const ff_gait *gait, const ff_cursor *cursor,
                              ff_vec2 position, double heading, ff_rates rates, double dt)
{
    return (ff_foot_scene){.space = space,
                           .blend = &gait->blend,
                           .cursor = cursor,
                           .position = position,
                           .heading = heading,
                           .rates = rates,
                           .acceleration = {(rates.forward - gait->rates.forward) / RATE_SMOOTHING,
                                            (rates.left - gait->rates.left) / RATE_SMOOTHING,
                                            (rates.turn - gait->rates.turn) / RATE_SMOOTHING},
                           .phase = gait->phase,
                           .idle_time = gait->idle_time,
                           .dt = dt,
                           .tempo = 1.0,
                           .goal_tempo = 1.0};
}

static void put_feet(const ff_blend_space *space, ff_gait *gait, ff_vec2 position, double heading)
{
    ff_cursor cursor = ff_cursor_at(space, &gait->blend, gait->phase, gait->idle_time);
    ff_foot_scene scene = scene_of(space, gait, &cursor, position, heading, gait->rates, 0.0);
    for (int foot = 0; foot < 2; ++foot) {
        ff_foot_neutral(&scene, foot, 0.0, &gait->foot[foot].lock);
        ff_foot_land(&gait->foot[foot], space->body.ball_rest);
    }
}

void ff_gait_init(const ff_blend_space *space, ff_gait *gait, ff_vec2 position, double heading,
                  uint64_t variation)
{
    memset(gait, 0, sizeof *gait);
    draw_style(gait, variation);
    ff_blend_find(space, gait->rates, &gait->blend);
    gait->mode = FF_GAIT_STAND;
    gait->stand = 1.0;
    put_feet(space, gait, position, heading);
}

void ff_gait_set_scale(const ff_blend_space *space, ff_gait *gait, ff_vec2 position, double heading,
                       double scale)
{
    gait->style.scale = scale;
    put_feet(space, gait, ff_scale2(position, 1.0 / scale), heading);
}

/* A foot's lock seen from where it would stand under the body: ahead, aside, yaw. */
static ff_vec3 lock_error(const ff_foot_scene *scene, const ff_gait_foot *state, int foot)
{
    ff_foothold neutral;
    ff_foot_neutral(scene, foot, 0.0, &neutral);
    ff_vec2 off =
        ff_to_frame2(ff_fwd2(scene->heading), ff_v2(state->lock.a - neutral.a, state->lock.b - neutral.b));
    return ff_v3(off.a, off.b, ff_wrap(state->lock.yaw - neutral.yaw));
}

static bool may_stand(const ff_foot_scene *scene, const ff_gait *gait)
{
    for (int foot = 0; foot < 2; ++foot) {
        if (!gait->foot[foot].planted) return false;
        ff_vec3 error = lock_error(scene, &gait->foot[foot], foot);
        if (fabs(error.x) > STAND_AHEAD || fabs(error.y) > STAND_ASIDE || fabs(error.z) > STAND_YAW)
            return false;
    }
    return true;
}

static double speed_of(ff_rates rates)
{
    return sqrt(rates.forward * rates.forward + rates.left * rates.left);
}

/* How urgently a standing foot should step to follow the body (1 = at its limit). */
static double drift(const ff_foot_scene *scene, const ff_gait *gait, int foot)
{
    ff_vec3 error = lock_error(scene, &gait->foot[foot], foot);
    return ff_max(sqrt(error.x * error.x + error.y * error.y) / DRIFT_AHEAD, fabs(error.z) / DRIFT_YAW);
}

static bool wants_to_step(const ff_foot_scene *scene, const ff_gait *gait)
{
    double worst = ff_max(drift(scene, gait, 0), drift(scene, gait, 1));
    if (worst > 1.4) return true;
    if (gait->stand < SETTLED)
        return false; /* first come to rest: the step then starts from a settled pose */
    return worst > 1.0 || speed_of(gait->rates) > START_SPEED || fabs(gait->rates.turn) > START_TURN;
}

/* The foot on the side the body goes or turns to opens the way; going straight it is the one left behind. */
static int choose_first_foot(const ff_foot_scene *scene, const ff_gait *gait)
{
    ff_rates rates = gait->rates;
    double sideways = rates.left + 0.3 * rates.turn;
    if (fabs(sideways) > 0.05 && fabs(sideways) > 0.2 * fabs(rates.forward)) return sideways > 0.0 ? 0 : 1;
    double left = drift(scene, gait, 0), right = drift(scene, gait, 1);
    if (fabs(left - right) > 0.2) return left > right ? 0 : 1;
    return (int)gait->first_foot;
}

/* Put the clock where the chosen foot is about to leave the ground. */
static void begin_stepping(const ff_foot_scene *scene, ff_gait *gait)
{
    double start, length;
    int foot = choose_first_foot(scene, gait);
    ff_blend_lock(scene->space, &gait->blend, foot, &start, &length);
    gait->phase = ff_phase_wrap(start + length);
    gait->pace = FIRST_PACE;
    gait->mode = FF_GAIT_STEP;
}

/* How far the body has left the planted foot behind: 0 none, 1 at the limit. */
static double stretch(const ff_foot_scene *scene, const ff_gait *gait, int foot)
{
    const ff_gait_foot *state = &gait->foot[foot];
    if (!state->planted) return 0.0;
    ff_foothold clip = ff_foot_of_clip(scene, foot);
    double a = state->lock.a - clip.a, b = state->lock.b - clip.b;
    double far = (sqrt(a * a + b * b) - STRETCH_FROM) / (STRETCH_TO - STRETCH_FROM);
    return ff_clamp(ff_max(far, fabs(ff_wrap(state->lock.yaw - clip.yaw)) / STRETCH_YAW - 1.0), 0.0, 1.0);
}

/* Walking, one foot is always down: it stands, or its heel has struck (key 0 left, key 2 right) and it is coming flat. Fast
 * walkers leave the ground with one foot before the other is flat; who comes to a stand does not. */
static bool is_down(const ff_foot_scene *scene, const ff_gait *gait, int foot)
{
    if (gait->foot[foot].planted) return true;
    if (ff_foot_closing(scene->rates) > 0.0) return false;
    return ff_phase_wrap(gait->phase - 2.0 * foot) < 1.0 && gait->foot[foot].progress > 0.5;
}

static bool time_to_lift(const ff_foot_scene *scene, const ff_gait *gait, int foot)
{
    if (gait->blend.way != FF_RUNNING && !is_down(scene, gait, 1 - foot)) return false;
    double start, length;
    ff_blend_lock(scene->space, &gait->blend, foot, &start, &length);
    double since = ff_phase_wrap(scene->phase - start);
    if (since >= length && FF_GAIT_KEYS - since > LEAST_SWING) return true;
    bool late = stretch(scene, gait, foot) >= 1.0 ||
                (gait->blend.way == FF_RUNNING && gait->foot[foot].raised > RUN_LIFTS);
    return late && since > length - EARLY_LIFT && FF_GAIT_KEYS - since > LEAST_SWING;
}

/* What the last switch has left of a difference. The place of a foot that stands is its lock's alone. */
static void add_offset(const ff_foot_scene *scene, const ff_pose_offset *offset, ff_gait_foot *state,
                       int foot)
{
    if (!ff_pose_offset_active(offset)) return;
    ff_pose_foot add = ff_pose_offset_foot(offset, foot);
    state->pitch += add.pitch;
    if (state->planted) {
        ff_foot_rest(&scene->space->body, state, foot);
        return;
    }
    state->now.height += add.height;
    ff_vec2 moved = ff_from_frame2(ff_fwd2(scene->heading), ff_v2(add.forward, add.left));
    state->now.a += moved.a;
    state->now.b += moved.b;
    state->now.yaw += add.yaw;
}

static void step_foot(const ff_foot_scene *scene, ff_gait *gait, int foot)
{
    ff_gait_foot *state = &gait->foot[foot];
    double flat = ff_smooth(gait->stand / SETTLED); /* who may step again stands on flat feet */
    bool lifts = state->planted && gait->mode == FF_GAIT_STEP && time_to_lift(scene, gait, foot);
    ff_foot_scene part = *scene;
    if (lifts) part.dt = ff_foot_lift(scene, state, foot, flat); /* the rest of this step is in the air */
    if (state->planted) {
        ff_foot_hold(scene, state, foot, flat);
    } else if (!(lifts && part.dt <= 0.0) && ff_foot_swing(&part, state, &gait->foot[1 - foot], foot)) {
        ff_foot_land(state, scene->space->body.ball_rest);
        ff_foot_hold(scene, state, foot, flat);
    }
    add_offset(scene, &gait->offset, state, foot);
    ff_foot_keep_clear(scene, state, &gait->foot[1 - foot], foot);
}

static void follow_rates(ff_gait *gait, ff_rates rates, double dt)
{
    double share = 1.0 - ff_exp(-dt / RATE_SMOOTHING);
    gait->rates.forward += share * (rates.forward - gait->rates.forward);
    gait->rates.left += share * (rates.left - gait->rates.left);
    gait->rates.turn += share * (rates.turn - gait->rates.turn);
}

/* What the blend is asked for. Weights are linear in the rates, so where these pass through zero they would turn on the spot,
 * and with them the pose: near zero the blend goes by the square. The feet do not mind, they are led by the root. */
static ff_rates blend_rates(ff_rates rates)
{
    double x = ff_length3(ff_blend_point(rates)) / HARDLY_MOVES;
    if (x >= 1.0) return rates;
    double share = x * (2.0 - x);
    return (ff_rates){rates.forward * share, rates.left * share, rates.turn * share};
}

/* By how much the weights of the blend may change. Who stands shows nothing of it; who is about to run, or has just come out of a
 * run, goes through all walks at once, and what is left of the change covers that. */
static double weight_change(const ff_gait *gait, double dt)
{
    bool ran = (double)gait->offset.time[0] > FF_POSE_OFFSET_TIME + 0.01;
    if (gait->blend.way == FF_RUNNING) return RUN_WEIGHT_SPEED * dt;
    bool free = gait->stand >= 1.0 || gait->wanted == FF_RUNNING || ran;
    return free ? FF_BLEND_CHANGE_MOST : WEIGHT_SPEED * dt;
}

static void follow_blend(const ff_blend_space *space, ff_gait *gait, double dt)
{
    ff_blend wanted;
    ff_rates asked = blend_rates(gait->rates);
    if (gait->blend.way == FF_SEMI_PROCEDURAL && gait->stand < 1.0) {
        ff_clip_follow(space, asked, dt, &gait->blend);
        return;
    }
    ff_locomotion_find(space, (ff_locomotion)gait->blend.way, asked, &wanted);
    ff_blend_follow(space, &wanted, weight_change(gait, dt), &gait->blend);
}

/* The clock of the steps: hurries when the body leaves its feet behind, and takes up its pace gradually. */
static void advance_phase(const ff_blend_space *space, ff_gait *gait, ff_foot_scene *scene)
{
    double most = ff_max(stretch(scene, gait, 0), stretch(scene, gait, 1));
    double hurry = ff_max(ff_smooth(most), 0.7 * ff_foot_closing(scene->rates));
    double quickest = gait->blend.way == FF_RUNNING ? RUN_MOST_TEMPO : MOST_TEMPO;
    double goal = (1.0 + (quickest - 1.0) * hurry) / gait->style.cadence;
    gait->pace += (1.0 - ff_exp(-scene->dt / PACE_TIME)) * (goal - gait->pace);
    gait->phase = ff_phase_advance(space, &gait->blend, gait->phase, scene->dt * gait->pace);
    scene->phase = gait->phase;
    scene->tempo = gait->pace;
    /* The goal jumps as a foot that was left behind lifts. A runner's other foot is nearly down by then, and would be led to
     * where it lands a little later within a frame: for runs, which begin at full pace, the present one is taken. */
    scene->goal_tempo = gait->blend.way == FF_RUNNING ? gait->pace : goal;
    scene->delay = PACE_TIME * (1.0 - gait->pace / scene->goal_tempo);
}

static void change_mode(const ff_foot_scene *scene, ff_gait *gait)
{
    if (gait->mode == FF_GAIT_STAND) {
        if (wants_to_step(scene, gait)) begin_stepping(scene, gait);
    } else if (speed_of(gait->rates) < STOP_SPEED && fabs(gait->rates.turn) < STOP_TURN &&
               gait->blend.way != FF_RUNNING && may_stand(scene, gait)) {
        gait->mode = FF_GAIT_STAND;
    }
}

void ff_gait_advance(const ff_blend_space *space, ff_gait *gait, const ff_gait_root *root, double dt)
{
    ff_vec2 position = root->position;
    double heading = root->heading;
    ff_rates rates = root->rates;
    ff_quat arms[FF_ARM_JOINTS];
    bool changing = ff_gait_arms_hurry(space, gait);
    ff_cursor cursor;
    if (changing) {
        cursor = ff_cursor_at(space, &gait->blend, gait->phase, gait->idle_time);
        ff_gait_arms(space, &cursor, arms);
    }
    follow_rates(gait, rates, dt);
    follow_blend(space, gait, dt);
    gait->idle_time += dt;
    ff_pose_offset_advance(&gait->offset, dt);

    cursor = ff_cursor_at(space, &gait->blend, gait->phase, gait->idle_time);
    ff_foot_scene scene = scene_of(space, gait, &cursor, position, heading, rates, dt);
    change_mode(&scene, gait);
    if (gait->mode == FF_GAIT_STEP) {
        advance_phase(space, gait, &scene);
        cursor = ff_cursor_at(space, &gait->blend, gait->phase, gait->idle_time);
    }
    if (changing) ff_gait_hold_arms(space, gait, &cursor, arms, dt);
    double toward = gait->mode == FF_GAIT_STAND ? dt / STAND_TIME : -dt / STAND_TIME;
    gait->stand = ff_clamp(gait->stand + toward, 0.0, 1.0);
    for (int foot = 0; foot < 2; ++foot)
        step_foot(&scene, gait, foot);
    ff_gait_lower_hips(space, gait, &cursor, position, heading, dt);
}

void ff_gait_want(const ff_blend_space *space, ff_gait *gait, ff_locomotion way, bool urgent)
{
    if (!ff_locomotion_available(space, way)) way = FF_BLENDING;
    if (gait->wanted != way) gait->waited = 0.0;
    gait->wanted = way;
    gait->urgent = urgent;
}

static ff_rates scaled(ff_rates rates, double size)
{
    return (ff_rates){rates.forward * size, rates.left * size, rates.turn};
}

ff_rates ff_gait_clamp(const ff_blend_space *space, const ff_gait *gait, ff_rates target)
{
    bool pace = gait->wanted == FF_RUNNING || gait->blend.way == FF_RUNNING;
    target = scaled(target, 1.0 / gait->style.scale);
    if (gait->wanted != gait->blend.way && !pace)
        target = ff_locomotion_clamp(space, (ff_locomotion)gait->wanted, target);
    return scaled(ff_locomotion_clamp(space, (ff_locomotion)gait->blend.way, target), gait->style.scale);
}

void ff_gait_step(const ff_blend_space *space, ff_gait *gait, ff_vec2 position, double heading,
                  ff_rates rates, double dt)
{
    double size = 1.0 / gait->style.scale;
    ff_gait_root root = {ff_scale2(position, size), heading, scaled(rates, size)};
    ff_gait_advance(space, gait, &root, dt);
    gait->seconds[gait->blend.way] += dt;
    gait->since_switch += dt;
    if (gait->wanted == gait->blend.way) return;
    gait->waited += dt;
    ff_gait_try_switch(space, gait, &root);
}
