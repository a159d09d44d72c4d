#include "runtime/core/plan/plan_field.h"
#include "runtime/core/plan/plan_solids.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE_MAX = 512, MOVES = 16, LAYERS = 3 };
enum { OPEN, TIGHT, SHUT };
static const double CELL = 0.2;    /* m; more where the extent needs it */
static const float TIGHTER = 4.0f; /* a step into the clearance is worth so many: elbows catch there */
/* Ways over the grid turn by multiples of 22.5 degrees or so: they are up to this much longer than straight ones. */
static const float DETOUR = 1.0f / 1.028f;

static const int moves[MOVES][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},  {1, 1}, {1, -1}, {-1, 1}, {-1, -1},
                                    {2, 1}, {2, -1}, {-2, 1}, {-2, -1}, {1, 2}, {-1, 2}, {1, -2}, {-1, -2}};

/* ---------------------------------------------------------------------------------------------------------- heap */

typedef struct entry {
    float distance;
    uint32_t cell;
} entry;

static bool before(entry p, entry q)
{
    return p.distance < q.distance || (p.distance == q.distance && p.cell < q.cell);
}

static bool push(ff_array *heap, entry e)
{
    if (!ff_array_grow(heap, 1, sizeof e)) return false;
    entry *items = heap->data;
    size_t at = heap->count - 1;
    for (; at > 0 && before(e, items[(at - 1) / 2]); at = (at - 1) / 2)
        items[at] = items[(at - 1) / 2];
    items[at] = e;
    return true;
}

static entry pop(ff_array *heap)
{
    entry *items = heap->data, top = items[0], last = items[--heap->count];
    size_t at = 0;
    for (size_t child; (child = 2 * at + 1) < heap->count; at = child) {
        if (child + 1 < heap->count && before(items[child + 1], items[child])) ++child;
        if (!before(items[child], last)) break;
        items[at] = items[child];
    }
    items[at] = last;
    return top;
}

/* --------------------------------------------------------------------------------------------------------- cells */

static bool inside(const ff_field *field, int i, int k)
{
    return i >= 0 && k >= 0 && i < (int)field->side && k < (int)field->side;
}

static bool is_open(const ff_field *field, const uint8_t *closed, int i, int k)
{
    return inside(field, i, k) && !closed[(uint32_t)i * field->side + (uint32_t)k];
}

/* A knight's move goes between two cells: both must be free. */
static bool may_move(const ff_field *field, const uint8_t *closed, int i, int k, const int move[2])
{
    if (!is_open(field, closed, i + move[0], k + move[1])) return false;
    int a = move[0] / 2, b = move[1] / 2;
    if (move[0] * move[1] == 0) return true;
    if (a == 0 && b == 0)
        return is_open(field, closed, i + move[0], k) && is_open(field, closed, i, k + move[1]);
    return is_open(field, closed, i + a, k + b) && is_open(field, closed, i + move[0] - a, k + move[1] - b);
}

static bool spread(ff_field *field, const uint8_t *closed, ff_array *heap)
{
    while (heap->count > 0) {
        entry e = pop(heap);
        if (e.distance > field->distance[e.cell]) continue;
        int i = (int)(e.cell / field->side), k = (int)(e.cell % field->side);
        for (int m = 0; m < MOVES; ++m) {
            if (!may_move(field, closed, i, k, moves[m])) continue;
            uint32_t to = (uint32_t)(i + moves[m][0]) * field->side + (uint32_t)(k + moves[m][1]);
            int square = moves[m][0] * moves[m][0] + moves[m][1] * moves[m][1];
            float distance = e.distance + (float)(field->cell * sqrt((double)square)) * DETOUR;
            if (field->distance[to] <= distance) continue;
            field->distance[to] = distance;
            if (!push(heap, (entry){distance, to})) return false;
        }
    }
    return true;
}

/* Somebody who turns by a wall is nearer to it than one who walks along it would be: closed cells in which the torso fits
 * take over from the open ones beside them, and the next ones from those. Two such cells on either side of a wall are no neighbours,
 * so what lies behind it does not show through. */
static bool fill_closed(ff_field *field, const uint8_t *closed)
{
    size_t cells = (size_t)field->side * field->side;
    float *next = ff_calloc(cells, sizeof *next);
    for (int layer = 0; next && layer < LAYERS; ++layer) {
        memcpy(next, field->distance, cells * sizeof *next);
        for (uint32_t c = 0; c < cells; ++c) {
            if (closed[c] != TIGHT || field->distance[c] < INFINITY) continue;
            int i = (int)(c / field->side), k = (int)(c % field->side);
            for (int m = 0; m < 8; ++m) {
                int a = i + moves[m][0], b = k + moves[m][1];
                if (!inside(field, a, b)) continue;
                float by =
                    field->distance[(uint32_t)a * field->side + (uint32_t)b] + TIGHTER * (float)field->cell;
                next[c] = by < next[c] ? by : next[c];
            }
        }
        memcpy(field->distance, next, cells * sizeof *next);
    }
    bool good = next != NULL;
    free(next);
    return good;
}

