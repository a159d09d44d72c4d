/* nav_movers.c - a box that moves is, in its own frame, four walls: velocities are shifted by its own there and back (van den
 * Berg et al. 2011 put obstacles that give no way so, with the whole of the change ours). */
#include "runtime/core/nav/nav_movers.h"

#include "runtime/core/nav/nav_forces.h"
#include "runtime/core/nav/nav_orca.h"
#include "runtime/core/nav/nav_path.h"

#define SOON 3.0        /* s: what cannot be met in that, however both hurry, is not looked at */
#define HURRY 2.2       /* m/s, of an agent */
#define WEIGHT 8.0      /* twice that of the most pressing person, who can give way */
#define REST FF_HORIZON /* of what rests or leaves: as for people */
#define COMES 12.0      /* s, of what comes at us: backing off is no way out, only to the side is */
#define COMES_AT 0.5    /* m/s towards us, from which it is that */
#define ROOM 0.04       /* m more than what is needed: bodies answer late */
#define PUSH 5.0        /* m/s^2, out of what is touched */
#define OUT_FASTEST 1.0 /* m/s on top of its own, out of what is overlapped */

/* m from p to its edge, the radius counted, with its centre at a place; *out: unit, away from the edge there. */
static double gap_to(const ff_nav_mover *mover, ff_vec2 centre, ff_vec2 p, ff_vec2 *out)
{
    ff_vec2 x = ff_to_frame2(mover->ahead, ff_sub2(p, centre));
    ff_vec2 edge = ff_v2(ff_clamp(x.a, -mover->half_length, mover->half_length),
                         ff_clamp(x.b, -mover->half_width, mover->half_width));
    ff_vec2 away = ff_sub2(x, edge);
    double distance = ff_length2(away);
    if (distance > 1e-9) {
        *out = ff_from_frame2(mover->ahead, ff_scale2(away, 1.0 / distance));
        return distance - mover->radius;
    }
    double along = mover->half_length - fabs(x.a), across = mover->half_width - fabs(x.b);
    ff_vec2 way = along < across ? ff_v2(x.a < 0.0 ? -1.0 : 1.0, 0.0) : ff_v2(0.0, x.b < 0.0 ? -1.0 : 1.0);
    *out = ff_from_frame2(mover->ahead, way);
    return -ff_min(along, across) - mover->radius;
}

/* Where it gets to, evenly, until I would touch it or come nearest, if I went on as I am about to. */
static ff_vec2 velocity_of(const ff_nav_mover *mover, const ff_seen *me)
{
    double least = INFINITY, nearest = 0.0, end = FF_PATH_STEP * (FF_PATH_POINTS - 1);
    for (double t = 0.0; t <= end; t += 0.5 * FF_PATH_STEP) {
        ff_vec2 out;
        ff_vec2 p = ff_madd2(me->position, me->reference, t);
        double gap = gap_to(mover, ff_path_at(&mover->path, t), p, &out) - me->radius;
        if (gap >= least) continue;
        least = gap;
        nearest = t;
        if (gap < 0.0) break;
    }
    double since = ff_max(nearest, FF_PATH_STEP);
    return ff_scale2(ff_sub2(ff_path_at(&mover->path, since), mover->path.at[0]), 1.0 / since);
}

uint32_t ff_movers_see(const ff_nav_mover *movers, uint32_t count, const ff_seen *me,
                       ff_mover_seen out[FF_MOVERS_SEEN_MAX])
{
    uint32_t seen = 0;
    for (uint32_t i = 0; i < count; ++i) {
        ff_mover_seen one = {.mover = &movers[i]};
        one.gap = gap_to(one.mover, one.mover->path.at[0], me->position, &one.out);
        one.velocity = velocity_of(one.mover, me);
        one.time = ff_max(one.gap - me->radius, 0.0) / (HURRY + ff_length2(one.velocity));
        if (one.time > SOON) continue;
        uint32_t at = seen;
        for (; at > 0 && one.time < out[at - 1].time; --at)
            if (at < FF_MOVERS_SEEN_MAX) out[at] = out[at - 1];
        if (at < FF_MOVERS_SEEN_MAX) out[at] = one;
        if (seen < FF_MOVERS_SEEN_MAX) ++seen;
    }
    return seen;
}

static bool is_disc(const ff_nav_mover *mover)
{
    return mover->half_length == 0.0 && mover->half_width == 0.0;
}

