/* derive.h - examples that no clip shows, made from a captured walk: its foot paths scaled to other rates, legs solved
 * to them (synthesis study, section 5). */
#ifndef FF_DERIVE_H
#define FF_DERIVE_H

#include "preprocess/examples/gait_fit.h"

typedef struct ff_derive_target {
    const char *name;
    double forward, left, turn; /* m/s, m/s, rad/s */
    double period;              /* s; 0 = as the model has it */
} ff_derive_target;

/* The semi-procedural clip (fit, made of base) at the target's rates, with the trunk and arms of base. A straight run may
 * be bent too. Marked FF_EXAMPLE_DERIVED. */
ff_status ff_derive_walk(const ff_rig *rig, const ff_example *base, const ff_gait_fit *fit,
                         const ff_derive_target *target, ff_example *out, ff_error *error);

/* Standing upright with the base's mean trunk and arms, feet under the hips, breathing. */
ff_status ff_derive_idle(const ff_rig *rig, const ff_example *base, ff_example *out, ff_error *error);

#endif
