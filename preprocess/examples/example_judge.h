/* example_judge.h - is a gait cycle good enough to walk with, and if not, why? */
#ifndef FF_EXAMPLE_JUDGE_H
#define FF_EXAMPLE_JUDGE_H

#include "preprocess/examples/example.h"

/* What closing a cycle may do, unless the settings say otherwise: m. Straight walks close better than anything else. */
#define FF_LOOP_JUMP 0.001
#define FF_LOOP_MOVED_STRAIGHT 0.02
#define FF_LOOP_MOVED 0.05

/* Straight ahead or back, without turning. */
bool ff_example_is_straight(const ff_example *example);

/* A walk straight ahead that is fast enough to make other gaits from, if it is good enough. */
#define FF_MODEL_SLOWEST 0.5f /* m/s */
bool ff_example_is_model(const ff_example *example);

/* May the pack use it? If not, why is a sentence with the figure that is too high or too low. */
bool ff_example_judge(const ff_example_settings *settings, const ff_rig *rig, const ff_example *example,
                      char *why, size_t size);
/* The same with the wider limits for want of anything better (FF_EXAMPLE_LOOSE): straight walks only. */
bool ff_example_judge_loosely(const ff_example_settings *settings, const ff_rig *rig,
                              const ff_example *example, char *why, size_t size);

#endif
