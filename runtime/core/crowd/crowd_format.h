/* crowd_format.h - a saved crowd, byte by byte: a file made of sections as packs are (pack_format.h), little-endian, records
 * without padding. One section for each array of state in crowd_arrays.c, under its name there: of every slot ever used, or
 * of the living agents in the order of their slots. All that a crowd needs to go on is in it but the pack. */
#ifndef FF_CROWD_FORMAT_H
#define FF_CROWD_FORMAT_H

#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/pack/sections.h"

#define FF_CROWD_MAGIC 0x57524344544f4f46u /* "FOOTDCRW" read as a little-endian u64 */
#define FF_CROWD_VERSION 1u

enum {
    FF_SECTION_CROWD_HEAD = FF_TAG('H', 'E', 'A', 'D'),  /* ff_saved_head: one */
    FF_SECTION_CROWD_DEF = FF_TAG('C', 'D', 'E', 'F'),   /* ff_saved_def: one */
    FF_SECTION_CROWD_WALL = FF_TAG('W', 'A', 'L', 'L'),  /* ff_saved_wall */
    FF_SECTION_CROWD_SPAWN = FF_TAG('S', 'P', 'W', 'N'), /* ff_spawning: one for each spawner */
    FF_SECTION_CROWD_SHOWN = FF_TAG('S', 'H', 'O', 'W'), /* uint32_t: one for each signal */
    FF_SECTION_CROWD_OBST = FF_TAG('O', 'B', 'S', 'T'),  /* ff_crowd_obstacle */
};

/* Where they are in the list of sections. */
enum {
    FF_SAVED_HEAD,
    FF_SAVED_DEF,
    FF_SAVED_WALLS,
    FF_SAVED_SPAWNING,
    FF_SAVED_SHOWN,
    FF_SAVED_OBSTACLES,
    FF_SAVED_BEHAVIOUR,
    FF_SAVED_ARRAYS = FF_SAVED_BEHAVIOUR + FF_BEHAVIOUR_ARRAYS
};

typedef struct ff_saved_head {
    uint64_t pack_checksum, pack_size; /* of the pack it walks on */
    uint64_t steps;
    uint64_t added, spawned, left;
    uint32_t agent_count, slot_count, free_first, unused;
    ff_fault fault;
} ff_saved_head;

typedef struct ff_saved_def {
    double step; /* s */
    uint64_t seed;
    uint32_t max_agents, max_walls;
    uint32_t navigation, facing;
    uint32_t mcn_parts; /* bit n: the n-th switch of ff_mcn_def */
    uint32_t model_velocity;
    uint32_t synthesis;
    uint32_t behaviour; /* 1: there is one, in sections of its own */
    double keep_right;  /* rad */
    double body_scale;
    double padding, prediction; /* m, s */
    double baseline_keep_right, baseline_padding;
    double plan_seconds, plan_expiry, plan_margin, proximity_cost; /* s, s, m, J/(kg s) */
    uint32_t planner, footsteps;                                   /* bits of the latter: mixed, paper */
    uint32_t nodes, plans, actions, expiry_actions, max_obstacles, unused_too;
    double speed_variations[FF_SPEED_VARIATIONS_MAX];
} ff_saved_def;

typedef struct ff_saved_wall {
    ff_vec2 from, to; /* m */
} ff_saved_wall;

/* The kinds of sections: the fixed ones above in their order, the arrays of the behaviour's definition, the arrays of
 * state. Returns their number. */
uint32_t ff_crowd_section_kinds(ff_section_kind kinds[FF_SECTIONS_MAX]);
ff_section_format ff_crowd_file_format(const ff_section_kind *kinds, uint32_t count);

ff_saved_def ff_crowd_def_pack(const ff_crowd_def *def);
/* False when a number that stands for one of several things stands for none. */
bool ff_crowd_def_unpack(const ff_saved_def *saved, ff_crowd_def *out);

#endif
