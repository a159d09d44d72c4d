/* The definitions of crowds and agents: defaults, and what they may hold. */
#include "runtime/core/crowd/crowd_def.h"

#include "runtime/core/base/fail.h"

#define CROWD_COOKIE 0x46464344u
#define AGENT_COOKIE 0x46464144u
#define AGENTS_MAX 1000000u
#define WALLS_MAX 1000000u
#define OBSTACLES_MAX 100000.0
#define NODES_MAX 20000.0
#define STEP_MIN 1e-5      /* s: below that speeds, which are differences over a step, are noise */
#define STEP_MAX 0.25      /* s: longer than that, people walk past each other unseen */
#define PLANE_MAX 1e6      /* m: millimetres must survive in a double many times over */
#define TOLERANCE_MIN 0.05 /* m */

ff_crowd_def ff_crowd_def_default(void)
{
    return (ff_crowd_def){.max_agents = 1000,
                          .max_walls = 1000,
                          .step = 1.0 / 30.0,
                          .seed = 1,
                          .threads = 1,
                          .keep_right = 0.30,
                          .navigation = FF_NAVIGATION_MCN,
                          .synthesis = FF_SYNTHESIS_HYBRID,
                          .mcn = {.hull = true,
                                  .sharp_turn = true,
                                  .stance = true,
                                  .forces = true,
                                  .density = true,
                                  .weighted = true,
                                  .gradual = true,
                                  .lean = true,
                                  .progress = true,
                                  .make_way = true,
                                  .facing = FF_FACING_HALFWAY,
                                  .padding = 0.02,
                                  .prediction = 0.3},
                          .planner = FF_PLANNER_VELOCITY,
                          .footsteps = {.nodes = 300, .expiry = 2.0, .expiry_actions = 3, .margin = 0.08},
                          .max_obstacles = 64,
                          .cookie = CROWD_COOKIE};
}

ff_agent_def ff_agent_def_default(void)
{
    return (ff_agent_def){.goal_tolerance = 0.5,
                          .machine = FF_NONE,
                          .preferred_speed = 1.3,
                          .radius = 0.3,
                          .cookie = AGENT_COOKIE};
}

ff_status ff_check_between(double value, double low, double high, const char *what, ff_error *error)
{
    if (value >= low && value <= high) return FF_OK;
    return ff_fail(error, isfinite(value) ? FF_ERR_RANGE : FF_ERR_NOT_FINITE, "%s is %g; expected %g to %g",
                   what, value, low, high);
}

static ff_status check_navigation(ff_navigation navigation, ff_error *error)
{
    if (navigation >= FF_NAVIGATION_CROWD && navigation <= FF_NAVIGATION_SF) return FF_OK;
    return ff_fail(error, FF_ERR_RANGE, "navigation is %d; expected one of FF_NAVIGATION_*", (int)navigation);
}

static ff_status check_synthesis(ff_synthesis synthesis, ff_error *error)
{
    if (synthesis >= FF_SYNTHESIS_CROWD && synthesis <= FF_SYNTHESIS_HYBRID) return FF_OK;
    return ff_fail(error, FF_ERR_RANGE, "synthesis is %d; expected one of FF_SYNTHESIS_*", (int)synthesis);
}

static ff_status check_navigation_def(const ff_crowd_def *def, ff_error *error)
{
    ff_status status = check_navigation(def->navigation, error);
    if (status == FF_OK) status = check_synthesis(def->synthesis, error);
    if (status == FF_OK)
        status = ff_check_between(def->keep_right, -0.5 * FF_PI, 0.5 * FF_PI, "keep_right (rad)", error);
    if (status == FF_OK)
        status = ff_check_between(def->baseline.keep_right, -0.5 * FF_PI, 0.5 * FF_PI,
                                  "the baselines' keep_right (rad)", error);
    if (status == FF_OK) status = ff_check_between(def->body_scale, 0.0, 0.15, "body_scale", error);
    if (status == FF_OK) status = ff_check_between(def->mcn.padding, 0.0, 0.5, "padding", error);
    if (status == FF_OK)
        status = ff_check_between(def->baseline.padding, 0.0, 0.5, "the baselines' padding", error);
    if (status == FF_OK) status = ff_check_between(def->mcn.prediction, 0.0, 1.0, "prediction", error);
    if (status == FF_OK && (def->mcn.facing < FF_FACING_HALFWAY || def->mcn.facing > FF_FACING_COMMAND))
        status =
            ff_fail(error, FF_ERR_RANGE, "facing is %d; expected one of FF_FACING_*", (int)def->mcn.facing);
    return status;
}

