#include "runtime/core/plan/plan_solids.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>

#define TALL 1e6 /* m: walls have no top */

/* -------------------------------------------------------------------------------------------------- one solid */

ff_solid ff_solid_of_shape(const ff_shape *shape)
{
    ff_solid s = {.centre = shape->centre,
                  .axis = ff_fwd2(shape->heading),
                  .half_length = shape->half_length,
                  .half_width = shape->half_width,
                  .radius = shape->radius,
                  .low = shape->low,
                  .high = shape->high,
                  .round = shape->round};
    s.bound = ff_length2(ff_v2(s.half_length, s.half_width)) + s.radius;
    return s;
}

ff_solid ff_solid_of_wall(ff_vec2 from, ff_vec2 to)
{
    ff_vec2 along = ff_sub2(to, from);
    double length = ff_length2(along);
    return (ff_solid){.centre = ff_scale2(ff_add2(from, to), 0.5),
                      .axis = length > 0.0 ? ff_scale2(along, 1.0 / length) : ff_v2(1.0, 0.0),
                      .half_length = 0.5 * length,
                      .low = -TALL,
                      .high = TALL,
                      .bound = 0.5 * length};
}

static double point_to_box2(ff_vec2 p, double length, double width)
{
    double a = ff_max(fabs(p.a) - length, 0.0), b = ff_max(fabs(p.b) - width, 0.0);
    return a * a + b * b;
}

static double point_to_segment2(ff_vec2 p, ff_vec2 q, ff_vec2 d, double dd)
{
    ff_vec2 to = ff_sub2(p, q);
    double t = dd > 0.0 ? ff_clamp(ff_dot2(to, d) / dd, 0.0, 1.0) : 0.0;
    ff_vec2 gap = ff_madd2(to, d, -t);
    return ff_dot2(gap, gap);
}

/* Does q + t d, t in [0, 1], meet the box? By clipping t to its slabs. */
static bool segment_meets_box(ff_vec2 q, ff_vec2 d, double length, double width)
{
    const double at[2] = {q.a, q.b}, by[2] = {d.a, d.b}, half[2] = {length, width};
    double from = 0.0, to = 1.0;
    for (int i = 0; i < 2; ++i) {
        if (by[i] == 0.0) {
            if (fabs(at[i]) > half[i]) return false;
            continue;
        }
        double t0 = (-half[i] - at[i]) / by[i], t1 = (half[i] - at[i]) / by[i];
        from = ff_max(from, ff_min(t0, t1));
        to = ff_min(to, ff_max(t0, t1));
    }
    return from <= to;
}

double ff_solid_distance2(const ff_solid *solid, ff_vec2 p, ff_vec2 q)
{
    ff_vec2 from = ff_to_frame2(solid->axis, ff_sub2(p, solid->centre));
    ff_vec2 d = ff_sub2(ff_to_frame2(solid->axis, ff_sub2(q, solid->centre)), from);
    double length = solid->half_length, width = solid->half_width, dd = ff_dot2(d, d);
    if (segment_meets_box(from, d, length, width)) return 0.0;
    double least = ff_min(point_to_box2(from, length, width), point_to_box2(ff_add2(from, d), length, width));
    for (int i = 0; i < 4; ++i) {
        ff_vec2 corner = ff_v2(i & 1 ? length : -length, i & 2 ? width : -width);
        least = ff_min(least, point_to_segment2(corner, from, d, dd));
    }
    return least;
}

/* How near, horizontally, a collider between low and high may come: less past a ball's equator; negative: as near as it
 * likes. */
static double reach_at(const ff_solid *solid, double low, double high)
{
    if (high < solid->low || low > solid->high) return -1.0;
    if (!solid->round) return solid->radius;
    double up = solid->high - solid->radius, down = solid->low + solid->radius;
    double off = low > up ? low - up : (high < down ? down - high : 0.0);
    return off >= solid->radius ? -1.0 : sqrt(solid->radius * solid->radius - off * off);
}

