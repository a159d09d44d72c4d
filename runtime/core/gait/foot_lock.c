#include "runtime/core/gait/foot_lock.h"

#define SLOPE_LIMIT 1.0      /* m/s, study section 4.2 */
#define SET_OFF_TIME 0.15    /* s, in which a foot that stood at rest takes up the swing */
#define STOOD_TEMPO 0.35     /* of the steps' clock: slower is a first step */
#define PLAN_SPEED 2.5       /* m/s, how fast a footprint may move early in swing; none at the end */
#define PLAN_TURN 6.0        /* rad/s, the same for its yaw */
#define CLOSE_UP_SPEED 0.25  /* m/s (turning counted as in the blend space) */
#define SPEED_UP_TIME 0.1    /* s, for which a root that speeds up is taken to go on doing so */
#define LEAST_LIFT 0.035     /* m, of the ball in mid swing (study, section 5: 4.5 cm for small steps) */
#define HEEL_CLEARANCE 0.018 /* m, the same of the heel (gait facts: people 1.4 to 2.3 cm) */
#define STRIKE 0.9           /* of the swing, which lasts until the foot is flat: the heel is down, */
#define STRIKES_FROM 0.22    /* and comes down for so long: where swings slow, 0.77 is yet in their middle */
#define CLEAR_ROUND 0.01     /* m, over which the corner is rounded where either begins to raise a foot, */
#define CLEAR_ROUND_RUN 0.02 /* and where a runner's comes to it, which is faster */
#define LIFT_WINDOW 0.5      /* of the swing, for offsets of height after the lift ... */
#define LAND_WINDOW 0.25     /* ... and before the landing, where the heel is near the floor */
#define PASS_ASIDE 0.08      /* m between ankles as one passes the other (gait facts: people 8.7 to 9.4 cm) */
#define PASS_AHEAD 0.30      /* m, from where on ankles are not beside each other */
#define LEAST_SPREAD 0.11    /* m between balls sideways while the feet are side by side */
#define LEAST_HEELS 0.08     /* m, the same between ankles beside each other ... */
#define HEELS_GIVE 7.0       /* 1/m: ... and less by this times the square of how far one is ahead */
#define LEAST_SPREAD_AHEAD 0.30 /* m, from where on one foot in front of the other may be in line with it */

/* Mean over the next time s of a rate that changes by acceleration until it is zero, or for SPEED_UP_TIME. */
static double mean_rate(double rate, double acceleration, double time)
{
    if (time <= 0.0) return rate;
    if (rate * acceleration < 0.0) {
        double stop = -rate / acceleration;
        return time < stop ? rate + 0.5 * acceleration * time : 0.5 * rate * stop / time;
    }
    double grow = ff_min(time, SPEED_UP_TIME);
    return rate + acceleration * grow * (1.0 - 0.5 * grow / time);
}

void ff_root_predict(const ff_foot_scene *scene, double time, ff_vec2 *position, double *heading)
{
    ff_rates now = scene->rates, change = scene->acceleration;
    double forward = mean_rate(now.forward, change.forward, time);
    double left = mean_rate(now.left, change.left, time);
    double turn = mean_rate(now.turn, change.turn, time) * time;
    double half = ff_clamp(0.5 * turn, -1.5, 1.5), square = half * half;
    double chord =
        1.0 - square / 6.0 * (1.0 - square / 20.0); /* sin(x)/x: the chord is shorter than the arc */
    ff_vec2 ahead = ff_fwd2(scene->heading + 0.5 * turn);
    ff_vec2 moved = ff_from_frame2(ahead, ff_v2(forward * time, left * time));
    *position = ff_madd2(scene->position, moved, chord);
    *heading = scene->heading + turn;
}

static ff_foothold place(ff_vec2 root, double heading, ff_foot_sample sample)
{
    ff_vec2 ball = ff_add2(root, ff_from_frame2(ff_fwd2(heading), ff_v2(sample.forward, sample.left)));
    return (ff_foothold){ball.a, ball.b, sample.height, heading + sample.yaw};
}

ff_foothold ff_foot_of_clip(const ff_foot_scene *scene, int foot)
{
    return place(scene->position, scene->heading, ff_sample_foot(scene->space, scene->cursor, foot));
}

