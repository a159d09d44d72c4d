/* Cheapest ways in empty space to a stand, for the actions that planners take by default.
 *
 * Where a goal lies, seen by who has just ended an action, is all that matters; so Dijkstra's algorithm runs backwards over
 * (action that has ended, place of the goal): from goals that are reached to those that one more step before leads to. Places
 * that fall into a cell count as one; each keeps the exact place that it was reached with. Then the tables of actions that
 * lead to much the same are merged, so that a table is never more than any of its actions needs.
 */
#include "preprocess/actions/reach.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/maths.h"
#include "runtime/core/plan/plan_set.h"

#include <stdlib.h>
#include <string.h>

enum {
    CELLS = 97,
    PLANE = CELLS * CELLS,
    BUCKETS = 1400,
    MIDDLE = FF_REACH_CELLS / 2,
    EDGE = (CELLS - FF_REACH_CELLS) / 2
};
enum { TABLE = FF_REACH_CELLS * FF_REACH_CELLS, FILL_ROUNDS = 12 };
static const float BUCKET = 0.05f;          /* J/kg; no step costs so little */
static const float COVER = FF_REACH_RADIUS; /* m: of the middles of cells that count as reached */
static const float NEVER = 1e6f;

/* ------------------------------------------------------------------------------------------------------- steps */

/* From the end of an action to the end of one that follows it, in the frame of the root at first. */
typedef struct edge {
    uint32_t before, after; /* actions, of those chosen */
    float move[2], cosine, sine;
    float cost;
} edge;

static edge edge_of(const ff_pack_action *action, const ff_pack_action *next, float joint)
{
    ff_vec2 axis = ff_fwd2((double)action->theta), anchor = ff_v2(0.0, 0.0);
    if (next->support == action->swing) anchor = ff_v2((double)action->land[0], (double)action->land[1]);
    ff_vec2 from = ff_v2((double)action->root_end[0], (double)action->root_end[1]);
    ff_vec2 move = ff_add2(ff_to_frame2(axis, ff_sub2(anchor, from)),
                           ff_v2((double)next->root_end[0], (double)next->root_end[1]));
    ff_vec2 turned = ff_fwd2((double)next->theta);
    return (edge){.move = {(float)move.a, (float)move.b},
                  .cosine = (float)turned.a,
                  .sine = (float)turned.b,
                  .cost = ff_action_cost(next, 1.0f) + joint};
}

static int by_after(const void *x, const void *y)
{
    const edge *p = x, *q = y;
    if (p->after != q->after) return p->after < q->after ? -1 : 1;
    return (p->before > q->before) - (p->before < q->before);
}

/* All steps between chosen actions, by where they lead; first[a] is the first that leads to a. place: of each action of
 * the pack among those chosen, or UINT32_MAX. */
static bool find_edges(const ff_pack *pack, const uint32_t *place, uint32_t count, ff_array *edges,
                       uint32_t *first)
{
    for (uint32_t i = 0; i < pack->action_count; ++i) {
        const ff_pack_action *a = &pack->actions[i];
        for (uint32_t k = 0; place[i] != UINT32_MAX && k < a->successor_count; ++k) {
            const ff_pack_successor *s = &pack->successors[a->first_successor + k];
            const ff_pack_action *next = &pack->actions[s->action];
            if (place[s->action] == UINT32_MAX || ff_action_is_platform(next) || next->mode == FF_MODE_IDLE)
                continue;
            edge *e = ff_array_grow(edges, 1, sizeof *e);
            if (!e) return false;
            *e = edge_of(a, next, s->cost);
            e->before = place[i];
            e->after = place[s->action];
        }
    }
    if (edges->count > 1) qsort(edges->data, edges->count, sizeof(edge), by_after);
    const edge *e = edges->data;
    for (uint32_t a = 0, i = 0; a <= count; ++a) {
        while (i < edges->count && e[i].after < a)
            ++i;
        first[a] = i;
    }
    return true;
}

/* ---------------------------------------------------------------------------------------------------- Dijkstra */

/* A cell of an action in a bucket; it may be in others too, the first counts. */
typedef struct waiting {
    uint32_t cell;
    int32_t next;
} waiting;

