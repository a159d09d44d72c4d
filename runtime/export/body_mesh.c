/* body_mesh.c - the body's surface by naive surface nets (Gibson 1998): one vertex in every grid cell that the surface
 * passes through, moved onto the surface; one quad across every grid edge that it cuts. */
#include "runtime/export/body_mesh.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

typedef struct grid {
    ff_vec3 low;
    double cell;
    uint32_t size[3]; /* nodes */
    float *values;    /* signed distance at the nodes */
    uint32_t *vertex; /* vertex of the cell whose lowest node this is, or NO_VERTEX */
} grid;

#define NO_VERTEX UINT32_MAX
#define BLEND 0.020 /* m: over which neighbouring bones share the surface */

static size_t node(const grid *g, uint32_t x, uint32_t y, uint32_t z)
{
    return ((size_t)z * g->size[1] + y) * g->size[0] + x;
}

static ff_vec3 place(const grid *g, double x, double y, double z)
{
    return ff_madd3(g->low, ff_v3(x, y, z), g->cell);
}

static ff_status fill_grid(const ff_body_shape *shape, double cell, grid *g, ff_error *error)
{
    ff_vec3 low = ff_v3(1e9, 1e9, 1e9), high = ff_v3(-1e9, -1e9, -1e9);
    for (uint32_t i = 0; i < shape->count; ++i) {
        const ff_limb *limb = &shape->limbs[i];
        double r = ff_max(limb->radius_a, limb->radius_b) + 3.0 * cell;
        low = ff_v3(ff_min(low.x, ff_min(limb->a.x, limb->b.x) - r),
                    ff_min(low.y, ff_min(limb->a.y, limb->b.y) - r),
                    ff_min(low.z, ff_min(limb->a.z, limb->b.z) - r));
        high = ff_v3(ff_max(high.x, ff_max(limb->a.x, limb->b.x) + r),
                     ff_max(high.y, ff_max(limb->a.y, limb->b.y) + r),
                     ff_max(high.z, ff_max(limb->a.z, limb->b.z) + r));
    }
    low.x = floor(low.x / cell) *
            cell; /* nodes in the middle tell legs apart that are less than a cell from it */
    ff_vec3 extent = ff_scale3(ff_sub3(high, low), 1.0 / cell);
    if (!(extent.x < 1000.0 && extent.y < 1000.0 && extent.z < 1000.0))
        return ff_fail(error, FF_ERR_UNSUPPORTED, "the pack's skeleton is too large to draw (%.1f m tall)",
                       high.y - low.y);
    *g = (grid){.low = low,
                .cell = cell,
                .size = {(uint32_t)extent.x + 2, (uint32_t)extent.y + 2, (uint32_t)extent.z + 2}};
    size_t nodes = (size_t)g->size[0] * g->size[1] * g->size[2];
    g->values = ff_calloc(nodes, sizeof *g->values);
    g->vertex = ff_calloc(nodes, sizeof *g->vertex);
    if (!g->values || !g->vertex) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the body's grid");
    for (uint32_t z = 0; z < g->size[2]; ++z)
        for (uint32_t y = 0; y < g->size[1]; ++y)
            for (uint32_t x = 0; x < g->size[0]; ++x)
                g->values[node(g, x, y, z)] = (float)ff_body_distance(shape, place(g, x, y, z));
    return FF_OK;
}

static ff_vec3 gradient(const ff_body_shape *shape, ff_vec3 p)
{
    const double e = 0.002;
    return ff_unit3(ff_v3(
        ff_body_distance(shape, ff_v3(p.x + e, p.y, p.z)) - ff_body_distance(shape, ff_v3(p.x - e, p.y, p.z)),
        ff_body_distance(shape, ff_v3(p.x, p.y + e, p.z)) - ff_body_distance(shape, ff_v3(p.x, p.y - e, p.z)),
        ff_body_distance(shape, ff_v3(p.x, p.y, p.z + e)) -
            ff_body_distance(shape, ff_v3(p.x, p.y, p.z - e))));
}

/* ------------------------------------------------------------------------------------------------ skinning */

int ff_joint_side(uint32_t joint)
{
    if ((joint >= FF_JOINT_CLAVICLE_L && joint <= FF_JOINT_WRIST_L) ||
        (joint >= FF_JOINT_HIP_L && joint <= FF_JOINT_BALL_L))
        return 1;
    return joint >= FF_JOINT_CLAVICLE_R && joint < FF_JOINT_COUNT ? -1 : 0;
}

