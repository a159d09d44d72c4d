#include "mocap/generator/recipes.h"
#include "mocap/generator/curves.h"

#include <string.h>

#define FRAME (1.0 / 120.0)

static void add_knot(ff_plan *plan, double t, double forward, double left, double turn)
{
    plan->knots[plan->knot_count++] = (ff_rate_knot){t, forward, left, turn};
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
    return ff_max(floor(time / FRAME + 0.5), 20.0) * FRAME;
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
    double seconds = 2.0 * step * cycles + 24 * FRAME;
    add_knot(plan, -10.0, forward, left, turn);
    add_knot(plan, seconds + 10.0, forward, left, turn);
    /* the clip begins a little before a contact */
    int before = 6;
    add_contacts(plan, 12 * FRAME - before * step, step, leading_foot(info, 0.0), before + 2 * cycles + 8);
    plan->begin = -4.0;
    plan->end = seconds + 4.0;
    return (int)(seconds / FRAME + 0.5) + 1;
}

static int plan_idle(const ff_recipe *recipe, ff_plan *plan)
{
    (void)recipe;
    double seconds = 8.0;
    add_knot(plan, -4.0, 0.0, 0.0, 0.0);
    add_knot(plan, seconds + 4.0, 0.0, 0.0, 0.0);
    add_contacts(plan, -4.0, 1.0, 0, 2);
    plan->stand_first = plan->stand_last = true;
    plan->begin = -4.0;
    plan->end = seconds + 4.0;
    return (int)(seconds / FRAME) + 1;
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
        .arms = 0.55, .toe_out = 6.0 * FF_DEG, .breathing = 1.0                                              \
    }
#define STEADY(name, text, tags, mode, forward, left, turn, ...)                                             \
    {                                                                                                        \
        {name, text, tags, mode, forward, left, turn, true}, plan_steady, 0.0, false, __VA_ARGS__            \
    }

const ff_recipe ff_recipes[] = {
    STEADY("walk-creep", "very slow short steps, 0.4 m/s", "walk slow straight", "walk", 0.40, 0, 0, USUAL),
    STEADY("walk-shuffle", "slow short steps, 0.6 m/s", "walk slow straight", "walk", 0.60, 0, 0, USUAL),
    STEADY("walk-stroll", "strolling, 0.8 m/s", "walk slow straight", "walk", 0.80, 0, 0, USUAL),
    STEADY("walk-slow", "slow walk, 1.02 m/s", "walk slow straight", "walk", 1.02, 0, 0, USUAL),
    STEADY("walk-normal", "normal walk, 1.27 m/s", "walk straight", "walk", 1.27, 0, 0, USUAL),
    STEADY("walk-fast", "fast walk, 1.6 m/s", "walk fast straight", "walk", 1.60, 0, 0, USUAL),
    STEADY("walk-brisk", "very fast walk, 1.75 m/s", "walk fast straight", "walk", 1.75, 0, 0, USUAL),
    STEADY("curve-left-wide", "wide curve to the left", "walk curve left", "walk", 1.25, 0, 0.35, USUAL),
    STEADY("curve-right-wide", "wide curve to the right", "walk curve right", "walk", 1.25, 0, -0.35, USUAL),
    STEADY("curve-left", "curve to the left", "walk curve left", "walk", 1.20, 0, 0.80, USUAL),
    STEADY("curve-right", "curve to the right", "walk curve right", "walk", 1.20, 0, -0.80, USUAL),
    STEADY("curve-left-tight", "tight curve to the left", "walk curve left", "walk", 0.70, 0, 1.25, USUAL),
    STEADY("curve-right-tight", "tight curve to the right", "walk curve right", "walk", 0.70, 0, -1.25,
           USUAL),
    STEADY("strafe-left-slow", "side steps to the left, 0.3 m/s", "strafe left", "walk", 0, 0.30, 0,
           CALM_ARMS),
    STEADY("strafe-right-slow", "side steps to the right, 0.3 m/s", "strafe right", "walk", 0, -0.30, 0,
           CALM_ARMS),
    STEADY("strafe-left", "side steps to the left, 0.6 m/s", "strafe left", "walk", 0, 0.60, 0, CALM_ARMS),
    STEADY("strafe-right", "side steps to the right, 0.6 m/s", "strafe right", "walk", 0, -0.60, 0,
           CALM_ARMS),
    {{"idle", "standing, breathing and swaying a little", "idle stand", "idle", 0, 0, 0, true},
     plan_idle,
     0.0,
     false,
     USUAL},
};
const int ff_recipe_count = (int)(sizeof ff_recipes / sizeof ff_recipes[0]);
