/* gait_fit.h - the semi-procedural clip from a captured straight walk, and its laws from many (runtime/core/gait/gait_model.h
 * evaluates it). */
#ifndef FF_GAIT_FIT_H
#define FF_GAIT_FIT_H

#include "preprocess/examples/example.h"
#include "runtime/core/gait/gait_model.h"

/* Standing feet: from the middle to a ball (m), and toe-out. */
#define FF_STAND_HALF_WIDTH 0.09
#define FF_STAND_TOE_OUT (7.0 * FF_DEG)

typedef struct ff_gait_fit {
    ff_pack_gait gait; /* gait.example is for the caller to set */
    ff_pack_gait_path path[FF_GAIT_SAMPLES];
} ff_gait_fit;

/* The clip: a straight walk forwards, made the same on both sides. Laws by least squares over walks (straight, forwards;
 * may hold clip itself), through the clip's own point; those of people in general when there are fewer than three. */
void ff_gait_fit_make(const ff_rig *rig, const ff_example *clip, const ff_example *const *walks, int count,
                      ff_gait_fit *out);

static inline ff_gait_model ff_gait_fit_model(const ff_gait_fit *fit)
{
    return (ff_gait_model){&fit->gait, fit->path};
}

#endif
