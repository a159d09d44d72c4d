/* How large the colliders are, and with that the cylinder about all of them. */
#include "preprocess/build/pack_fill.h"
#include "runtime/core/base/fail.h"

#include <string.h>

static double coarse_radius(const ff_pack_collider *samples, uint32_t count, const double *radii)
{
    double most = 0.0;
    for (uint32_t k = 0; k < count; ++k) {
        const ff_pack_collider *at = samples + (size_t)k * FF_COLLIDER_COUNT, *root = &at[FF_COLLIDER_ROOT];
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
            ff_vec2 away = ff_v2((double)at[c].a - (double)root->a, (double)at[c].b - (double)root->b);
            most = ff_max(most, ff_length2(away) + radii[c]);
        }
    }
    return most;
}

ff_status ff_pack_set_collider_radii(ff_pack_content *content, const double radii[FF_COLLIDER_COUNT],
                                     ff_error *error)
{
    content->collider_radii.count = 0;
    float *out = ff_array_grow(&content->collider_radii, FF_COLLIDER_COUNT, sizeof *out);
    if (!out) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the colliders");
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c)
        out[c] = (float)radii[c];
    ff_pack_action *action = content->actions.data;
    const ff_pack_collider *colliders = content->colliders.data;
    for (size_t i = 0; i < content->actions.count; ++i)
        action[i].coarse_radius =
            (float)coarse_radius(colliders + action[i].first_collider, action[i].collider_samples, radii);
    return FF_OK;
}
