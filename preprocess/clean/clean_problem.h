/* clean_problem.h - the least-squares problem of the clean-up: what is known at each knot, what is wanted, and the
 * terms whose squares are summed. The solver behind it is met in clean_ceres.cpp alone.
 *
 * All terms are divided by how far off each may be (cleanup study, section 3.4); those that occur once per knot also
 * count by the time between knots, so that the rate of the knots makes no difference. */
#ifndef FF_CLEAN_PROBLEM_H
#define FF_CLEAN_PROBLEM_H

#include "preprocess/clean/clean_foot.h"

/* A foot in its place on the ground. */
typedef struct ff_clean_plant {
    double at[FF_CLEAN_PLANT];       /* where it is now: x, z of the ball, direction heel to ball */
    double tied[FF_CLEAN_PLANT];     /* where the clip has it */
    double heel_height, ball_height; /* m, of the two points when planted */
    bool settled;                    /* its place is not to change any more */
} ff_clean_plant;

typedef struct ff_clean_knot {
    ff_clean_pose pose;      /* as captured */
    int plant[2];            /* of the problem's, or -1 */
    double heel[2], ball[2]; /* how much the points are pinned, 0 to 1 */
    double ground[2];        /* m, height that a planted point has where the foot is */
    bool near_ground[2];
} ff_clean_knot;

typedef struct ff_clean_problem {
    const ff_rig *rig;
    const ff_clean_settings *settings;
    double knot_time; /* s */
    int knot_count, plant_count;
    ff_clean_knot *knots;
    ff_clean_plant *plants;
    double (*root)[FF_CLEAN_ROOT];   /* [knot_count] changes, the unknowns */
    double (*legs)[2][FF_CLEAN_LEG]; /* [knot_count] */
} ff_clean_problem;

typedef struct ff_clean_solution {
    int iterations;
    bool converged;
    double cost; /* half the sum of the squares */
} ff_clean_solution;

#ifdef __cplusplus
extern "C" {
#endif

/* Solve for knots [first, last) and the plants they touch. The first settled of them are known and stay. */
ff_status ff_clean_solve(ff_clean_problem *problem, int first, int last, int settled, ff_clean_solution *out,
                         ff_error *error);

/* -------------------------------------------------------------------------------------------- the terms, for tests */

/* Slopes are row-major, [residual][unknown]; any of them, or the list, may be NULL (as Ceres has it). */

/* Ball and heel from their places in the plant: 6 residuals of root, leg and plant. */
void ff_clean_pin_term(const ff_clean_problem *problem, int knot, int side, const double *root,
                       const double *leg, const double *plant, double *residuals, double **slopes);
/* Heel, ball and toe under the ground: 3 residuals of root and leg. */
void ff_clean_ground_term(const ff_clean_problem *problem, int knot, int side, const double *root,
                          const double *leg, double *residuals, double **slopes);
/* Knee bent too little or the wrong way: 1 residual of leg. */
void ff_clean_knee_term(const ff_clean_problem *problem, int knot, int side, const double *leg,
                        double *residuals, double **slopes);

/* 1 / sigma of each unknown: for staying where it was, and for its second derivative. Times ff_clean_knot_weight. */
extern const double ff_clean_root_close[FF_CLEAN_ROOT], ff_clean_root_smooth[FF_CLEAN_ROOT];
extern const double ff_clean_leg_close[FF_CLEAN_LEG], ff_clean_leg_smooth[FF_CLEAN_LEG];
double ff_clean_knot_weight(const ff_clean_problem *problem);
/* The same of a plant, for staying where the clip has it. */
void ff_clean_plant_tie(const ff_clean_problem *problem, double out[FF_CLEAN_PLANT]);

#ifdef __cplusplus
}
#endif
#endif
