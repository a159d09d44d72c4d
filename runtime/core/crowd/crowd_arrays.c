#include "runtime/core/crowd/crowd_arrays.h"

#include "runtime/core/crowd/crowd_check.h"
#include "runtime/core/crowd/crowd_state.h"

#include <string.h>

#define ARRAY_ALIGN 64

#define ROW(name, kind, member, check)                                                                       \
    {                                                                                                        \
        name, kind, offsetof(ff_crowd, member), sizeof *((ff_crowd *)0)->member, NULL, check                 \
    }

static bool has_behaviour(const ff_crowd_def *def)
{
    return def->behaviour != NULL;
}

/* Of an array that not every crowd needs, write the row out, with a function for wanted. The order is that of the hash and of saved crowds. */
static const ff_crowd_array arrays[] = {
    ROW("SGEN", FF_ARRAY_SLOT, generation, NULL),
    ROW("SLIV", FF_ARRAY_SLOT, alive, NULL),
    ROW("SFRE", FF_ARRAY_SLOT, next_free, NULL),
    ROW("NUMB", FF_ARRAY_AGENT, number, NULL),
    ROW("TRAI", FF_ARRAY_AGENT, traits, ff_crowd_check_traits),
    ROW("MIND", FF_ARRAY_AGENT, minds, ff_crowd_check_mind),
    ROW("BODY", FF_ARRAY_AGENT, bodies, ff_crowd_check_body),
    ROW("VELO", FF_ARRAY_AGENT, velocity, ff_crowd_check_velocity),
    ROW("GAIT", FF_ARRAY_AGENT, gaits, ff_crowd_check_gait),
    ROW("CHOI", FF_ARRAY_AGENT, choices, ff_crowd_check_choice),
    {"COND", FF_ARRAY_AGENT, offsetof(ff_crowd, conducts), sizeof(ff_conduct), has_behaviour,
     ff_crowd_check_conduct},
    {"fire", FF_ARRAY_STEP, offsetof(ff_crowd, firing), sizeof(uint32_t), has_behaviour, NULL},
    {"STEP", FF_ARRAY_AGENT, offsetof(ff_crowd, steppers), sizeof(ff_stepper), ff_footsteps_wanted,
     ff_crowd_check_stepper},
    ROW("seen", FF_ARRAY_STEP, unsorted, NULL),
    ROW("near", FF_ARRAY_STEP, neighbours, NULL),
    ROW("nnbr", FF_ARRAY_STEP, neighbour_count, NULL),
    ROW("rate", FF_ARRAY_STEP, rates, NULL),
    ROW("live", FF_ARRAY_STEP, live, NULL),
};

uint32_t ff_crowd_array_count(void)
{
    return sizeof arrays / sizeof arrays[0];
}

const ff_crowd_array *ff_crowd_array_at(uint32_t index)
{
    return &arrays[index];
}

static bool wanted(const ff_crowd_array *array, const ff_crowd_def *def)
{
    return !array->wanted || array->wanted(def);
}

void *ff_crowd_array_element(const ff_crowd *crowd, const ff_crowd_array *array, uint32_t slot)
{
    unsigned char *data; /* copied, as the pointers have different types */
    memcpy(&data, (const unsigned char *)crowd + array->pointer, sizeof data);
    return data ? data + slot * array->size : NULL;
}

size_t ff_crowd_arrays_bytes(const ff_crowd_def *def)
{
    size_t bytes = 0;
    for (uint32_t i = 0; i < ff_crowd_array_count(); ++i)
        if (wanted(&arrays[i], def)) bytes += def->max_agents * arrays[i].size + ARRAY_ALIGN;
    return bytes;
}

bool ff_crowd_arrays_init(ff_crowd *crowd, ff_arena *arena)
{
    for (uint32_t i = 0; i < ff_crowd_array_count(); ++i) {
        if (!wanted(&arrays[i], &crowd->def)) continue;
        void *data = ff_arena_push(arena, crowd->def.max_agents, arrays[i].size, ARRAY_ALIGN);
        if (!data) return false;
        memcpy((unsigned char *)crowd + arrays[i].pointer, &data, sizeof data);
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------- hash */

static uint64_t fnv(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *byte = data;
    for (size_t i = 0; i < size; ++i)
        hash = (hash ^ byte[i]) * 0x100000001b3u;
    return hash;
}

uint64_t ff_crowd_state_hash(const ff_crowd *crowd)
{
    uint64_t hash = 0xcbf29ce484222325u;
    hash = fnv(hash, &crowd->steps, sizeof crowd->steps);
    hash = fnv(hash, &crowd->free_first, sizeof crowd->free_first);
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        for (uint32_t i = 0; i < ff_crowd_array_count(); ++i) {
            bool hashed =
                arrays[i].kind == FF_ARRAY_SLOT || (arrays[i].kind == FF_ARRAY_AGENT && crowd->alive[slot]);
            const void *element = hashed ? ff_crowd_array_element(crowd, &arrays[i], slot) : NULL;
            if (element) hash = fnv(hash, element, arrays[i].size);
        }
    }
    return hash;
}
