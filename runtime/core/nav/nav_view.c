#include "runtime/core/nav/nav_view.h"

#include "runtime/core/nav/nav_forces.h"
#include "runtime/core/nav/nav_orca.h"
#include "runtime/core/nav/nav_path.h"

#define SHARE 0.5      /* of the avoidance, as the other does the same (unless it is firm) */
#define WEIGHT_MAX 4.0 /* of the most pressing neighbour in the dense fallback */
/* Of somebody behind: who follows looks out for himself. Else those in a column cannot brake for one who comes from the
 * side, each because of the next behind him (not in the study). */
#define BEHIND 0.5
#define WALL_HORIZON 1.0 /* s, algorithms C.7 */
#define WALL_REACH 3.5   /* m: top speed for the horizon, and some */
#define OVERLAP_TIME 0.1 /* s, algorithms C.7: shorter steps must not kick harder */

/* Opposite for the two of a pair that stands on one point. */
static ff_vec2 apart(const ff_seen *me, const ff_seen *other)
{
    return ff_v2(me->slot < other->slot ? 1.0 : -1.0, 0.0);
}

void ff_nav_look(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours, uint32_t count,
                 ff_nav_view *out)
{
    out->world = world;
    out->me = &world->grid->seen[self];
    out->neighbours = neighbours;
    out->neighbour_count = count;
    out->wall_count = ff_walls_near(world->walls, out->me->position, WALL_REACH, out->walls);
    out->mover_count = ff_movers_see(world->movers, world->mover_count, out->me, out->movers);
}

ff_vec2 ff_nav_forces(const ff_nav_view *view, double one, double total)
{
    const ff_seen *me = view->me;
    double padding = view->world->padding;
    ff_vec2 sum = ff_force_from_walls(view->walls, view->wall_count, me->position, me->velocity,
                                      me->radius + padding, one);
    for (uint32_t i = 0; i < view->neighbour_count; ++i) {
        if (view->neighbours[i].time == INFINITY) break; /* nor will those after it be met */
        const ff_seen *other = &view->world->grid->seen[view->neighbours[i].index];
        double reach = me->radius + other->radius + 2.0 * padding;
        ff_vec2 x = ff_sub2(me->position, other->position);
        sum = ff_add2(
            sum, ff_force_from_disc(x, ff_sub2(me->velocity, other->velocity), reach, one, apart(me, other)));
    }
    for (uint32_t i = 0; i < view->mover_count; ++i)
        sum = ff_add2(sum, ff_force_from_mover(&view->movers[i], me, me->radius + padding, one));
    return ff_shorten2(sum, total);
}

void ff_nav_add_walls(const ff_nav_view *view, ff_constraints *lines)
{
    const ff_seen *me = view->me;
    lines->walls = ff_orca_walls(view->walls, view->wall_count, me->position, me->reference,
                                 me->radius + view->world->padding, WALL_HORIZON, lines->line, 0);
    lines->hull = lines->sharp = lines->hard = lines->count = lines->walls;
}

/* Who is on a plan goes where that leads, and leaves all avoiding to us. */
static ff_line avoid_path(const ff_nav_view *view, const ff_seen *other, ff_avoiding how, double *time)
{
    const ff_seen *me = view->me;
    ff_path_meeting meeting = ff_path_meet(&view->world->paths[other->slot], me, how.prediction);
    *time = meeting.time;
    return ff_orca_disc(meeting.to_other, ff_sub2(me->reference, meeting.velocity), me->reference,
                        meeting.reach + 2.0 * view->world->padding, FF_HORIZON - how.prediction, 1.0,
                        ff_max(view->world->step, OVERLAP_TIME), how.lean, apart(me, other));
}

