#include "preprocess/step_check.h"

#include "preprocess/whole.h"

#include <stdio.h>

static const double TURN_TRAVEL = 0.25, TURN_ANGLE = 20.0 * FF_DEG; /* m, rad: algorithms A.6 */
static const double CROUCHED = 0.8;                                 /* hips, share of their height at rest */
/* m. Algorithms A.6, but a run of 4 m/s carries its feet 2.7 m. */
static const double FARTHEST_SWING = 2.2, FARTHEST_RUN = 3.5, HIGHEST_STEP = 0.45;
static const double DOUBTFUL = 0.3; /* confidence of a plant */
/* m: where an action begins and ends the ball of the foot that carries it is no higher than this over its level. What
 * validate asks for is 5 mm more. */
static const double FOOT_UP = 0.045;

static bool is_jump(const ff_motion *motion, const ff_plants *plants, const ff_step_span *span)
{
    int from = 0, to = 0;
    return ff_find_flight(plants, span->first, span->last, &from, &to) &&
           ff_flight_is_jump(motion, plants, from, to);
}

bool ff_is_crouched(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants, int first, int last)
{
    double sum = 0.0;
    for (int i = first; i <= last; ++i)
        sum += ff_hips_height(motion, plants, i);
    return sum / (last - first + 1) < CROUCHED * rig->offset[FF_ROLE_HIPS].y;
}

int ff_step_mode(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants,
                 const ff_step_span *span, int mode_tag, bool from_standing, bool to_standing)
{
    if (is_jump(motion, plants, span)) return FF_MODE_JUMP;
    if (mode_tag == FF_MODE_CROUCH || ff_is_crouched(rig, motion, plants, span->first, span->last))
        return FF_MODE_CROUCH;
    ff_vec3 moved = ff_sub3(motion->root[span->last], motion->root[span->first]);
    if (ff_length2(ff_v2(moved.x, moved.y)) < TURN_TRAVEL && fabs(moved.z) > TURN_ANGLE) return FF_MODE_TURN;
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

bool ff_step_acceptable(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants,
                        const ff_step_span *span, const ff_pack_action *r, char *reason, size_t size)
{
    const ff_plant *support = &plants->items[span->support], *swing = &plants->items[span->swing];
    double seconds = (span->last - span->first) * motion->frame_time;
    bool whole = (r->flags & FF_ACTION_WHOLE) != 0;
    bool run = r->mode == FF_MODE_RUN;
    if (support->confidence < DOUBTFUL || swing->confidence < DOUBTFUL)
        return say(reason, size, "a plant is doubtful (confidence %.2f)",
                   ff_min(support->confidence, swing->confidence));
    if (seconds < (run ? 0.15 : 0.2))
        return say(reason, size, "too short (%.2f s): both feet land almost at once", seconds);
    if (!whole && seconds > (run ? 0.7 : 1.5))
        return say(reason, size, "too long for one step (%.2f s)", seconds);
    double swung = ff_length2(ff_v2((double)r->swing_displacement[0], (double)r->swing_displacement[1]));
    if (!whole && swung > (run ? FARTHEST_RUN : FARTHEST_SWING))
        return say(reason, size, "the swing foot moves too far (%.2f m)", swung);
    if (fabs((double)r->rise) > HIGHEST_STEP)
        return say(reason, size, "the footsteps differ in height (%.0f cm)", 100.0 * (double)r->rise);
    double up = ff_max(ball_up(rig, motion, support, span->first), ball_up(rig, motion, swing, span->last));
    if (up > FOOT_UP)
        return say(reason, size, "a foot that should stand is %.0f cm over the ground", 100.0 * up);
    return true;
}
