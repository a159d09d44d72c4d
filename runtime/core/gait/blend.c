#include "runtime/core/gait/blend.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define CELLS (FF_BLEND_GRID * FF_BLEND_GRID * FF_BLEND_GRID)
#define INSIDE_TOLERANCE 1e-9 /* algorithms D.2 */
#define CORNERS 4             /* of a simplex at most */

static int compare_faces(const void *left, const void *right)
{
    const ff_blend_face *p = left, *q = right;
    for (int i = 0; i < 3; ++i)
        if (p->vertex[i] != q->vertex[i]) return p->vertex[i] < q->vertex[i] ? -1 : 1;
    return 0;
}

static ff_blend_face face_of(int32_t a, int32_t b, int32_t c)
{
    ff_blend_face face = {{a, b, c}, (a >= 0) + (b >= 0) + (c >= 0)};
    for (int i = 1; i < face.count; ++i)
        for (int j = i; j > 0 && face.vertex[j] < face.vertex[j - 1]; --j) {
            int32_t swap = face.vertex[j];
            face.vertex[j] = face.vertex[j - 1];
            face.vertex[j - 1] = swap;
        }
    return face;
}

/* Index of each example among the vertices, or -1. */
static int32_t vertex_of(const ff_blend_space *space, int32_t example)
{
    if (example < 0) return -1;
    uint32_t frame = space->pack->streams[space->pack->examples[example].stream].first_frame;
    for (uint32_t v = 0; v < space->vertex_count; ++v)
        if (space->vertices[v].first_frame == frame) return (int32_t)v;
    return -1;
}

static void add_simplex(const ff_blend_space *space, const ff_pack_simplex *simplex, ff_blend_region *region)
{
    int32_t v[4];
    ff_vec3 corner[4];
    for (int i = 0; i < 4; ++i) {
        v[i] = vertex_of(space, simplex->vertex[i]);
        if (simplex->vertex[i] >= 0 && v[i] < 0) return; /* an example that cannot be used */
        if (v[i] >= 0) corner[i] = space->points[v[i]];
    }
    if (v[3] < 0) {
        region->faces[region->face_count++] = face_of(v[0], v[1], v[2]);
        return;
    }
    if (!ff_blend_solid_make(corner, v, &region->solids[region->solid_count])) return;
    ++region->solid_count;
    for (int without = 0; without < 4; ++without)
        region->faces[region->face_count++] =
            face_of(v[without == 0 ? 1 : 0], v[without <= 1 ? 2 : 1], v[without <= 2 ? 3 : 2]);
}

/* Faces between two solids are inside: drop every face that appears twice. */
static void keep_outer_faces(ff_blend_region *region)
{
    if (region->face_count == 0) return;
    qsort(region->faces, region->face_count, sizeof *region->faces, compare_faces);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < region->face_count;) {
        uint32_t same = i + 1;
        while (same < region->face_count && compare_faces(&region->faces[i], &region->faces[same]) == 0)
            ++same;
        if (same == i + 1 || region->solid_count == 0) region->faces[kept++] = region->faces[i];
        i = same;
    }
    region->face_count = kept;
}

static uint32_t axis_cell(double value, double low, double scale)
{
    return (uint32_t)ff_clamp((value - low) * scale, 0.0, FF_BLEND_GRID - 1.0);
}

typedef struct cell_box {
    uint32_t low[3], high[3];
} cell_box;

static cell_box cells_of(const ff_blend_region *region, ff_vec3 low, ff_vec3 high)
{
    ff_vec3 origin = region->grid_low, scale = region->grid_scale;
    return (cell_box){{axis_cell(low.x, origin.x, scale.x), axis_cell(low.y, origin.y, scale.y),
                       axis_cell(low.z, origin.z, scale.z)},
                      {axis_cell(high.x, origin.x, scale.x), axis_cell(high.y, origin.y, scale.y),
                       axis_cell(high.z, origin.z, scale.z)}};
}

static void measure_grid(const ff_blend_space *space, ff_blend_region *region)
{
    ff_vec3 low = ff_v3(0.0, 0.0, 0.0), high = low;
    for (uint32_t v = 0; v < space->vertex_count; ++v) {
        ff_vec3 p = space->points[v];
        low = ff_v3(ff_min(low.x, p.x), ff_min(low.y, p.y), ff_min(low.z, p.z));
        high = ff_v3(ff_max(high.x, p.x), ff_max(high.y, p.y), ff_max(high.z, p.z));
    }
    region->grid_low = low;
    region->grid_scale =
        ff_v3(FF_BLEND_GRID / ff_max(high.x - low.x, 1e-3), FF_BLEND_GRID / ff_max(high.y - low.y, 1e-3),
              FF_BLEND_GRID / ff_max(high.z - low.z, 1e-3));
}

