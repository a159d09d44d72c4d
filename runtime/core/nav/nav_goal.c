#include "runtime/core/nav/nav_goal.h"

#include "runtime/core/nav/nav_time.h"

#define SLOW_DOWN 0.8 /* m before the goal */
#define RUN_BRAKE 1.2 /* m/s^2, with which who runs there slows down to a walk */
#define SLOW 0.25     /* m/s: who has braked to that within the tolerance stands */
#define CREEP 0.15    /* m/s, least speed on the way: above the idle threshold of the body */
#define LEAVE 0.3     /* m beyond the tolerance until one who was pushed away walks back at once */
#define RETURN 1.0    /* s, after which he does so from anywhere outside it */
#define PROGRESS 0.25 /* m nearer to the goal: the least that counts */
#define PATIENCE 6.0  /* s without progress */
#define TAKEN 1.0  /* m beyond the tolerance: a goal this near, and held by others, is as good as reached */
#define SETTLE 5.0 /* s until one who settled tries again; twice as long every time */
#define DETOUR_TIME 2.0  /* s */
#define DETOUR_FIRST 0.8 /* rad */
#define DETOUR_MORE 0.4  /* rad more with every second try */
#define DETOUR_MAX 2.0   /* rad */

#define WAY_GAP 0.5    /* m between two people, from which one who stands makes way */
#define WAY_AHEAD 1.0  /* s */
#define WAY_SPEED 0.5  /* m/s */
#define WAY_LEAST 0.05 /* m/s: who wants less than that needs no way */

#define PRESS_GAP 0.15 /* m between two who are in each other's ways */
/* Of the angle between where one wants to and where the other is, within which that is in the way. */
#define PRESS_COS 0.6
#define PRESS_TIME 0.7   /* s without progress, after which one does something about it in any case */
#define PRESS_MOVING 0.3 /* m/s, with which the other will soon be past */
#define PRESS_WAIT 0.2   /* of the preferred speed, until he is */
#define PRESS_TURN 1.2   /* rad from the other, into which one steps past who stays */
#define PRESS_STEP 0.5   /* s, for which one does so */
#define ABREAST 0.7 /* cosine of the least angle between the way of two and the line from one to the other */

#define MEET_TIME 5.0   /* s */
#define MEET_WIDTH 0.6  /* m, by which a pass is called a meeting although nobody would touch */
#define EASE 0.5        /* s */
#define WALL_TIME 2.0   /* s to a wall beside the way, from which the side preference fades */
#define FADE_FROM 0.8   /* m from the goal: no side preference inside */
#define FADE_LENGTH 2.0 /* m */

static ff_vec2 turned(ff_vec2 v, double angle)
{
    return ff_from_frame2(ff_fwd2(angle), v);
}

/* Whether somebody stands there who wants the same place; others can be asked to make way. */
static bool goal_taken(const ff_grid *grid, const ff_neighbour *neighbours, uint32_t count,
                       const ff_traits *traits)
{
    for (uint32_t i = 0; i < count; ++i) {
        const ff_seen *other = &grid->seen[neighbours[i].index];
        double reach = traits->radius + other->radius;
        ff_vec2 apart = ff_sub2(other->goal, traits->goal);
        if (other->standing && ff_dot2(apart, apart) < reach * reach) return true;
    }
    return false;
}

static void give_way_to_fate(bool taken, double distance, const ff_nav_world *world, const ff_traits *traits,
                             ff_mind *mind)
{
    mind->stalled = 0.0;
    mind->best = distance;
    if (taken && distance < traits->goal_tolerance + TAKEN) {
        mind->standing = FF_SETTLED;
        ++mind->detours;
        return;
    }
    /* First round the preferred side, then the other, then wider. */
    uint32_t pairs = mind->detours / 2;
    double size = ff_min(DETOUR_FIRST + DETOUR_MORE * pairs, DETOUR_MAX);
    double side = (mind->detours % 2 == 0) == (world->keep_right >= 0.0) ? -1.0 : 1.0;
    mind->detour = side * size;
    mind->detour_left = DETOUR_TIME;
    ++mind->detours;
}

static void stand_or_go(double distance, double speed, double step, const ff_traits *traits, ff_mind *mind)
{
    bool inside = distance <= traits->goal_tolerance;
    if (!mind->standing) {
        if (inside && speed <= SLOW) mind->standing = FF_STANDS, mind->stalled = 0.0;
        return;
    }
    if (inside) {
        mind->standing = FF_STANDS;
        mind->stalled = 0.0;
        return;
    }
    mind->stalled += step;
    bool settled = mind->standing == FF_SETTLED;
    double wait = settled ? SETTLE * (double)(1u << (mind->detours < 5 ? mind->detours : 5)) : RETURN;
    double reach = traits->goal_tolerance + LEAVE + (settled ? TAKEN : 0.0);
    if (distance > reach || mind->stalled > wait) {
        mind->standing = FF_WALKS;
        mind->stalled = 0.0;
        mind->best = distance;
    }
}

