#include "runtime/export/obstacle_outline.h"

#include "runtime/core/base/maths.h"

ff_vec2 ff_obstacle_at(const ff_obstacle_def *obstacle, double time)
{
    const ff_obstacle_point *path = obstacle->path;
    if (obstacle->kind != FF_OBSTACLE_PATH || obstacle->path_count == 0) return obstacle->position;
    uint32_t last = obstacle->path_count - 1;
    double t = time - obstacle->start, length = path[last].time;
    if (obstacle->cyclic && length > 0.0) t -= length * floor(t / length);
    ff_vec2 at = path[last].at;
    if (t <= path[0].time) at = path[0].at;
    for (uint32_t i = 1; i <= last; ++i) {
        if (t <= path[i - 1].time || t > path[i].time) continue;
        double share = (t - path[i - 1].time) / (path[i].time - path[i - 1].time);
        at = ff_madd2(path[i - 1].at, ff_sub2(path[i].at, path[i - 1].at), share);
    }
    return ff_add2(obstacle->position, at);
}

void ff_obstacle_outline(const ff_obstacle_def *obstacle, double time, ff_vec2 out[FF_OBSTACLE_CORNERS])
{
    static const double side[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    ff_vec2 centre = ff_obstacle_at(obstacle, time), forward = ff_fwd2(obstacle->heading);
    for (int i = 0; i < FF_OBSTACLE_CORNERS; ++i) {
        const double *corner = side[i / 4];
        ff_vec2 round = ff_scale2(ff_fwd2(0.5 * FF_PI * (i / 4 + i % 4 / 3.0)), obstacle->radius);
        ff_vec2 point =
            ff_add2(ff_v2(corner[0] * obstacle->half_length, corner[1] * obstacle->half_width), round);
        out[i] = ff_add2(centre, ff_from_frame2(forward, point));
    }
}
