#include "mocap/generator/recipes.h"
#include "mocap/generator/curves.h"

#include <string.h>

#define FRAME (1.0 / 120.0)

static void add_knot(ff_plan *plan, double t, double forward, double left, double turn)
{
    plan->knots[plan->knot_count++] = (ff_rate_knot){t, forward, left, turn};
}

static double whole(double seconds)
{
    return floor(seconds / FRAME + 0.5) * FRAME;
}
static int frames_of(double seconds)
{
    return (int)(seconds / FRAME + 0.5) + 1;
}

/* Contacts of alternating feet every step seconds from t on. */
static void add_contacts(ff_plan *plan, double t, double step, int first_foot, int count)
{
    for (int i = 0; i < count && plan->contact_count < FF_PLAN_MAX_CONTACTS; ++i)
        plan->contacts[plan->contact_count++] = (ff_contact){t + i * step, (first_foot + i) % 2};
}

/* Seconds per step people take at these rates, in whole frames: by the cadence fit in forward walking, quicker small
 * steps sideways, and no more than 90 degrees of turn per cycle (synthesis study, section 5). */
static double step_time(double forward, double left, double turn, bool run)
{
    double speed = sqrt(forward * forward + left * left);
    double time = 1.0 / ff_usual_step_rate(speed, run);
    if (!run) time = ff_min(time, 0.72);
    double sideways = 0.5 * (0.95 - 0.25 * fabs(left)), share = speed > 0.0 ? fabs(left) / speed : 0.0;
    if (share > 0.2) time = ff_lerp(time, sideways, ff_smooth((share - 0.2) / 0.6));
    if (turn != 0.0) time = ff_min(time, 0.25 * FF_PI / fabs(turn));
    if (turn != 0.0 && speed < 0.3) time = ff_min(time, 0.52);
    return ff_max(whole(time), 20.0 * FRAME);
}

/* The foot that steps first: the one on the side of the way, so that mirrored clips mirror exactly. */
static int leading_foot(const ff_generator_info *info, double amount)
{
    return info->left < 0.0 || info->turn < 0.0 || amount < 0.0 ? 1 : 0;
}

static int plan_steady(const ff_recipe *recipe, ff_plan *plan)
{
    const ff_generator_info *info = &recipe->info;
    double forward = recipe->reversed ? -info->forward : info->forward;
    double left = recipe->reversed ? -info->left : info->left,
           turn = recipe->reversed ? -info->turn : info->turn;
    double step = step_time(forward, left, turn, plan->style.run);
    int cycles = (int)ff_max(5.0, floor(5.5 / (2.0 * step)) + 1.0);
    double seconds = 2.0 * step * cycles + 24 * FRAME, lead = plan->style.run ? 6 * FRAME : 12 * FRAME;
    add_knot(plan, -10.0, forward, left, turn);
    add_knot(plan, seconds + 10.0, forward, left, turn);
    /* the clip begins a little before a contact */
    int before = 6;
    add_contacts(plan, lead - before * step, step, leading_foot(info, 0.0), before + 2 * cycles + 8);
    plan->begin = -4.0;
    plan->end = seconds + 4.0;
    return frames_of(seconds);
}

static int plan_idle(const ff_recipe *recipe, ff_plan *plan)
{
    (void)recipe;
    double seconds = 9.0;
    add_knot(plan, -4.0, 0.0, 0.0, 0.0);
    add_knot(plan, seconds + 4.0, 0.0, 0.0, 0.0);
    add_contacts(plan, -4.0, 1.0, 0, 2);
    plan->stand_first = plan->stand_last = true;
    plan->begin = -4.0;
    plan->end = seconds + 4.0;
    return frames_of(seconds);
}

/* Hold still, then walk off with first_foot. Speeds at the first four contacts, and the body moving 0.45 s before the
 * foot leaves, as measured (gait facts, "Turning, starting, stopping"). */