static ff_status check_footsteps_def(const ff_crowd_def *def, ff_error *error)
{
    const ff_footsteps_def *f = &def->footsteps;
    if (def->planner < FF_PLANNER_CROWD || def->planner > FF_PLANNER_FOOTSTEPS)
        return ff_fail(error, FF_ERR_RANGE, "planner is %d; expected one of FF_PLANNER_*", (int)def->planner);
    ff_status status = ff_check_between(f->nodes, 1.0, NODES_MAX, "footsteps.nodes", error);
    if (status == FF_OK) status = ff_check_between(f->seconds, 0.0, 10.0, "footsteps.seconds", error);
    if (status == FF_OK) status = ff_check_between(f->plans, 0.0, AGENTS_MAX, "footsteps.plans", error);
    if (status == FF_OK) status = ff_check_between(f->expiry, 0.05, 1e3, "footsteps.expiry (s)", error);
    if (status == FF_OK)
        status = ff_check_between(f->expiry_actions, 1.0, 1e3, "footsteps.expiry_actions", error);
    if (status == FF_OK) status = ff_check_between(f->margin, 0.0, 1.0, "footsteps.margin (m)", error);
    if (status == FF_OK)
        status = ff_check_between(f->proximity_cost, 0.0, 1e4, "footsteps.proximity_cost", error);
    for (int i = 0; status == FF_OK && i < FF_SPEED_VARIATIONS_MAX; ++i)
        if (f->speed_variations[i] != 0.0)
            status =
                ff_check_between(f->speed_variations[i], 0.5, 1.5, "a footsteps.speed_variations", error);
    if (status == FF_OK)
        status = ff_check_between(def->max_obstacles, 0.0, OBSTACLES_MAX, "max_obstacles", error);
    return status;
}

ff_status ff_crowd_check_def(const ff_pack *pack, const ff_crowd_def *def, ff_error *error)
{
    if (!pack || !def) return ff_fail(error, FF_ERR_ARGUMENT, "a crowd needs a pack and a definition");
    if (def->cookie != CROWD_COOKIE)
        return ff_fail(error, FF_ERR_ARGUMENT,
                       "the crowd's definition was not made by ff_crowd_def_default()");
    if (def->max_agents < 1 || def->max_agents > AGENTS_MAX)
        return ff_fail(error, FF_ERR_RANGE, "max_agents is %u; expected 1 to %u", def->max_agents,
                       AGENTS_MAX);
    if (def->max_walls > WALLS_MAX)
        return ff_fail(error, FF_ERR_RANGE, "max_walls is %u; expected at most %u", def->max_walls,
                       WALLS_MAX);
    ff_status status = ff_check_between(def->step, STEP_MIN, STEP_MAX, "step (s)", error);
    if (status == FF_OK) status = check_footsteps_def(def, error);
    return status == FF_OK ? check_navigation_def(def, error) : status;
}

static bool is_place(ff_vec2 p)
{
    return fabs(p.a) <= PLANE_MAX && fabs(p.b) <= PLANE_MAX; /* false for nan */
}

ff_status ff_crowd_check_place(ff_vec2 p, const char *what, ff_error *error)
{
    if (is_place(p)) return FF_OK;
    bool finite = isfinite(p.a) && isfinite(p.b);
    return ff_fail(error, finite ? FF_ERR_RANGE : FF_ERR_NOT_FINITE, "%s is (%g, %g) m; expected within %g m",
                   what, p.a, p.b, PLANE_MAX);
}

static ff_status check_machine(const ff_crowd *crowd, uint32_t machine, ff_error *error)
{
    uint32_t count = crowd->behaviour ? crowd->behaviour->def.machine_count : 0;
    if (machine == FF_NONE || machine < count) return FF_OK;
    return ff_fail(error, FF_ERR_RANGE, "machine %u of a crowd whose behaviour has %u", machine, count);
}

ff_status ff_agent_check_def(const ff_crowd *crowd, const ff_agent_def *def, ff_error *error)
{
    if (!def || def->cookie != AGENT_COOKIE)
        return ff_fail(error, FF_ERR_ARGUMENT,
                       "the agent's definition was not made by ff_agent_def_default()");
    ff_status status = ff_crowd_check_place(def->position, "position", error);
    if (status == FF_OK) status = ff_crowd_check_place(def->goal, "goal", error);
    if (status == FF_OK) status = ff_check_between(def->heading, -1e3, 1e3, "heading", error);
    if (status == FF_OK)
        status = ff_check_between(def->goal_tolerance, TOLERANCE_MIN, 1e3, "goal_tolerance", error);
    if (status == FF_OK) status = ff_check_between(def->preferred_speed, 0.1, 4.0, "preferred_speed", error);
    if (status == FF_OK) status = ff_check_between(def->radius, 0.05, 1.5, "radius", error);
    if (status == FF_OK) status = check_navigation(def->navigation, error);
    if (status == FF_OK) status = check_synthesis(def->synthesis, error);
    if (status == FF_OK) status = check_machine(crowd, def->machine, error);
    return status;
}
