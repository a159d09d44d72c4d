/* pack_use.h - do with an opened pack what a crowd does: whatever the loader lets through must be safe to use. */
#ifndef FF_TEST_PACK_USE_H
#define FF_TEST_PACK_USE_H

#include "runtime/core/base/random.h"
#include "runtime/core/gait/synth_state.h"
#include "runtime/core/pack/joints.h"

/* One agent for so many steps at rates drawn from seed. Returns whether all poses were finite. */
static inline bool ff_pack_use(const ff_pack *pack, int steps, uint64_t seed)
{
    ff_blend_space *space;
    if (ff_blend_space_create(pack, &space, NULL) != FF_OK) return true;
    ff_random random = {seed, 0, 0};
    ff_gait gait;
    ff_vec2 position = {0.0, 0.0};
    double heading = 0.0;
    bool finite = true;
    ff_rates rates = {0.0, 0.0, 0.0};
    ff_gait_init(space, &gait, position, heading, seed);
    for (int i = 0; i < steps; ++i) {
        if (i % 3 == 2)
            ff_gait_want(space, &gait, (ff_locomotion)((seed + (uint64_t)i / 3) % FF_LOCOMOTION_COUNT),
                         i % 2 == 1);
        if (i % 8 == 0)
            rates = ff_gait_clamp(space, &gait,
                                  (ff_rates){ff_random_range(&random, -1.0, 3.0),
                                             ff_random_range(&random, -0.7, 0.7),
                                             ff_random_range(&random, -2.0, 2.0)});
        position = ff_madd2(position, ff_from_frame2(ff_fwd2(heading), ff_v2(rates.forward, rates.left)),
                            1.0 / 30.0);
        heading += rates.turn / 30.0;
        ff_gait_step(space, &gait, position, heading, rates, 1.0 / 30.0);
        ff_vec3 hips;
        ff_quat rotations[FF_JOINT_COUNT];
        ff_gait_pose(space, &gait, position, heading, &hips, rotations);
        finite = finite && isfinite(hips.x + hips.y + hips.z);
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            finite = finite && fabs(ff_quat_dot(rotations[j], rotations[j]) - 1.0) < 1e-6;
    }
    ff_blend_space_destroy(space);
    return finite;
}

#endif
