/* blend.h - the blend space: walking examples as points of (forward, left, turn), with the simplices between them. */
#ifndef FF_BLEND_H
#define FF_BLEND_H

#include "runtime/core/gait/blend_simplex.h"
#include "runtime/core/gait/gait_model.h"
#include "runtime/core/pack/joints.h"
#include "runtime/core/pose/pose_matrices.h"

#define FF_POSE_LANES 24 /* joints of a pack, rounded up for SIMD */

/* A cycle of steps has four sections. Walking: from left contact, right toe-off, right contact, left toe-off. Running, which
 * has its own order: from left contact, left toe-off, right contact, right toe-off. */
#define FF_GAIT_KEYS 4

/* One example, in doubles and in phase u of [0, 4): section k lasts from key k to key k + 1. */
typedef struct ff_blend_vertex {
    ff_rates rates;
    double period;                        /* s, of a cycle of steps */
    double rate;                          /* frames per second of the stream */
    double key[FF_GAIT_KEYS + 1];         /* fractions of the cycle, the last is 1 */
    double lock_start[2], lock_length[2]; /* u: from where and for how long each ball stands still */
    uint32_t first_frame, frame_count;
    uint32_t idle; /* 1: no steps in it; sampled on the agent's idle clock */
    uint32_t example;
} ff_blend_vertex;

typedef struct ff_blend_face {
    int32_t vertex[3];
    int32_t count;
} ff_blend_face;

/* The part of the pack's skeleton that synthesis computes with. */
typedef struct ff_body_frame {
    ff_vec3 offset[FF_JOINT_COUNT];
    ff_vec3 heel[2], toe[2]; /* in the ankle's and in the ball's frame */
    double thigh[2], shank[2];
    double toe_length[2],
        toe_flat[2]; /* m, and rad up from straight ahead, of the toe tip from the ball, seen from the side */
    double ball_rest; /* m, height of the ball joints when the foot is flat */
} ff_body_frame;
void ff_body_frame_read(const ff_pack *pack, ff_body_frame *out);

/* The simplices of one gait. */
typedef struct ff_blend_region {
    ff_blend_solid *solids;
    uint32_t solid_count;
    ff_blend_face *faces; /* the outside of the solids, and simplices that are flat by themselves */
    uint32_t face_count;
    /* Solids by cell of a coarse grid over their bounds: cell_first[cell] .. cell_first[cell + 1] in cell_solids. */
    ff_vec3 grid_low, grid_scale;
    uint32_t *cell_first, *cell_solids;
} ff_blend_region;

/* The semi-procedural clip, ready to be played (locomotion.c). */
#define FF_MODEL_NODES_FORWARD 12
#define FF_MODEL_NODES_LEFT 5
#define FF_MODEL_NODES_TURN 5
typedef struct ff_clip_model {
    ff_gait_model clip;           /* clip.gait NULL: the pack has none */
    int32_t vertex;               /* whose trunk and arms it has */
    double fastest;               /* m/s ahead */
    double hold[2];               /* shares of the stance between which a ball stands still */
    ff_quat mean[FF_JOINT_HIP_L]; /* of those over the cycle: what is left of them in the smallest steps */
    /* Mean height of the hips by rates, so that the longest reach of a standing leg is FF_LEG_REACH: steps that are
     * small are walked upright, long ones lower (study, section 5). */
    float height[FF_MODEL_NODES_FORWARD][FF_MODEL_NODES_LEFT][FF_MODEL_NODES_TURN];
} ff_clip_model;

struct ff_blend_space {
    const ff_pack *pack;
    ff_body_frame body;
    ff_blend_vertex *vertices; /* walks, then runs */
    ff_vec3 *points;           /* of the vertices */
    uint32_t vertex_count;
    uint32_t walk_count;
    ff_blend_region region[FF_GAIT_COUNT];
    /* Poses of the examples' frames, numbered as FEET is: decoded once, as every agent blends several of them twice a
     * step. Rotations in 16 bits: half the memory of floats, and so more of it near the processor. */
    float (*hips)[3]; /* forward, left, height */
    ff_pose_store poses;
    ff_pose_tree tree;
    float offsets[3 * FF_POSE_LANES]; /* of the tree */
    int32_t idle;                     /* vertex index of the idle example (its rates are zero), or -1 */
    /* rad/s, the most that captured examples turn each joint by, left or right; huge where they do not tell */
    double fastest[FF_JOINT_COUNT];
    ff_quat rest[FF_JOINT_HIP_L]; /* trunk and arms at the start of the idle example, if there is one */
    double neutral[2][3];         /* per foot: forward, left, yaw of its place under a standing body */
    ff_clip_model model;
};

#define FF_BLEND_GRID 16 /* cells per axis */

/* What is played: a blend of up to four examples, or the semi-procedural clip. */
typedef struct ff_blend {
    int32_t vertex[FF_BLEND_MAX]; /* -1: unused; of the clip: whose trunk and arms it has */
    double weight[FF_BLEND_MAX];  /* of poses: w'_i = (w_i / T_i) / sum (w_j / T_j), study section 6 */
    double period;                /* s, of the blended cycle */
    ff_rates rates;               /* what the blend's root does */
    double stance, hips;  /* of the clip: share of the cycle from contact to toe-off; mean height, m */
    uint32_t way, unused; /* FF_BLENDING, ... */
} ff_blend;

/* A blend of nothing. */
void ff_blend_clear(ff_blend *out);
#define FF_BLEND_CHANGE_MOST 2.0 /* from one blend to one of other examples */
/* Lead a blend towards the wanted one, the weights changing by at most `most` in all. From one simplex to the next weights are
 * continuous in the rates, but they may change completely within a few cm/s where simplices are thin, and jump where rates
 * outside of all of them have another nearest place. The blend's own speed and turn stay exact for the weights it has. */
void ff_blend_follow(const ff_blend_space *space, const ff_blend *wanted, double most, ff_blend *blend);
/* Lead the semi-procedural clip, which blend is, towards what it is at the wanted rates, by what is possible in dt s. */
void ff_clip_follow(const ff_blend_space *space, ff_rates wanted, double dt, ff_blend *blend);
/* The blend of walks whose rates are the nearest to target. */
void ff_blend_find(const ff_blend_space *space, ff_rates target, ff_blend *out);
/* The same by any motion that is available (ff_locomotion_available). */
void ff_locomotion_find(const ff_blend_space *space, ff_locomotion way, ff_rates target, ff_blend *out);

/* Parts of ff_blend_space_create: vertex tables from the pack; then the semi-procedural clip, if the pack has one. */
ff_status ff_blend_read_examples(ff_blend_space *space, ff_error *error);
void ff_clip_model_make(ff_blend_space *space);

/* The blend of one gait (FF_GAIT_WALK, FF_GAIT_RUN) whose rates are the nearest to target. */
void ff_blend_find_in(const ff_blend_space *space, int gait, ff_rates target, ff_blend *out);

#endif