static bool is_parent(const ff_figure *figure, uint32_t parent, uint32_t joint)
{
    return figure->parent[joint] == (int32_t)parent;
}

/* At most two bones apart, and not the other leg: they may move one piece of skin together. */
static bool are_near(const ff_figure *figure, uint32_t i, uint32_t j)
{
    if (ff_joint_side(i) * ff_joint_side(j) < 0) return false;
    if (i == j || is_parent(figure, i, j) || is_parent(figure, j, i)) return true;
    int32_t pi = figure->parent[i], pj = figure->parent[j];
    return pi == pj || (pi >= 0 && is_parent(figure, j, (uint32_t)pi)) ||
           (pj >= 0 && is_parent(figure, i, (uint32_t)pj));
}

static uint32_t nearest_limb(const ff_body_shape *shape, ff_vec3 p, double *joint_distance)
{
    uint32_t best = 0;
    double least = 1e9;
    for (uint32_t j = 0; j < FF_JOINT_COUNT; ++j)
        joint_distance[j] = 1e9;
    for (uint32_t i = 0; i < shape->count; ++i) {
        const ff_limb *limb = &shape->limbs[i];
        double d = ff_limb_distance(shape, limb, p);
        joint_distance[limb->joint] = ff_min(joint_distance[limb->joint], d);
        if (d < least) {
            least = d;
            best = i;
        }
    }
    return best;
}

/* Weights fall with the distance of a bone's limbs; limbs of the other side pull only close to the middle. */
static void set_weights(const ff_figure *figure, double scale, uint32_t owner, const double *distance,
                        ff_body_vertex *vertex)
{
    double weight[4] = {0};
    uint32_t joint[4] = {0};
    for (uint32_t j = 0; j < FF_JOINT_COUNT; ++j) {
        if (distance[j] > 1e8 || !are_near(figure, owner, j)) continue;
        if (ff_joint_side(j) * (double)vertex->position[0] < -BLEND * scale) continue;
        double w = exp(-(distance[j] - distance[owner]) / (BLEND * scale));
        for (int k = 0; k < 4; ++k) { /* keep the four largest, in order */
            if (w <= weight[k]) continue;
            double w_out = weight[k];
            uint32_t j_out = joint[k];
            weight[k] = w;
            joint[k] = j;
            for (int m = k + 1; m < 4; ++m) {
                double w_next = weight[m];
                uint32_t j_next = joint[m];
                weight[m] = w_out;
                joint[m] = j_out;
                w_out = w_next;
                j_out = j_next;
            }
            break;
        }
    }
    double sum = weight[0] + weight[1] + weight[2] + weight[3];
    int left = 255;
    for (int k = 3; k >= 0; --k) { /* the largest takes what rounding leaves */
        int share = k == 0 ? left : (int)(255.0 * weight[k] / sum + 0.5);
        vertex->weights[k] = (uint8_t)share;
        vertex->joints[k] = (uint8_t)(share > 0 ? joint[k] : 0);
        left -= share;
    }
}

static ff_cover cover_at(const ff_figure *figure, const ff_body_shape *shape, const ff_limb *limb, ff_vec3 p)
{
    if (limb->joint != FF_JOINT_HEAD) return limb->cover;
    ff_vec3 q = ff_scale3(ff_sub3(p, figure->rest[FF_JOINT_HEAD]), 1.0 / shape->scale);
    bool crown = q.y > 0.135 && q.z<0.105, back = q.y> 0.03 && q.z < 0.005;
    return crown || back ? FF_COVER_HAIR : FF_COVER_SKIN;
}

/* ------------------------------------------------------------------------------------------ surface nets */

typedef struct builder {
    const ff_figure *figure;
    const ff_body_shape *shape;
    grid g;
    ff_body_mesh *mesh;
    ff_array unsorted; /* uint32_t[3] */
} builder;

/* Mean of the points where the surface cuts the cell's edges; false when it does not pass through. */
static bool crossing(const grid *g, uint32_t x, uint32_t y, uint32_t z, ff_vec3 *out)
{
    float value[8];
    int inside = 0;
    for (uint32_t c = 0; c < 8; ++c) {
        value[c] = g->values[node(g, x + (c & 1u), y + (c >> 1 & 1u), z + (c >> 2))];
        inside += value[c] < 0.0f;
    }
    if (inside == 0 || inside == 8) return false;
    ff_vec3 sum = {0};
    double count = 0.0;
    for (uint32_t c = 0; c < 8; ++c)
        for (uint32_t axis = 0; axis < 3; ++axis) {
            uint32_t d = c | 1u << axis;
            if (d == c || (value[c] < 0.0f) == (value[d] < 0.0f)) continue;
            double t = (double)value[c] / ((double)value[c] - (double)value[d]);
            double at[3] = {c & 1u, c >> 1 & 1u, c >> 2};
            at[axis] += t;
            sum = ff_add3(sum, ff_v3(at[0], at[1], at[2]));
            count += 1.0;
        }
    *out = place(g, x + sum.x / count, y + sum.y / count, z + sum.z / count);
    return true;
}

