#include "runtime/export/look.h"

#include "runtime/core/base/random.h"

enum { HUES = 24 }; /* few enough for viewers to share materials */

static ff_colour shirt(const ff_scene *scene, uint32_t agent)
{
    static const double group_hue[4] = {0.02, 0.58, 0.12, 0.36};
    uint32_t group = ff_scene_agents(scene)[agent].group;
    if (scene->groups == 1) { /* nobody to tell apart: many colours */
        uint32_t one = (uint32_t)(ff_random_at(11, 0, agent) % HUES);
        return ff_colour_hsv((double)one / HUES, 0.55, one % 2 ? 0.90 : 0.72);
    }
    if (scene->groups <= 4) {
        double shift = ((int)(agent % 5) - 2) * 0.012, light = 0.86 - 0.05 * (double)(agent % 3);
        return ff_colour_hsv(group_hue[group % 4] + shift, 0.72, light);
    }
    uint32_t hue = (uint32_t)((uint64_t)group * HUES / scene->groups);
    return ff_colour_hsv((double)hue / HUES, 0.70, hue % 2 ? 0.90 : 0.76);
}

ff_look ff_look_of(const ff_scene *scene, uint32_t agent)
{
    static const ff_colour skins[4] = {{236, 194, 166}, {214, 165, 130}, {166, 118, 88}, {122, 84, 62}};
    static const ff_colour hairs[4] = {{58, 42, 34}, {34, 30, 30}, {120, 86, 52}, {92, 88, 86}};
    static const ff_colour trousers[4] = {{58, 66, 88}, {74, 70, 66}, {48, 50, 56}, {104, 96, 82}};
    static const ff_colour shoes[2] = {{44, 38, 36}, {84, 60, 44}};
    uint64_t bits = ff_random_at(7, 0, agent); /* clothes do not depend on the scene's seed */
    ff_look look;
    look.cover[FF_COVER_SHIRT] = shirt(scene, agent);
    look.cover[FF_COVER_SKIN] = skins[bits & 3u];
    look.cover[FF_COVER_HAIR] = hairs[bits >> 2 & 3u];
    look.cover[FF_COVER_TROUSERS] = trousers[bits >> 4 & 3u];
    look.cover[FF_COVER_SHOES] = shoes[bits >> 6 & 1u];
    return look;
}

double ff_ground_tile(double width, double depth)
{
    double tile = 1.0;
    while (width * depth > 20000.0 * tile * tile)
        tile *= 10.0;
    return tile;
}

uint32_t ff_region_outline(const ff_region *region, ff_vec2 out[FF_OUTLINE_MOST])
{
    static const double side[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    if (region->shape == FF_REGION_POINT) return 0;
    uint32_t count = region->shape == FF_REGION_BOX ? 4 : FF_OUTLINE_MOST;
    for (uint32_t i = 0; i < count; ++i) {
        ff_vec2 corner = region->shape == FF_REGION_BOX
                             ? ff_v2(side[i][0] * region->half.a, side[i][1] * region->half.b)
                             : ff_scale2(ff_fwd2(FF_TAU * i / FF_OUTLINE_MOST), region->half.a);
        out[i] = ff_add2(region->centre, ff_from_frame2(ff_fwd2(region->heading), corner));
    }
    return count;
}
