/* plan_action.h - what a pack's record says to whoever plans with it. */
#ifndef FF_PLAN_ACTION_H
#define FF_PLAN_ACTION_H

#include "runtime/core/pack/pack.h"

#define FF_E_S 2.23 /* J/(kg s): of standing (algorithms B.2) */
#define FF_E_W 1.26 /* J s/(kg m2) */
/* m/s: who is slower loses time, which has a price. As fast as adults walk who are at ease; the cheapest is 1.33. */
#define FF_WALK_SPEED 1.45f

#define FF_PLATFORM_COST 150.0f /* J/kg, of a jump or a duck on top of its energy (algorithms B.2) */
#define FF_ACTION_SHORTEST 0.2f /* s, of an action that can be planned with */
#define FF_ACTION_LONGEST 3.0f

/* What an action leads to. */
typedef enum ff_action_class {
    FF_CLASS_WALK,
    FF_CLASS_STAND,
    FF_CLASS_SIDE_OPEN, /* feet apart, one goes on to the side or closes */
    FF_CLASS_BACK_OPEN
} ff_action_class;

/* Of the pack's records (plan_action.c), for whoever prepares plans: can it be walked on level ground; is it a jump or a duck; its class; what
 * it costs at a pace, J/kg with penalties (algorithms B.2) and with the price of the time that it loses over walking. */
bool ff_action_is_usable(const ff_pack_action *record);
bool ff_action_is_platform(const ff_pack_action *record);
bool ff_action_is_made_up(const ff_pack_action *record); /* a jump or a duck that no clip shows */
ff_action_class ff_action_class_of(const ff_pack_action *record);
float ff_action_cost(const ff_pack_action *record, float pace);

#endif
