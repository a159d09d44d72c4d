/* plan.h - where the body goes and where each foot stands: everything of a clip that is decided before a pose is made.
 *
 * A plan starts from two things: rates of the root over time (knots) and the times of foot contacts. The root path is
 * the integral of the rates; each footprint is where the root is in the middle of that foot's stance, plus half the
 * step width; so feet always suit the path, in straight walks, curves, side steps, turns in place, starts and stops.
 */
#ifndef FF_PLAN_H
#define FF_PLAN_H

#include "runtime/core/base/maths.h"

enum { FF_PLAN_MAX_KNOTS = 16, FF_PLAN_MAX_CONTACTS = 72, FF_PLAN_RATE = 480 };

/* How this clip differs from the usual gait at its speed. */
typedef struct ff_plan_style {
    bool run;
    bool backward;    /* to be played in reverse: quick rolls, since toes touch and heels leave at once */
    double sink;      /* m, hips lower than usual (crouch) */
    double bend;      /* rad, trunk further forward */
    double arms;      /* arm swing relative to the measured one */
    double widen;     /* m, added to the step width */
    double toe_out;   /* rad */
    double shift;     /* m, weight shifted from leg to leg in a stand */
    double breathing; /* size of breathing and idle sway, 1 = a calm person */
    double side;      /* 1, or -1 in a clip of the other side: sway mirrors too */
    int person;       /* whose curves, 0 = the mean walker */
    uint64_t seed;    /* idle sway differs by seed */
} ff_plan_style;

typedef struct ff_rate_knot {
    double t;                   /* s */
    double forward, left, turn; /* m/s, m/s, rad/s */
} ff_rate_knot;

typedef struct ff_contact {
    double t; /* s */
    int foot; /* 0 left, 1 right */
} ff_contact;

typedef struct ff_root {
    ff_vec2 position; /* m */
    double heading;   /* rad, unwrapped */
    double forward, left, turn;
} ff_root;

/* One stretch of a foot on the ground. */
typedef struct ff_footing {
    double contact;                      /* s: the foot has come down */
    double flat;                         /* s: sole flat and still from here ... */
    double heel_off;                     /* ... to here */
    double release;                      /* s: the ball is still until here */
    double toe_off;                      /* s: the toes have left */
    ff_vec2 ball;                        /* m, from flat to release */
    double yaw;                          /* rad, while flat */
    double twist;                        /* rad, turned about the ball while the heel is up */
    double pitch_contact, pitch_release; /* rad, toes up + */
    double speed;                        /* m/s, of the root about this time */
    /* The swing that ends in this footing: raised and carried outward by so much at its middle, m. */
    double lift, aside;
} ff_footing;

/* A whole-body gesture over time (a jump): the hips rise by a cubic through values and rates, the rest monotonically. */
typedef struct ff_gesture {
    double t;          /* s */
    double rise, rate; /* m over the usual height, m/s */
    double bend, arms; /* rad: trunk forward, both upper arms forward */
} ff_gesture;

typedef struct ff_plan {
    ff_plan_style style;
    ff_rate_knot knots[FF_PLAN_MAX_KNOTS];
    int knot_count;
    ff_contact contacts[FF_PLAN_MAX_CONTACTS]; /* alternating feet, by time */
    int contact_count;
    bool stand_first;  /* the first two contacts are a stand from ever before */
    bool stand_last;   /* the last two never end */
    double begin, end; /* s, of the root table */
    ff_gesture gestures[FF_PLAN_MAX_KNOTS];
    int gesture_count;
    bool jump; /* the feet leave and land together */

    /* Filled by ff_plan_finish. */
    ff_root *roots; /* FF_PLAN_RATE per second from begin */
    int root_count;
    ff_footing footings[2][FF_PLAN_MAX_CONTACTS];
    int footing_count[2];
} ff_plan;

/* Integrate the root and place the feet. False when memory is short. */
bool ff_plan_finish(ff_plan *plan);
void ff_plan_free(ff_plan *plan);

/* Root at any time (clamped to the table). */
ff_root ff_plan_root(const ff_plan *plan, double t);

/* The gesture at a time; all zero when the plan has none. */
ff_gesture ff_plan_gesture(const ff_plan *plan, double t);

/* Gait phase: whole numbers are left contacts, halves right ones. */
double ff_plan_phase(const ff_plan *plan, double t);

/* A point given in the root's frame at t: (forward, left) to plane coordinates and back. */
ff_vec2 ff_plan_to_world(const ff_root *root, ff_vec2 local);
ff_vec2 ff_plan_to_local(const ff_root *root, ff_vec2 world);

/* Cubic on [0, 1] with these end values and end slopes. */
double ff_hermite(double u, double p0, double p1, double m0, double m1);

/* Monotone cubic interpolation (Fritsch and Carlson 1980) through count points (x ascending), constant outside. */
double ff_monotone(const double *x, const double *y, int count, double at);

#endif
