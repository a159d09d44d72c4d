#include "runtime/core/nav/nav.h"

#include "runtime/core/nav/nav_baseline.h"
#include "runtime/core/nav/nav_density.h"
#include "runtime/core/nav/nav_facing.h"
#include "runtime/core/nav/nav_forces.h"
#include "runtime/core/nav/nav_goal.h"
#include "runtime/core/nav/nav_view.h"

/* Navigation study, section 4, unless another source is named. */
#define DENSITY_BETA 0.0
#define LEAN 0.1 /* rad: who meets head on, nearly, passes on the side of the convention (not in the study) */
#define STAND_SPEED 0.6  /* m/s, at which one who stands steps aside at most */
#define STAND_CHANGE 3.0 /* m/s^2 */
#define STAND_FIRM 0.25  /* m/s, what he does not budge for */

/* The steady form of eq 9: the velocity at which the drive and the forces balance. */
static ff_vec2 adapt_by_forces(const ff_nav_view *view, ff_vec2 preferred)
{
    ff_vec2 sum = ff_nav_forces(view, FF_FORCE_MAX, FF_FORCE_TOTAL_MAX);
    ff_vec2 adapted = ff_madd2(preferred, sum, FF_RELAXATION);
    return ff_shorten2(adapted, 1.3 * ff_length2(preferred) + 0.2);
}

/* The densest on each side of the way: the segments of one chain must count once. */
static double density_of_walls(const ff_nav_view *view, ff_vec2 critical, ff_vec2 ahead)
{
    double most[2] = {0.0, 0.0};
    for (uint32_t i = 0; i < view->wall_count; ++i) {
        ff_vec2 nearest = ff_wall_nearest(view->walls[i], critical);
        ff_vec2 offset = ff_sub2(nearest, critical);
        if (ff_dot2(ff_sub2(nearest, view->me->position), ahead) <= 0.0) continue;
        int side = ff_det2(ahead, offset) > 0.0;
        most[side] = ff_max(most[side], ff_density_of_wall(offset));
    }
    return most[0] + most[1];
}

static ff_vec2 adapt_to_density(const ff_nav_view *view, ff_vec2 preferred, ff_vec2 adapted)
{
    ff_vec2 ahead = ff_unit2(preferred);
    if (ff_dot2(ahead, ahead) < 0.5) return adapted;
    const ff_grid *grid = view->world->grid;
    ff_vec2 critical = ff_madd2(view->me->position, ahead, FF_DENSITY_AHEAD);
    ff_run runs[FF_GRID_RUNS_MAX];
    uint32_t run_count = ff_grid_runs(grid, view->me->position, FF_NEIGHBOUR_REACH, runs);
    double rho = 0.0;
    for (uint32_t r = 0; r < run_count; ++r) {
        for (uint32_t i = runs[r].first; i < runs[r].end; ++i) {
            if (&grid->seen[i] == view->me) continue;
            rho += ff_density_of_agent(ff_sub2(grid->seen[i].position, critical), ahead);
        }
    }
    return ff_shorten2(adapted,
                       ff_density_speed(rho + density_of_walls(view, critical, ahead), DENSITY_BETA));
}

static void gather(const ff_nav_view *view, const ff_nav_body *body, ff_vec2 preferred, ff_mind *mind,
                   ff_constraints *lines)
{
    const ff_mcn_def *mcn = view->world->mcn;
    ff_vec2 facing = ff_fwd2(body->heading);
    ff_nav_add_walls(view, lines);
    lines->hull = lines->walls;
    if (mcn->hull) lines->hull = ff_hull_lines(view->world->hull, facing, lines->line, lines->walls);
    lines->sharp = lines->hull;
    if (mcn->sharp_turn)
        lines->sharp = ff_hull_sharp_turn(facing, preferred, &mind->sharp_side, lines->line, lines->hull);
    lines->hard = lines->sharp;
    if (mcn->stance)
        lines->hard =
            ff_stance_line(&body->stance, view->me->position, view->me->radius, view->me->velocity,
                           mind->command, view->world->step, &mind->stance, lines->line, lines->sharp);
    lines->count = lines->hard;
    double keep_right = view->world->keep_right;
    double lean = keep_right > 0.0 ? LEAN : (keep_right < 0.0 ? -LEAN : 0.0);
    ff_avoiding how = {mcn->prediction, mcn->lean ? lean : 0.0, mcn->weighted};
    ff_nav_add_movers(view, mcn->prediction, lines);
    ff_nav_add_agents(view, how, lines);
}

