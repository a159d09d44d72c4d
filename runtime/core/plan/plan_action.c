#include "runtime/core/plan/plan_action.h"

#include "runtime/core/plan/plan.h"

static const float RUN_FACTOR = 1.3f, CROSS_FACTOR = 1.1f; /* algorithms B.2 */
static const double CROSS = -20.0 * FF_DEG;
static const float FLAT = 0.05f, LEVEL = 0.03f; /* m: heights and rises that pass for level ground */

bool ff_action_is_platform(const ff_pack_action *r)
{
    return r->mode == FF_MODE_JUMP || r->mode == FF_MODE_CROUCH || r->mode == FF_MODE_CLIMB;
}

bool ff_action_is_made_up(const ff_pack_action *r)
{
    return ff_action_is_platform(r) && (r->flags & FF_ACTION_DERIVED);
}

bool ff_action_is_usable(const ff_pack_action *r)
{
    return r->mode != FF_MODE_CLIMB && fabsf(r->height) < FLAT && fabsf(r->rise) < LEVEL &&
           r->duration >= FF_ACTION_SHORTEST && r->duration <= FF_ACTION_LONGEST &&
           r->collider_samples >= 2 && r->energy >= 0.0f && r->speed >= 0.0f && r->support != r->swing;
}

ff_action_class ff_action_class_of(const ff_pack_action *r)
{
    if (r->flags & FF_ACTION_TO_STANDING) return FF_CLASS_STAND;
    if (r->speed > 0.5f) return FF_CLASS_WALK;
    double alpha = fabs((double)r->alpha);
    if (alpha > 150.0 * FF_DEG) return FF_CLASS_BACK_OPEN;
    return alpha > 60.0 * FF_DEG ? FF_CLASS_SIDE_OPEN : FF_CLASS_WALK;
}

/* The integral of e_s + e_w v^2, with speeds multiplied by the pace and times divided by it. */
float ff_action_cost(const ff_pack_action *r, float pace)
{
    float standing = (float)FF_E_S * r->duration, moving = fmaxf(r->energy - standing, 0.0f);
    float cost = pace == 1.0f ? r->energy : standing / pace + moving * pace;
    if (r->mode == FF_MODE_RUN) cost *= RUN_FACTOR;
    if (!(r->flags & FF_ACTION_ALPHA_UNDEFINED) && (double)r->alpha < CROSS) cost *= CROSS_FACTOR;
    if (ff_action_is_platform(r)) cost += FF_PLATFORM_COST;
    float lost = r->duration / pace * (1.0f - pace * r->speed / FF_WALK_SPEED); /* s */
    if (lost > 0.0f) cost += lost * (float)((FF_PLAN_WAIT - 1.0) * FF_E_S);
    return cost;
}
