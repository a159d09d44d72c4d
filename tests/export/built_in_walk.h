/* built_in_walk.h - walkers on the built-in pack, seen through poses. Needs _GNU_SOURCE. */
#ifndef FF_TEST_BUILT_IN_WALK_H
#define FF_TEST_BUILT_IN_WALK_H

#include "runtime/core/gait/synth_state.h"
#include "runtime/export/gait_meter.h"
#include "tests/built_in_pack.h"

typedef struct built_in {
    ff_pack *pack;
    ff_blend_space *space;
    ff_figure figure;
} built_in;

static inline int built_in_open(void **state)
{
    static built_in all;
    ff_error error;
    FF_ASSERT_OK(ff_pack_open(ff_built_in_pack_path(), &all.pack, &error), error);
    FF_ASSERT_OK(ff_blend_space_create(all.pack, &all.space, &error), error);
    FF_ASSERT_OK(ff_figure_from_pack(all.pack, &all.figure, &error), error);
    *state = &all;
    return 0;
}

static inline int built_in_close(void **state)
{
    built_in *all = *state;
    ff_blend_space_destroy(all->space);
    ff_pack_close(all->pack);
    return 0;
}

typedef struct built_in_walker {
    const ff_blend_space *space;
    ff_gait gait;
    ff_vec2 position;
    double heading;
    ff_rates rates;
} built_in_walker;

static inline void built_in_begin(const built_in *all, built_in_walker *w, uint64_t variation)
{
    *w = (built_in_walker){.space = all->space};
    ff_gait_init(w->space, &w->gait, w->position, w->heading, variation);
}

/* Towards these rates, 2 m/s2 and 4 rad/s2 at most; the root moves by exactly what results. */
static inline void built_in_go(built_in_walker *w, ff_rates wanted, double dt)
{
    ff_rates *now = &w->rates;
    now->forward += ff_clamp(wanted.forward - now->forward, -2.0 * dt, 2.0 * dt);
    now->left += ff_clamp(wanted.left - now->left, -2.0 * dt, 2.0 * dt);
    now->turn += ff_clamp(wanted.turn - now->turn, -4.0 * dt, 4.0 * dt);
    *now = ff_gait_clamp(w->space, &w->gait, *now);
    ff_vec2 ahead = ff_fwd2(w->heading + 0.5 * now->turn * dt);
    w->position = ff_madd2(w->position, ff_from_frame2(ahead, ff_v2(now->forward, now->left)), dt);
    w->heading += now->turn * dt;
    ff_gait_step(w->space, &w->gait, w->position, w->heading, *now, dt);
}

static inline void built_in_pose(const built_in_walker *w, ff_vec3 *hips, ff_quat *rotations)
{
    ff_gait_pose(w->space, &w->gait, w->position, w->heading, hips, rotations);
}

#endif
