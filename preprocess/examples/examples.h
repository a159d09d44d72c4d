/* examples.h - which of all the cycles found the pack walks with. */
#ifndef FF_EXAMPLES_H
#define FF_EXAMPLES_H

#include "preprocess/examples/cycles.h"
#include "preprocess/examples/gait_fit.h"

#define FF_EXAMPLES_MAX_WALKS 60
#define FF_EXAMPLES_MAX_RUNS 20

/* A cycle that was not good enough. */
typedef struct ff_left_out {
    char name[96], why[96];
} ff_left_out;

/* What the straight walk of a set that everything else is made from had to be taken from. */
typedef enum ff_example_level {
    FF_LEVEL_FIRM, /* a whole cycle that closes well */
    FF_LEVEL_HALF, /* one step and its mirror image */
    FF_LEVEL_LOOSE /* either, although it closes badly */
} ff_example_level;

typedef struct ff_example_set {
    /* idle first, then walks, then runs, each by rates; mirrored copies follow their original */
    ff_example *items;
    int count;
    int base;       /* subject whose cycles come first, -1 = none */
    int candidates; /* cycles that were good enough to choose from */
    ff_example_level level;
    ff_gait_fit gait; /* the semi-procedural clip */
    ff_left_out *left_out;
    int left_out_count;
} ff_example_set;

/* Choose from the cycles of every clip (whose subject is subject[clip]) a set that covers as many rates as the clips
 * show, the same to the left as to the right; make up what is missing and walking needs: standing, stepping in place,
 * turning in place, side steps, slow and backward walks. Chosen cycles move out of cycles. When no whole straight walk is
 * good enough, the next level's are taken and marked FF_EXAMPLE_LOOSE. Fails with FF_ERR_NO_DATA, saying what there is
 * instead, when there is no straight walk at all. */
ff_status ff_examples_select(const ff_example_settings *settings, const ff_rig *rig, ff_cycles *cycles,
                             const int *subject, int clip_count, ff_example_set *out, ff_error *error);
void ff_example_set_free(ff_example_set *set);

#endif
