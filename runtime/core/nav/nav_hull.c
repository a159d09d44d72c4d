#include "runtime/core/nav/nav_hull.h"

#define POINTS_MAX 256 /* more examples than that: the rest is ignored by the first pass of make_chain */
#define FLAT 1e-9      /* m^2/s^2, twice the area under which three corners are on one line */
#define TIGHT 0.3      /* m/s, sideways in a sharp turn */
#define COS_ENTER 0.0  /* 90 degrees */
#define COS_LEAVE 0.17364817766693033 /* 80 degrees */

static bool before(ff_vec2 p, ff_vec2 q)
{
    return p.a != q.a ? p.a < q.a : p.b < q.b;
}

static double area2(ff_vec2 p, ff_vec2 q, ff_vec2 r)
{
    return ff_det2(ff_sub2(q, p), ff_sub2(r, p));
}

/* Andrew's monotone chain; counter-clockwise. */
static uint32_t convex_hull(ff_vec2 *points, uint32_t count, ff_vec2 *hull)
{
    for (uint32_t i = 1; i < count; ++i) {
        ff_vec2 p = points[i];
        uint32_t at = i;
        for (; at > 0 && before(p, points[at - 1]); --at)
            points[at] = points[at - 1];
        points[at] = p;
    }
    uint32_t size = 0;
    for (uint32_t i = 0; i < count; ++i) {
        while (size >= 2 && area2(hull[size - 2], hull[size - 1], points[i]) <= FLAT)
            --size;
        hull[size++] = points[i];
    }
    uint32_t lower = size + 1;
    for (uint32_t i = count - 1; i-- > 0;) {
        while (size >= lower && area2(hull[size - 2], hull[size - 1], points[i]) <= FLAT)
            --size;
        hull[size++] = points[i];
    }
    return size > 1 ? size - 1 : size; /* the last is the first again */
}

static uint32_t drop_smallest_corner(ff_vec2 *hull, uint32_t size)
{
    uint32_t smallest = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < size; ++i) {
        /* The origin may be a corner; without it standing still would be forbidden. */
        if (hull[i].a == 0.0 && hull[i].b == 0.0) continue;
        double area = area2(hull[(i + size - 1) % size], hull[i], hull[(i + 1) % size]);
        if (area < least) least = area, smallest = i;
    }
    for (uint32_t i = smallest; i + 1 < size; ++i)
        hull[i] = hull[i + 1];
    return size - 1;
}

void ff_hull_make(const ff_pack_point2 *points, uint32_t count, ff_hull *out)
{
    ff_vec2 sorted[POINTS_MAX + 1], hull[2 * POINTS_MAX + 2];
    uint32_t used = 0;
    double speed = 0.0;
    for (uint32_t i = 0; i < count && used < POINTS_MAX; ++i) {
        sorted[used++] = ff_v2((double)points[i].f, (double)points[i].l);
        speed = ff_max(speed, ff_length2(sorted[used - 1]));
    }
    sorted[used++] = ff_v2(0.0, 0.0);
    *out = (ff_hull){.count = 0};
    if (speed == 0.0) return;
    uint32_t size = convex_hull(sorted, used, hull);
    if (size < 3) {
        size = 4;
        hull[0] = ff_v2(0.0, -0.3 * speed), hull[1] = ff_v2(speed, -0.3 * speed);
        hull[2] = ff_v2(speed, 0.3 * speed), hull[3] = ff_v2(0.0, 0.3 * speed);
    }
    while (size > FF_HULL_MAX)
        size = drop_smallest_corner(hull, size);
    out->count = size;
    for (uint32_t i = 0; i < size; ++i) {
        /* Counter-clockwise travel has the inside on the left, as a line wants it. */
        out->line[i] = (ff_line){hull[i], ff_unit2(ff_sub2(hull[(i + 1) % size], hull[i])), 1.0};
        out->speed = ff_max(out->speed, ff_length2(hull[i]));
    }
}

uint32_t ff_hull_lines(const ff_hull *hull, ff_vec2 facing, ff_line *lines, uint32_t count)
{
    for (uint32_t i = 0; i < hull->count; ++i) {
        const ff_line *line = &hull->line[i];
        lines[count++] =
            (ff_line){ff_from_frame2(facing, line->point), ff_from_frame2(facing, line->direction), 1.0};
    }
    return count;
}

uint32_t ff_hull_sharp_turn(ff_vec2 facing, ff_vec2 preferred, double *side, ff_line *lines, uint32_t count)
{
    ff_vec2 wish = ff_unit2(preferred);
    double ahead = ff_dot2(facing, wish), length = ff_dot2(wish, wish);
    if (length < 0.5 || ahead > COS_LEAVE) *side = 0.0;
    if (length > 0.5 && *side == 0.0 && ahead < COS_ENTER) *side = ff_det2(facing, wish) >= 0.0 ? 1.0 : -1.0;
    if (*side == 0.0) return count;
    /* side * left . v <= TIGHT: outward normal n, so the direction is n turned left. */
    ff_vec2 normal = ff_scale2(ff_left2(facing), *side);
    lines[count] = (ff_line){ff_scale2(normal, TIGHT), ff_left2(normal), 1.0};
    return count + 1;
}
