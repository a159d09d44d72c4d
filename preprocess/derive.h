/* derive.h - examples that no clip shows, made from a captured walk: its foot paths scaled to other rates, legs solved
 * to them (synthesis study, section 5). */
#ifndef FF_DERIVE_H
#define FF_DERIVE_H

#include "preprocess/example.h"

typedef struct ff_derive_target {
    const char *name;
    double forward, left, turn; /* m/s, m/s, rad/s */
    double period;              /* s */
} ff_derive_target;

/* A straight walk (base; read backwards for backward targets) at the target's rates. Marked FF_EXAMPLE_DERIVED. */
ff_status ff_derive_walk(const ff_rig *rig, const ff_example *base, const ff_derive_target *target,
                         ff_example *out, ff_error *error);

/* Standing upright with the base's mean trunk and arms, feet under the hips, breathing. */
ff_status ff_derive_idle(const ff_rig *rig, const ff_example *base, ff_example *out, ff_error *error);

#endif