/* The side, +1 left or -1 right, on which two who are in each other's ways pass: to which what they want leads, taken
 * together, so that both get the same. 0: they are not. */
static double passing_side(const ff_nav_world *world, const ff_seen *me, const ff_seen *other)
{
    ff_vec2 to_other = ff_sub2(other->position, me->position);
    double distance = ff_length2(to_other), reach = me->radius + other->radius;
    if (other->standing || distance > reach + PRESS_GAP || distance <= 0.0) return 0.0;
    ff_vec2 n = ff_scale2(to_other, 1.0 / distance);
    ff_vec2 mine = ff_unit2(me->preferred), theirs = ff_unit2(other->preferred);
    if (ff_dot2(n, mine) < PRESS_COS || -ff_dot2(n, theirs) < PRESS_COS) return 0.0;
    double past = ff_det2(n, mine) - ff_det2(n, theirs);
    if (past == 0.0) return world->keep_right >= 0.0 ? -1.0 : 1.0;
    return past > 0.0 ? 1.0 : -1.0;
}

/* A step past who stays in one's way, as one does in his. */
static void step_past(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours,
                      uint32_t count, ff_vec2 to_goal, ff_mind *mind)
{
    const ff_seen *me = &world->grid->seen[self];
    for (uint32_t i = 0; i < count; ++i) {
        const ff_seen *other = &world->grid->seen[neighbours[i].index];
        double side = passing_side(world, me, other);
        if (side == 0.0 || ff_length2(other->velocity) > PRESS_MOVING) continue;
        ff_vec2 way = turned(ff_sub2(other->position, me->position), side * PRESS_TURN);
        mind->detour = ff_atan2(ff_det2(to_goal, way), ff_dot2(to_goal, way));
        mind->detour_left = PRESS_STEP;
        return;
    }
}

ff_vec2 ff_nav_preferred(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours,
                         uint32_t count, const ff_traits *traits, ff_mind *mind)
{
    ff_vec2 to_goal = ff_sub2(traits->goal, world->grid->seen[self].position);
    double distance = ff_length2(to_goal);
    stand_or_go(distance, ff_length2(world->grid->seen[self].velocity), world->step, traits, mind);
    /* Within the tolerance people brake evenly (as fast as the command may change) and then stand. */
    if (mind->standing || distance <= traits->goal_tolerance) return ff_v2(0.0, 0.0);

    bool watched = world->mcn->progress && traits->navigation == FF_NAVIGATION_MCN;
    if (mind->detour_left > 0.0) {
        mind->detour_left -= world->step;
        mind->best = distance;
        mind->stalled = 0.0;
    } else if (distance < mind->best - PROGRESS) {
        mind->best = distance;
        mind->stalled = 0.0;
    } else {
        mind->stalled += world->step;
        if (mind->stalled > PATIENCE && watched)
            give_way_to_fate(goal_taken(world->grid, neighbours, count, traits), distance, world, traits,
                             mind);
        else if (mind->stalled > PRESS_TIME && watched)
            step_past(world, self, neighbours, count, to_goal, mind);
    }
    double fastest = traits->preferred_speed;
    if (fastest > FF_RUN_PREFERRED) fastest = ff_min(fastest, sqrt(2.0 * RUN_BRAKE * distance));
    double speed = ff_max(fastest * ff_min(distance / SLOW_DOWN, 1.0), ff_min(CREEP, fastest));
    ff_vec2 preferred = ff_scale2(ff_unit2(to_goal), speed);
    return mind->detour_left > 0.0 ? turned(preferred, mind->detour) : preferred;
}

/* Whether anybody near would be met within MEET_TIME, or passed closely, at the preferred velocity. */
static bool meets_somebody(const ff_grid *grid, uint32_t self, ff_vec2 preferred)
{
    const ff_seen *me = &grid->seen[self];
    ff_run runs[FF_GRID_RUNS_MAX];
    uint32_t run_count = ff_grid_runs(grid, me->position, FF_NEIGHBOUR_REACH, runs);
    for (uint32_t r = 0; r < run_count; ++r) {
        for (uint32_t i = runs[r].first; i < runs[r].end; ++i) {
            const ff_seen *other = &grid->seen[i];
            ff_vec2 x = ff_sub2(me->position, other->position);
            if (!(ff_dot2(x, x) <= FF_NEIGHBOUR_REACH * FF_NEIGHBOUR_REACH) || i == self) continue;
            double reach = me->radius + other->radius + MEET_WIDTH;
            if (ff_time_to_disc(x, ff_sub2(preferred, other->velocity), reach) < MEET_TIME) return true;
        }
    }
    return false;
}

