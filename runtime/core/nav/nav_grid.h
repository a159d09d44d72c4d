/* nav_grid.h - who is near whom: agents sorted by the cells of a uniform grid.
 *
 * The grid is a torus: cell coordinates are taken modulo its sides, so the plane has no edge and one far agent costs
 * nothing; cells that share a place only add candidates that the distance test drops. Agents are copied in cell
 * order, row by row, so that a query reads a few unbroken runs of memory.
 */
#ifndef FF_NAV_GRID_H
#define FF_NAV_GRID_H

#include "runtime/core/base/maths.h"
#include "runtime/core/base/memory.h"

#define FF_NEIGHBOUR_REACH 5.0 /* m */
#define FF_NEIGHBOURS_MAX 10

/* What an agent shows the others: a copy of the last step's state. */
typedef struct ff_seen {
    ff_vec2 position;  /* m */
    ff_vec2 velocity;  /* m/s, of the root */
    ff_vec2 reference; /* m/s, midpoint of its last command and its velocity: what ORCA takes it to do */
    ff_vec2 preferred; /* m/s, where it would like to go */
    ff_vec2 goal;      /* m */
    double radius;     /* m */
    uint32_t slot;
    uint32_t standing; /* 0: walks (nav.h) */
    uint32_t firm;     /* 1: moves by footsteps that are planned already, and gives no way */
    uint32_t unused;
} ff_seen;

/* Where one of them will be who moves by a plan: FF_PATH_STEP apart, from now on. */
#define FF_PATH_STEP 0.25 /* s */
enum { FF_PATH_POINTS = 11 };
typedef struct ff_path {
    ff_vec2 at[FF_PATH_POINTS]; /* m */
} ff_path;

typedef struct ff_grid {
    ff_seen *seen;   /* [count] in cell order, by slot within a cell */
    uint32_t *start; /* [cells + 1] */
    uint32_t *cell;  /* [capacity] scratch: cell of each unsorted agent */
    uint32_t side;   /* cells along each axis, a power of two */
    uint32_t count;
    uint32_t capacity;
} ff_grid;

size_t ff_grid_bytes(uint32_t capacity);
/* Take memory from the arena; false when it is short. */
bool ff_grid_init(ff_grid *grid, uint32_t capacity, ff_arena *arena);

/* Sort unsorted[count] into the grid (counting sort: stable, so the order depends on nothing else). */
void ff_grid_fill(ff_grid *grid, const ff_seen *unsorted, uint32_t count);

/* Runs [first, end) of grid->seen that together hold everybody within reach (m, at most FF_NEIGHBOUR_REACH) of p, each
 * once. */
#define FF_GRID_RUNS_MAX 10
typedef struct ff_run {
    uint32_t first, end;
} ff_run;
uint32_t ff_grid_runs(const ff_grid *grid, ff_vec2 p, double reach, ff_run runs[FF_GRID_RUNS_MAX]);

typedef struct ff_neighbour {
    double time;     /* s to collision at present velocities; INFINITY = none */
    double distance; /* m, squared */
    uint32_t index;  /* into grid->seen */
} ff_neighbour;

/* The at most FF_NEIGHBOURS_MAX most pressing of those within reach of grid->seen[self]: by time to collision (with
 * padding m added to each radius), then distance, then slot. Returns how many. */
uint32_t ff_grid_neighbours(const ff_grid *grid, uint32_t self, double padding,
                            ff_neighbour out[FF_NEIGHBOURS_MAX]);

#endif
