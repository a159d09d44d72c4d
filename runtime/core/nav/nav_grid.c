#include "runtime/core/nav/nav_grid.h"

#include "runtime/core/nav/nav_time.h"

#define CELL 2.5   /* m: a query touches 5 rows of 5 cells */
#define SPAN 2     /* cells on each side that FF_NEIGHBOUR_REACH can reach */
#define SIDE_MIN 8 /* must exceed 2 * SPAN + 1, or a query would see a cell twice */

static uint32_t grid_side(uint32_t capacity)
{
    uint32_t side = SIDE_MIN;
    while ((uint64_t)side * side < capacity && side < 4096)
        side *= 2;
    return side;
}

size_t ff_grid_bytes(uint32_t capacity)
{
    size_t cells = (size_t)grid_side(capacity) * grid_side(capacity);
    return capacity * (sizeof(ff_seen) + sizeof(uint32_t)) + (cells + 1) * sizeof(uint32_t) + 3 * 64;
}

bool ff_grid_init(ff_grid *grid, uint32_t capacity, ff_arena *arena)
{
    size_t cells = (size_t)grid_side(capacity) * grid_side(capacity);
    *grid = (ff_grid){.side = grid_side(capacity), .capacity = capacity};
    grid->seen = ff_arena_push(arena, capacity, sizeof *grid->seen, 64);
    grid->start = ff_arena_push(arena, cells + 1, sizeof *grid->start, 64);
    grid->cell = ff_arena_push(arena, capacity, sizeof *grid->cell, 64);
    return grid->seen && grid->start && grid->cell;
}

/* Cell number along one axis, before it is wrapped. Positions beyond 2e9 m share the last cell. */
static int64_t cell_of(double x)
{
    return (int64_t)floor(ff_clamp(x / CELL, -1e9, 1e9));
}

static uint32_t wrapped(const ff_grid *grid, int64_t cell)
{
    return (uint32_t)(uint64_t)cell & (grid->side - 1);
}

void ff_grid_fill(ff_grid *grid, const ff_seen *unsorted, uint32_t count)
{
    size_t cells = (size_t)grid->side * grid->side;
    uint32_t *start = grid->start;
    grid->count = count;
    for (size_t i = 0; i <= cells; ++i)
        start[i] = 0;
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t row = wrapped(grid, cell_of(unsorted[i].position.b));
        grid->cell[i] = row * grid->side + wrapped(grid, cell_of(unsorted[i].position.a));
        ++start[grid->cell[i] + 1];
    }
    for (size_t i = 1; i <= cells; ++i)
        start[i] += start[i - 1];
    /* Filling moves start[c] to the end of cell c, which is the start of c + 1: shift back afterwards. */
    for (uint32_t i = 0; i < count; ++i)
        grid->seen[start[grid->cell[i]]++] = unsorted[i];
    for (size_t i = cells; i > 0; --i)
        start[i] = start[i - 1];
    start[0] = 0;
}

uint32_t ff_grid_runs(const ff_grid *grid, ff_vec2 p, double reach, ff_run runs[FF_GRID_RUNS_MAX])
{
    uint32_t count = 0;
    int64_t span = reach <= CELL ? 1 : SPAN;
    int64_t column = cell_of(p.a), row = cell_of(p.b);
    uint32_t left = wrapped(grid, column - span), right = wrapped(grid, column + span);
    for (int64_t r = row - span; r <= row + span; ++r) {
        const uint32_t *start = grid->start + (size_t)wrapped(grid, r) * grid->side;
        if (left <= right) {
            runs[count++] = (ff_run){start[left], start[right + 1]};
        } else {
            runs[count++] = (ff_run){start[0], start[right + 1]};
            runs[count++] = (ff_run){start[left], start[grid->side]};
        }
    }
    return count;
}

/* Whether p presses more than q. */
static bool more_pressing(const ff_grid *grid, const ff_neighbour *p, const ff_neighbour *q)
{
    if (p->time != q->time) return p->time < q->time;
    if (p->distance != q->distance) return p->distance < q->distance;
    return grid->seen[p->index].slot < grid->seen[q->index].slot;
}

static uint32_t insert(const ff_grid *grid, ff_neighbour *list, uint32_t count, ff_neighbour one)
{
    if (count == FF_NEIGHBOURS_MAX) {
        if (!more_pressing(grid, &one, &list[count - 1])) return count;
        --count;
    }
    uint32_t at = count;
    for (; at > 0 && more_pressing(grid, &one, &list[at - 1]); --at)
        list[at] = list[at - 1];
    list[at] = one;
    return count + 1;
}

/* Those of seen[first, end) within reach of p: at most FILTER, without a branch that a processor would guess wrong half of
 * the time. */
#define FILTER 32
static uint32_t within_reach(const ff_grid *grid, ff_vec2 p, uint32_t first, uint32_t end, uint32_t *out)
{
    uint32_t count = 0;
    for (uint32_t i = first; i < end; ++i) {
        ff_vec2 x = ff_sub2(p, grid->seen[i].position);
        out[count] = i;
        count += ff_dot2(x, x) <= FF_NEIGHBOUR_REACH * FF_NEIGHBOUR_REACH;
    }
    return count;
}

static uint32_t consider(const ff_grid *grid, uint32_t self, uint32_t i, double padding, ff_neighbour *list,
                         uint32_t count)
{
    const ff_seen *me = &grid->seen[self], *other = &grid->seen[i];
    ff_vec2 x = ff_sub2(me->position, other->position);
    double reach = me->radius + other->radius + 2.0 * padding;
    double time = ff_time_to_disc(x, ff_sub2(me->velocity, other->velocity), reach);
    return insert(grid, list, count, (ff_neighbour){time, ff_dot2(x, x), i});
}

uint32_t ff_grid_neighbours(const ff_grid *grid, uint32_t self, double padding,
                            ff_neighbour out[FF_NEIGHBOURS_MAX])
{
    ff_vec2 here = grid->seen[self].position;
    ff_run runs[FF_GRID_RUNS_MAX];
    uint32_t run_count = ff_grid_runs(grid, here, FF_NEIGHBOUR_REACH, runs), count = 0, near[FILTER];
    for (uint32_t r = 0; r < run_count; ++r) {
        for (uint32_t i = runs[r].first; i < runs[r].end; i += FILTER) {
            uint32_t end = runs[r].end - i < FILTER ? runs[r].end : i + FILTER;
            uint32_t near_count = within_reach(grid, here, i, end, near);
            for (uint32_t k = 0; k < near_count; ++k)
                if (near[k] != self) count = consider(grid, self, near[k], padding, out, count);
        }
    }
    return count;
}
