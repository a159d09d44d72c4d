#include "runtime/core/nav/nav_walls.h"

static uint32_t leaves_for(uint32_t capacity)
{
    uint32_t leaves = 1;
    while (leaves < capacity && leaves < 1u << 30)
        leaves *= 2;
    return leaves;
}

size_t ff_walls_bytes(uint32_t capacity)
{
    return capacity * sizeof(ff_wall) + 2 * (size_t)leaves_for(capacity) * sizeof(ff_box) + 2 * 64;
}

bool ff_walls_init(ff_walls *walls, uint32_t capacity, ff_arena *arena)
{
    *walls = (ff_walls){.capacity = capacity, .leaves = leaves_for(capacity)};
    walls->wall = ff_arena_push(arena, capacity, sizeof *walls->wall, 64);
    walls->box = ff_arena_push(arena, 2 * (size_t)walls->leaves, sizeof *walls->box, 64);
    if ((capacity > 0 && !walls->wall) || !walls->box) return false;
    for (size_t i = 0; i < 2 * (size_t)walls->leaves; ++i)
        walls->box[i] = (ff_box){ff_v2(INFINITY, INFINITY), ff_v2(-INFINITY, -INFINITY)};
    return true;
}

void ff_walls_add(ff_walls *walls, ff_vec2 from, ff_vec2 to)
{
    uint32_t index = walls->count++;
    walls->wall[index] = ff_wall_between(from, to);
    for (uint32_t node = walls->leaves + index; node > 0; node /= 2) {
        ff_box *box = &walls->box[node];
        box->low = ff_v2(ff_min(box->low.a, ff_min(from.a, to.a)), ff_min(box->low.b, ff_min(from.b, to.b)));
        box->high =
            ff_v2(ff_max(box->high.a, ff_max(from.a, to.a)), ff_max(box->high.b, ff_max(from.b, to.b)));
    }
}

/* Squared distance from p to the box; infinite for an empty one. */
static double distance_to_box(const ff_box *box, ff_vec2 p)
{
    double a = ff_max(ff_max(box->low.a - p.a, p.a - box->high.a), 0.0);
    double b = ff_max(ff_max(box->low.b - p.b, p.b - box->high.b), 0.0);
    return a * a + b * b;
}

typedef struct near_list {
    const ff_wall **wall;
    double distance[FF_NEAR_WALLS_MAX];
    uint32_t count;
} near_list;

/* Nearest first; an equal one stays behind those added before it, as leaves are visited in order. */
static void keep(near_list *list, const ff_wall *wall, double distance)
{
    if (list->count == FF_NEAR_WALLS_MAX) {
        if (distance >= list->distance[list->count - 1]) return;
        --list->count;
    }
    uint32_t at = list->count++;
    for (; at > 0 && distance < list->distance[at - 1]; --at) {
        list->wall[at] = list->wall[at - 1];
        list->distance[at] = list->distance[at - 1];
    }
    list->wall[at] = wall;
    list->distance[at] = distance;
}

uint32_t ff_walls_near(const ff_walls *walls, ff_vec2 p, double reach, const ff_wall *out[FF_NEAR_WALLS_MAX])
{
    near_list list = {.wall = out};
    if (walls->count == 0) return 0;
    uint32_t stack[64], depth = 0;
    stack[depth++] = 1;
    while (depth > 0) {
        uint32_t node = stack[--depth];
        if (!(distance_to_box(&walls->box[node], p) <= reach * reach)) continue;
        if (node < walls->leaves) {
            stack[depth++] = 2 * node + 1; /* the left child is taken first */
            stack[depth++] = 2 * node;
            continue;
        }
        const ff_wall *wall = &walls->wall[node - walls->leaves];
        ff_vec2 gap = ff_sub2(p, ff_wall_nearest(wall, p));
        double distance = ff_dot2(gap, gap);
        if (distance <= reach * reach) keep(&list, wall, distance);
    }
    return list.count;
}