ff_mind ff_mind_new(double heading)
{
    ff_mind mind = {.facing = heading};
    ff_mind_forget_goal(&mind);
    return mind;
}

void ff_mind_forget_goal(ff_mind *mind)
{
    mind->best = 1e30;
    mind->stalled = mind->detour = mind->detour_left = 0.0;
    mind->detours = mind->standing = 0;
}

ff_vec2 ff_nav_reference(const ff_mcn_def *mcn, const ff_traits *traits, const ff_mind *mind,
                         ff_vec2 position, ff_vec2 velocity)
{
    ff_vec2 reference = ff_scale2(ff_add2(mind->command, velocity), 0.5);
    ff_vec2 to_goal = ff_sub2(traits->goal, position);
    bool inside = ff_dot2(to_goal, to_goal) <= traits->goal_tolerance * traits->goal_tolerance;
    if (mind->standing || !inside) return reference;
    return ff_shorten2(reference, ff_max(ff_length2(reference) - FF_COMMAND_CHANGE * mcn->prediction, 0.0));
}

/* One who stands makes way and steps out of the way, slowly and not for every trifle. */
static void stand(const ff_nav_view *view, ff_constraints *lines, ff_vec2 wish, ff_mind *mind)
{
    ff_circle aside = {ff_v2(0.0, 0.0), STAND_SPEED};
    ff_vec2 v = ff_nav_solve(lines, aside, aside, wish);
    if (ff_length2(v) < STAND_FIRM && ff_dot2(wish, wish) == 0.0) v = ff_v2(0.0, 0.0);
    ff_vec2 change = ff_shorten2(ff_sub2(v, mind->command), STAND_CHANGE * view->world->step);
    mind->command = ff_add2(mind->command, change);
}

static void walk(const ff_nav_view *view, ff_constraints *lines, ff_vec2 preferred, ff_mind *mind)
{
    const ff_mcn_def *mcn = view->world->mcn;
    double step = view->world->step;
    ff_vec2 wish = mcn->forces ? adapt_by_forces(view, preferred) : preferred;
    if (mcn->density) wish = adapt_to_density(view, preferred, wish);
    ff_circle near = {mind->command, FF_COMMAND_CHANGE * step};
    ff_circle wide = {ff_v2(0.0, 0.0), view->speed_max};
    mind->command = ff_nav_solve(lines, mcn->gradual ? near : wide, wide, wish);
    mind->facing = ff_nav_facing((ff_facing_rule){mcn->facing, mcn->back_pedal}, preferred, mind->command,
                                 mind->facing, step, &mind->strafing);
}

void ff_nav_step(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours, uint32_t count,
                 const ff_traits *traits, const ff_nav_body *body, ff_mind *mind)
{
    ff_nav_view view;
    ff_nav_look(world, self, neighbours, count, &view);
    view.speed_max = ff_max(FF_SPEED_MAX, traits->preferred_speed);
    ff_vec2 preferred = ff_nav_preferred(world, self, neighbours, count, traits, mind);
    mind->preferred = preferred;
    bool constrained = traits->navigation == FF_NAVIGATION_MCN;
    if (constrained && mind->standing && world->mcn->make_way)
        mind->preferred = ff_nav_make_way(world, self, neighbours, count);
    preferred = ff_nav_keep_right(world, self, view.walls, view.wall_count, traits, preferred, mind);
    if (constrained && world->mcn->progress)
        preferred = ff_nav_fall_back(world, self, neighbours, count, preferred, mind);
    if (constrained) {
        ff_constraints lines;
        gather(&view, body, preferred, mind, &lines);
        if (mind->standing)
            stand(&view, &lines, mind->preferred, mind);
        else
            walk(&view, &lines, preferred, mind);
    } else {
        mind->command = traits->navigation == FF_NAVIGATION_ORCA ? ff_nav_orca(&view, preferred)
                                                                 : ff_nav_social_force(&view, preferred);
        mind->facing = ff_nav_facing((ff_facing_rule){FF_FACING_COMMAND, false}, preferred, mind->command,
                                     mind->facing, world->step, &mind->strafing);
    }
    if (mind->standing)
        mind->facing = ff_nav_face(traits->face, traits->face_at, view.me->position, mind->facing);
}
