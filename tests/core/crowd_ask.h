/* crowd_ask.h - what the public interface says of an agent who is there. */
#ifndef FF_TEST_CROWD_ASK_H
#define FF_TEST_CROWD_ASK_H

#include "runtime/footfall.h"
#include "tests/check.h"

static inline ff_agent_state state_of(const ff_crowd *crowd, ff_agent agent)
{
    ff_agent_state state;
    ff_error error;
    FF_ASSERT_OK(ff_crowd_agent_state(crowd, agent, &state, &error), error);
    return state;
}

#endif