static ff_status add_vertex(builder *b, uint32_t x, uint32_t y, uint32_t z, ff_error *error)
{
    ff_vec3 p;
    b->g.vertex[node(&b->g, x, y, z)] = NO_VERTEX;
    if (!crossing(&b->g, x, y, z, &p)) return FF_OK;
    ff_vec3 normal = gradient(b->shape, p);
    for (int i = 0; i < 2; ++i) { /* onto the surface, but not out of the cell's neighbourhood */
        double d = ff_clamp(ff_body_distance(b->shape, p), -0.5 * b->g.cell, 0.5 * b->g.cell);
        p = ff_madd3(p, normal, -d);
        normal = gradient(b->shape, p);
    }
    ff_body_vertex *vertex = ff_array_grow(&b->mesh->vertices, 1, sizeof *vertex);
    if (!vertex) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the body's mesh");
    *vertex = (ff_body_vertex){.position = {(float)p.x, (float)p.y, (float)p.z},
                               .normal = {(float)normal.x, (float)normal.y, (float)normal.z}};
    double distance[FF_JOINT_COUNT];
    const ff_limb *limb = &b->shape->limbs[nearest_limb(b->shape, p, distance)];
    set_weights(b->figure, b->shape->scale, limb->joint, distance, vertex);
    vertex->cover = (uint8_t)cover_at(b->figure, b->shape, limb, p);
    b->g.vertex[node(&b->g, x, y, z)] = (uint32_t)b->mesh->vertices.count - 1;
    return FF_OK;
}

/* The quad round the grid edge that starts at (x, y, z) and runs along axis. */
static ff_status add_quad(builder *b, uint32_t x, uint32_t y, uint32_t z, uint32_t axis, ff_error *error)
{
    uint32_t step[3] = {0};
    step[axis] = 1;
    bool from = b->g.values[node(&b->g, x, y, z)] < 0.0f;
    bool to = b->g.values[node(&b->g, x + step[0], y + step[1], z + step[2])] < 0.0f;
    if (from == to) return FF_OK;
    uint32_t u[3] = {0}, v[3] = {0};
    u[(axis + 1) % 3] = 1;
    v[(axis + 2) % 3] = 1;
    uint32_t corner[4] = {b->g.vertex[node(&b->g, x - u[0] - v[0], y - u[1] - v[1], z - u[2] - v[2])],
                          b->g.vertex[node(&b->g, x - v[0], y - v[1], z - v[2])],
                          b->g.vertex[node(&b->g, x, y, z)],
                          b->g.vertex[node(&b->g, x - u[0], y - u[1], z - u[2])]};
    uint32_t(*triangle)[3] = ff_array_grow(&b->unsorted, 2, sizeof *triangle);
    if (!triangle) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the body's mesh");
    static const int out[2][3] = {{0, 1, 2}, {0, 2, 3}}, in[2][3] = {{0, 2, 1}, {0, 3, 2}};
    for (int t = 0; t < 2; ++t)
        for (int k = 0; k < 3; ++k)
            triangle[t][k] = corner[from ? out[t][k] : in[t][k]];
    return FF_OK;
}

static ff_status run_nets(builder *b, ff_error *error)
{
    const uint32_t *size = b->g.size;
    ff_status status = FF_OK;
    for (uint32_t z = 0; z + 1 < size[2]; ++z)
        for (uint32_t y = 0; y + 1 < size[1]; ++y)
            for (uint32_t x = 0; x + 1 < size[0] && status == FF_OK; ++x)
                status = add_vertex(b, x, y, z, error);
    for (uint32_t z = 1; z + 1 < size[2]; ++z)
        for (uint32_t y = 1; y + 1 < size[1]; ++y)
            for (uint32_t x = 1; x + 1 < size[0]; ++x)
                for (uint32_t axis = 0; axis < 3 && status == FF_OK; ++axis)
                    status = add_quad(b, x, y, z, axis, error);
    return status;
}