static int plan_start(const ff_recipe *recipe, ff_plan *plan)
{
    double v = recipe->amount, step = step_time(v, 0.0, 0.0, false), first = 1.75;
    int foot = recipe->foot;
    double stance = ff_usual_stance(v, false), leaves = first - 2.0 * step * (1.0 - stance);
    double second = first + whole(1.12 * step), third = second + whole(1.03 * step);
    double seconds = third + 5.0 * step + 0.1;
    add_contacts(plan, first - 2.0 * step, step, foot, 3);
    add_contacts(plan, second, third - second, 1 - foot, 2);
    add_contacts(plan, third + step, step, 1 - foot, 9);
    add_knot(plan, leaves - 0.45, 0.0, 0.0, 0.0);
    add_knot(plan, leaves, 0.20 * v, 0.0, 0.0);
    add_knot(plan, first, 0.47 * v, 0.0, 0.0);
    add_knot(plan, second, 0.86 * v, 0.0, 0.0);
    add_knot(plan, third, 0.94 * v, 0.0, 0.0);
    add_knot(plan, third + step, v, 0.0, 0.0);
    plan->stand_first = true;
    plan->begin = -1.0;
    plan->end = seconds + 2.0;
    return frames_of(seconds);
}

/* Walk, then stop in two steps of which the last only closes. */
static int plan_stop(const ff_recipe *recipe, ff_plan *plan)
{
    double v = recipe->amount, step = step_time(v, 0.0, 0.0, false);
    int foot = recipe->foot;
    int steady = 12;
    double start = 0.1 - 6.0 * step, last = start + (steady - 1) * step;
    double before = last + whole(1.08 * step), close = before + whole(1.04 * step);
    add_contacts(plan, start, step, (foot + steady + 1) % 2, steady);
    add_contacts(plan, before, close - before, 1 - foot, 2);
    add_knot(plan, last - step, v, 0.0, 0.0);
    add_knot(plan, last, 0.90 * v, 0.0, 0.0);
    add_knot(plan, before, 0.52 * v, 0.0, 0.0);
    add_knot(plan, close, 0.13 * v, 0.0, 0.0);
    add_knot(plan, close + 0.55, 0.0, 0.0, 0.0);
    plan->stand_last = true;
    plan->begin = start - 1.0;
    plan->end = close + 3.0;
    return frames_of(close + 1.6);
}

static double total_turn(const ff_plan *plan)
{
    double sum = 0.0, x[FF_PLAN_MAX_KNOTS], y[FF_PLAN_MAX_KNOTS];
    for (int i = 0; i < plan->knot_count; ++i) {
        x[i] = plan->knots[i].t;
        y[i] = plan->knots[i].turn;
    }
    for (int i = 0; i < 4800; ++i)
        sum += ff_monotone(x, y, plan->knot_count, (i + 0.5) / 480.0) / 480.0;
    return sum;
}

/* Turn on the spot by amount radians: the inner foot opens, the outer follows, some 40 degrees to a step. */
static int plan_turn(const ff_recipe *recipe, ff_plan *plan)
{
    double angle = recipe->amount, step = whole(0.52);
    int steps = 1 + (int)floor(fabs(angle) / (44.0 * FF_DEG)), foot = angle > 0.0 ? 0 : 1;
    double first = 1.6, last = first + (steps - 1) * step, leaves = first - 0.58 * step;
    add_contacts(plan, first - 2.0 * step, step, foot, 2 + steps);
    add_knot(plan, leaves - 0.25, 0.0, 0.0, 0.0);
    add_knot(plan, first - 0.05, 0.0, 0.0, 1.0);
    if (steps > 2) add_knot(plan, last - 0.75 * step, 0.0, 0.0, 1.0);
    add_knot(plan, last + 0.20, 0.0, 0.0, 0.0);
    double scale = angle / total_turn(plan);
    for (int i = 0; i < plan->knot_count; ++i)
        plan->knots[i].turn *= scale;
    plan->stand_first = plan->stand_last = true;
    plan->begin = -1.0;
    plan->end = last + 3.0;
    return frames_of(last + 1.4);
}

#define JUMP_OFF 1.50   /* s, take-off */
#define JUMP_SPEED 1.95 /* m/s, upward at take-off */
#define JUMP_AIR (2.0 * JUMP_SPEED / 9.81)