/* The clip's foot in the world at a later phase, time s from now, should the rates stay. */
static ff_foothold clip_foot_later(const ff_foot_scene *scene, int foot, double phase, double time)
{
    ff_vec2 root;
    double heading;
    ff_root_predict(scene, time, &root, &heading);
    ff_cursor cursor = ff_cursor_at(scene->space, scene->blend, phase, scene->idle_time + time);
    return place(root, heading, ff_sample_foot(scene->space, &cursor, foot));
}

static ff_foothold subtract(ff_foothold p, ff_foothold q)
{
    return (ff_foothold){p.a - q.a, p.b - q.b, p.height - q.height, ff_wrap(p.yaw - q.yaw)};
}

/* How fast the clip's foot moves over the ground about a phase, at which it is then: 0 for a clip without skate at its own
 * rates. */
static ff_foothold clip_foot_speed(const ff_foot_scene *scene, int foot, double phase, double time,
                                   ff_foothold then)
{
    const double h = 0.02;
    double tempo = time > 0.0 ? scene->goal_tempo : scene->tempo;
    double later = ff_phase_advance(scene->space, scene->blend, phase, h * tempo);
    ff_foothold step = subtract(clip_foot_later(scene, foot, later, time + h), then);
    return (ff_foothold){step.a / h, step.b / h, step.height / h, step.yaw / h};
}

/* Slope of the offset of a foot that stands while the clip's foot moves at speed. */
static ff_foothold standing_slope(ff_foothold speed)
{
    double pace = sqrt(speed.a * speed.a + speed.b * speed.b);
    double keep = pace > SLOPE_LIMIT ? SLOPE_LIMIT / pace : 1.0;
    return (ff_foothold){-speed.a * keep, -speed.b * keep, -ff_clamp(speed.height, -SLOPE_LIMIT, SLOPE_LIMIT),
                         0.0};
}

static double phase_to(double from, double to)
{
    return ff_phase_wrap(to - from);
}

void ff_foot_land(ff_gait_foot *state, double ball_rest)
{
    state->planted = 1;
    state->lock.height = ball_rest;
    state->lock.yaw = ff_wrap(state->lock.yaw);
    state->now = state->lock;
}

/* How far the ball must be over its rest height for the heel not to be in the floor when the toes point up. */
static double heel_rise(const ff_body_frame *body, int foot, double pitch)
{
    if (pitch <= 0.0) return 0.0;
    double sine, cosine;
    ff_sincos(pitch, &sine, &cosine);
    int ankle = FF_JOINT_ANKLE_L + foot * FF_JOINT_LEG_STRIDE;
    ff_vec3 heel = ff_sub3(body->heel[foot], body->offset[ankle + 1]);
    return ff_max(heel.y * (1.0 - cosine) - heel.z * sine, 0.0);
}

void ff_foot_rest(const ff_body_frame *body, ff_gait_foot *state, int foot)
{
    state->now.height = state->lock.height + heel_rise(body, foot, state->pitch);
}

void ff_foot_hold(const ff_foot_scene *scene, ff_gait_foot *state, int foot, double standing)
{
    ff_foot_sample sample = ff_sample_foot(scene->space, scene->cursor, foot);
    state->now = state->lock;
    state->pitch = sample.pitch * (1.0 - standing);
    ff_foot_rest(&scene->space->body, state, foot);
}

double ff_foot_lift(const ff_foot_scene *scene, ff_gait_foot *state, int foot, double standing)
{
    double start, length;
    ff_blend_lock(scene->space, scene->blend, foot, &start, &length);
    /* The release was a moment ago, within this step: from there the swing leads on. */
    double release = scene->phase - ff_max(phase_to(start, scene->phase) - length, 0.0);
    double since = ff_phase_duration(scene->space, scene->blend, release, scene->phase) / scene->tempo;
    if (since > scene->dt) { /* it waited for the other foot */
        release = scene->phase;
        since = 0.0;
    }
    state->planted = 0;
    state->stood = ff_max(standing, 1.0 - ff_smooth((scene->tempo - STOOD_TEMPO) / STOOD_TEMPO));
    state->stood = ff_max(state->stood, ff_foot_closing(scene->rates));
    double pitch = state->pitch;
    ff_foot_hold(scene, state, foot, standing);
    state->pitch =
        ff_lerp(state->pitch, pitch, state->stood); /* the clock of a first step has just jumped to it */
    state->from_pitch = state->pitch - ff_sample_foot(scene->space, scene->cursor, foot).pitch;
    ff_foothold clip = clip_foot_later(scene, foot, release, -since);
    state->from = subtract(state->now, clip);
    state->slope = standing_slope(clip_foot_speed(scene, foot, release, -since, clip));
    /* The yaw of a foot on its toes means little, so in swing the clip's is not followed: it leads from lock to lock
     * in the frame of the body. */
    state->from.yaw = ff_wrap(state->now.yaw - (scene->heading - scene->rates.turn * since));
    state->slope.yaw = -scene->rates.turn;
    state->left = state->now;
    state->left_pitch = state->pitch;
    state->elapsed = 0.0;
    state->progress = 0.0;
    state->phase_left = phase_to(scene->phase, start);
    return since;
}

