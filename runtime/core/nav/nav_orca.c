#include "runtime/core/nav/nav_orca.h"

/* u = smallest change of the relative velocity out of the disc of radius reach / time round to_other / time. */
static ff_line leave_disc(ff_vec2 w, double reach, double time, ff_vec2 own, double share, ff_vec2 apart)
{
    double length = ff_length2(w);
    ff_vec2 out = length > 1e-9 ? ff_scale2(w, 1.0 / length) : apart;
    ff_vec2 u = ff_scale2(out, reach / time - length);
    return (ff_line){ff_madd2(own, u, share), ff_v2(out.b, -out.a), 1.0};
}

ff_line ff_orca_disc(ff_vec2 to_other, ff_vec2 relative, ff_vec2 own, double reach, double horizon,
                     double share, double overlap_time, double lean, ff_vec2 apart)
{
    double square = ff_dot2(to_other, to_other), reach2 = reach * reach;
    if (square <= reach2) {
        ff_vec2 w = ff_madd2(relative, to_other, -1.0 / overlap_time);
        return leave_disc(w, reach, overlap_time, own, share, apart);
    }
    ff_vec2 w = ff_madd2(relative, to_other, -1.0 / horizon);
    double towards = ff_dot2(w, to_other);
    if (towards < 0.0 && towards * towards > reach2 * ff_dot2(w, w))
        return leave_disc(w, reach, horizon, own, share, apart);
    /* One of the two tangents from the origin to the disc. */
    double e = sqrt(square - reach2), a = to_other.a, b = to_other.b;
    double middle = lean * sqrt(square * ff_dot2(w, w));
    ff_vec2 d = ff_det2(to_other, w) > middle ? ff_v2(a * e - b * reach, a * reach + b * e)
                                              : ff_v2(-(a * e + b * reach), -(-a * reach + b * e));
    d = ff_scale2(d, 1.0 / square);
    ff_vec2 u = ff_sub2(ff_scale2(d, ff_dot2(relative, d)), relative);
    return (ff_line){ff_madd2(own, u, share), d, 1.0};
}

/* A point of the boundary of a wall's velocity obstacle, with the direction out of it. */
typedef struct boundary {
    ff_vec2 point, normal;
} boundary;
#define BOUNDARY_MAX 5

/* Tangent from the origin that passes the disc round c on its left (side 1) or right (side -1). */
static ff_vec2 tangent(ff_vec2 c, double radius, double side)
{
    double square = ff_dot2(c, c), e = sqrt(ff_max(square - radius * radius, 0.0)), r = side * radius;
    return ff_v2((c.a * e - c.b * r) / square, (c.a * r + c.b * e) / square);
}

static boundary on_leg(ff_vec2 c, ff_vec2 leg, double side, double radius, double horizon, ff_vec2 v)
{
    double start = sqrt(ff_max(ff_dot2(c, c) - radius * radius, 0.0)) / horizon;
    return (boundary){ff_scale2(leg, ff_max(ff_dot2(leg, v), start)), ff_scale2(ff_left2(leg), side)};
}

/* Point of the disc c / horizon nearest to v, if it is on the part whose normals are between first and last
 * (counter-clockwise, less than half a turn). */
static uint32_t on_arc(ff_vec2 c, ff_vec2 first, ff_vec2 last, double radius, double horizon, ff_vec2 v,
                       boundary *out)
{
    ff_vec2 centre = ff_scale2(c, 1.0 / horizon), normal = ff_unit2(ff_sub2(v, centre));
    if (ff_det2(first, normal) < 0.0 || ff_det2(normal, last) < 0.0 || ff_dot2(normal, normal) < 0.5)
        return 0;
    *out = (boundary){ff_madd2(centre, normal, radius / horizon), normal};
    return 1;
}

/* The velocity obstacle of a wall seen from p (not touching it) is convex: everything behind the nearest side of the
 * wall grown by radius and shrunk by horizon, between the outer tangents. The nearest point to v of each part of its
 * boundary. */
static uint32_t boundary_parts(const ff_wall *wall, ff_vec2 p, ff_vec2 v, double radius, double horizon,
                               boundary out[BOUNDARY_MAX])
{
    ff_vec2 end[2] = {ff_sub2(wall->from, p), ff_sub2(wall->to, p)};
    ff_vec2 left = tangent(end[0], radius, 1.0), other_left = tangent(end[1], radius, 1.0);
    ff_vec2 right = tangent(end[0], radius, -1.0), other_right = tangent(end[1], radius, -1.0);
    int left_end = ff_det2(left, other_left) > 0.0, right_end = ff_det2(right, other_right) < 0.0;
    if (left_end) left = other_left;
    if (right_end) right = other_right;

    uint32_t count = 0;
    out[count++] = on_leg(end[left_end], left, 1.0, radius, horizon, v);
    out[count++] = on_leg(end[right_end], right, -1.0, radius, horizon, v);
    ff_vec2 first = ff_left2(left), last = ff_scale2(ff_left2(right), -1.0);
    if (left_end == right_end) /* one end hides the other: a disc */
        return count + on_arc(end[left_end], first, last, radius, horizon, v, &out[count]);
    ff_vec2 facing = ff_left2(wall->along);
    if (ff_dot2(facing, end[0]) > 0.0) facing = ff_scale2(facing, -1.0);
    double s = ff_clamp(ff_dot2(ff_sub2(v, ff_scale2(end[0], 1.0 / horizon)), wall->along), 0.0,
                        wall->length / horizon);
    ff_vec2 foot = ff_madd2(ff_scale2(end[0], 1.0 / horizon), wall->along, s);
    out[count++] = (boundary){ff_madd2(foot, facing, radius / horizon), facing};
    count += on_arc(end[left_end], first, facing, radius, horizon, v, &out[count]);
    count += on_arc(end[right_end], facing, last, radius, horizon, v, &out[count]);
    return count;
}