typedef struct ways {
    uint32_t count; /* actions */
    const edge *edges;
    const uint32_t *first;
    bool *stands;     /* of each action: ends in standing */
    float *least;     /* [count][PLANE] J/kg */
    float (*goal)[2]; /* m: where exactly it lies */
    uint8_t *done;
    ff_array waiting;
    int32_t bucket[BUCKETS];
} ways;

/* The cell of an action that sees the goal at (f, l); -1 outside. */
static int64_t cell_of(uint32_t action, float f, float l)
{
    int i = (int)(f * (1.0f / FF_REACH_CELL) + (float)(CELLS / 2) + 0.5f);
    int k = (int)(l * (1.0f / FF_REACH_CELL) + (float)(CELLS / 2) + 0.5f);
    if ((unsigned)i >= CELLS || (unsigned)k >= CELLS) return -1;
    return ((int64_t)action * CELLS + i) * CELLS + k;
}

static bool offer(ways *w, uint32_t action, float f, float l, float cost)
{
    int64_t cell = cell_of(action, f, l);
    int bucket = (int)(cost / BUCKET);
    if (cell < 0 || w->least[cell] <= cost || bucket >= BUCKETS) return true;
    waiting *entry = ff_array_grow(&w->waiting, 1, sizeof *entry);
    if (!entry) return false;
    *entry = (waiting){(uint32_t)cell, w->bucket[bucket]};
    w->bucket[bucket] = (int32_t)(w->waiting.count - 1);
    w->least[cell] = cost;
    w->goal[cell][0] = f;
    w->goal[cell][1] = l;
    return true;
}

/* Goals that are reached already, by standing there. */
static bool offer_goals(ways *w)
{
    bool good = true;
    for (uint32_t a = 0; a < w->count; ++a) {
        if (!w->stands[a]) continue;
        for (int i = -4; i <= 4; ++i)
            for (int k = -4; k <= 4; ++k) {
                float f = FF_REACH_CELL * (float)i, l = FF_REACH_CELL * (float)k;
                if (f * f + l * l <= COVER * COVER) good = good && offer(w, a, f, l, 0.0f);
            }
    }
    return good;
}

static bool find_ways(ways *w)
{
    size_t cells = (size_t)w->count * PLANE;
    for (size_t i = 0; i < cells; ++i)
        w->least[i] = NEVER;
    for (int i = 0; i < BUCKETS; ++i)
        w->bucket[i] = -1;
    bool good = offer_goals(w);
    for (int i = 0; i < BUCKETS && good; ++i)
        for (int32_t at = w->bucket[i]; at >= 0 && good;) {
            const waiting entry = ((const waiting *)w->waiting.data)[at];
            uint32_t cell = entry.cell, action = cell / PLANE;
            at = entry.next;
            if (w->done[cell]) continue;
            w->done[cell] = 1;
            float f = w->goal[cell][0], l = w->goal[cell][1], cost = w->least[cell];
            for (uint32_t k = w->first[action]; k < w->first[action + 1] && good; ++k) {
                const edge *e = &w->edges[k];
                good = offer(w, e->before, e->move[0] + e->cosine * f - e->sine * l,
                             e->move[1] + e->sine * f + e->cosine * l, cost + e->cost);
            }
        }
    return good;
}

/* What a cell that no goal came to costs by the way of its steps, each to the cell that the middle of this one comes to: turned
 * lattices do not cover each other. Returns whether any cell got a price. */
static bool fill_holes(ways *w)
{
    bool any = false;
    for (uint32_t a = 0; a < w->count; ++a)
        for (uint32_t k = w->first[a]; k < w->first[a + 1]; ++k) {
            const edge *e = &w->edges[k];
            float *least = w->least + (size_t)e->before * PLANE;
            for (int cell = 0; cell < PLANE; ++cell) {
                if (w->done[(size_t)e->before * PLANE + (size_t)cell]) continue;
                float f = FF_REACH_CELL * (float)(cell / CELLS - CELLS / 2) - e->move[0];
                float l = FF_REACH_CELL * (float)(cell % CELLS - CELLS / 2) - e->move[1];
                int64_t to = cell_of(a, e->cosine * f + e->sine * l, e->cosine * l - e->sine * f);
                if (to < 0 || w->least[to] + e->cost >= least[cell]) continue;
                least[cell] = w->least[to] + e->cost;
                any = true;
            }
        }
    return any;
}

