/* crowd_check.h - is what was read of an agent usable? After this nothing has to check again: whatever passes may be ugly,
 * but steps and poses are safe. One function for each array of agents' state (crowd_arrays.c). */
#ifndef FF_CROWD_CHECK_H
#define FF_CROWD_CHECK_H

#include "runtime/core/crowd/crowd_arrays.h"

/* NULL, or what is wrong with an element and at which of its bytes. */
const char *ff_crowd_check_traits(const ff_crowd *crowd, const void *element, size_t *byte);
const char *ff_crowd_check_mind(const ff_crowd *crowd, const void *element, size_t *byte);
const char *ff_crowd_check_body(const ff_crowd *crowd, const void *element, size_t *byte);
const char *ff_crowd_check_velocity(const ff_crowd *crowd, const void *element, size_t *byte);
const char *ff_crowd_check_choice(const ff_crowd *crowd, const void *element, size_t *byte);
const char *ff_crowd_check_conduct(const ff_crowd *crowd, const void *element, size_t *byte);
const char *ff_crowd_check_gait(const ff_crowd *crowd, const void *element, size_t *byte);
const char *ff_crowd_check_stepper(const ff_crowd *crowd, const void *element,
                                   size_t *byte); /* crowd_check_step.c */

/* The bytes [from, to) of an element hold doubles: whether all of them lie in [low, high]; else *byte tells the first that
 * does not. */
bool ff_crowd_doubles_fit(const void *element, size_t from, size_t to, double low, double high, size_t *byte);

#endif