/* The sides of the rectangle, of a capsule its one middle line; returns how many. */
static uint32_t sides_of(const ff_nav_mover *mover, ff_wall wall[4], const ff_wall *list[4])
{
    double l = mover->half_length, w = mover->half_width;
    const ff_vec2 corner[4] = {ff_v2(l, w), ff_v2(-l, w), ff_v2(-l, -w), ff_v2(l, -w)};
    ff_vec2 at[4];
    for (int i = 0; i < 4; ++i)
        at[i] = ff_add2(mover->path.at[0], ff_from_frame2(mover->ahead, corner[i]));
    uint32_t count = l > 0.0 && w > 0.0 ? 4 : 1;
    wall[0] = ff_wall_between(at[0], w > 0.0 && l == 0.0 ? at[2] : at[1]);
    for (uint32_t i = 1; i < count; ++i)
        wall[i] = ff_wall_between(at[i], at[(i + 1) % 4]);
    for (uint32_t i = 0; i < count; ++i)
        list[i] = &wall[i];
    return count;
}

/* Where I shall be, as seen from it, when my body has answered; not in touch with it. */
static ff_vec2 where_i_answer(const ff_mover_seen *seen, const ff_seen *me, double reach, double *ahead)
{
    ff_vec2 drift = ff_sub2(me->velocity, seen->velocity), out;
    for (int i = 0; i < 8 && *ahead > 0.0; ++i, *ahead *= 0.5) {
        ff_vec2 then = ff_madd2(me->position, drift, *ahead);
        if (gap_to(seen->mover, seen->mover->path.at[0], then, &out) > reach) return then;
    }
    *ahead = 0.0;
    return me->position;
}

uint32_t ff_mover_lines(const ff_mover_seen *seen, const ff_seen *me, double reach, double ahead,
                        double least_time, ff_line *lines, uint32_t count)
{
    const ff_nav_mover *mover = seen->mover;
    ff_vec2 v = seen->velocity;
    if (seen->gap <= reach) { /* out of it, as it moves */
        double faster = ff_min((reach - seen->gap) / least_time, OUT_FASTEST);
        ff_vec2 point = ff_madd2(v, seen->out, faster);
        lines[count] = (ff_line){point, ff_v2(seen->out.b, -seen->out.a), WEIGHT};
        return count + 1;
    }
    reach += ROOM;
    ff_vec2 then = where_i_answer(seen, me, reach, &ahead);
    double comes = ff_clamp(ff_dot2(v, seen->out) / COMES_AT, 0.0, 1.0);
    double horizon = REST + (COMES - REST) * comes - ahead;
    /* Left where that costs least of what I do and of what I want: by the first alone one who starts, or has braked, is content
     * with creeping towards it; by the second alone one changes sides too late. */
    ff_vec2 relative = ff_sub2(ff_scale2(ff_add2(me->reference, me->preferred), 0.5), v);
    uint32_t first = count;
    if (is_disc(mover)) {
        lines[count++] = ff_orca_disc(ff_sub2(mover->path.at[0], then), relative, relative,
                                      reach + mover->radius, horizon, 1.0, least_time, 0.0, seen->out);
    } else {
        ff_wall wall[4];
        const ff_wall *list[4];
        uint32_t walls = sides_of(mover, wall, list);
        count = ff_orca_walls(list, walls, then, relative, reach + mover->radius, horizon, lines, count);
    }
    for (uint32_t i = first; i < count; ++i) {
        lines[i].point = ff_add2(lines[i].point, v);
        lines[i].weight = WEIGHT;
    }
    return count;
}

ff_vec2 ff_force_from_mover(const ff_mover_seen *seen, const ff_seen *me, double reach, double limit)
{
    ff_vec2 v = ff_sub2(me->velocity, seen->velocity);
    if (seen->gap <= reach) return ff_scale2(seen->out, ff_min(PUSH, limit));
    if (is_disc(seen->mover)) {
        ff_vec2 x = ff_sub2(me->position, seen->mover->path.at[0]);
        return ff_force_from_disc(x, v, reach + seen->mover->radius, limit, seen->out);
    }
    ff_wall wall[4];
    const ff_wall *list[4];
    uint32_t walls = sides_of(seen->mover, wall, list);
    return ff_force_from_walls(list, walls, me->position, v, reach + seen->mover->radius, limit);
}
