/* play_walk.h - random chains of actions, played: what the poses say, frame by frame. Needs _GNU_SOURCE. */
#ifndef FF_TEST_PLAY_WALK_H
#define FF_TEST_PLAY_WALK_H

#include "runtime/core/base/random.h"
#include "runtime/core/plan/plan_action.h"
#include "runtime/core/play/play.h"
#include "tests/built_in_pack.h"

typedef struct play_world {
    ff_pack *pack;
    ff_blend_space *space;
    ff_play_set *set;
    uint32_t stand; /* an action that only stands */
} play_world;

static inline int play_world_open(void **state, const char *path)
{
    static play_world w;
    ff_error error;
    memset(&w, 0, sizeof w);
    FF_ASSERT_OK(ff_pack_open(path, &w.pack, &error), error);
    FF_ASSERT_OK(ff_blend_space_create(w.pack, &w.space, &error), error);
    FF_ASSERT_OK(ff_play_set_create(w.pack, w.space, &w.set, &error), error);
    while (w.stand < w.pack->action_count && w.pack->actions[w.stand].mode != FF_MODE_IDLE)
        ++w.stand;
    assert_true(w.stand < w.pack->action_count);
    *state = &w;
    return 0;
}

static inline int play_world_close(void **state)
{
    play_world *w = *state;
    ff_play_set_destroy(w->set);
    ff_blend_space_destroy(w->space);
    ff_pack_close(w->pack);
    return 0;
}

/* Where all joints are in the world, and how they are turned from their parents. */
typedef struct play_frame {
    ff_vec3 at[FF_JOINT_COUNT];
    ff_quat local[FF_JOINT_COUNT];
    ff_vec3 heel[2];
} play_frame;

static inline play_frame play_look(const play_world *w, const ff_play *play, double time)
{
    play_frame frame;
    ff_vec3 hips;
    ff_quat world[FF_JOINT_COUNT];
    ff_play_pose(w->set, play, time, &hips, frame.local);
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        int parent = ff_joint_parents[j];
        world[j] = parent < 0 ? frame.local[j] : ff_quat_mul(world[parent], frame.local[j]);
        frame.at[j] =
            parent < 0 ? hips
                       : ff_add3(frame.at[parent], ff_quat_rotate(world[parent], w->space->body.offset[j]));
    }
    for (int foot = 0; foot < 2; ++foot) {
        int ankle = FF_JOINT_ANKLE_L + foot * FF_JOINT_LEG_STRIDE;
        frame.heel[foot] = ff_add3(frame.at[ankle], ff_quat_rotate(world[ankle], w->space->body.heel[foot]));
    }
    return frame;
}

static inline ff_vec3 play_ball(const play_frame *frame, int foot)
{
    return frame->at[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
}

/* A chain of actions: each follows the one before by the pack's own list, on the foot that stands. */
typedef struct play_chain {
    ff_random random;
    ff_play_foot feet[2];
    double heading, time;
    uint32_t last;
    bool vary; /* walking steps at three quarters to five quarters of their speed */
} play_chain;

static inline bool play_may_follow(const ff_pack_action *action)
{
    bool platform =
        action->mode == FF_MODE_JUMP || action->mode == FF_MODE_CROUCH || action->mode == FF_MODE_CLIMB;
    /* Idling is not stepped into: who waits stands (plan_set.c). */
    return !platform && action->mode != FF_MODE_RUN && action->mode != FF_MODE_IDLE && action->rise == 0.0f;
}

static inline void play_chain_begin(const play_world *w, ff_play *play, play_chain *chain, uint64_t seed)
{
    ff_play_order stand = {.action = w->stand, .pace = 1.0};
    ff_play_init(w->set, play, &stand, 0.0, (double)seed);
    *chain =
        (play_chain){.random = {seed, 7, 0}, .heading = play->step[0].heading, .time = 0.5, .last = w->stand};
    chain->feet[0] = play->step[0].foot[0];
    chain->feet[1] = play->step[0].foot[1];
}

static inline double play_chain_pace(play_chain *chain, const ff_pack_action *action)
{
    bool walks = action->mode == FF_MODE_WALK_SHORT || action->mode == FF_MODE_WALK_LONG;
    uint32_t ends = FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING;
    return chain->vary && walks && !(action->flags & ends) ? ff_random_range(&chain->random, 0.75, 1.25)
                                                           : 1.0;
}

/* The next action; false where the pack has none that can be walked. */
static inline bool play_chain_next(const play_world *w, ff_play *play, play_chain *chain, ff_play_order *out)
{
    const ff_pack_action *last = &w->pack->actions[chain->last];
    uint32_t list[1024], count = 0; /* but what was made up for danger */
    for (uint32_t k = 0; k < last->successor_count && count < 1024; ++k) {
        uint32_t next = w->pack->successors[last->first_successor + k].action;
        if (!ff_action_is_made_up(&w->pack->actions[next])) list[count++] = next;
    }
    for (int tries = 0; tries < 200 && count > 0; ++tries) {
        uint32_t next = list[(uint32_t)(ff_random_unit(&chain->random) * count)];
        const ff_pack_action *action = &w->pack->actions[next];
        if (!play_may_follow(action) || !chain->feet[action->support].planted) continue;
        const ff_play_foot *foot = &chain->feet[action->support];
        *out = (ff_play_order){
            next, 0, chain->time, play_chain_pace(chain, action), {foot->a, foot->b}, chain->heading};
        ff_play_next(w->set, play, out);
        ff_play_feet_after(w->set, &play->step[1], chain->feet);
        chain->heading += (double)action->theta;
        chain->time += w->set->actions[next].duration / out->pace;
        chain->last = next;
        return true;
    }
    return false;
}

#endif
