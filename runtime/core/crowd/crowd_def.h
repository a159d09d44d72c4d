/* crowd_def.h - are the definitions of crowds and agents fit to be used? Every refusal says what was expected. */
#ifndef FF_CROWD_DEF_H
#define FF_CROWD_DEF_H

#include "runtime/core/crowd/crowd_state.h"

/* what: the name the caller knows the value by, with its unit. */
ff_status ff_check_between(double value, double low, double high, const char *what, ff_error *error);
ff_status ff_crowd_check_def(const ff_pack *pack, const ff_crowd_def *def, ff_error *error);
ff_status ff_agent_check_def(const ff_crowd *crowd, const ff_agent_def *def, ff_error *error);

#endif