/* Squat, leap forward by half a metre, land on the balls of the feet and give way. */
static int plan_jump(const ff_recipe *recipe, ff_plan *plan)
{
    (void)recipe;
    const double off = JUMP_OFF, on = whole(JUMP_OFF + JUMP_AIR), seconds = on + 1.9, top = 0.085;
    const double apex = top + JUMP_SPEED * JUMP_SPEED / (2.0 * 9.81), mid = 0.5 * (off + on);
    const ff_gesture gestures[] = {
        {0.45, 0.0, 0.0, 0.0, 0.0},
        {1.10, -0.24, 0.0, 38.0 * FF_DEG, -48.0 * FF_DEG},
        {1.18, -0.235, 0.12, 40.0 * FF_DEG, -40.0 * FF_DEG},
        {off, top, JUMP_SPEED, 10.0 * FF_DEG, 55.0 * FF_DEG},
        {mid, apex, 0.0, 6.0 * FF_DEG, 62.0 * FF_DEG},
        {on, top - 0.02, -JUMP_SPEED, 12.0 * FF_DEG, 45.0 * FF_DEG},
        {on + 0.24, -0.19, 0.0, 30.0 * FF_DEG, 20.0 * FF_DEG},
        {on + 0.95, 0.0, 0.0, 0.0, 0.0},
    };
    plan->gesture_count = (int)(sizeof gestures / sizeof gestures[0]);
    for (int i = 0; i < plan->gesture_count; ++i)
        plan->gestures[i] = gestures[i];
    add_knot(plan, 1.10, 0.0, 0.0, 0.0);
    add_knot(plan, off, 1.10, 0.0, 0.0);
    add_knot(plan, on, 1.05, 0.0, 0.0);
    add_knot(plan, on + 0.40, 0.0, 0.0, 0.0);
    add_contacts(plan, -1.0, 0.5, 0, 2);
    add_contacts(plan, on, FRAME, 0, 2);
    plan->stand_first = plan->stand_last = plan->jump = true;
    plan->begin = -2.0;
    plan->end = seconds + 3.0;
    return frames_of(seconds);
}

/* Both feet leave and land in the same frame. */
static void adjust_jump(ff_plan *plan)
{
    const double on = plan->contacts[2].t;
    for (int foot = 0; foot < 2; ++foot) {
        ff_footing *from = &plan->footings[foot][0], *to = &plan->footings[foot][1];
        from->heel_off = JUMP_OFF - 0.17;
        from->release = JUMP_OFF - 0.01;
        from->toe_off = JUMP_OFF;
        from->pitch_release = -56.0 * FF_DEG;
        from->twist = 0.0;
        to->contact = on;
        to->flat = on + 0.09;
        to->pitch_contact = -26.0 * FF_DEG;
        to->lift = 0.13;
    }
}

#define USUAL                                                                                                \
    {                                                                                                        \
        .arms = 1.0, .toe_out = 6.0 * FF_DEG, .breathing = 1.0                                               \
    }
#define RUNNING                                                                                              \
    {                                                                                                        \
        .run = true, .arms = 1.0, .toe_out = 4.0 * FF_DEG, .breathing = 1.0                                  \
    }
#define CALM_ARMS                                                                                            \
    {                                                                                                        \
        .arms = 0.40, .toe_out = 6.0 * FF_DEG, .breathing = 1.0                                              \
    }
#define CROUCHED                                                                                             \
    {                                                                                                        \
        .arms = 0.7, .toe_out = 8.0 * FF_DEG, .breathing = 1.0, .sink = 0.16, .bend = 32.0 * FF_DEG          \
    }
#define SHIFTING                                                                                             \
    {                                                                                                        \
        .arms = 1.0, .toe_out = 8.0 * FF_DEG, .breathing = 1.0, .shift = 0.045                               \
    }
/* One pace throughout; B = planned forward and played backward. */
#define PACE(name, text, tags, mode, v, l, w, style)                                                         \
    {                                                                                                        \
        {name, text, tags, mode, v, l, w, true}, plan_steady, NULL, 0.0, 0, false, style                     \
    }
