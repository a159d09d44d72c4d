/* generator.h - the built-in clips: people who walk, made from measured gait without any file.
 *
 * Feet are planned first (exact plants in world space: heel strike, roll, flat, heel off, toe off), the pelvis follows
 * measured curves, legs are solved to the feet, trunk and arms move by the curves of the mean walker or of one
 * measured person. Everything is deterministic: the same options give the same bits.
 *
 * The measured curves come from the CMU Graphics Lab Motion Capture Database. The data used in this project was
 * obtained from mocap.cs.cmu.edu. The database was created with funding from NSF EIA-0196217.
 */
#ifndef FF_GENERATOR_H
#define FF_GENERATOR_H

#include "mocap/clip.h"

/* What a catalogue says of a clip. Strings are constant. */
typedef struct ff_generator_info {
    const char *name;           /* "walk-normal" */
    const char *description;    /* one line */
    const char *tags;           /* space-separated */
    const char *mode;           /* "walk", "run", "jump", "turn", "crouch", "idle" */
    double forward, left, turn; /* m/s, m/s, rad/s of a clip that keeps one pace throughout, else 0 */
    bool steady;                /* keeps one pace: at least four equal cycles */
} ff_generator_info;

typedef struct ff_generator_options {
    int person;    /* 0 = the mean walker, up to ff_generator_people() - 1 = one measured person */
    uint64_t seed; /* of noise and idle sway */
    /* What real capture has; all 0 = none. */
    double noise_mm; /* random displacement of the joints, standard deviation */
    double skate_cm; /* drift of a foot during its stance */
    double floor_cm; /* height of the floor */
    double tilt_deg; /* slope of the floor along z */
    double missing;  /* share of frames that repeat the frame before */
} ff_generator_options;

/* The truth about one stretch of a foot on the ground. Frames count from 0, both ends inclusive: start = first frame
 * with any part of the foot on the floor and no longer coming down, end = last frame before the last part leaves;
 * from flat_start to flat_end heel and ball are still, from ball_start to ball_end the ball is. A stretch outside the
 * clip is -1, -1. */
typedef struct ff_true_plant {
    int foot; /* 0 left, 1 right */
    int start, end;
    int flat_start, flat_end;
    int ball_start, ball_end;
    bool cut_start, cut_end; /* the plant goes on beyond the clip */
    ff_vec3 ball;            /* m, while flat */
    double yaw;              /* rad, heel to ball, while flat */
} ff_true_plant;

typedef struct ff_generated {
    ff_clip clip;
    ff_true_plant *plants; /* by start, then end */
    int plant_count;
} ff_generated;

int ff_generator_count(void);
ff_generator_info ff_generator_describe(int index); /* 0 <= index < ff_generator_count() */
int ff_generator_find(const char *name);            /* index or -1 */
int ff_generator_people(void);

/* Make clip index; options may be NULL. The caller frees *out with ff_generated_free. */
ff_status ff_generator_make(int index, const ff_generator_options *options, ff_generated *out,
                            ff_error *error);
void ff_generated_free(ff_generated *generated);

/* `footfall-pack generate`: write the clips, the truth about their plants (plants.csv) and a catalogue of them into a
 * folder. Returns the exit status. */
int ff_generate_command(int argc, char **argv);

#endif