/* Where the pair will be when a body has answered, and ORCA from there (study 4, 4). */
static ff_line avoid_agent(const ff_nav_view *view, const ff_seen *other, ff_avoiding how)
{
    const ff_seen *me = view->me;
    double reach = me->radius + other->radius + 2.0 * view->world->padding;
    ff_vec2 now = ff_sub2(other->position, me->position), drift = ff_sub2(other->velocity, me->velocity);
    ff_vec2 then = now;
    double ahead = ff_dot2(now, now) > reach * reach ? how.prediction : 0.0;
    for (int i = 0; i < 8 && ahead > 0.0; ++i, ahead *= 0.5) {
        then = ff_madd2(now, drift, ahead);
        if (ff_dot2(then, then) > reach * reach) break;
        then = now;
    }
    return ff_orca_disc(then, ff_sub2(me->reference, other->reference), me->reference, reach,
                        FF_HORIZON - ahead, SHARE, ff_max(view->world->step, OVERLAP_TIME), how.lean,
                        apart(me, other));
}

static ff_line avoid(const ff_nav_view *view, const ff_neighbour *neighbour, ff_avoiding how)
{
    const ff_seen *me = view->me, *other = &view->world->grid->seen[neighbour->index];
    double time = neighbour->time;
    ff_line line = other->firm ? avoid_path(view, other, how, &time) : avoid_agent(view, other, how);
    if (!how.weighted) return line;
    line.weight = ff_clamp(FF_HORIZON / ff_max(time, OVERLAP_TIME), 1.0, WEIGHT_MAX);
    if (!me->standing && ff_dot2(ff_sub2(other->position, me->position), me->velocity) < 0.0)
        line.weight *= BEHIND;
    return line;
}

void ff_nav_add_movers(const ff_nav_view *view, double prediction, ff_constraints *lines)
{
    for (uint32_t i = 0; i < view->mover_count; ++i)
        lines->count =
            ff_mover_lines(&view->movers[i], view->me, view->me->radius + view->world->padding, prediction,
                           ff_max(view->world->step, OVERLAP_TIME), lines->line, lines->count);
}

void ff_nav_add_agents(const ff_nav_view *view, ff_avoiding how, ff_constraints *lines)
{
    for (uint32_t i = 0; i < view->neighbour_count; ++i)
        lines->line[lines->count++] = avoid(view, &view->neighbours[i], how);
}

/* Forget the hard lines from first on. */
static void give_up(ff_constraints *lines, uint32_t first)
{
    uint32_t gone = lines->hard - first;
    for (uint32_t i = lines->hard; i < lines->count; ++i)
        lines->line[i - gone] = lines->line[i];
    lines->hard = first;
    lines->count -= gone;
}

ff_vec2 ff_nav_solve(ff_constraints *lines, ff_circle near, ff_circle wide, ff_vec2 wish)
{
    const uint32_t yields[] = {lines->sharp, lines->hull, lines->walls};
    ff_vec2 v;
    ff_circle circle = near;
    uint32_t failed = ff_solve_nearest(lines->line, lines->count, circle, wish, &v);
    if (failed < lines->hard) {
        circle = wide;
        failed = ff_solve_nearest(lines->line, lines->count, circle, wish, &v);
    }
    if (failed >= lines->hard && failed < lines->count && lines->hard > lines->sharp) {
        /* Rather a step across the standing foot than into somebody. */
        give_up(lines, lines->sharp);
        failed = ff_solve_nearest(lines->line, lines->count, circle, wish, &v);
    }
    for (int i = 0; i < 3 && failed < lines->hard; ++i) {
        if (yields[i] == lines->hard) continue;
        give_up(lines, yields[i]);
        failed = ff_solve_nearest(lines->line, lines->count, circle, wish, &v);
    }
    if (failed < lines->hard) return ff_v2(0.0, 0.0);
    if (failed < lines->count) ff_solve_dense(lines->line, lines->count, lines->hard, failed, circle, &v);
    return isfinite(v.a) && isfinite(v.b) ? v : ff_v2(0.0, 0.0);
}
