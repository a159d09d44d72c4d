#include "preprocess/examples/sharp_turn.h"

#include "preprocess/examples/hull.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/maths.h"

#include <stdlib.h>

#define TIGHT 0.3             /* m/s, sideways, for want of tight turns */
#define SHARP (90.0 * FF_DEG) /* rad/s */
#define SAME 1e-6             /* rad */
#define ON_HULL 1e-6          /* m/s */

static ff_vec2 velocity_of(const ff_turning *m)
{
    return ff_hull_velocity(m->speed, m->turn);
}

/* By direction, which is the turn over a second; of several in one direction the fastest first. */
static int by_direction(const void *x, const void *y)
{
    const ff_turning *a = x, *b = y;
    double p = ff_clamp(a->turn, -FF_PI, FF_PI), q = ff_clamp(b->turn, -FF_PI, FF_PI);
    if (p != q) return p < q ? -1 : 1;
    return a->speed > b->speed ? -1 : a->speed < b->speed;
}

/* Corners of the star: the fastest of each direction, none at rest. */
static int keep_corners(ff_turning *motions, int count)
{
    int kept = 0;
    qsort(motions, (size_t)count, sizeof *motions, by_direction);
    for (int i = 0; i < count; ++i) {
        if (motions[i].speed < TIGHT * 0.1) continue; /* turning on the spot has no direction */
        if (kept > 0 && motions[i].turn - motions[kept - 1].turn < SAME) continue;
        motions[kept++] = motions[i];
    }
    return kept;
}

/* Does some motion lie beyond the line from p to q, seen from the origin? */
static bool inside_hull(const ff_turning *motions, int count, ff_vec2 p, ff_vec2 q)
{
    ff_vec2 along = ff_unit2(ff_sub2(q, p));
    for (int i = 0; i < count; ++i)
        if (ff_det2(along, ff_sub2(velocity_of(&motions[i]), p)) < -ON_HULL) return true;
    return false;
}

static ff_status add_line(ff_array *out, ff_vec2 point, ff_vec2 direction, int side, ff_error *error)
{
    ff_pack_sharp *line = ff_array_grow(out, 1, sizeof *line);
    if (!line) return ff_fail(error, FF_ERR_NO_MEMORY, "the limits of sharp turns");
    *line = (ff_pack_sharp){{(float)point.a, (float)point.b}, {(float)direction.a, (float)direction.b}, side};
    return FF_OK;
}

static ff_status find_side(const ff_turning *motions, int count, int side, ff_array *out, ff_error *error)
{
    ff_status status = FF_OK;
    bool found = false;
    for (int i = 0; i + 1 < count && status == FF_OK; ++i) {
        const ff_turning *from = &motions[i], *to = &motions[i + 1];
        bool sharp = side * from->turn > SHARP || side * to->turn > SHARP;
        ff_vec2 p = velocity_of(from), q = velocity_of(to), along = ff_unit2(ff_sub2(q, p));
        /* Counter-clockwise: the origin is to the left, unless the two are more than half a turn apart. */
        if (!sharp || ff_det2(along, ff_scale2(p, -1.0)) <= 0.0) continue;
        if (!inside_hull(motions, count, p, q)) continue; /* an edge of the hull holds anyway */
        status = add_line(out, p, along, side, error);
        found = true;
    }
    if (found || status != FF_OK) return status;
    return add_line(out, ff_v2(0.0, side * TIGHT), ff_v2(-side, 0.0), side, error);
}

ff_status ff_sharp_turns_find(ff_turning *motions, int count, ff_array *out, ff_error *error)
{
    int corners = keep_corners(motions, count);
    ff_status status = find_side(motions, corners, 1, out, error);
    if (status == FF_OK) status = find_side(motions, corners, -1, out, error);
    return status;
}
