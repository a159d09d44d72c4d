/* How large the parts of a character are that planners keep apart. */
#include "preprocess/actions/annotate.h"
#include "preprocess/base/filter.h"
#include "preprocess/skin/mesh.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>

#define COVERED 0.95 /* of the vertices: a few stray ones do not count */
enum { FEWEST = 4 };

/* Which collider the vertices of a joint are in; -1: none, as of arms and legs. */
static int collider_of(int role)
{
    switch (role) {
    case FF_ROLE_HEAD:
        return FF_COLLIDER_HEAD;
    case FF_ROLE_WRIST_L:
        return FF_COLLIDER_HAND_L;
    case FF_ROLE_WRIST_R:
        return FF_COLLIDER_HAND_R;
    case FF_ROLE_ANKLE_L:
    case FF_ROLE_BALL_L:
        return FF_COLLIDER_FOOT_L;
    case FF_ROLE_ANKLE_R:
    case FF_ROLE_BALL_R:
        return FF_COLLIDER_FOOT_R;
    case FF_ROLE_HIPS:
        return FF_COLLIDER_ROOT;
    default:
        return -1;
    }
}

/* The part that a vertex is mostly of. */
static int part_of(const ff_skin_vertex *v)
{
    for (int b = 0; b < FF_SKIN_BONES; ++b)
        if (v->weight[b] >= 0.5) return collider_of(v->joint[b]);
    return -1;
}

/* Colliders are upright cylinders: what is about the axis at rest is so while head and hips are upright and feet flat. Hands
 * turn any way. */
static double distance(int collider, ff_vec3 middle, ff_vec3 at)
{
    ff_vec3 away = ff_sub3(at, middle);
    bool hand = collider == FF_COLLIDER_HAND_L || collider == FF_COLLIDER_HAND_R;
    return hand ? ff_length3(away) : ff_length2(ff_plane(away));
}

/* Left and right alike, as every action has a mirror image. */
static void even_out(double *left, double *right)
{
    *left = *right = ff_max(*left, *right);
}

ff_status ff_mesh_collider_radii(const ff_mesh *mesh, const ff_rig *rig, double out[FF_COLLIDER_COUNT],
                                 ff_error *error)
{
    ff_vec3 at[FF_BODY_COUNT], middle[FF_COLLIDER_COUNT];
    double *distances = ff_calloc((size_t)mesh->vertex_count + 1, sizeof *distances);
    if (!distances) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d vertices", mesh->vertex_count);
    ff_rig_rest_pose(rig, at);
    ff_collider_middles(at, middle);
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
        int n = 0;
        for (int i = 0; i < mesh->vertex_count; ++i)
            if (part_of(&mesh->vertices[i]) == c)
                distances[n++] = distance(c, middle[c], mesh->vertices[i].at);
        out[c] = n >= FEWEST ? ff_filter_quantile(distances, n, COVERED) : 0.0;
    }
    even_out(&out[FF_COLLIDER_HAND_L], &out[FF_COLLIDER_HAND_R]);
    even_out(&out[FF_COLLIDER_FOOT_L], &out[FF_COLLIDER_FOOT_R]);
    free(distances);
    return FF_OK;
}