static bool share_an_end(const ff_wall *p, const ff_wall *q)
{
    const ff_vec2 from_p[2] = {p->from, p->to}, from_q[2] = {q->from, q->to};
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            ff_vec2 gap = ff_sub2(from_p[i], from_q[j]);
            if (ff_dot2(gap, gap) < 1e-12) return true;
        }
    }
    return false;
}

static bool inside_chained(const ff_wall *const *walls, uint32_t count, uint32_t self, ff_vec2 p, boundary at,
                           double radius, double horizon)
{
    ff_vec2 v = ff_madd2(at.point, at.normal, 1e-6);
    for (uint32_t i = 0; i < count; ++i) {
        if (i != self && share_an_end(walls[i], walls[self]) &&
            ff_time_to_wall(walls[i], p, v, radius, NULL) <= horizon)
            return true;
    }
    return false;
}

/* A way past one wall: where on the boundary, and how far (squared) that is from our velocity. */
typedef struct exit_point {
    boundary at;
    double distance;
    uint32_t wall;
} exit_point;

/* We touch the wall: not further in. False where the end of one segment is touched beside the next one's flat side: that
 * one speaks for both, or we would stick to the joints of a chain. */
static bool leave_touched(const ff_wall *const *walls, uint32_t count, uint32_t self, ff_vec2 p,
                          exit_point *out)
{
    ff_vec2 away = ff_sub2(p, ff_wall_nearest(walls[self], p));
    for (uint32_t i = 0; i < count; ++i) {
        ff_vec2 other = ff_sub2(p, ff_wall_nearest(walls[i], p));
        if (ff_dot2(other, other) < ff_dot2(away, away) - 1e-12 && ff_dot2(other, away) > 0.0 &&
            share_an_end(walls[i], walls[self]))
            return false;
    }
    *out = (exit_point){{ff_v2(0.0, 0.0), ff_unit2(away)}, 0.0, self};
    if (ff_dot2(out->at.normal, out->at.normal) < 0.5) out->at.normal = ff_left2(walls[self]->along);
    return true;
}

/* The nearest boundary point that belongs to the boundary of the whole chain; if there is none (other segments
 * surround this one), the nearest of its own. */
static exit_point nearest_exit(const ff_wall *const *walls, uint32_t count, uint32_t self, ff_vec2 p,
                               ff_vec2 own, double radius, double horizon)
{
    boundary at[BOUNDARY_MAX];
    exit_point best = {.distance = INFINITY, .wall = self};
    uint32_t part_count = boundary_parts(walls[self], p, own, radius, horizon, at);
    for (int hidden = 0; hidden < 2 && isinf(best.distance); ++hidden) {
        for (uint32_t k = 0; k < part_count; ++k) {
            ff_vec2 change = ff_sub2(at[k].point, own);
            double distance = ff_dot2(change, change);
            if (distance >= best.distance) continue;
            if (!hidden && inside_chained(walls, count, self, p, at[k], radius, horizon)) continue;
            best.at = at[k];
            best.distance = distance;
        }
    }
    return best;
}

/* Whether the line forbids all that the wall forbids: its nearer end of time is beyond the line, so what is behind it
 * is too, as the line admits the origin. */
static bool covers(ff_line line, const ff_wall *wall, ff_vec2 p, double radius, double horizon)
{
    double need = radius / horizon - 1e-9, scale = 1.0 / horizon;
    return ff_line_violation(line, ff_scale2(ff_sub2(wall->from, p), scale)) >= need &&
           ff_line_violation(line, ff_scale2(ff_sub2(wall->to, p), scale)) >= need;
}

uint32_t ff_orca_walls(const ff_wall *const *walls, uint32_t count, ff_vec2 p, ff_vec2 own, double radius,
                       double horizon, ff_line *lines, uint32_t line_count)
{
    if (count == 0) return line_count;
    exit_point exits[FF_WALL_LINES_MAX] = {0};
    uint32_t exit_count = 0, first = line_count;
    for (uint32_t i = 0; i < count && i < FF_WALL_LINES_MAX; ++i) {
        exit_point exit;
        ff_vec2 away = ff_sub2(p, ff_wall_nearest(walls[i], p));
        if (ff_dot2(away, away) > radius * radius)
            exit = nearest_exit(walls, count, i, p, own, radius, horizon);
        else if (!leave_touched(walls, count, i, p, &exit))
            continue;
        uint32_t at = exit_count++;
        for (; at > 0 && exit.distance < exits[at - 1].distance; --at)
            exits[at] = exits[at - 1];
        exits[at] = exit;
    }
    for (uint32_t i = 0; i < exit_count; ++i) {
        bool covered = false;
        for (uint32_t k = first; k < line_count && !covered; ++k)
            covered = covers(lines[k], walls[exits[i].wall], p, radius, horizon);
        if (covered) continue;
        ff_vec2 normal = exits[i].at.normal;
        lines[line_count++] = (ff_line){exits[i].at.point, ff_v2(normal.b, -normal.a), 1.0};
    }
    return line_count;
}
