/* crowd_obstacles.c - boxes, discs, capsules and spheres in the way: fixed, on a known path, or moved by the caller. */
#include "runtime/core/base/fail.h"
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/plan/plan_solids.h"

#include <string.h>

#define OBSTACLE_COOKIE 0x46464f42u
#define LARGEST 1e4 /* m */
#define SMALLEST 1e-3
#define FASTEST 20.0 /* m/s: what moves faster was put somewhere else and does not go on like that */
#define CORNERS 8    /* of the polygon that velocity navigation takes a disc for */

ff_obstacle_def ff_obstacle_def_default(void)
{
    return (ff_obstacle_def){.radius = 0.1, .high = 2.0, .cookie = OBSTACLE_COOKIE};
}

static bool between(double value, double low, double high)
{
    return value >= low && value <= high; /* false for nan */
}

static ff_status check_path(const ff_obstacle_def *def, ff_error *error)
{
    if (def->path_count < 1 || def->path_count > FF_OBSTACLE_POINTS_MAX)
        return ff_fail(error, FF_ERR_RANGE, "an obstacle's path has %u points; expected 1 to %d",
                       def->path_count, FF_OBSTACLE_POINTS_MAX);
    for (uint32_t i = 0; i < def->path_count; ++i) {
        ff_status status = ff_crowd_check_place(def->path[i].at, "a point of an obstacle's path", error);
        if (status != FF_OK) return status;
        double least = i > 0 ? def->path[i - 1].time : 0.0;
        if (!between(def->path[i].time, least, 1e6) || (i > 0 && def->path[i].time == least))
            return ff_fail(error, FF_ERR_RANGE, "the times of an obstacle's path do not rise from 0 on");
    }
    return FF_OK;
}

static ff_status check_def(const ff_obstacle_def *def, ff_error *error)
{
    if (!def || def->cookie != OBSTACLE_COOKIE)
        return ff_fail(error, FF_ERR_ARGUMENT,
                       "the obstacle's definition was not made by ff_obstacle_def_default()");
    if (def->kind < FF_OBSTACLE_STATIC || def->kind > FF_OBSTACLE_FREE)
        return ff_fail(error, FF_ERR_RANGE, "an obstacle's kind is %d; expected one of FF_OBSTACLE_*",
                       (int)def->kind);
    ff_status status = ff_crowd_check_place(def->position, "an obstacle's position", error);
    if (status != FF_OK) return status;
    double largest = ff_max(ff_max(def->half_length, def->half_width), def->radius);
    if (!between(def->half_length, 0.0, LARGEST) || !between(def->half_width, 0.0, LARGEST) ||
        !between(def->radius, 0.0, LARGEST) || largest < SMALLEST)
        return ff_fail(error, FF_ERR_RANGE,
                       "an obstacle's sizes are %g, %g and %g m; expected 0 to %g, not all 0",
                       def->half_length, def->half_width, def->radius, LARGEST);
    if (!between(def->heading, -1e3, 1e3) || !between(def->start, -1e6, 1e6))
        return ff_fail(error, FF_ERR_RANGE, "an obstacle's heading is %g and its start %g", def->heading,
                       def->start);
    if (!between(def->low, -LARGEST, def->high) || !between(def->high, def->low + SMALLEST, LARGEST))
        return ff_fail(error, FF_ERR_RANGE, "an obstacle reaches from %g to %g m over the ground", def->low,
                       def->high);
    return def->kind == FF_OBSTACLE_PATH ? check_path(def, error) : FF_OK;
}

static ff_shape shape_of(const ff_obstacle_def *def)
{
    return (ff_shape){.centre = def->position,
                      .heading = def->heading,
                      .half_length = def->half_length,
                      .half_width = def->half_width,
                      .radius = def->radius,
                      .low = def->low,
                      .high = def->high,
                      .round = def->round};
}

/* Velocity navigation knows segments: the sides of the box about it, of a disc about as many as look round. */
static void add_walls(ff_crowd *crowd, ff_crowd_obstacle *obstacle)
{
    const ff_shape *shape = &obstacle->shape;
    bool disc = shape->half_length == 0.0 && shape->half_width == 0.0;
    int count = disc ? CORNERS : 4;
    ff_vec2 corner[CORNERS], ahead = ff_fwd2(shape->heading);
    for (int i = 0; i < count; ++i) {
        ff_vec2 round = ff_scale2(ff_fwd2(FF_TAU * i / count), shape->radius);
        double length = shape->half_length + shape->radius, width = shape->half_width + shape->radius;
        ff_vec2 box = ff_v2(i == 0 || i == 3 ? length : -length, i < 2 ? width : -width);
        corner[i] = ff_add2(shape->centre, ff_from_frame2(ahead, disc ? round : box));
    }
    obstacle->first_wall = crowd->walls.count;
    for (int i = 0; i < count && crowd->walls.count < crowd->walls.capacity; ++i, ++obstacle->wall_count)
        ff_walls_add(&crowd->walls, corner[i], corner[(i + 1) % count]);
}

