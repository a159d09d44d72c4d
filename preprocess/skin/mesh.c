#include "preprocess/skin/mesh.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

void ff_mesh_free(ff_mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->triangles);
    memset(mesh, 0, sizeof *mesh);
}

static ff_status no_memory(const ff_mesh *mesh, ff_error *error)
{
    return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a mesh of %d triangles", mesh->triangle_count);
}

/* -------------------------------------------------------------------------------------------- vertices in one place */

typedef struct placed {
    ff_vec3 at;
    int vertex;
} placed;

static int by_place(const void *left, const void *right)
{
    const placed *a = left, *b = right;
    if (a->at.x != b->at.x) return a->at.x < b->at.x ? -1 : 1;
    if (a->at.y != b->at.y) return a->at.y < b->at.y ? -1 : 1;
    if (a->at.z != b->at.z) return a->at.z < b->at.z ? -1 : 1;
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

/* Seams of texture and normals split vertices: give those at one place the number of the first of them. */
static bool weld(const ff_mesh *mesh, uint32_t *first)
{
    size_t count = (size_t)mesh->vertex_count;
    placed *sorted = ff_calloc(count, sizeof *sorted);
    if (!sorted) return false;
    for (size_t i = 0; i < count; ++i)
        sorted[i] = (placed){mesh->vertices[i].at, (int)i};
    qsort(sorted, count, sizeof *sorted, by_place);
    for (size_t i = 0; i < count; ++i) {
        bool same = i > 0 && sorted[i].at.x == sorted[i - 1].at.x && sorted[i].at.y == sorted[i - 1].at.y &&
                    sorted[i].at.z == sorted[i - 1].at.z;
        first[sorted[i].vertex] = same ? first[sorted[i - 1].vertex] : (uint32_t)sorted[i].vertex;
    }
    free(sorted);
    return true;
}

/* ---------------------------------------------------------------------------------------------------------- clean */

typedef struct corners {
    uint32_t welded[3]; /* ascending */
    int triangle;
} corners;

static int by_corners(const void *left, const void *right)
{
    const corners *a = left, *b = right;
    for (int i = 0; i < 3; ++i)
        if (a->welded[i] != b->welded[i]) return a->welded[i] < b->welded[i] ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static void order(uint32_t v[3])
{
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2 - i; ++k)
            if (v[k] > v[k + 1]) {
                uint32_t larger = v[k];
                v[k] = v[k + 1];
                v[k + 1] = larger;
            }
}

/* The area of a triangle that counts as none (m^2). */
#define FLAT 1e-12

static bool is_degenerate(const ff_mesh *mesh, int triangle, const uint32_t welded[3])
{
    if (welded[0] == welded[1] || welded[1] == welded[2]) return true;
    const uint32_t *t = mesh->triangles[triangle];
    ff_vec3 a = mesh->vertices[t[0]].at;
    ff_vec3 cross = ff_cross3(ff_sub3(mesh->vertices[t[1]].at, a), ff_sub3(mesh->vertices[t[2]].at, a));
    return !(ff_length3(cross) > 2.0 * FLAT);
}

/* Which triangles stay. */
static void judge_triangles(const ff_mesh *mesh, const uint32_t *first, corners *list, bool *stays,
                            ff_mesh_faults *faults)
{
    size_t count = (size_t)mesh->triangle_count;
    for (size_t t = 0; t < count; ++t) {
        list[t].triangle = (int)t;
        for (int c = 0; c < 3; ++c)
            list[t].welded[c] = first[mesh->triangles[t][c]];
        order(list[t].welded);
        stays[t] = !is_degenerate(mesh, (int)t, list[t].welded);
        faults->degenerate += !stays[t];
    }
    qsort(list, count, sizeof *list, by_corners);
    for (size_t i = 1; i < count; ++i) {
        if (memcmp(list[i].welded, list[i - 1].welded, sizeof list[i].welded) != 0 ||
            !stays[list[i].triangle])
            continue;
        stays[list[i].triangle] = false;
        faults->repeated++;
    }
}

/* Keep the triangles that stay and the vertices they use. */
static void squeeze(ff_mesh *mesh, const bool *stays, uint32_t *number, ff_mesh_faults *faults)
{
    int triangles = 0, vertices = 0;
    for (int t = 0; t < mesh->triangle_count; ++t)
        if (stays[t]) memmove(mesh->triangles[triangles++], mesh->triangles[t], sizeof mesh->triangles[0]);
    mesh->triangle_count = triangles;
    for (int i = 0; i < mesh->vertex_count; ++i)
        number[i] = UINT32_MAX;
    for (int i = 0; i < 3 * triangles; ++i)
        number[mesh->triangles[i / 3][i % 3]] = 0;
    for (int i = 0; i < mesh->vertex_count; ++i) {
        if (number[i] == UINT32_MAX) continue;
        mesh->vertices[vertices] = mesh->vertices[i];
        number[i] = (uint32_t)vertices++;
    }
    faults->unused += mesh->vertex_count - vertices;
    mesh->vertex_count = vertices;
    for (int i = 0; i < 3 * triangles; ++i)
        mesh->triangles[i / 3][i % 3] = number[mesh->triangles[i / 3][i % 3]];
}

ff_status ff_mesh_clean(ff_mesh *mesh, ff_mesh_faults *faults, ff_error *error)
{
    uint32_t *first = ff_calloc((size_t)mesh->vertex_count, sizeof *first);
    corners *list = ff_calloc((size_t)mesh->triangle_count, sizeof *list);
    bool *stays = ff_calloc((size_t)mesh->triangle_count, sizeof *stays);
    ff_status status = FF_OK;
    if (first && list && stays && weld(mesh, first)) {
        judge_triangles(mesh, first, list, stays, faults);
        squeeze(mesh, stays, first, faults);
        if (mesh->triangle_count == 0)
            status = ff_fail(error, FF_ERR_NO_DATA, "the mesh has no triangle with an area");
    } else {
        status = no_memory(mesh, error);
    }
    free(first);
    free(list);
    free(stays);
    return status;
}

/* --------------------------------------------------------------------------------------------------------- normals */

typedef struct creases {
    const ff_mesh *mesh; /* whose vertices are one per place */
    double least;        /* cosine of the turn beyond which faces that meet do not share a normal */
    ff_vec3 *face;       /* [triangles] normal times twice the area */
    int *start, *around; /* faces around each vertex */
} creases;

static void list_faces(creases *c)
{
    const ff_mesh *mesh = c->mesh;
    int corner_count = 3 * mesh->triangle_count;
    for (int t = 0; t < mesh->triangle_count; ++t) {
        const uint32_t *v = mesh->triangles[t];
        ff_vec3 a = mesh->vertices[v[0]].at;
        c->face[t] = ff_cross3(ff_sub3(mesh->vertices[v[1]].at, a), ff_sub3(mesh->vertices[v[2]].at, a));
    }
    for (int i = 0; i < corner_count; ++i)
        c->start[mesh->triangles[i / 3][i % 3] + 1]++;
    for (int i = 0; i < mesh->vertex_count; ++i)
        c->start[i + 1] += c->start[i];
    for (int i = corner_count - 1; i >= 0;
         --i) { /* starts move up while they are filled and come out right */
        uint32_t v = mesh->triangles[i / 3][i % 3];
        c->around[--c->start[v + 1]] = i / 3;
    }
}

static ff_vec3 corner_normal(const creases *c, int triangle, uint32_t vertex, int end)
{
    ff_vec3 own = ff_unit3(c->face[triangle]), sum = {0.0, 0.0, 0.0};
    for (int i = c->start[vertex + 1]; i < end; ++i) {
        ff_vec3 other = c->face[c->around[i]];
        if (ff_dot3(own, ff_unit3(other)) >= c->least) sum = ff_add3(sum, other);
    }
    return ff_length3(sum) > 0.0 ? ff_unit3(sum) : own;
}

/* A vertex for every place and normal: corners of a triangle whose normal agrees share one. */
static bool split_at_creases(const creases *c, ff_mesh *out, int *next)
{
    const ff_mesh *mesh = c->mesh;
    int corner_count = 3 * mesh->triangle_count;
    int *chain = next, *head = next + corner_count;
    for (int i = 0; i < mesh->vertex_count; ++i)
        head[i] = -1;
    for (int i = 0; i < corner_count; ++i) {
        uint32_t v = mesh->triangles[i / 3][i % 3];
        int end = (int)v + 1 < mesh->vertex_count ? c->start[v + 2] : corner_count;
        ff_vec3 normal = corner_normal(c, i / 3, v, end);
        int k = head[v];
        while (k >= 0 && ff_dot3(out->vertices[k].normal, normal) < 0.9998)
            k = chain[k];
        if (k < 0) {
            k = out->vertex_count++;
            out->vertices[k] = mesh->vertices[v];
            out->vertices[k].normal = normal;
            chain[k] = head[v];
            head[v] = k;
        }
        out->triangles[i / 3][i % 3] = (uint32_t)k;
    }
    return true;
}

static ff_status make_normals(const ff_mesh *mesh, double crease, ff_mesh *out, ff_error *error)
{
    size_t corner_count = 3 * (size_t)mesh->triangle_count, count = (size_t)mesh->vertex_count;
    memset(out, 0, sizeof *out);
    creases c = {.mesh = mesh, .least = ff_cos(crease * FF_DEG)};
    c.face = ff_calloc((size_t)mesh->triangle_count, sizeof *c.face);
    c.start = ff_calloc(count + 2, sizeof *c.start);
    c.around = ff_calloc(corner_count, sizeof *c.around);
    int *room = ff_calloc(corner_count + count, sizeof *room);
    out->vertices = ff_calloc(corner_count, sizeof *out->vertices);
    out->triangles = ff_calloc((size_t)mesh->triangle_count, sizeof *out->triangles);
    bool made = c.face && c.start && c.around && room && out->vertices && out->triangles;
    if (made) {
        list_faces(&c);
        split_at_creases(&c, out, room);
        out->triangle_count = mesh->triangle_count;
    } else {
        ff_mesh_free(out);
    }
    free(c.face);
    free(c.start);
    free(c.around);
    free(room);
    return made ? FF_OK : no_memory(mesh, error);
}

/* ---------------------------------------------------------------------------------------------------------- reduce */

/* Places and triangles between them, without seams. */
typedef struct welded {
    ff_vec3 *places;
    int *vertex; /* one of the mesh's at each place */
    int count;
    uint32_t (*triangles)[3];
} welded;

static bool weld_mesh(const ff_mesh *mesh, welded *out)
{
    size_t count = (size_t)mesh->vertex_count;
    uint32_t *first = ff_calloc(count, sizeof *first);
    out->places = ff_calloc(count, sizeof *out->places);
    out->vertex = ff_calloc(count, sizeof *out->vertex);
    out->triangles = ff_calloc((size_t)mesh->triangle_count, sizeof *out->triangles);
    bool made = first && out->places && out->vertex && out->triangles && weld(mesh, first);
    for (size_t i = 0; made && i < count; ++i) {
        if (first[i] != i) {
            first[i] = first[first[i]]; /* the first of a place comes before the others */
            continue;
        }
        out->places[out->count] = mesh->vertices[i].at;
        out->vertex[out->count] = (int)i;
        first[i] = (uint32_t)out->count++;
    }
    for (int i = 0; made && i < 3 * mesh->triangle_count; ++i)
        out->triangles[i / 3][i % 3] = first[mesh->triangles[i / 3][i % 3]];
    free(first);
    return made;
}

ff_status ff_mesh_reduce(const ff_mesh *mesh, int triangles, double crease, ff_mesh *out,
                         ff_mesh_faults *faults, ff_error *error)
{
    memset(out, 0, sizeof *out);
    welded w = {0};
    int *kept = NULL;
    ff_mesh smaller = {0};
    ff_status status = weld_mesh(mesh, &w) ? FF_OK : no_memory(mesh, error);
    if (status == FF_OK)
        status = ff_mesh_collapse(w.places, w.count, (const uint32_t(*)[3])w.triangles, mesh->triangle_count,
                                  triangles, &kept, &smaller.vertex_count, &smaller.triangles,
                                  &smaller.triangle_count, &faults->torn, error);
    if (status == FF_OK) {
        smaller.vertices = ff_calloc((size_t)smaller.vertex_count, sizeof *smaller.vertices);
        if (!smaller.vertices) status = no_memory(mesh, error);
    }
    for (int i = 0; status == FF_OK && i < smaller.vertex_count; ++i)
        smaller.vertices[i] = mesh->vertices[w.vertex[kept[i]]];
    if (status == FF_OK) status = make_normals(&smaller, crease, out, error);
    free(w.places);
    free(w.vertex);
    free(w.triangles);
    free(kept);
    ff_mesh_free(&smaller);
    return status;
}
