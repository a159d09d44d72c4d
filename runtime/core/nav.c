#include "runtime/core/nav.h"

#include "runtime/core/nav_density.h"
#include "runtime/core/nav_forces.h"
#include "runtime/core/nav_goal.h"
#include "runtime/core/nav_orca.h"

/* Navigation study, section 4, unless another source is named. */
#define RELAXATION 0.54 /* s, of eq 9 */
#define DENSITY_BETA 0.0
#define HORIZON 2.5 /* s */
#define SHARE 0.5   /* of the avoidance, as the other does the same */
#define LEAN 0.1 /* rad: who meets head on, nearly, passes on the side of the convention (not in the study) */
#define PREDICTION 0.3     /* s, about the lag of a body */
#define WEIGHT_MAX 4.0     /* of the most pressing neighbour in the dense fallback */
#define COMMAND_CHANGE 2.0 /* m/s^2 */
#define SPEED_MAX 2.2      /* m/s */
#define WALL_HORIZON 1.0   /* s, algorithms C.7 */
#define WALL_REACH 3.5     /* m: top speed for the horizon, and some */
#define OVERLAP_TIME 0.1   /* s, algorithms C.7: shorter steps must not kick harder */
#define STILL 0.05         /* m/s: a command below it has no direction */
#define STAND_SPEED 0.6    /* m/s, at which one who stands steps aside at most */
#define STAND_CHANGE 3.0   /* m/s^2 */
#define STAND_FIRM 0.25    /* m/s, what he does not budge for */

typedef struct nav_view {
    const ff_nav_world *world;
    const ff_seen *me;
    const ff_neighbour *neighbours;
    uint32_t neighbour_count;
    const ff_wall *walls[FF_NEAR_WALLS_MAX];
    uint32_t wall_count;
} nav_view;

/* Opposite for the two of a pair that stands on one point. */
static ff_vec2 apart(const ff_seen *me, const ff_seen *other)
{
    return ff_v2(me->slot < other->slot ? 1.0 : -1.0, 0.0);
}

/* The steady form of eq 9: the velocity at which the drive and the forces balance. */
static ff_vec2 adapt_by_forces(const nav_view *view, ff_vec2 preferred)
{
    const ff_seen *me = view->me;
    ff_vec2 sum = ff_force_from_walls(view->walls, view->wall_count, me->position, me->velocity,
                                      me->radius + FF_PADDING);
    for (uint32_t i = 0; i < view->neighbour_count; ++i) {
        const ff_seen *other = &view->world->grid->seen[view->neighbours[i].index];
        double reach = me->radius + other->radius + 2.0 * FF_PADDING;
        ff_vec2 x = ff_sub2(me->position, other->position);
        sum = ff_add2(sum,
                      ff_force_from_disc(x, ff_sub2(me->velocity, other->velocity), reach, apart(me, other)));
    }
    ff_vec2 adapted = ff_madd2(preferred, ff_shorten2(sum, FF_FORCE_TOTAL_MAX), RELAXATION);
    return ff_shorten2(adapted, 1.3 * ff_length2(preferred) + 0.2);
}

/* The densest on each side of the way: the segments of one chain must count once. */
static double density_of_walls(const nav_view *view, ff_vec2 critical, ff_vec2 ahead)
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