static uint32_t cell_index(uint32_t x, uint32_t y, uint32_t z)
{
    return (z * FF_BLEND_GRID + y) * FF_BLEND_GRID + x;
}

/* Count (solids NULL) or list the solids whose bounds touch each cell. */
static void visit_cells(const ff_blend_region *region, uint32_t *next, uint32_t *solids)
{
    for (uint32_t s = 0; s < region->solid_count; ++s) {
        cell_box box = cells_of(region, region->solids[s].low, region->solids[s].high);
        for (uint32_t z = box.low[2]; z <= box.high[2]; ++z)
            for (uint32_t y = box.low[1]; y <= box.high[1]; ++y)
                for (uint32_t x = box.low[0]; x <= box.high[0]; ++x) {
                    uint32_t *at = &next[cell_index(x, y, z)];
                    if (solids) solids[*at] = s;
                    ++*at;
                }
    }
}

static ff_status build_grid(const ff_blend_space *space, ff_blend_region *region, ff_error *error)
{
    measure_grid(space, region);
    region->cell_first = ff_calloc(CELLS + 1, sizeof *region->cell_first);
    uint32_t *next = ff_calloc(CELLS, sizeof *next);
    if (!region->cell_first || !next) {
        free(next);
        return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory preparing the blend space");
    }
    visit_cells(region, next, NULL);
    for (uint32_t c = 0; c < CELLS; ++c) {
        region->cell_first[c + 1] = region->cell_first[c] + next[c];
        next[c] = region->cell_first[c];
    }
    region->cell_solids = ff_calloc(region->cell_first[CELLS], sizeof *region->cell_solids);
    if (region->cell_solids) visit_cells(region, next, region->cell_solids);
    free(next);
    return region->cell_solids ? FF_OK
                               : ff_fail(error, FF_ERR_NO_MEMORY, "out of memory preparing the blend space");
}

#define MAX_SIMPLICES 4096u /* some 30 examples make about 100 */

static ff_status read_region(const ff_blend_space *space, uint32_t gait, ff_blend_region *region,
                             ff_error *error)
{
    const ff_pack *pack = space->pack;
    uint32_t first = gait == FF_GAIT_WALK ? 0 : space->walk_count,
             end = gait == FF_GAIT_WALK ? space->walk_count : space->vertex_count;
    region->solids = ff_calloc(pack->simplex_count, sizeof *region->solids);
    region->faces = ff_calloc(4 * (size_t)pack->simplex_count + space->vertex_count, sizeof *region->faces);
    if (!region->solids || !region->faces)
        return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory preparing the blend space");
    for (uint32_t i = 0; i < pack->simplex_count; ++i)
        if (pack->simplices[i].gait == gait) add_simplex(space, &pack->simplices[i], region);
    keep_outer_faces(region);
    /* There is always something to go to: with no simplices, or only doubled ones, the examples by themselves. */
    bool bare = region->solid_count == 0 || region->face_count == 0;
    for (uint32_t v = first; v < end && bare; ++v)
        region->faces[region->face_count++] = face_of((int32_t)v, -1, -1);
    return build_grid(space, region, error);
}

ff_status ff_blend_space_create(const ff_pack *pack, ff_blend_space **out, ff_error *error)
{
    *out = NULL;
    if (pack->simplex_count > MAX_SIMPLICES)
        return ff_fail(error, FF_ERR_RANGE, "the pack has %u simplices, at most %u can be blended",
                       pack->simplex_count, MAX_SIMPLICES);
    ff_blend_space *space = ff_calloc(1, sizeof *space);
    if (!space) return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory preparing the blend space");
    space->pack = pack;
    ff_status status = ff_blend_read_examples(space, error);
    for (uint32_t gait = 0; gait < FF_GAIT_COUNT && status == FF_OK; ++gait)
        status = read_region(space, gait, &space->region[gait], error);
    if (status != FF_OK) {
        ff_blend_space_destroy(space);
        return status;
    }
    ff_clip_model_make(space);
    *out = space;
    return FF_OK;
}

void ff_blend_space_destroy(ff_blend_space *space)
{
    if (!space) return;
    free(space->vertices);
    free(space->points);
    free(space->hips);
    free(space->poses.keys);
    for (int gait = 0; gait < FF_GAIT_COUNT; ++gait) {
        ff_blend_region *region = &space->region[gait];
        free(region->solids);
        free(region->faces);
        free(region->cell_first);
        free(region->cell_solids);
    }
    free(space);
}

void ff_blend_clear(ff_blend *out)
{
    *out = (ff_blend){.way = FF_BLENDING};
    for (int i = 0; i < FF_BLEND_MAX; ++i)
        out->vertex[i] = -1;
}