/* To those who plan: what stands is one of the solids, what is on a path a mover whose points are the crowd's. */
static void make_known(ff_crowd *crowd, const ff_crowd_obstacle *obstacle)
{
    ff_footsteps *f = crowd->footsteps;
    if (!f || obstacle->kind == FF_OBSTACLE_FREE) return;
    if (obstacle->kind == FF_OBSTACLE_STATIC) {
        ff_solids_add(f->solids, ff_solid_of_shape(&obstacle->shape));
        return;
    }
    ff_mover *mover = &f->movers[f->mover_count++];
    *mover = (ff_mover){.shape = obstacle->shape,
                        .path = obstacle->path,
                        .count = obstacle->path_count,
                        .cyclic = obstacle->cyclic,
                        .start = obstacle->start};
    mover->shape.centre = obstacle->home;
}

ff_status ff_crowd_add_obstacle(ff_crowd *crowd, const ff_obstacle_def *def, uint32_t *out, ff_error *error)
{
    if (!crowd) return ff_fail(error, FF_ERR_ARGUMENT, "no crowd to add an obstacle to");
    ff_status status = check_def(def, error);
    if (status != FF_OK) return status;
    if (crowd->obstacle_count == crowd->def.max_obstacles)
        return ff_fail(error, FF_ERR_RANGE, "there are %u obstacles already; raise max_obstacles",
                       crowd->obstacle_count);
    bool fixed = def->kind == FF_OBSTACLE_STATIC;
    if (fixed && crowd->steps > 0)
        return ff_fail(error, FF_ERR_ARGUMENT,
                       "obstacles that do not move are fixed once the first step was taken");
    if (out) *out = crowd->obstacle_count;
    ff_crowd_obstacle *obstacle = &crowd->obstacles[crowd->obstacle_count++];
    memset(obstacle, 0, sizeof *obstacle);
    obstacle->shape = shape_of(def);
    obstacle->home = obstacle->before = def->position;
    obstacle->kind = def->kind;
    obstacle->cyclic = def->cyclic;
    obstacle->start = def->start;
    for (uint32_t i = 0; def->kind == FF_OBSTACLE_PATH && i < def->path_count; ++i)
        obstacle->path[obstacle->path_count++] = (ff_path_point){def->path[i].time, def->path[i].at};
    if (fixed) add_walls(crowd, obstacle);
    make_known(crowd, obstacle);
    return FF_OK;
}

const char *ff_obstacle_restore(ff_crowd *crowd, const ff_crowd_obstacle *saved)
{
    const ff_shape *shape = &saved->shape;
    ff_obstacle_def def = {.kind = (ff_obstacle_kind)saved->kind,
                           .position = saved->home,
                           .heading = shape->heading,
                           .half_length = shape->half_length,
                           .half_width = shape->half_width,
                           .radius = shape->radius,
                           .low = shape->low,
                           .high = shape->high,
                           .round = shape->round != 0,
                           .path_count = saved->path_count,
                           .start = saved->start,
                           .cookie = OBSTACLE_COOKIE};
    for (uint32_t i = 0; i < saved->path_count && i < FF_OBSTACLE_POINTS_MAX; ++i)
        def.path[i] = (ff_obstacle_point){saved->path[i].time, saved->path[i].at};
    if (saved->kind > FF_OBSTACLE_FREE || shape->round > 1 || saved->cyclic > 1 ||
        check_def(&def, NULL) != FF_OK)
        return "an obstacle is out of range";
    if (!between(shape->centre.a, -1e7, 1e7) || !between(shape->centre.b, -1e7, 1e7) ||
        !between(saved->before.a, -1e7, 1e7) || !between(saved->before.b, -1e7, 1e7))
        return "an obstacle is at no place";
    if (crowd->obstacle_count == crowd->def.max_obstacles)
        return "there are more obstacles than max_obstacles";
    ff_crowd_obstacle *obstacle = &crowd->obstacles[crowd->obstacle_count++];
    *obstacle = *saved;
    make_known(crowd, obstacle);
    return NULL;
}