/* A triangle wears what most of its corners wear. */
static ff_status sort_by_cover(builder *b, ff_error *error)
{
    const ff_body_vertex *vertices = b->mesh->vertices.data;
    const uint32_t(*from)[3] = (const uint32_t(*)[3])b->unsorted.data;
    uint32_t(*to)[3] = ff_array_grow(&b->mesh->triangles, b->unsorted.count, sizeof *to);
    if (!to) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the body's mesh");
    uint32_t count = 0;
    for (int cover = 0; cover < FF_COVER_COUNT; ++cover) {
        b->mesh->cover_first[cover] = count;
        for (size_t t = 0; t < b->unsorted.count; ++t) {
            uint8_t c0 = vertices[from[t][0]].cover, c1 = vertices[from[t][1]].cover;
            uint8_t c2 = vertices[from[t][2]].cover;
            if ((c1 == c2 ? c1 : c0) == cover) memcpy(to[count++], from[t], sizeof *to);
        }
    }
    b->mesh->cover_first[FF_COVER_COUNT] = count;
    return FF_OK;
}

/* The pack's own character in place of a body made from the bones: dressed in one colour, its shirt's. */
static ff_status take_character(const ff_figure *figure, ff_body_mesh *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    ff_body_vertex *v = ff_array_grow(&out->vertices, figure->vertex_count, sizeof *v);
    uint32_t(*t)[3] = ff_array_grow(&out->triangles, figure->triangle_count, sizeof *t);
    if (!v || !t) {
        ff_body_mesh_free(out);
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the character's surface");
    }
    for (uint32_t i = 0; i < figure->vertex_count; ++i) {
        const ff_pack_vertex *from = &figure->vertices[i];
        v[i] = (ff_body_vertex){.cover = FF_COVER_SHIRT};
        memcpy(v[i].position, from->position, sizeof v[i].position);
        memcpy(v[i].normal, from->normal, sizeof v[i].normal);
        memcpy(v[i].joints, from->joints, sizeof v[i].joints);
        memcpy(v[i].weights, from->weights, sizeof v[i].weights);
    }
    memcpy(t, figure->triangles, figure->triangle_count * sizeof *t);
    for (int cover = FF_COVER_SHIRT + 1; cover <= FF_COVER_COUNT; ++cover)
        out->cover_first[cover] = figure->triangle_count;
    return FF_OK;
}

ff_status ff_body_mesh_make(const ff_figure *figure, double cell, ff_body_mesh *out, ff_error *error)
{
    if (figure->vertices) return take_character(figure, out, error);
    ff_body_shape shape;
    ff_body_shape_make(figure, &shape);
    memset(out, 0, sizeof *out);
    builder b = {.figure = figure, .shape = &shape, .mesh = out};
    ff_status status = fill_grid(&shape, cell * shape.scale, &b.g, error);
    if (status == FF_OK) status = run_nets(&b, error);
    if (status == FF_OK) status = sort_by_cover(&b, error);
    free(b.g.values);
    free(b.g.vertex);
    ff_array_free(&b.unsorted);
    if (status != FF_OK) ff_body_mesh_free(out);
    return status;
}

void ff_body_mesh_free(ff_body_mesh *mesh)
{
    ff_array_free(&mesh->vertices);
    ff_array_free(&mesh->triangles);
    memset(mesh, 0, sizeof *mesh);
}

void ff_body_mesh_skin(const ff_body_mesh *mesh, const ff_figure *figure, const ff_vec3 *joint_positions,
                       const ff_quat *joint_rotations, ff_vec3 *positions, ff_vec3 *normals)
{
    const ff_body_vertex *vertices = mesh->vertices.data;
    for (size_t i = 0; i < mesh->vertices.count; ++i) {
        const ff_body_vertex *vertex = &vertices[i];
        ff_vec3 rest = ff_v3(vertex->position[0], vertex->position[1], vertex->position[2]);
        ff_vec3 up = ff_v3(vertex->normal[0], vertex->normal[1], vertex->normal[2]);
        ff_vec3 p = {0}, n = {0};
        for (int k = 0; k < 4 && vertex->weights[k] > 0; ++k) {
            uint32_t j = vertex->joints[k];
            double w = vertex->weights[k] / 255.0;
            ff_vec3 local = ff_quat_rotate(joint_rotations[j], ff_sub3(rest, figure->rest[j]));
            p = ff_madd3(p, ff_add3(local, joint_positions[j]), w);
            n = ff_madd3(n, ff_quat_rotate(joint_rotations[j], up), w);
        }
        positions[i] = p;
        normals[i] = ff_unit3(n);
    }
}
