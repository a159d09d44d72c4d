/* cycles_make.h - the walking cycles of a generated clip on its own rig, for the tests of what examples are made of. */
#ifndef FF_CYCLES_MAKE_H
#define FF_CYCLES_MAKE_H

#include "preprocess/examples/cycles.h"
#include "tests/preprocess/motion_make.h"

typedef struct made_cycles {
    ff_rig rig;
    made_motion made;
    ff_cycles cycles;
} made_cycles;

static inline ff_cycles cut_cycles(const ff_rig *rig, const made_motion *made)
{
    ff_cycles cycles;
    ff_error error;
    FF_ASSERT_OK(ff_cycles_cut(&standard()->cut.cycles, rig, &made->motion, &made->plants, 0, made->clip.name,
                               &cycles, &error),
                 error);
    return cycles;
}

static inline made_cycles make_cycles(const char *name)
{
    made_cycles of;
    ff_clip clip = generated_clip(name);
    of.rig = rig_of(&clip);
    of.made = make_motion(&of.rig, clip);
    of.cycles = cut_cycles(&of.rig, &of.made);
    return of;
}

static inline void made_cycles_free(made_cycles *of)
{
    ff_cycles_free(&of->cycles);
    made_motion_free(&of->made);
}

#endif
