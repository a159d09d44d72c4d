#include "preprocess/step_check.h"

#include "preprocess/standing.h"

#include <stdio.h>
#include <stdlib.h>

static const double TURN_TRAVEL = 0.25, TURN_ANGLE = 20.0 * FF_DEG; /* m, rad: algorithms A.6 */
static const double JUMP_FLIGHT = 0.3;                              /* s: twice the flight of a fast run */
static const double TOGETHER = 0.06;                                /* s: both feet leave or land as one */
static const double CROUCHED = 0.8;                                 /* hips, share of their height at rest */
/* m. Algorithms A.6, but a run of 4 m/s carries its feet 2.7 m. */
static const double FARTHEST_SWING = 2.2, FARTHEST_RUN = 3.5, STEP_UP = 0.05, OFF_FLOOR = 0.1;
static const double DOUBTFUL = 0.3; /* confidence of a plant */

static bool is_jump(const ff_motion *motion, const ff_plants *plants, const ff_step_span *span)
{
    int from = 0, to = 0;
    if (!ff_find_flight(plants, span->first, span->last, &from, &to)) return false;
    double dt = motion->frame_time;
    if ((to - from + 1) * dt >= JUMP_FLIGHT) return true;
    const ff_plant *support = &plants->items[span->support], *swing = &plants->items[span->swing];
    if (span->swing_from < 0) return false;
    /* The support foot's own landing after the flight, if it lands at all. */
    int again = ff_plant_at(plants, support->foot, swing->start + (int)(TOGETHER / dt));
    bool leave = abs(plants->items[span->swing_from].end - support->end) * dt <= TOGETHER;
    bool land = again >= 0 && again != span->support &&
                abs(plants->items[again].start - swing->start) * dt <= TOGETHER;
    return leave && land;
}

static bool is_crouched(const ff_rig *rig, const ff_motion *motion, const ff_step_span *span)
{
    double sum = 0.0;
    for (int i = span->first; i <= span->last; ++i)
        sum += motion->hips[i].z;
    return sum / (span->last - span->first + 1) < CROUCHED * rig->offset[FF_ROLE_HIPS].y;
}

int ff_step_mode(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants,
                 const ff_step_span *span, int mode_tag, bool from_standing, bool to_standing)
{
    if (is_jump(motion, plants, span)) return FF_MODE_JUMP;
    if (mode_tag == FF_MODE_CROUCH || is_crouched(rig, motion, span)) return FF_MODE_CROUCH;
    ff_vec3 moved = ff_sub3(motion->root[span->last], motion->root[span->first]);
    if (ff_length2(ff_v2(moved.x, moved.y)) < TURN_TRAVEL && fabs(moved.z) > TURN_ANGLE) return FF_MODE_TURN;
    if (from_standing && !to_standing) return FF_MODE_START;
    if (to_standing && !from_standing) return FF_MODE_STOP;
    return -1;
}

/* Height of a plant's ball over where the plane of the floor has it, m. */
static double over_floor(const ff_plants *plants, const ff_plant *plant)
{
    const ff_floor *floor = &plants->floor;
    return plant->ball_y - floor->base - ff_dot2(floor->slope, plant->ball) -
           plants->shape[plant->foot].ball_height;
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
    bool run = r->mode == FF_MODE_RUN;
    if (support->confidence < DOUBTFUL || swing->confidence < DOUBTFUL)
        return say(reason, size, "a plant is doubtful (confidence %.2f)",
                   ff_min(support->confidence, swing->confidence));
    if (seconds < (run ? 0.15 : 0.2))
        return say(reason, size, "too short (%.2f s): both feet land almost at once", seconds);
    if (seconds > (run ? 0.7 : (r->mode == FF_MODE_JUMP ? 3.0 : 1.5)))
        return say(reason, size, "too long for one step (%.2f s)", seconds);
    double swung = ff_length2(ff_v2((double)r->swing_displacement[0], (double)r->swing_displacement[1]));
    if (swung > (run ? FARTHEST_RUN : FARTHEST_SWING))
        return say(reason, size, "the swing foot moves too far (%.2f m)", swung);
    double from = over_floor(plants, support), to = over_floor(plants, swing);
    if (fabs(to - from) > STEP_UP)
        return say(reason, size, "the footsteps differ in height (%.1f cm)", 100.0 * (to - from));
    if (fabs(to) > OFF_FLOOR)
        return say(reason, size, "the footsteps are not on the floor (%.1f cm)", 100.0 * to);
    return true;
}
