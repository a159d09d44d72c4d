/* cycles.h - gait cycles cut from a motion: left contact to left contact, closed, at constant root rates. */
#ifndef FF_CYCLES_H
#define FF_CYCLES_H

#include "preprocess/examples/example.h"

typedef struct ff_cycles {
    ff_example *items; /* in the order of the clip */
    int count;
    int rejected; /* left contacts that gave no cycle */
} ff_cycles;

/* Every cycle of the clip whose contacts come in the order of a walk or a run and that no clip end disturbs; seam and
 * wander are measured, not judged. Whose clip they are (clip) is for the caller to say. */
ff_status ff_cycles_cut(const ff_cycle_settings *settings, const ff_rig *rig, const ff_motion *motion,
                        const ff_plants *plants, int rest_frames, const char *clip_name, ff_cycles *out,
                        ff_error *error);

/* Cycles made of one step and its mirror image, for clips that show no whole cycle that is fit to be used: marked
 * FF_EXAMPLE_LOOSE. Appended to out, after ff_cycles_cut. The caller frees out after a failure too. */
ff_status ff_cycles_cut_half(const ff_cycle_settings *settings, const ff_rig *rig, const ff_motion *motion,
                             const ff_plants *plants, int rest_frames, const char *clip_name, ff_cycles *out,
                             ff_error *error);

/* Loops of standing still in the clip: at most one, the quietest, of 2 to 4 s. Appended to out. */
ff_status ff_cycles_cut_idle(const ff_cycle_settings *settings, const ff_rig *rig, const ff_motion *motion,
                             const ff_plants *plants, int rest_frames, const char *clip_name, ff_cycles *out,
                             ff_error *error);
void ff_cycles_free(ff_cycles *cycles);

#endif