/* Begins at the goal; at one in a wall, with what is free around it. */
static bool begin(ff_field *field, const uint8_t *closed, ff_vec2 goal, ff_array *heap)
{
    int i = (int)floor((goal.a - field->corner.a) / field->cell + 0.5),
        k = (int)floor((goal.b - field->corner.b) / field->cell + 0.5);
    for (int reach = 0; reach <= 3 && heap->count == 0; ++reach)
        for (int di = -reach; di <= reach; ++di)
            for (int dk = -reach; dk <= reach; ++dk) {
                if (!is_open(field, closed, i + di, k + dk)) continue;
                uint32_t cell = (uint32_t)(i + di) * field->side + (uint32_t)(k + dk);
                field->distance[cell] = (float)(reach * field->cell);
                if (!push(heap, (entry){field->distance[cell], cell})) return false;
            }
    return true;
}

ff_status ff_field_create(const ff_solids *solids, ff_vec2 goal, double extent, double clearance,
                          ff_field **out, ff_error *error)
{
    *out = NULL;
    if (!(extent > 0.0 && extent <= 1e4))
        return ff_fail(error, FF_ERR_RANGE,
                       "the extent of a distance field is %g m; expected more than 0, at most 10000", extent);
    ff_field *field = ff_calloc(1, sizeof *field);
    uint8_t *closed = NULL;
    ff_array heap = {0};
    bool good = field != NULL;
    if (good) {
        field->cell = ff_max(CELL, 2.0 * extent / (SIDE_MAX - 1));
        int half = (int)ceil(extent / field->cell);
        field->side = (uint32_t)(2 * half + 1);
        field->corner = ff_sub2(goal, ff_v2(half * field->cell, half * field->cell));
        double fits = 0.75 * field->cell; /* more than half of the way to a neighbour's middle */
        size_t cells = (size_t)field->side * field->side;
        field->distance = ff_calloc(cells, sizeof *field->distance);
        closed = ff_calloc(cells, 1);
        good = field->distance && closed;
        for (uint32_t c = 0; good && c < cells; ++c) {
            ff_vec2 at =
                ff_add2(field->corner, ff_v2(c / field->side * field->cell, c % field->side * field->cell));
            field->distance[c] = INFINITY;
            if (ff_solids_near(solids, at, clearance))
                closed[c] = ff_solids_near(solids, at, fits) ? SHUT : TIGHT;
        }
        good = good && begin(field, closed, goal, &heap) && spread(field, closed, &heap) &&
               fill_closed(field, closed);
    }
    free(closed);
    ff_array_free(&heap);
    if (!good) {
        ff_field_destroy(field);
        return ff_fail(error, FF_ERR_NO_MEMORY, "a distance field of %g m", extent);
    }
    *out = field;
    return FF_OK;
}

void ff_field_destroy(ff_field *field)
{
    if (!field) return;
    free(field->distance);
    free(field);
}

double ff_field_distance(const ff_field *field, ff_vec2 p)
{
    double a = (p.a - field->corner.a) / field->cell, b = (p.b - field->corner.b) / field->cell;
    int i = (int)floor(a), k = (int)floor(b);
    if (!inside(field, i, k) || !inside(field, i + 1, k + 1)) return -1.0;
    /* From the nearest of the cells around that one can be in: at least what is left after the way there. */
    double best = INFINITY;
    for (int di = 0; di < 2; ++di)
        for (int dk = 0; dk < 2; ++dk) {
            double distance = (double)field->distance[(uint32_t)(i + di) * field->side + (uint32_t)(k + dk)];
            double away = field->cell * ff_length2(ff_v2(a - i - di, b - k - dk));
            best = ff_min(best, distance + away);
        }
    return best < INFINITY ? ff_max(best - 0.5 * field->cell, 0.0) : -1.0;
}

uint32_t ff_field_path(const ff_field *field, ff_vec2 p, ff_vec2 *out, uint32_t most)
{
    int i = (int)floor((p.a - field->corner.a) / field->cell + 0.5),
        k = (int)floor((p.b - field->corner.b) / field->cell + 0.5);
    uint32_t count = 0;
    float here = INFINITY;
    if (inside(field, i, k)) here = field->distance[(uint32_t)i * field->side + (uint32_t)k];
    while (count < most && here > 0.0f) {
        int best = -1;
        for (int m = 0; m < MOVES; ++m) {
            int a = i + moves[m][0], b = k + moves[m][1];
            if (!inside(field, a, b)) continue;
            float there = field->distance[(uint32_t)a * field->side + (uint32_t)b];
            if (there < here) {
                here = there;
                best = m;
            }
        }
        if (best < 0) break;
        i += moves[best][0];
        k += moves[best][1];
        out[count++] = ff_add2(field->corner, ff_v2(i * field->cell, k * field->cell));
    }
    return count;
}
