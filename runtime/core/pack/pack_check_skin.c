#include "runtime/core/pack/pack_check.h"

#include "runtime/core/base/fail.h"

#define LIMIT_BODY 10.0f /* m */
#define LIMIT_UV 1e6f

static ff_status check_vertices(const ff_pack *pack, ff_error *error)
{
    for (uint32_t i = 0; i < pack->vertex_count; ++i) {
        const ff_pack_vertex *v = &pack->vertices[i];
        const float *wild = ff_pack_wild_float(v->position, 6, LIMIT_BODY);
        if (!wild) wild = ff_pack_wild_float(v->uv, 2, LIMIT_UV);
        if (wild) return FF_PACK_REFUSE("VERT", wild, "vertex %u: %g", i, (double)*wild);
        unsigned sum = 0;
        for (int b = 0; b < 4; ++b) {
            sum += v->weights[b];
            if (v->joints[b] >= pack->joint_count)
                return FF_PACK_REFUSE("VERT", &v->joints[b], "vertex %u: joint %u of %u", i, v->joints[b],
                                      pack->joint_count);
        }
        if (sum != 255)
            return FF_PACK_REFUSE("VERT", v->weights, "vertex %u: weights add up to %u, not 255", i, sum);
    }
    return FF_OK;
}

static ff_status check_level(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_skin *s = &pack->skins[index];
    if (!ff_pack_range_fits(s->first_vertex, s->vertex_count, pack->vertex_count))
        return FF_PACK_REFUSE("SKIN", s, "level %u: vertices %u + %u of %u", index, s->first_vertex,
                              s->vertex_count, pack->vertex_count);
    if (!ff_pack_range_fits(s->first_triangle, s->triangle_count, pack->triangle_count) ||
        s->triangle_count == 0)
        return FF_PACK_REFUSE("SKIN", &s->first_triangle, "level %u: triangles %u + %u of %u", index,
                              s->first_triangle, s->triangle_count, pack->triangle_count);
    for (uint32_t t = 0; t < s->triangle_count; ++t) {
        const ff_pack_triangle *triangle = &pack->triangles[s->first_triangle + t];
        for (int c = 0; c < 3; ++c)
            if (triangle->corner[c] >= s->vertex_count)
                return FF_PACK_REFUSE("INDX", &triangle->corner[c], "level %u: vertex %u of %u", index,
                                      triangle->corner[c], s->vertex_count);
    }
    return FF_OK;
}

ff_status ff_pack_check_skin(const ff_pack *pack, ff_error *error)
{
    ff_status status = check_vertices(pack, error);
    for (uint32_t i = 0; i < pack->skin_count && status == FF_OK; ++i)
        status = check_level(pack, i, error);
    return status;
}
