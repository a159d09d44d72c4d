/* plan_world.h - a pack's actions and random worlds to plan in, for the tests of plans. Needs _GNU_SOURCE. */
#ifndef FF_TEST_PLAN_WORLD_H
#define FF_TEST_PLAN_WORLD_H

#include "runtime/core/base/random.h"
#include "runtime/core/plan/plan_field.h"
#include "runtime/core/plan/plan_set.h"
#include "runtime/core/plan/plan_solids.h"
#include "tests/built_in_pack.h"

typedef struct plan_world {
    ff_pack *pack;
    ff_action_set *set, *few, *varied; /* the default ones; a handful; these, walking steps at three speeds */
    ff_plan_scratch *scratch, *few_scratch, *varied_scratch;
} plan_world;

static inline int plan_world_open(void **state)
{
    static plan_world w;
    ff_error error;
    FF_ASSERT_OK(ff_pack_open(ff_built_in_pack_path(), &w.pack, &error), error);
    FF_ASSERT_OK(ff_action_set_create(w.pack, 0, &w.set, &error), error);
    FF_ASSERT_OK(ff_action_set_create(w.pack, 24, &w.few, &error), error);
    FF_ASSERT_OK(ff_action_set_create_varied(w.pack, 24, (const double[]){0.75, 1.25}, 2, &w.varied, &error),
                 error);
    FF_ASSERT_OK(ff_plan_scratch_create(w.set, 20000, &w.scratch, &error), error);
    FF_ASSERT_OK(ff_plan_scratch_create(w.few, 40000, &w.few_scratch, &error), error);
    FF_ASSERT_OK(ff_plan_scratch_create(w.varied, 40000, &w.varied_scratch, &error), error);
    *state = &w;
    return 0;
}

static inline int plan_world_close(void **state)
{
    plan_world *w = *state;
    ff_plan_scratch_destroy(w->varied_scratch);
    ff_plan_scratch_destroy(w->few_scratch);
    ff_plan_scratch_destroy(w->scratch);
    ff_action_set_destroy(w->varied);
    ff_action_set_destroy(w->few);
    ff_action_set_destroy(w->set);
    ff_pack_close(w->pack);
    return 0;
}

/* Discs, boxes and walls about a place, clear of its middle. */
enum { PLAN_THINGS = 8 };
static inline ff_solids *plan_things(ff_random *random, double from, double to, int count)
{
    ff_shape shapes[PLAN_THINGS];
    ff_vec2 walls[PLAN_THINGS][2];
    uint32_t shape_count = 0, wall_count = 0;
    for (int i = 0; i < count; ++i) {
        ff_vec2 at =
            ff_scale2(ff_fwd2(ff_random_range(random, -FF_PI, FF_PI)), ff_random_range(random, from, to));
        ff_vec2 along = ff_scale2(ff_fwd2(ff_random_range(random, -FF_PI, FF_PI)), 0.4);
        if (i % 3 == 0) {
            walls[wall_count][0] = ff_sub2(at, along);
            walls[wall_count++][1] = ff_add2(at, along);
        } else
            shapes[shape_count++] =
                (ff_shape){.centre = at,
                           .heading = ff_random_range(random, -FF_PI, FF_PI),
                           .half_length = i % 3 == 1 ? ff_random_range(random, 0.0, 0.4) : 0.0,
                           .half_width = i % 3 == 1 ? 0.15 : 0.0,
                           .radius = i % 3 == 1 ? 0.0 : ff_random_range(random, 0.05, 0.3),
                           .high = 1.0};
    }
    ff_solids *solids;
    ff_error error;
    FF_ASSERT_OK(
        ff_solids_create((const ff_vec2(*)[2])walls, wall_count, shapes, shape_count, &solids, &error),
        error);
    return solids;
}

/* Others who walk about: plans of their own from a ring about the place to the other side. */
static inline uint32_t plan_others(const plan_world *w, ff_random *random, double radius, uint32_t count,
                                   double time, ff_plan *plans, ff_track *tracks, const ff_track **list)
{
    ff_plan_options options = ff_plan_options_default();
    options.inflation_step = 0.0;
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; ++i) {
        double angle = ff_random_range(random, -FF_PI, FF_PI);
        ff_vec2 at = ff_scale2(ff_fwd2(angle), ff_random_range(random, 0.5 * radius, radius));
        ff_plan_stand(w->set, at, ff_random_range(random, -FF_PI, FF_PI), time, &plans[n]);
        ff_plan_track(w->set, &plans[n], time, &tracks[n]);
        bool free_place = true;
        for (uint32_t k = 0; k < n && free_place; ++k)
            free_place = !ff_track_conflict(&tracks[n], &tracks[k], time, 0.1, NULL);
        if (!free_place) continue;
        const ff_plan_world world = {.tracks = list, .track_count = n};
        ff_plan_goal goal = ff_plan_goal_at(ff_scale2(at, -1.0));
        ff_plan_search(w->set, &world, &plans[n], time, &goal, &options, w->scratch, &plans[n]);
        ff_plan_track(w->set, &plans[n], time, &tracks[n]);
        list[n] = &tracks[n];
        ++n;
    }
    return n;
}

#endif
