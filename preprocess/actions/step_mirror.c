#include "preprocess/actions/steps.h"

/* Reflection left to right (algorithms A.8): components to the left, headings and yaws change their sign; the sides
 * swap; alpha and step width are measured relative to the swing side and stay. */
static void mirror_record(ff_pack_action *r)
{
    r->support = 1u - r->support;
    r->swing = 1u - r->swing;
    r->flags ^= FF_ACTION_MIRRORED;
    r->root_displacement[1] = -r->root_displacement[1];
    r->direction = -r->direction;
    r->swing_displacement[1] = -r->swing_displacement[1];
    r->theta = -r->theta;
    for (int k = 1; k < 3; ++k) {
        r->root_start[k] = -r->root_start[k];
        r->root_end[k] = -r->root_end[k];
        r->land[k] = -r->land[k];
    }
    r->support_yaw = -r->support_yaw;
}

static int other_side(int collider)
{
    switch (collider) {
    case FF_COLLIDER_HAND_L:
        return FF_COLLIDER_HAND_R;
    case FF_COLLIDER_HAND_R:
        return FF_COLLIDER_HAND_L;
    case FF_COLLIDER_FOOT_L:
        return FF_COLLIDER_FOOT_R;
    case FF_COLLIDER_FOOT_R:
        return FF_COLLIDER_FOOT_L;
    default:
        return collider;
    }
}

/* Reflect a join: left becomes minus left, the sides' joints change places. */
static void mirror_join(const ff_join *from, ff_join *to)
{
    for (int k = 0; k < FF_JOIN_FRAMES; ++k)
        for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j) {
            const float *at = from->at[k][ff_role_mirror((ff_role)j)];
            to->at[k][j][0] = at[0];
            to->at[k][j][1] = -at[1];
            to->at[k][j][2] = at[2];
        }
}

void ff_action_mirror(const ff_action *action, ff_action *out)
{
    *out = *action;
    mirror_record(&out->record);
    for (uint32_t k = 0; k < action->record.collider_samples; ++k)
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
            ff_pack_collider at = action->colliders[k][other_side(c)];
            at.b = -at.b;
            out->colliders[k][c] = at;
        }
    for (uint32_t k = 0; k < action->record.event_count; ++k)
        out->events[k].foot = 1u - action->events[k].foot;
    mirror_join(&action->start, &out->start);
    mirror_join(&action->end, &out->end);
}