static double hermite(double s, double from, double slope_from, double to, double slope_to)
{
    double s2 = s * s, s3 = s2 * s;
    return (2.0 * s3 - 3.0 * s2 + 1.0) * from + (s3 - 2.0 * s2 + s) * slope_from +
           (3.0 * s2 - 2.0 * s3) * to + (s3 - s2) * slope_to;
}

/* The mean of where the clip's foot will be over its stance (Simpson's rule over three places). */
static ff_foothold stance_mean(const ff_foot_scene *scene, int foot, ff_foothold landing, double start,
                               double length, double time)
{
    double half = ff_phase_duration(scene->space, scene->blend, start, start + 0.5 * length);
    double whole = half + ff_phase_duration(scene->space, scene->blend, start + 0.5 * length, start + length);
    ff_foothold middle = clip_foot_later(scene, foot, start + 0.5 * length, time + half);
    ff_foothold end = clip_foot_later(scene, foot, start + length, time + whole);
    return (ff_foothold){(landing.a + 4.0 * middle.a + end.a) / 6.0,
                         (landing.b + 4.0 * middle.b + end.b) / 6.0, scene->space->body.ball_rest,
                         (landing.yaw + 4.0 * middle.yaw + end.yaw) / 6.0};
}

void ff_foot_neutral(const ff_foot_scene *scene, int foot, double time, ff_foothold *out)
{
    const double *neutral = scene->space->neutral[foot];
    ff_vec2 root;
    double heading;
    ff_root_predict(scene, time, &root, &heading);
    ff_foot_sample sample = {neutral[0], neutral[1], scene->space->body.ball_rest, neutral[2], 0.0};
    *out = place(root, heading, sample);
}

double ff_foot_closing(ff_rates rates)
{
    return 1.0 - ff_smooth(ff_length3(ff_blend_point(rates)) / CLOSE_UP_SPEED);
}

/* A body that hardly moves puts its foot where it will stand. */
static void close_up(const ff_foot_scene *scene, int foot, double time, ff_foothold *plan)
{
    double share = ff_foot_closing(scene->rates);
    if (share <= 0.0) return;
    ff_foothold stand;
    ff_foot_neutral(scene, foot, time, &stand);
    plan->a = ff_lerp(plan->a, stand.a, share);
    plan->b = ff_lerp(plan->b, stand.b, share);
    plan->yaw += share * ff_wrap(stand.yaw - plan->yaw);
}

