#include "runtime/export/glb_parts.h"

#include "runtime/core/base/maths.h"

#include <math.h>

#define ROUGH 0.85

/* glTF colour factors are linear, ours are sRGB. */
static double linear(uint8_t value)
{
    double v = value / 255.0;
    v = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    return floor(v * 1e4 + 0.5) / 1e4;
}

int ff_glb_add_paint(ff_glb_model *model, const char *name, ff_colour colour, int both_sides)
{
    double rgb[3] = {linear(colour.r), linear(colour.g), linear(colour.b)};
    return ff_glb_add_material(model, name, rgb, ROUGH, both_sides);
}

int ff_glb_add_vectors(ff_glb_model *model, const float (*values)[3], size_t count, bool bounded)
{
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    for (size_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) {
            low[k] = ff_min(low[k], (double)values[i][k]);
            high[k] = ff_max(high[k], (double)values[i][k]);
        }
    int view = ff_glb_add_view(model, values, count * sizeof *values, 12, FF_GLB_VERTICES);
    return ff_glb_add_accessor(model, view, 0, FF_GLB_F32, 0, 3, count, bounded ? low : NULL,
                               bounded ? high : NULL);
}

int ff_glb_add_indices(ff_glb_model *model, const uint32_t (*triangles)[3], size_t count)
{
    int view = ff_glb_add_view(model, triangles, count * sizeof *triangles, 0, FF_GLB_INDICES);
    return ff_glb_add_accessor(model, view, 0, FF_GLB_U32, 0, 1, 3 * count, NULL, NULL);
}