static ff_vec2 adapt_to_density(const nav_view *view, ff_vec2 preferred, ff_vec2 adapted)
{
    ff_vec2 ahead = ff_unit2(preferred);
    if (ff_dot2(ahead, ahead) < 0.5) return adapted;
    const ff_grid *grid = view->world->grid;
    ff_vec2 critical = ff_madd2(view->me->position, ahead, FF_DENSITY_AHEAD);
    ff_run runs[FF_GRID_RUNS_MAX];
    uint32_t run_count = ff_grid_runs(grid, view->me->position, runs);
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

/* Where the pair will be when a body has answered, and ORCA from there (study 4, 4). */
static ff_line avoid(const nav_view *view, const ff_neighbour *neighbour)
{
    const ff_seen *me = view->me, *other = &view->world->grid->seen[neighbour->index];
    double reach = me->radius + other->radius + 2.0 * FF_PADDING;
    ff_vec2 now = ff_sub2(other->position, me->position), drift = ff_sub2(other->velocity, me->velocity);
    ff_vec2 then = now;
    double ahead = ff_dot2(now, now) > reach * reach ? PREDICTION : 0.0;
    for (int i = 0; i < 8 && ahead > 0.0; ++i, ahead *= 0.5) {
        then = ff_madd2(now, drift, ahead);
        if (ff_dot2(then, then) > reach * reach) break;
        then = now;
    }
    double lean = view->world->keep_right > 0.0 ? LEAN : (view->world->keep_right < 0.0 ? -LEAN : 0.0);
    ff_line line =
        ff_orca_disc(then, ff_sub2(me->reference, other->reference), me->reference, reach, HORIZON - ahead,
                     SHARE, ff_max(view->world->step, OVERLAP_TIME), lean, apart(me, other));
    line.weight = ff_clamp(HORIZON / ff_max(neighbour->time, OVERLAP_TIME), 1.0, WEIGHT_MAX);
    return line;
}

typedef struct constraints {
    ff_line line[FF_LINES_MAX]; /* walls, then what the body cannot do, then other agents */
    uint32_t walls, hard, count;
} constraints;

static void gather(const nav_view *view, ff_vec2 facing, ff_vec2 preferred, ff_mind *mind, constraints *out)
{
    const ff_seen *me = view->me;
    out->walls = ff_orca_walls(view->walls, view->wall_count, me->position, me->reference,
                               me->radius + FF_PADDING, WALL_HORIZON, out->line, 0);
    out->hard = ff_hull_lines(view->world->hull, facing, out->line, out->walls);
    out->hard = ff_hull_sharp_turn(facing, preferred, &mind->sharp_side, out->line, out->hard);
    out->count = out->hard;
    for (uint32_t i = 0; i < view->neighbour_count; ++i)
        out->line[out->count++] = avoid(view, &view->neighbours[i]);
}

/* Inside near if the hard lines let us, else inside wide; if rounding leaves nothing there, without the body's limits
 * (the body will clamp), but never through a wall. */
static ff_vec2 solve(constraints *lines, ff_circle near, ff_circle wide, ff_vec2 wish)
{
    ff_vec2 v;
    uint32_t hard = lines->hard, count = lines->count;
    ff_circle circle = near;
    uint32_t failed = ff_solve_nearest(lines->line, count, circle, wish, &v);
    if (failed < hard) {
        circle = wide;
        failed = ff_solve_nearest(lines->line, count, circle, wish, &v);
    }
    if (failed < hard) {
        for (uint32_t i = hard; i < count; ++i)
            lines->line[lines->walls + i - hard] = lines->line[i];
        count -= hard - lines->walls;
        hard = lines->walls;
        failed = ff_solve_nearest(lines->line, count, circle, wish, &v);
        if (failed < hard) return ff_v2(0.0, 0.0);
    }
    if (failed < count) ff_solve_dense(lines->line, count, hard, failed, circle, &v);
    return isfinite(v.a) && isfinite(v.b) ? v : ff_v2(0.0, 0.0);
}

/* Halfway between where one would like to go and where one goes, unless that is backwards (study 4, 7). */
static double facing_for(ff_vec2 preferred, ff_vec2 command, double facing)
{
    ff_vec2 wish = ff_unit2(preferred), way = ff_unit2(command), face = way;
    if (ff_dot2(command, command) < STILL * STILL)
        face = wish;
    else if (ff_dot2(wish, way) > 0.0)
        face = ff_add2(wish, way);
    return ff_dot2(face, face) > 0.0 ? ff_atan2(face.b, face.a) : facing;
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

void ff_nav_step(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours, uint32_t count,
                 const ff_traits *traits, double heading, ff_mind *mind)
{
    nav_view view = {
        .world = world, .me = &world->grid->seen[self], .neighbours = neighbours, .neighbour_count = count};
    view.wall_count = ff_walls_near(world->walls, view.me->position, WALL_REACH, view.walls);
    ff_vec2 preferred = ff_nav_preferred(world, self, neighbours, count, traits, mind);
    mind->preferred = mind->standing ? ff_nav_make_way(world, self, neighbours, count) : preferred;
    preferred = ff_nav_keep_right(world, self, view.walls, view.wall_count, traits, preferred, mind);

    ff_vec2 wish = mind->preferred;
    if (!mind->standing) wish = adapt_to_density(&view, preferred, adapt_by_forces(&view, preferred));
    constraints lines;
    gather(&view, ff_fwd2(heading), preferred, mind, &lines);
    if (mind->standing) {
        ff_circle aside = {ff_v2(0.0, 0.0), STAND_SPEED};
        ff_vec2 v = solve(&lines, aside, aside, wish);
        if (ff_length2(v) < STAND_FIRM && ff_dot2(wish, wish) == 0.0) v = ff_v2(0.0, 0.0);
        ff_vec2 change = ff_shorten2(ff_sub2(v, mind->command), STAND_CHANGE * world->step);
        mind->command = ff_add2(mind->command, change);
        return;
    }
    ff_circle near = {mind->command, COMMAND_CHANGE * world->step};
    ff_circle wide = {ff_v2(0.0, 0.0), SPEED_MAX};
    mind->command = solve(&lines, near, wide, wish);
    mind->facing = facing_for(preferred, mind->command, mind->facing);
}