bool ff_solid_hit(const ff_solid *solid, ff_vec2 moved, ff_vec2 origin, const ff_knot *x0, const ff_knot *x1,
                  const float *radii, double margin)
{
    for (uint32_t i = 0; i < FF_COLLIDER_COUNT; ++i) {
        float low[2], high[2];
        ff_collider_extent(i, x0->y[i], &low[0], &high[0]);
        ff_collider_extent(i, x1->y[i], &low[1], &high[1]);
        double reach =
            reach_at(solid, ff_min((double)low[0], (double)low[1]), ff_max((double)high[0], (double)high[1]));
        if (reach < 0.0) continue;
        reach += (double)radii[i] + margin;
        ff_vec2 p = ff_add2(origin, ff_v2((double)x0->a[i], (double)x0->b[i]));
        ff_vec2 q = ff_sub2(ff_add2(origin, ff_v2((double)x1->a[i], (double)x1->b[i])), moved);
        if (ff_solid_distance2(solid, p, q) <= reach * reach) return true;
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------------- many */

static void put_in_tree(ff_solids *solids, uint32_t index)
{
    const ff_solid *s = &solids->items[index];
    double a = fabs(s->axis.a) * s->half_length + fabs(s->axis.b) * s->half_width + s->radius;
    double b = fabs(s->axis.b) * s->half_length + fabs(s->axis.a) * s->half_width + s->radius;
    for (uint32_t node = solids->leaves + index; node > 0; node /= 2) {
        double *box = solids->box[node];
        box[0] = ff_min(box[0], s->centre.a - a);
        box[1] = ff_min(box[1], s->centre.b - b);
        box[2] = ff_max(box[2], s->centre.a + a);
        box[3] = ff_max(box[3], s->centre.b + b);
    }
}

ff_status ff_solids_reserve(uint32_t capacity, ff_solids **out, ff_error *error)
{
    *out = NULL;
    uint32_t leaves = 1;
    while (leaves < capacity && leaves < 1u << 30)
        leaves *= 2;
    ff_solids *solids = ff_calloc(1, sizeof *solids);
    if (solids) {
        solids->leaves = leaves;
        solids->items = ff_calloc(capacity, sizeof *solids->items);
        solids->box = ff_calloc(2 * (size_t)leaves, sizeof *solids->box);
    }
    if (!solids || !solids->items || !solids->box) {
        ff_solids_destroy(solids);
        return ff_fail(error, FF_ERR_NO_MEMORY, "%u walls and obstacles", capacity);
    }
    for (uint32_t i = 0; i < 2 * leaves; ++i)
        for (int k = 0; k < 4; ++k)
            solids->box[i][k] = k < 2 ? INFINITY : -INFINITY;
    *out = solids;
    return FF_OK;
}

void ff_solids_add(ff_solids *solids, ff_solid solid)
{
    solids->items[solids->count] = solid;
    put_in_tree(solids, solids->count++);
}

ff_status ff_solids_create(const ff_vec2 (*walls)[2], uint32_t wall_count, const ff_shape *shapes,
                           uint32_t shape_count, ff_solids **out, ff_error *error)
{
    ff_status status = ff_solids_reserve(wall_count + shape_count, out, error);
    for (uint32_t i = 0; status == FF_OK && i < wall_count; ++i)
        ff_solids_add(*out, ff_solid_of_wall(walls[i][0], walls[i][1]));
    for (uint32_t i = 0; status == FF_OK && i < shape_count; ++i)
        ff_solids_add(*out, ff_solid_of_shape(&shapes[i]));
    return status;
}

void ff_solids_destroy(ff_solids *solids)
{
    if (!solids) return;
    free(solids->items);
    free(solids->box);
    free(solids);
}

static double box_distance2(const double box[4], ff_vec2 p)
{
    double a = ff_max(ff_max(box[0] - p.a, p.a - box[2]), 0.0),
           b = ff_max(ff_max(box[1] - p.b, p.b - box[3]), 0.0);
    return a * a + b * b;
}

/* Goes through all solids whose boxes are within the radius of p, until one is hit. */
typedef bool visit(const ff_solid *solid, const void *context);
static bool go_through(const ff_solids *solids, ff_vec2 p, double radius, visit *hits, const void *context)
{
    if (!solids || solids->count == 0) return false;
    uint32_t stack[64], depth = 0;
    stack[depth++] = 1;
    while (depth > 0) {
        uint32_t node = stack[--depth];
        if (!(box_distance2(solids->box[node], p) <= radius * radius)) continue;
        if (node < solids->leaves) {
            stack[depth++] = 2 * node + 1;
            stack[depth++] = 2 * node;
        } else if (hits(&solids->items[node - solids->leaves], context))
            return true;
    }
    return false;
}

typedef struct disc {
    ff_vec2 from, to;
    double radius;
} disc;

static bool disc_hits(const ff_solid *solid, const void *context)
{
    const disc *d = context;
    double reach = solid->radius + d->radius;
    return ff_solid_distance2(solid, d->from, d->to) <= reach * reach;
}

bool ff_solids_near(const ff_solids *solids, ff_vec2 p, double radius)
{
    return go_through(solids, p, radius, disc_hits, &(disc){p, p, radius});
}

bool ff_solids_clear(const ff_solids *solids, ff_vec2 p, ff_vec2 q, double radius)
{
    double reach = 0.5 * ff_length2(ff_sub2(q, p)) + radius;
    return !go_through(solids, ff_scale2(ff_add2(p, q), 0.5), reach, disc_hits, &(disc){p, q, radius});
}

typedef struct course {
    ff_vec2 origin;
    const ff_knot *knots;
    uint32_t count;
    const float *radii;
    double margin;
} course;

static bool course_hits(const ff_solid *solid, const void *context)
{
    const course *c = context;
    for (uint32_t k = 0; k + 1 < c->count; ++k)
        if (ff_solid_hit(solid, ff_v2(0.0, 0.0), c->origin, &c->knots[k], &c->knots[k + 1], c->radii,
                         c->margin))
            return true;
    return false;
}

bool ff_solids_hit(const ff_solids *solids, ff_vec2 centre, double radius, ff_vec2 origin,
                   const ff_knot *knots, uint32_t count, const float *radii, double margin)
{
    return go_through(solids, centre, radius + margin, course_hits,
                      &(course){origin, knots, count, radii, margin});
}

uint32_t ff_waypoint_seen(const ff_solids *solids, const ff_vec2 *points, uint32_t count, uint32_t next,
                          ff_vec2 position, double radius)
{
    for (uint32_t i = count; i > next + 1; --i)
        if (ff_solids_clear(solids, position, points[i - 1], radius)) return i - 1;
    return next;
}