/* 1, or less when the turned way runs into a wall soon and the straight one does not: nobody steps aside into walls. */
static double room_beside(const ff_wall *const *walls, uint32_t count, const ff_seen *me, ff_vec2 straight,
                          ff_vec2 aside)
{
    double soonest = INFINITY, straight_on = INFINITY;
    for (uint32_t i = 0; i < count; ++i) {
        soonest = ff_min(soonest, ff_time_to_wall(walls[i], me->position, aside, me->radius, NULL));
        straight_on =
            ff_min(straight_on, ff_time_to_wall(walls[i], me->position, straight, me->radius, NULL));
    }
    return soonest < straight_on ? ff_min(soonest / WALL_TIME, 1.0) : 1.0;
}

ff_vec2 ff_nav_keep_right(const ff_nav_world *world, uint32_t self, const ff_wall *const *walls,
                          uint32_t wall_count, const ff_traits *traits, ff_vec2 preferred, ff_mind *mind)
{
    const ff_seen *me = &world->grid->seen[self];
    if (world->keep_right == 0.0) return preferred;
    bool goes = ff_dot2(preferred, preferred) > 0.0,
         meets = goes && meets_somebody(world->grid, self, preferred);
    mind->bias = ff_clamp(mind->bias + (meets ? 1.0 : -1.0) * world->step / EASE, 0.0, 1.0);
    if (!goes || mind->bias <= 0.0) return preferred;
    double distance = ff_length2(ff_sub2(traits->goal, me->position));
    double fade = ff_clamp((distance - FADE_FROM) / FADE_LENGTH, 0.0, 1.0);
    double angle = -world->keep_right * mind->bias * fade;
    double room = room_beside(walls, wall_count, me, preferred, turned(preferred, angle));
    return turned(preferred, angle * room);
}

/* Whether two walk side by side, and who wants to go on less (of equals, the later slot). */
static bool falls_back(const ff_seen *me, const ff_seen *other)
{
    ff_vec2 to_other = ff_sub2(other->position, me->position);
    ff_vec2 both = ff_add2(me->velocity, other->velocity), along = ff_unit2(both);
    if (ff_length2(both) < 2.0 * PRESS_MOVING || ff_dot2(me->velocity, other->velocity) <= 0.0) return false;
    if (fabs(ff_dot2(along, to_other)) > ABREAST * ff_length2(to_other)) return false;
    double eager = ff_dot2(along, ff_sub2(other->preferred, me->preferred));
    return eager > 0.0 || (eager == 0.0 && me->slot > other->slot);
}

ff_vec2 ff_nav_fall_back(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours,
                         uint32_t count, ff_vec2 preferred, const ff_mind *mind)
{
    const ff_seen *me = &world->grid->seen[self];
    bool stuck = mind->stalled > PRESS_TIME;
    for (uint32_t i = 0; i < count; ++i) {
        const ff_seen *other = &world->grid->seen[neighbours[i].index];
        if (passing_side(world, me, other) == 0.0) continue;
        if (stuck ? ff_length2(other->velocity) > PRESS_MOVING : falls_back(me, other))
            return ff_scale2(preferred, PRESS_WAIT);
    }
    return preferred;
}

ff_vec2 ff_nav_make_way(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours,
                        uint32_t count)
{
    const ff_seen *me = &world->grid->seen[self];
    ff_vec2 sum = ff_v2(0.0, 0.0);
    if (ff_length2(me->velocity) > WAY_SPEED) return sum; /* still coming to his stand */
    for (uint32_t i = 0; i < count; ++i) {
        const ff_seen *other = &world->grid->seen[neighbours[i].index];
        double wish = ff_length2(other->preferred), reach = me->radius + other->radius;
        ff_vec2 apart = ff_sub2(me->goal, other->goal);
        /* Two cannot stand on one goal: who was first keeps it. */
        if (wish < WAY_LEAST || ff_dot2(apart, apart) < reach * reach) continue;
        ff_vec2 way = ff_scale2(other->preferred, 1.0 / wish), x = ff_sub2(me->position, other->position);
        double gap = ff_length2(x) - reach, across = ff_det2(way, x);
        if (gap > WAY_GAP || ff_dot2(way, x) < 0.0 || fabs(across) > reach + 2.0 * world->padding) continue;
        /* To the side where he will be once the other has moved on: or both step to the same side, again and again. */
        double later = across - WAY_AHEAD * ff_det2(way, other->velocity);
        double side = later >= 0.0 ? 1.0 : -1.0;
        sum = ff_madd2(sum, ff_left2(way), side * (1.0 - ff_max(gap, 0.0) / WAY_GAP));
    }
    return ff_scale2(ff_unit2(sum), WAY_SPEED);
}