/* Ground point under the ankle of a foot that lies flat. */
static ff_vec2 ankle_ground(const ff_body_frame *body, int foot, ff_foothold ball)
{
    ff_vec3 to_ball = body->offset[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
    return ff_madd2(ff_v2(ball.a, ball.b), ff_fwd2(ball.yaw), -to_ball.z);
}

/* Keep the new footprint on its own side of the standing foot: legs never cross, and toes that point apart bring no heels
 * together. Of two feet in the air the one that lands later looks after that. */
static void keep_sides(const ff_body_frame *body, const ff_gait_foot *other, int foot, double progress,
                       ff_foothold *plan)
{
    if (!other->planted && other->progress < progress) return;
    ff_vec2 forward = ff_fwd2(plan->yaw);
    double side = foot == 0 ? 1.0 : -1.0;
    ff_vec2 balls = ff_to_frame2(forward, ff_v2(plan->a - other->lock.a, plan->b - other->lock.b));
    ff_vec2 heels = ff_to_frame2(
        forward, ff_sub2(ankle_ground(body, foot, *plan), ankle_ground(body, 1 - foot, other->lock)));
    double wanted = LEAST_SPREAD * (1.0 - ff_smooth(fabs(balls.a) / LEAST_SPREAD_AHEAD));
    double apart = LEAST_HEELS - HEELS_GIVE * heels.a * heels.a;
    double missing = ff_max(wanted - side * balls.b, apart - side * heels.b);
    if (missing <= 0.0) return;
    ff_vec2 push = ff_scale2(ff_left2(forward), side * missing);
    plan->a += push.a;
    plan->b += push.b;
}

/* Move the planned footprint towards the wanted one, the less the nearer it is to landing. */
static void replan(ff_gait_foot *state, ff_foothold wanted, double progress, double dt)
{
    double room = 1.0 - progress;
    double a = wanted.a - state->lock.a, b = wanted.b - state->lock.b;
    double far = sqrt(a * a + b * b), most = PLAN_SPEED * room * dt;
    double share = far > most ? most / far : 1.0;
    state->lock.a += a * share;
    state->lock.b += b * share;
    double turn = ff_wrap(wanted.yaw - state->lock.yaw), most_turn = PLAN_TURN * room * dt;
    state->lock.yaw += ff_clamp(turn, -most_turn, most_turn);
    state->lock.height = wanted.height;
}

/* The larger of two heights, with a rounded corner of about round where they meet, so that the knee feels none. */
static double soft_max(double x, double y, double round)
{
    double over = y - x;
    return x + 0.5 * (over + sqrt(over * over + round * round));
}

/* Raise a swinging ball over an arc above the floor, and the heel over the floor until it strikes. */
static void clear_floor(const ff_body_frame *body, ff_gait_foot *state, int foot, double corner)
{
    double arc = 4.0 * state->progress * (1.0 - state->progress), round = corner * arc;
    double up = state->progress < 0.5 ? arc : 1.0;
    double heel = body->ball_rest + heel_rise(body, foot, state->pitch) +
                  HEEL_CLEARANCE * up * ff_smooth((STRIKE - state->progress) / STRIKES_FROM);
    state->now.height = soft_max(state->now.height, body->ball_rest + LEAST_LIFT * arc * arc, round);
    state->now.height = soft_max(state->now.height, heel, round);
}

/* Height is the clip's own but for the ends of the swing: an offset led over the whole swing would, by its slopes, take
 * the height away that the clip clears the floor with. */
static double height_offset(const ff_gait_foot *state, ff_foothold to, ff_foothold slope, double span)
{
    double early = state->progress / LIFT_WINDOW, late = (state->progress - 1.0) / LAND_WINDOW + 1.0;
    if (early < 1.0)
        return hermite(early, state->from.height, state->slope.height * span * LIFT_WINDOW, 0.0, 0.0);
    if (late > 0.0) return hermite(late, 0.0, 0.0, to.height, slope.height * span * LAND_WINDOW);
    return 0.0;
}

/* Ground point under the ankle of a foot as it is. */
static ff_vec2 ankle_now(const ff_body_frame *body, const ff_gait_foot *state, int foot)
{
    ff_vec3 to_ball = body->offset[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
    double sine, cosine;
    ff_sincos(state->pitch, &sine, &cosine);
    return ff_madd2(ff_v2(state->now.a, state->now.b), ff_fwd2(state->now.yaw),
                    to_ball.y * sine - to_ball.z * cosine);
}

/* Push a foot that swings past the standing one out to the side, so that ankles do not brush (study, section 5). */
static void pass_beside(const ff_foot_scene *scene, ff_gait_foot *state, const ff_gait_foot *other, int foot)
{
    const ff_body_frame *body = &scene->space->body;
    ff_vec2 forward = ff_fwd2(scene->heading), left = ff_left2(forward);
    ff_vec2 apart =
        ff_to_frame2(forward, ff_sub2(ankle_now(body, state, foot), ankle_now(body, other, 1 - foot)));
    double arc = 4.0 * state->progress * (1.0 - state->progress), side = foot == 0 ? 1.0 : -1.0;
    double near = arc * (1.0 - ff_smooth(fabs(apart.a) / PASS_AHEAD));
    double push = near * soft_max(0.0, PASS_ASIDE - side * apart.b, 0.02);
    state->now.a += side * push * left.a;
    state->now.b += side * push * left.b;
}

bool ff_foot_sets_off(const ff_gait_foot *state)
{
    return state->elapsed < SET_OFF_TIME * state->stood;
}

/* A swing's beginning is that of a foot in motion. One that was at rest takes it up gradually, or its knee would jerk. */
static void set_off(ff_gait_foot *state)
{
    if (!ff_foot_sets_off(state)) return;
    double rest = 1.0 - ff_smooth(state->elapsed / (SET_OFF_TIME * state->stood));
    state->now.a = ff_lerp(state->now.a, state->left.a, rest);
    state->now.b = ff_lerp(state->now.b, state->left.b, rest);
    state->now.height = ff_lerp(state->now.height, state->left.height, rest);
    state->now.yaw += rest * ff_wrap(state->left.yaw - state->now.yaw);
    state->pitch = ff_lerp(state->pitch, state->left_pitch, rest);
}

/* The foot now: the clip's, with an offset between that of the old lock and that of the new one. landing: the clip's
 * foot at the landing, time s from now. */
static void fly(const ff_foot_scene *scene, ff_gait_foot *state, int foot, ff_foothold landing,
                ff_foothold slope, double time)
{
    double s = state->progress, span = state->elapsed + time;
    ff_foothold to = subtract(state->lock, landing);
    ff_foot_sample sample = ff_sample_foot(scene->space, scene->cursor, foot);
    ff_foothold clip = place(scene->position, scene->heading, sample);
    state->now.a = clip.a + hermite(s, state->from.a, state->slope.a * span, to.a, slope.a * span);
    state->now.b = clip.b + hermite(s, state->from.b, state->slope.b * span, to.b, slope.b * span);
    state->now.height = clip.height + height_offset(state, to, slope, span);
    double turn = scene->rates.turn, heading;
    ff_vec2 root;
    ff_root_predict(scene, time, &root, &heading);
    double to_yaw = ff_wrap(state->lock.yaw - heading);
    state->now.yaw =
        scene->heading + hermite(s, state->from.yaw, state->slope.yaw * span, to_yaw, -turn * span);
    state->pitch = sample.pitch + hermite(s, state->from_pitch, 0.0, 0.0, 0.0);
    set_off(state);
}

void ff_foot_keep_clear(const ff_foot_scene *scene, ff_gait_foot *state, const ff_gait_foot *other, int foot)
{
    state->path = state->now;
    if (state->planted) return;
    pass_beside(scene, state, other, foot);
    double corner = scene->blend->way == FF_RUNNING ? CLEAR_ROUND_RUN : CLEAR_ROUND;
    clear_floor(&scene->space->body, state, foot, corner);
}

bool ff_foot_swing(const ff_foot_scene *scene, ff_gait_foot *state, const ff_gait_foot *other, int foot)
{
    double start, length;
    ff_blend_lock(scene->space, scene->blend, foot, &start, &length);
    double left = phase_to(scene->phase, start);
    if (left > state->phase_left + 0.5) return true; /* the phase has passed the landing */
    state->phase_left = left;
    double whole = ff_phase_duration(scene->space, scene->blend, scene->phase, scene->phase + left);
    double time = ff_max(whole / scene->goal_tempo + scene->delay, 0.5 * whole / scene->goal_tempo);
    bool first = state->elapsed == 0.0;
    state->elapsed += scene->dt;
    /* What is left of the swing at the speed that fits the time left: elapsed / (elapsed + time) at a steady pace, and no jump
     * when the pace changes. */
    state->progress += (1.0 - state->progress) * scene->dt / ff_max(time + scene->dt, 1e-9);

    ff_foothold landing = clip_foot_later(scene, foot, start, time);
    ff_foothold wanted = stance_mean(scene, foot, landing, start, length, time);
    close_up(scene, foot, time, &wanted);
    keep_sides(&scene->space->body, other, foot, state->progress, &wanted);
    if (first) state->lock = wanted;
    replan(state, wanted, state->progress, scene->dt);
    keep_sides(&scene->space->body, other, foot, state->progress, &state->lock);
    fly(scene, state, foot, landing, standing_slope(clip_foot_speed(scene, foot, start, time, landing)),
        time);
    return false;
}