/* The nearest place on the outside of a region. */
static void project(const ff_blend_space *space, const ff_blend_region *region, ff_vec3 p, ff_blend *out)
{
    double best = -1.0;
    for (int i = 0; i < CORNERS; ++i) {
        out->vertex[i] = i == 0 ? 0 : -1;
        out->weight[i] = i == 0 ? 1.0 : 0.0;
    }
    for (uint32_t f = 0; f < region->face_count; ++f) {
        const ff_blend_face *face = &region->faces[f];
        ff_vec3 corner[3];
        double weight[3];
        for (int i = 0; i < face->count; ++i)
            corner[i] = space->points[face->vertex[i]];
        double distance = ff_blend_face_nearest(corner, face->count, p, weight);
        if (best >= 0.0 && distance >= best) continue;
        best = distance;
        for (int i = 0; i < CORNERS; ++i) {
            out->vertex[i] = i < face->count ? face->vertex[i] : -1;
            out->weight[i] = i < face->count ? weight[i] : 0.0;
        }
    }
}

/* Of the turn rate asked for: with less of it one would go on, but not where one wants to. */
#define LEAST_TURN 0.15
#define LEAST_ASIDE 0.75 /* of the side-stepping: or one would step aside for ever and not turn */

static bool locate(const ff_blend_region *region, ff_vec3 p, ff_blend *out)
{
    cell_box box = cells_of(region, p, p);
    uint32_t cell = cell_index(box.low[0], box.low[1], box.low[2]);
    for (uint32_t i = region->cell_first[cell]; i < region->cell_first[cell + 1]; ++i) {
        const ff_blend_solid *solid = &region->solids[region->cell_solids[i]];
        if (!ff_blend_solid_locate(solid, p, INSIDE_TOLERANCE, out->weight)) continue;
        for (int k = 0; k < CORNERS; ++k)
            out->vertex[k] = solid->vertex[k];
        return true;
    }
    return false;
}

/* From weights of rates to weights of poses: blended time is warped, so each example counts by its cadence and both
 * the speed and the turn come out exactly (synthesis study, section 6). */
static void weigh_by_period(const ff_blend_space *space, ff_blend *blend)
{
    ff_vec3 point = ff_v3(0.0, 0.0, 0.0);
    double cadence = 0.0, total = 0.0;
    for (int i = 0; i < CORNERS; ++i) {
        if (blend->vertex[i] < 0) continue;
        double weight = ff_max(blend->weight[i], 0.0);
        point = ff_madd3(point, space->points[blend->vertex[i]], weight);
        blend->weight[i] = weight / space->vertices[blend->vertex[i]].period;
        cadence += blend->weight[i];
        total += weight;
    }
    for (int i = 0; i < CORNERS; ++i)
        blend->weight[i] = blend->vertex[i] < 0 ? 0.0 : blend->weight[i] / cadence;
    blend->period = total / cadence;
    blend->rates = ff_blend_rates(ff_scale3(point, 1.0 / total));
}

void ff_blend_find_in(const ff_blend_space *space, int gait, ff_rates target, ff_blend *out)
{
    const ff_blend_region *region = &space->region[gait];
    ff_vec3 p = ff_blend_point(target);
    ff_blend_clear(out);
    if (!locate(region, p, out)) project(space, region, p, out);
    weigh_by_period(space, out);
    out->way = gait == FF_GAIT_RUN ? FF_RUNNING : FF_BLENDING;
}

void ff_blend_find(const ff_blend_space *space, ff_rates target, ff_blend *out)
{
    ff_blend_find_in(space, FF_GAIT_WALK, target, out);
}

ff_rates ff_blend_clamp(const ff_blend_space *space, ff_rates target)
{
    ff_blend blend;
    ff_vec3 p = ff_blend_point(target);
    const ff_blend_region *region = &space->region[FF_GAIT_WALK];
    if (locate(region, p, &blend)) return target;
    project(space, region, p, &blend);
    weigh_by_period(space, &blend);
    return blend.rates;
}

ff_rates ff_blend_clamp_turn(const ff_blend_space *space, ff_rates target)
{
    ff_blend blend;
    const ff_blend_region *region = &space->region[FF_GAIT_WALK];
    if (locate(region, ff_blend_point(target), &blend)) return target;
    ff_rates going = ff_blend_clamp(space, (ff_rates){target.forward, target.left, 0.0});
    for (double aside = 1.0; aside > LEAST_ASIDE; aside *= 0.8) {
        for (double share = 1.0; share > LEAST_TURN; share *= 0.7) {
            ff_rates both = {going.forward, aside * going.left, share * target.turn};
            if (locate(region, ff_blend_point(both), &blend)) return both;
        }
    }
    return ff_blend_clamp(space, target);
}