/* ------------------------------------------------------------------------------------------------------ tables */

/* The part that is kept, as the left foot sees it. A place counts with the cheapest of its own cell and the four beside it: what
 * comes round a corner of turned lattices may miss a cell at its edge. */
static void crop(const float *plane, bool mirrored, float *table)
{
    for (int i = 0; i < FF_REACH_CELLS; ++i)
        for (int k = 0; k < FF_REACH_CELLS; ++k) {
            int column = (mirrored ? FF_REACH_CELLS - 1 - k : k) + EDGE;
            const float *at = plane + (i + EDGE) * CELLS + column;
            float least = at[0];
            for (int side = 0; side < 4; ++side) {
                float beside = at[(int[]){1, -1, CELLS, -CELLS}[side]] + 0.3f;
                least = beside < least ? beside : least;
            }
            table[i * FF_REACH_CELLS + k] = least;
        }
}

/* What merging two tables gives away, J/kg in the mean over the cells. */
static float apart(const float *x, const float *y)
{
    float sum = 0.0f;
    for (int i = 0; i < TABLE; ++i) {
        float d = x[i] - y[i];
        d = d < 0.0f ? -d : d;
        sum += d < 5.0f ? d : 5.0f;
    }
    return sum / TABLE;
}

/* Merges the nearest two until so many are left; kind[]: of each action. Returns how many. */
static uint32_t merge(float *tables, uint32_t count, uint32_t wanted, uint32_t *kind, float *gap)
{
    for (uint32_t a = 0; a < count; ++a) {
        kind[a] = a;
        for (uint32_t b = 0; b < a; ++b)
            gap[a * count + b] = apart(tables + (size_t)a * TABLE, tables + (size_t)b * TABLE);
    }
    uint32_t left = count;
    while (left > 1) {
        uint32_t x = 0, y = 0;
        float least = INFINITY;
        for (uint32_t a = 0; a < count; ++a)
            for (uint32_t b = 0; b < a; ++b)
                if (kind[a] == a && kind[b] == b && gap[a * count + b] < least) {
                    least = gap[a * count + b];
                    x = b;
                    y = a;
                }
        if (left <= wanted && least > 1e-3f) break;
        float *to = tables + (size_t)x * TABLE, *from = tables + (size_t)y * TABLE;
        for (int i = 0; i < TABLE; ++i)
            to[i] = from[i] < to[i] ? from[i] : to[i];
        for (uint32_t a = 0; a < count; ++a)
            if (kind[a] == y) kind[a] = x;
        --left;
        for (uint32_t a = 0; a < count; ++a)
            if (kind[a] == a && a != x)
                gap[a > x ? a * count + x : x * count + a] = apart(tables + (size_t)a * TABLE, to);
    }
    return left;
}

static void write_table(const float *table, ff_pack_reach *out)
{
    memset(out, 0, sizeof *out);
    for (int i = 0; i < FF_REACH_CELLS; ++i)
        for (int k = 0; k < FF_REACH_CELLS; ++k) {
            float units = table[i * FF_REACH_CELLS + k] / FF_REACH_UNIT;
            out->cost[i][k] = units < (float)FF_REACH_NEVER ? (uint16_t)units : FF_REACH_NEVER;
        }
}

/* ------------------------------------------------------------------------------------------------------- whole */

typedef struct work {
    bool *usable, *chosen;
    uint32_t *place, *first, *kind, *index;
    float *tables, *gap;
    ff_array edges;
    ways ways;
} work;

