#include "preprocess/step_check.h"

#include "preprocess/whole.h"

#include <stdio.h>

static const double TURN_TRAVEL = 0.25, TURN_ANGLE = 20.0 * FF_DEG; /* m, rad: algorithms A.6 */
static const double CROUCHED = 0.8;                                 /* hips, share of their height at rest */
/* m. Algorithms A.6, but a run of 4 m/s carries its feet 2.7 m. */
static const double FARTHEST_SWING = 2.2, FARTHEST_RUN = 3.5, HIGHEST_STEP = 0.45;
static const double DOUBTFUL = 0.3; /* confidence of a plant */

static bool is_jump(const ff_motion *motion, const ff_plants *plants, const ff_step_span *span)
{
    int from = 0, to = 0;
    return ff_find_flight(plants, span->first, span->last, &from, &to) &&
           ff_flight_is_jump(motion, plants, from, to);
}

static bool is_crouched(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants,
                        const ff_step_span *span)
{
    double sum = 0.0;
    for (int i = span->first; i <= span->last; ++i)
        sum += ff_hips_height(motion, plants, i);
    return sum / (span->last - span->first + 1) < CROUCHED * rig->offset[FF_ROLE_HIPS].y;
}

int ff_step_mode(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants,
                 const ff_step_span *span, int mode_tag, bool from_standing, bool to_standing)
{
    if (is_jump(motion, plants, span)) return FF_MODE_JUMP;
    if (mode_tag == FF_MODE_CROUCH || is_crouched(rig, motion, plants, span)) return FF_MODE_CROUCH;
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

bool ff_step_acceptable(const ff_motion *motion, const ff_plants *plants, const ff_step_span *span,
                        const ff_pack_action *r, char *reason, size_t size)
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
    return true;
}
