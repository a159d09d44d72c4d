/* The adapter to librecast; without its headers a stub that says so. */
#include "runtime/export/detour.h"

extern "C" {
#include "runtime/core/base/fail.h"
}

#ifdef FF_HAVE_DETOUR
#include <recastnavigation/DetourCommon.h>
#include <recastnavigation/DetourCrowd.h>
#include <recastnavigation/DetourNavMesh.h>
#include <recastnavigation/DetourNavMeshBuilder.h>
#include <recastnavigation/DetourNavMeshQuery.h>

#include <new>
#include <vector>

struct ff_detour {
    dtNavMesh *mesh;
    dtCrowd *crowd;
    std::vector<int> index;
};

int ff_detour_here(void)
{
    return 1;
}

/* One square polygon. */
static dtNavMesh *open_ground(double half)
{
    const float cell = 0.05f;
    const float side = static_cast<float>(2.0 * half);
    const unsigned short last = static_cast<unsigned short>(side / cell);
    const unsigned short corners[] = {0, 0, 0, 0, 0, last, last, 0, last, last, 0, 0};
    const unsigned short polygon[] = {0, 1, 2, 3, 0xffff, 0xffff, 0xffff, 0xffff};
    const unsigned short flags[] = {1};
    const unsigned char areas[] = {0};
    dtNavMeshCreateParams params = {};
    params.verts = corners;
    params.vertCount = 4;
    params.polys = polygon;
    params.polyFlags = flags;
    params.polyAreas = areas;
    params.polyCount = 1;
    params.nvp = 4;
    params.bmin[0] = params.bmin[2] = -0.5f * side;
    params.bmin[1] = -1.0f;
    params.bmax[0] = params.bmax[2] = 0.5f * side;
    params.bmax[1] = 1.0f;
    params.walkableHeight = 2.0f;
    params.walkableRadius = 0.3f;
    params.walkableClimb = 0.5f;
    params.cs = cell;
    params.ch = 0.05f;
    params.buildBvTree = true;
    unsigned char *data = nullptr;
    int size = 0;
    if (!dtCreateNavMeshData(&params, &data, &size)) return nullptr;
    dtNavMesh *mesh = dtAllocNavMesh();
    if (!mesh || dtStatusFailed(mesh->init(data, size, DT_TILE_FREE_DATA))) {
        dtFreeNavMesh(mesh);
        if (!mesh) dtFree(data);
        return nullptr;
    }
    return mesh;
}

/* As in librecast's own demonstration: full avoidance, high quality, with separation. */
static dtCrowdAgentParams walker(const ff_detour_agent &agent)
{
    dtCrowdAgentParams params = {};
    params.radius = static_cast<float>(agent.radius);
    params.height = 1.8f;
    params.maxAcceleration = 8.0f;
    params.maxSpeed = static_cast<float>(agent.preferred_speed);
    params.collisionQueryRange = params.radius * 12.0f;
    params.pathOptimizationRange = params.radius * 30.0f;
    params.separationWeight = 2.0f;
    params.updateFlags = DT_CROWD_ANTICIPATE_TURNS | DT_CROWD_OPTIMIZE_VIS | DT_CROWD_OPTIMIZE_TOPO |
                         DT_CROWD_OBSTACLE_AVOIDANCE | DT_CROWD_SEPARATION;
    params.obstacleAvoidanceType = 3;
    return params;
}

static bool populate(ff_detour *detour, const ff_detour_agent *agents, uint32_t count)
{
    dtObstacleAvoidanceParams quality = *detour->crowd->getObstacleAvoidanceParams(0);
    quality.velBias = 0.5f;
    quality.adaptiveDivs = 7;
    quality.adaptiveRings = 3;
    quality.adaptiveDepth = 3;
    detour->crowd->setObstacleAvoidanceParams(3, &quality);
    const float reach[3] = {1.0f, 2.0f, 1.0f};
    for (uint32_t i = 0; i < count; ++i) {
        const float start[3] = {static_cast<float>(agents[i].position.b), 0.0f,
                                static_cast<float>(agents[i].position.a)};
        const float goal[3] = {static_cast<float>(agents[i].goal.b), 0.0f,
                               static_cast<float>(agents[i].goal.a)};
        dtCrowdAgentParams params = walker(agents[i]);
        int index = detour->crowd->addAgent(start, &params);
        dtPolyRef polygon = 0;
        float nearest[3];
        detour->crowd->getNavMeshQuery()->findNearestPoly(goal, reach, detour->crowd->getFilter(0), &polygon,
                                                          nearest);
        if (index < 0 || !polygon || !detour->crowd->requestMoveTarget(index, polygon, nearest)) return false;
        detour->index.push_back(index);
    }
    return true;
}

static ff_status create(const ff_detour_agent *agents, uint32_t count, double half_side, ff_detour **out,
                        ff_error *error)
{
    ff_detour *detour = new ff_detour{open_ground(half_side), dtAllocCrowd(), {}};
    bool made = detour->mesh && detour->crowd &&
                detour->crowd->init(static_cast<int>(count), 0.6f, detour->mesh) &&
                populate(detour, agents, count);
    if (!made) {
        ff_detour_destroy(detour);
        return ff_fail(error, FF_ERR_UNSUPPORTED, "Detour cannot lay out %u agents on %.0f m", count,
                       2.0 * half_side);
    }
    *out = detour;
    return FF_OK;
}

ff_status ff_detour_create(const ff_detour_agent *agents, uint32_t count, double half_side, ff_detour **out,
                           ff_error *error)
{
    *out = nullptr;
    try {
        return create(agents, count, half_side, out, error);
    } catch (const std::bad_alloc &) {
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for Detour's crowd of %u", count);
    }
}

void ff_detour_destroy(ff_detour *detour)
{
    if (!detour) return;
    dtFreeCrowd(detour->crowd);
    dtFreeNavMesh(detour->mesh);
    delete detour;
}

void ff_detour_step(ff_detour *detour, double dt)
{
    detour->crowd->update(static_cast<float>(dt), nullptr);
}

static ff_vec2 plane(const float *p)
{
    return ff_vec2{static_cast<double>(p[2]), static_cast<double>(p[0])};
}

ff_vec2 ff_detour_position(const ff_detour *detour, uint32_t agent)
{
    return plane(detour->crowd->getAgent(detour->index[agent])->npos);
}

ff_vec2 ff_detour_velocity(const ff_detour *detour, uint32_t agent)
{
    return plane(detour->crowd->getAgent(detour->index[agent])->vel);
}

#else

int ff_detour_here(void)
{
    return 0;
}

ff_status ff_detour_create(const ff_detour_agent *agents, uint32_t count, double half_side, ff_detour **out,
                           ff_error *error)
{
    (void)agents, (void)count, (void)half_side;
    *out = nullptr;
    return ff_fail(error, FF_ERR_UNSUPPORTED, "this program was built without librecast");
}
void ff_detour_destroy(ff_detour *) {}
void ff_detour_step(ff_detour *, double) {}
ff_vec2 ff_detour_position(const ff_detour *, uint32_t)
{
    return ff_vec2{0.0, 0.0};
}
ff_vec2 ff_detour_velocity(const ff_detour *, uint32_t)
{
    return ff_vec2{0.0, 0.0};
}

#endif
