#include "preprocess/actions/step_check.h"

#include "preprocess/actions/whole.h"

#include <stdio.h>

static bool is_jump(const ff_whole_settings *set, const ff_motion *motion, const ff_plants *plants,
                    const ff_step_span *span)
{
    int from = 0, to = 0;
    return ff_find_flight(plants, span->first, span->last, &from, &to) &&
           ff_flight_is_jump(set, motion, plants, from, to);
}

bool ff_is_crouched(const ff_step_settings *set, const ff_rig *rig, const ff_motion *motion,
                    const ff_plants *plants, int first, int last)
{
    double sum = 0.0;
    for (int i = first; i <= last; ++i)
        sum += ff_hips_height(motion, plants, i);
    return sum / (last - first + 1) < set->crouched * rig->offset[FF_ROLE_HIPS].y;
}

int ff_step_mode(const ff_cut_settings *set, const ff_rig *rig, const ff_motion *motion,
                 const ff_plants *plants, const ff_step_span *span, int mode_tag, bool from_standing,
                 bool to_standing)
{
    if (is_jump(&set->whole, motion, plants, span)) return FF_MODE_JUMP;
    if (mode_tag == FF_MODE_CROUCH ||
        ff_is_crouched(&set->steps, rig, motion, plants, span->first, span->last))
        return FF_MODE_CROUCH;
    ff_vec3 moved = ff_sub3(motion->root[span->last], motion->root[span->first]);
    if (ff_length2(ff_v2(moved.x, moved.y)) < set->steps.turn_travel &&
        fabs(moved.z) > set->steps.turn_angle * FF_DEG)
        return FF_MODE_TURN;
    if (from_standing && !to_standing) return FF_MODE_START;
    if (to_standing && !from_standing) return FF_MODE_STOP;
    return -1;
}

static bool say(char *reason, size_t size, const char *format, double value)
{
    /* Every format below takes one number. */
    snprintf(reason, size, format, value);
    return false;
}

/* How far the ball of a plant's foot is over its level in one frame, m: much where the capture of an ankle is broken. */
static double ball_up(const ff_rig *rig, const ff_motion *motion, const ff_plant *plant, int frame)
{
    ff_vec3 at[FF_BODY_COUNT], rest[FF_BODY_COUNT];
    int ball = plant->foot == FF_LEFT ? FF_ROLE_BALL_L : FF_ROLE_BALL_R;
    ff_rig_rest_pose(rig, rest);
    ff_motion_pose(rig, motion, frame, at, NULL);
    return at[ball].y - rest[ball].y - plant->level * motion->scale;
}

bool ff_step_acceptable(const ff_step_settings *set, const ff_rig *rig, const ff_motion *motion,
                        const ff_plants *plants, const ff_step_span *span, const ff_pack_action *r,
                        char *reason, size_t size)
{
    const ff_plant *support = &plants->items[span->support], *swing = &plants->items[span->swing];
    double seconds = (span->last - span->first) * motion->frame_time;
    bool whole = (r->flags & FF_ACTION_WHOLE) != 0;
    bool run = r->mode == FF_MODE_RUN;
    if (support->confidence < set->doubtful || swing->confidence < set->doubtful)
        return say(reason, size, "a plant is doubtful (confidence %.2f)",
                   ff_min(support->confidence, swing->confidence));
    if (seconds < (run ? set->shortest_run : set->shortest))
        return say(reason, size, "too short (%.2f s): both feet land almost at once", seconds);
    if (!whole && seconds > (run ? set->longest_run : set->longest))
        return say(reason, size, "too long for one step (%.2f s)", seconds);
    double swung = ff_length2(ff_v2((double)r->swing_displacement[0], (double)r->swing_displacement[1]));
    if (!whole && swung > (run ? set->farthest_run : set->farthest))
        return say(reason, size, "the swing foot moves too far (%.2f m)", swung);
    if (fabs((double)r->rise) > set->highest)
        return say(reason, size, "the footsteps differ in height (%.0f cm)", 100.0 * (double)r->rise);
    double up = ff_max(ball_up(rig, motion, support, span->first), ball_up(rig, motion, swing, span->last));
    if (up > set->foot_up)
        return say(reason, size, "a foot that should stand is %.0f cm over the ground", 100.0 * up);
    return true;
}