static bool begin(work *w, const ff_pack *pack)
{
    uint32_t total = pack->action_count, stand;
    w->usable = ff_calloc(total, sizeof *w->usable);
    w->chosen = ff_calloc(total, sizeof *w->chosen);
    w->place = ff_calloc(total, sizeof *w->place);
    if (!w->usable || !w->chosen || !w->place) return false;
    for (uint32_t i = 0; i < total; ++i)
        w->usable[i] = ff_action_is_usable(&pack->actions[i]);
    ff_set_select(pack, FF_ACTIONS_DEFAULT, w->usable, w->chosen, &stand);
    for (uint32_t i = 0; i < total; ++i) /* what is made up for danger leads to nothing that steps do not */
        w->chosen[i] = w->chosen[i] && !ff_action_is_made_up(&pack->actions[i]);
    for (uint32_t i = 0; i < total; ++i)
        w->place[i] = w->chosen[i] ? w->ways.count++ : UINT32_MAX;
    size_t count = w->ways.count;
    w->first = ff_calloc(count + 2, sizeof *w->first);
    w->kind = ff_calloc(count, sizeof *w->kind);
    w->index = ff_calloc(count, sizeof *w->index);
    w->tables = ff_calloc(count * TABLE, sizeof *w->tables);
    w->gap = ff_calloc(count * count, sizeof *w->gap);
    w->ways.stands = ff_calloc(count, sizeof *w->ways.stands);
    w->ways.least = ff_calloc(count * PLANE, sizeof *w->ways.least);
    w->ways.goal = ff_calloc(count * PLANE, sizeof *w->ways.goal);
    w->ways.done = ff_calloc(count * PLANE, sizeof *w->ways.done);
    if (!w->ways.stands) return false;
    for (uint32_t i = 0; i < total; ++i)
        if (w->chosen[i]) w->ways.stands[w->place[i]] = (pack->actions[i].flags & FF_ACTION_TO_STANDING) != 0;
    return w->first && w->kind && w->index && w->tables && w->gap && w->ways.stands && w->ways.least &&
           w->ways.goal && w->ways.done && find_edges(pack, w->place, w->ways.count, &w->edges, w->first);
}

static void end(work *w)
{
    free(w->usable);
    free(w->chosen);
    free(w->place);
    free(w->first);
    free(w->kind);
    free(w->index);
    free(w->tables);
    free(w->gap);
    free(w->ways.stands);
    free(w->ways.least);
    free(w->ways.goal);
    free(w->ways.done);
    ff_array_free(&w->ways.waiting);
    ff_array_free(&w->edges);
}

/* Tables of all chosen actions, merged, into the content. */
static bool add_tables(work *w, ff_pack_content *content)
{
    ff_pack_action *actions = content->actions.data;
    uint32_t count = w->ways.count;
    for (size_t i = 0; i < content->actions.count; ++i)
        if (w->place[i] != UINT32_MAX)
            crop(w->ways.least + (size_t)w->place[i] * PLANE, actions[i].swing == 1,
                 w->tables + (size_t)w->place[i] * TABLE);
    uint32_t left = merge(w->tables, count, FF_REACH_KINDS_MAX, w->kind, w->gap), n = 0;
    ff_pack_reach *out = ff_array_grow(&content->reach, left, sizeof *out);
    if (!out) return false;
    for (uint32_t a = 0; a < count; ++a)
        if (w->kind[a] == a) {
            write_table(w->tables + (size_t)a * TABLE, &out[n]);
            w->index[a] = n++;
        }
    for (size_t i = 0; i < content->actions.count; ++i)
        if (w->place[i] != UINT32_MAX) actions[i].reach = w->index[w->kind[w->place[i]]];
    return true;
}

ff_status ff_pack_add_reach(ff_pack_content *content, ff_error *error)
{
    ff_pack_action *actions = content->actions.data;
    for (size_t i = 0; i < content->actions.count; ++i)
        actions[i].reach = FF_REACH_NONE;
    const ff_pack pack = {.actions = actions,
                          .action_count = (uint32_t)content->actions.count,
                          .successors = content->successors.data,
                          .successor_count = (uint32_t)content->successors.count};
    work w = {0};
    bool good = begin(&w, &pack);
    if (good && w.ways.count > 0) {
        w.ways.edges = w.edges.data;
        w.ways.first = w.first;
        good = find_ways(&w.ways);
        for (int i = 0; good && i < FILL_ROUNDS && fill_holes(&w.ways); ++i)
            continue;
        good = good && add_tables(&w, content);
    }
    end(&w);
    return good ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for reach tables");
}
