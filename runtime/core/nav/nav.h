/* nav.h - one agent's decision: which velocity to ask of the body, and where to face (motion-constrained navigation,
 * FbCrowd section 4, in the formulation of the navigation study, section 4). */
#ifndef FF_NAV_H
#define FF_NAV_H

#include "runtime/core/nav/nav_grid.h"
#include "runtime/core/nav/nav_hull.h"
#include "runtime/core/nav/nav_movers.h"
#include "runtime/core/nav/nav_stance.h"
#include "runtime/core/nav/nav_walls.h"

/* Above this preferred speed (m/s) people run where they can. */
#define FF_RUN_PREFERRED 2.2

/* What navigation does not change from step to step. */
typedef struct ff_traits {
    ff_vec2 goal;           /* m */
    double goal_tolerance;  /* m */
    double preferred_speed; /* m/s */
    double radius;          /* m */
    uint32_t navigation;    /* FF_NAVIGATION_MCN, _ORCA or _SF */
    uint32_t synthesis;     /* FF_SYNTHESIS_BLENDING, _SEMI_PROCEDURAL or _HYBRID */
    ff_vec2 face_at;        /* m, or a direction: where to look while standing */
    uint32_t face;          /* FF_FACE_FREE, _POINT or _HEADING */
    uint32_t unused;
} ff_traits;

/* Walks to its goal; stands at it; stands as near to it as others let it. */
enum { FF_WALKS, FF_STANDS, FF_SETTLED };

/* What navigation remembers of one agent. Plain, without padding: it is hashed as bytes. */
typedef struct ff_mind {
    ff_vec2 command;    /* m/s, what was asked for last */
    ff_vec2 preferred;  /* m/s, before any regard for others; of one who stands: to where he makes way */
    double facing;      /* rad, where the body shall face */
    double bias;        /* 0..1, how far the side preference has been eased in */
    double sharp_side;  /* turn in progress: +1 left, -1 right, 0 none */
    double best;        /* m, least distance to the goal so far */
    double stalled;     /* s since best improved; standing short of the goal: s since settling */
    double detour;      /* rad by which the way is turned now */
    double detour_left; /* s */
    double strafing;    /* s of side-stepping, or, negative, until it is allowed again (nav_facing.h) */
    ff_vec2 measured;   /* m/s, of the root as seen from outside: what baselines go by */
    ff_stance_memory stance;
    uint32_t detours;  /* how many were tried for this goal */
    uint32_t standing; /* FF_WALKS, FF_STANDS or FF_SETTLED */
} ff_mind;

/* Shared by all agents during a step; read only. */
typedef struct ff_nav_world {
    const ff_grid *grid;
    const ff_walls *walls;
    const ff_hull *hull;
    const ff_mcn_def *mcn;
    double step; /* s */
    /* As the agent's method has them: */
    double keep_right;    /* rad, by which people turn aside for those they meet; negative = to the left */
    double padding;       /* m per disc, in forces and constraints */
    const ff_path *paths; /* by slot, of those who are firm; NULL: nobody is */
    const ff_nav_mover *movers; /* obstacles that move */
    uint32_t mover_count;
} ff_nav_world;

/* What synthesis has made of the last decision. */
typedef struct ff_nav_body {
    double heading; /* rad */
    ff_stance stance;
} ff_nav_body;

ff_mind ff_mind_new(double heading);
/* The goal has changed. */
void ff_mind_forget_goal(ff_mind *mind);

/* What ORCA takes an agent to be doing, for itself and for others: midway between what it was asked for and what it does.
 * Of one who brakes at its goal a little less: who follows closely would otherwise wait for it to slow down, and it for
 * room to do so, and both would walk on past the goal. */
ff_vec2 ff_nav_reference(const ff_mcn_def *mcn, const ff_traits *traits, const ff_mind *mind,
                         ff_vec2 position, ff_vec2 velocity);

/* Decide for grid->seen[self] with these neighbours (from ff_grid_neighbours): updates mind. */
void ff_nav_step(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours, uint32_t count,
                 const ff_traits *traits, const ff_nav_body *body, ff_mind *mind);

#endif