static ff_status check_obstacle(const ff_crowd *crowd, uint32_t obstacle, ff_error *error)
{
    if (crowd && obstacle < crowd->obstacle_count) return FF_OK;
    return ff_fail(error, FF_ERR_ARGUMENT, "there is no obstacle %u", obstacle);
}

ff_status ff_crowd_move_obstacle(ff_crowd *crowd, uint32_t obstacle, ff_vec2 position, double heading,
                                 ff_error *error)
{
    ff_status status = check_obstacle(crowd, obstacle, error);
    if (status == FF_OK) status = ff_crowd_check_place(position, "an obstacle's position", error);
    if (status != FF_OK) return status;
    if (crowd->obstacles[obstacle].kind != FF_OBSTACLE_FREE)
        return ff_fail(error, FF_ERR_ARGUMENT, "obstacle %u is none that the caller moves", obstacle);
    if (!between(heading, -1e3, 1e3))
        return ff_fail(error, FF_ERR_RANGE, "an obstacle's heading is %g", heading);
    crowd->obstacles[obstacle].shape.centre = position;
    crowd->obstacles[obstacle].shape.heading = heading;
    return FF_OK;
}

ff_status ff_crowd_obstacle_place(const ff_crowd *crowd, uint32_t obstacle, ff_vec2 *position,
                                  double *heading, ff_error *error)
{
    ff_status status = check_obstacle(crowd, obstacle, error);
    if (status != FF_OK) return status;
    if (position) *position = crowd->obstacles[obstacle].shape.centre;
    if (heading) *heading = crowd->obstacles[obstacle].shape.heading;
    return FF_OK;
}

/* Where one on a path is. */
static ff_vec2 on_path(const ff_crowd_obstacle *obstacle, double time)
{
    const ff_mover mover = {.path = obstacle->path,
                            .count = obstacle->path_count,
                            .cyclic = obstacle->cyclic,
                            .start = obstacle->start};
    return ff_add2(obstacle->home, ff_mover_at(&mover, time));
}

bool ff_obstacle_is_evaded(const ff_crowd_obstacle *obstacle)
{
    return obstacle->kind == FF_OBSTACLE_FREE && ff_shape_evasions(&obstacle->shape) != 0 &&
           ff_dot2(obstacle->velocity, obstacle->velocity) > 0.0;
}

/* As those see it who go by velocity. Where a path begins again somewhere else nothing moves there: it is as if it ended. */
static ff_nav_mover mover_of(const ff_crowd_obstacle *obstacle, double time)
{
    const ff_shape *shape = &obstacle->shape;
    ff_nav_mover mover = {.ahead = ff_fwd2(shape->heading),
                          .half_length = shape->half_length,
                          .half_width = shape->half_width,
                          .radius = shape->radius};
    mover.path.at[0] = shape->centre;
    for (int i = 1; i < FF_PATH_POINTS; ++i) {
        ff_vec2 before = mover.path.at[i - 1], next = ff_madd2(before, obstacle->velocity, FF_PATH_STEP);
        if (obstacle->kind == FF_OBSTACLE_PATH) next = on_path(obstacle, time + i * FF_PATH_STEP);
        ff_vec2 way = ff_sub2(next, before);
        bool moves = ff_dot2(way, way) <= FASTEST * FASTEST * FF_PATH_STEP * FF_PATH_STEP;
        mover.path.at[i] = moves ? next : before;
    }
    return mover;
}

void ff_obstacles_step(ff_crowd *crowd)
{
    double time = ff_crowd_time(crowd), step = crowd->def.step;
    crowd->mover_count = 0;
    for (uint32_t i = 0; i < crowd->obstacle_count; ++i) {
        ff_crowd_obstacle *obstacle = &crowd->obstacles[i];
        if (obstacle->kind == FF_OBSTACLE_PATH) {
            obstacle->shape.centre = on_path(obstacle, time);
            ff_vec2 next = on_path(obstacle, time + step);
            obstacle->velocity = ff_scale2(ff_sub2(next, obstacle->shape.centre), 1.0 / step);
        } else {
            obstacle->velocity = ff_scale2(ff_sub2(obstacle->shape.centre, obstacle->before), 1.0 / step);
        }
        if (ff_dot2(obstacle->velocity, obstacle->velocity) > FASTEST * FASTEST)
            obstacle->velocity = ff_v2(0.0, 0.0);
        obstacle->before = obstacle->shape.centre;
        if (obstacle->kind != FF_OBSTACLE_STATIC)
            crowd->movers[crowd->mover_count++] = mover_of(obstacle, time);
    }
}