#define BACK(name, text, tags, mode, v, l, w, style)                                                         \
    {                                                                                                        \
        {name, text, tags, mode, v, l, w, true}, plan_steady, NULL, 0.0, 0, true, style                      \
    }
#define MOVE(name, text, tags, mode, plan, adjust, amount, foot, style)                                      \
    {                                                                                                        \
        {name, text, tags, mode, 0, 0, 0, false}, plan, adjust, amount, foot, false, style                   \
    }

/* One line per clip. */
/* clang-format off */
const ff_recipe ff_recipes[] = {
    PACE("walk-creep", "very slow short steps, 0.4 m/s", "walk slow straight", "walk", 0.40, 0, 0, USUAL),
    PACE("walk-shuffle", "slow short steps, 0.6 m/s", "walk slow straight", "walk", 0.60, 0, 0, USUAL),
    PACE("walk-stroll", "strolling, 0.8 m/s", "walk slow straight", "walk", 0.80, 0, 0, USUAL),
    PACE("walk-slow", "slow walk, 1.02 m/s", "walk slow straight", "walk", 1.02, 0, 0, USUAL),
    PACE("walk-normal", "normal walk, 1.27 m/s", "walk straight", "walk", 1.27, 0, 0, USUAL),
    PACE("walk-fast", "fast walk, 1.6 m/s", "walk fast straight", "walk", 1.60, 0, 0, USUAL),
    PACE("walk-brisk", "very fast walk, 1.75 m/s", "walk fast straight", "walk", 1.75, 0, 0, USUAL),
    PACE("jog", "easy run, 2.4 m/s", "run jog straight", "run", 2.40, 0, 0, RUNNING),
    PACE("run", "run, 3 m/s", "run straight", "run", 3.00, 0, 0, RUNNING),
    PACE("run-curve-left", "run in a curve to the left", "run curve left", "run", 2.70, 0, 0.60, RUNNING),
    PACE("run-curve-right", "run in a curve to the right", "run curve right", "run", 2.70, 0, -0.60, RUNNING),
    PACE("curve-left-wide", "wide curve to the left", "walk curve left", "walk", 1.30, 0, 0.40, USUAL),
    PACE("curve-right-wide", "wide curve to the right", "walk curve right", "walk", 1.30, 0, -0.40, USUAL),
    PACE("curve-left", "curve to the left", "walk curve left", "walk", 1.25, 0, 0.85, USUAL),
    PACE("curve-right", "curve to the right", "walk curve right", "walk", 1.25, 0, -0.85, USUAL),
    PACE("curve-left-tight", "tight curve to the left", "walk curve left", "walk", 0.75, 0, 1.25, USUAL),
    PACE("curve-right-tight", "tight curve to the right", "walk curve right", "walk", 0.75, 0, -1.25, USUAL),
    PACE("curve-left-small", "small slow circle to the left", "walk slow curve left", "walk", 0.40, 0, 1.60, USUAL),
    PACE("curve-right-small", "small slow circle to the right", "walk slow curve right", "walk", 0.40, 0, -1.60, USUAL),
    PACE("spin-left-slow", "steps round on the spot to the left", "turn spin left", "turn", 0, 0, 0.80, CALM_ARMS),
    PACE("spin-right-slow", "steps round on the spot to the right", "turn spin right", "turn", 0, 0, -0.80, CALM_ARMS),
    PACE("spin-left", "quick steps round on the spot to the left", "turn spin left", "turn", 0, 0, 1.70, CALM_ARMS),
    PACE("spin-right", "quick steps round on the spot to the right", "turn spin right", "turn", 0, 0, -1.70, CALM_ARMS),
    PACE("strafe-left-slow", "side steps to the left, 0.3 m/s", "strafe left", "walk", 0, 0.30, 0, CALM_ARMS),
    PACE("strafe-right-slow", "side steps to the right, 0.3 m/s", "strafe right", "walk", 0, -0.30, 0, CALM_ARMS),
    PACE("strafe-left", "side steps to the left, 0.65 m/s", "strafe left", "walk", 0, 0.65, 0, CALM_ARMS),
    PACE("strafe-right", "side steps to the right, 0.65 m/s", "strafe right", "walk", 0, -0.65, 0, CALM_ARMS),
    PACE("diagonal-left-slow", "slow, forward and to the left", "walk slow diagonal left", "walk", 0.50, 0.30, 0, USUAL),
    PACE("diagonal-right-slow", "slow, forward and to the right", "walk slow diagonal right", "walk", 0.50, -0.30, 0, USUAL),
    PACE("diagonal-left", "forward and to the left", "walk diagonal left", "walk", 1.00, 0.40, 0, USUAL),
    PACE("diagonal-right", "forward and to the right", "walk diagonal right", "walk", 1.00, -0.40, 0, USUAL),
    BACK("back-slow", "backward, 0.4 m/s", "walk back slow", "walk", -0.40, 0, 0, CALM_ARMS),
    BACK("back", "backward, 0.85 m/s", "walk back", "walk", -0.85, 0, 0, USUAL),
    BACK("back-curve-left", "backward, turning left", "walk back curve left", "walk", -0.50, 0, 0.70, CALM_ARMS),
    BACK("back-curve-right", "backward, turning right", "walk back curve right", "walk", -0.50, 0, -0.70, CALM_ARMS),
    BACK("back-diagonal-left", "backward and to the left", "walk back diagonal left", "walk", -0.45, 0.30, 0, CALM_ARMS),
    BACK("back-diagonal-right", "backward and to the right", "walk back diagonal right", "walk", -0.45, -0.30, 0, CALM_ARMS),
    PACE("crouch", "crouched walk, 0.7 m/s", "crouch walk straight", "crouch", 0.70, 0, 0, CROUCHED),
    MOVE("start-left", "from standing to walking, left foot first", "start left", "walk", plan_start, NULL, 1.27, 0, USUAL),
    MOVE("start-right", "from standing to walking, right foot first", "start right", "walk", plan_start, NULL, 1.27, 1, USUAL),
    MOVE("start-slow", "from standing to a slow walk", "start left slow", "walk", plan_start, NULL, 0.85, 0, USUAL),
    MOVE("stop-left", "from walking to standing, left foot last", "stop left", "walk", plan_stop, NULL, 1.27, 0, USUAL),
    MOVE("stop-right", "from walking to standing, right foot last", "stop right", "walk", plan_stop, NULL, 1.27, 1, USUAL),
    MOVE("stop-slow", "from a slow walk to standing", "stop left slow", "walk", plan_stop, NULL, 0.85, 0, USUAL),
    MOVE("turn-left-45", "turn on the spot, 45 degrees left", "turn left", "turn", plan_turn, NULL, 45 * FF_DEG, 0, CALM_ARMS),
    MOVE("turn-right-45", "turn on the spot, 45 degrees right", "turn right", "turn", plan_turn, NULL, -45 * FF_DEG, 0, CALM_ARMS),
    MOVE("turn-left-90", "turn on the spot, 90 degrees left", "turn left", "turn", plan_turn, NULL, 90 * FF_DEG, 0, CALM_ARMS),
    MOVE("turn-right-90", "turn on the spot, 90 degrees right", "turn right", "turn", plan_turn, NULL, -90 * FF_DEG, 0, CALM_ARMS),
    MOVE("turn-left-180", "turn on the spot, 180 degrees left", "turn left", "turn", plan_turn, NULL, 180 * FF_DEG, 0, CALM_ARMS),
    MOVE("turn-right-180", "turn on the spot, 180 degrees right", "turn right", "turn", plan_turn, NULL, -180 * FF_DEG, 0, CALM_ARMS),
    MOVE("jump", "jump forward from standing", "jump", "jump", plan_jump, adjust_jump, 0, 0, USUAL),
    MOVE("idle", "standing, breathing and swaying a little", "idle stand", "idle", plan_idle, NULL, 0, 0, USUAL),
    {{"idle-shift", "standing, weight shifting from leg to leg", "idle stand", "idle", 0, 0, 0, false}, plan_idle, NULL, 0, 0, false, SHIFTING},
};
/* clang-format on */
const int ff_recipe_count = (int)(sizeof ff_recipes / sizeof ff_recipes[0]);
