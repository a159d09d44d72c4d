#include "runtime/core/crowd/crowd_check.h"

#include "runtime/core/crowd/crowd_state.h"

#include <string.h>

#define PLACE_MAX 1e7   /* m: ten times where agents may be put */
#define NUMBER_MAX 1e12 /* of whatever is only to be a number */
#define SPEED_MAX 1e3   /* m/s */
#define HEADING_MAX 1e4 /* rad */

bool ff_crowd_doubles_fit(const void *element, size_t from, size_t to, double low, double high, size_t *byte)
{
    for (size_t at = from; at < to; at += sizeof(double)) {
        double value;
        memcpy(&value, (const unsigned char *)element + at, sizeof value);
        if (value >= low && value <= high) continue; /* false for nan */
        *byte = at;
        return false;
    }
    return true;
}

/* The members from first to last, inclusive, of an element of a type, which are all doubles. */
#define MEMBERS_FIT(type, first, last, low, high)                                                            \
    ff_crowd_doubles_fit(element, offsetof(type, first),                                                     \
                         offsetof(type, last) + sizeof((const type *)0)->last, low, high, byte)
#define MEMBER_FITS(type, member, low, high) MEMBERS_FIT(type, member, member, low, high)

static bool floats_fit(const void *element, size_t from, size_t to, float limit, size_t *byte)
{
    for (size_t at = from; at < to; at += sizeof(float)) {
        float value;
        memcpy(&value, (const unsigned char *)element + at, sizeof value);
        if (value >= -limit && value <= limit) continue;
        *byte = at;
        return false;
    }
    return true;
}

/* Say at which member the fault is. */
#define REFUSE_MEMBER(type, member, text) return *byte = offsetof(type, member), text

const char *ff_crowd_check_traits(const ff_crowd *crowd, const void *element, size_t *byte)
{
    (void)crowd;
    const ff_traits *traits = element;
    if (!MEMBER_FITS(ff_traits, goal, -PLACE_MAX, PLACE_MAX)) return "a goal is no place";
    if (!MEMBER_FITS(ff_traits, goal_tolerance, 1e-3, 1e4)) return "a goal's tolerance is out of range";
    if (!MEMBER_FITS(ff_traits, preferred_speed, 1e-3, 1e2)) return "a preferred speed is out of range";
    if (!MEMBER_FITS(ff_traits, radius, 1e-3, 10.0)) return "a radius is out of range";
    if (traits->navigation <= FF_NAVIGATION_CROWD || traits->navigation > FF_NAVIGATION_SF)
        REFUSE_MEMBER(ff_traits, navigation, "a method of navigation is none");
    if (!MEMBER_FITS(ff_traits, face_at, -PLACE_MAX, PLACE_MAX)) return "what is looked at is no place";
    if (traits->face > FF_FACE_HEADING) REFUSE_MEMBER(ff_traits, face, "somebody looks in no known way");
    if (traits->synthesis <= FF_SYNTHESIS_CROWD || traits->synthesis > FF_SYNTHESIS_HYBRID)
        REFUSE_MEMBER(ff_traits, synthesis, "a method of synthesis is none");
    return NULL;
}

const char *ff_crowd_check_choice(const ff_crowd *crowd, const void *element, size_t *byte)
{
    (void)crowd;
    const ff_choice *choice = element;
    if (!MEMBER_FITS(ff_choice, calm, 0.0, NUMBER_MAX)) return "a time of calm is negative or none";
    if (choice->control > 1) REFUSE_MEMBER(ff_choice, control, "control is neither wanted nor not");
    if (choice->runs > 1) REFUSE_MEMBER(ff_choice, runs, "somebody neither runs nor not");
    return NULL;
}

const char *ff_crowd_check_mind(const ff_crowd *crowd, const void *element, size_t *byte)
{
    (void)crowd;
    const ff_mind *mind = element;
    if (!MEMBERS_FIT(ff_mind, command, preferred, -SPEED_MAX, SPEED_MAX)) return "a velocity is out of range";
    if (!MEMBER_FITS(ff_mind, facing, -HEADING_MAX, HEADING_MAX)) return "a facing is out of range";
    if (!MEMBER_FITS(ff_mind, bias, 0.0, 1.0)) return "a side preference is not from 0 to 1";
    if (!MEMBER_FITS(ff_mind, sharp_side, -1.0, 1.0)) return "the side of a turn is not from -1 to 1";
    if (!MEMBERS_FIT(ff_mind, best, stalled, 0.0, 1e30)) return "a distance or time is negative or no number";
    if (!MEMBER_FITS(ff_mind, detour, -HEADING_MAX, HEADING_MAX)) return "a detour is out of range";
    if (!MEMBERS_FIT(ff_mind, detour_left, strafing, -NUMBER_MAX, NUMBER_MAX)) return "a time is no number";
    if (!MEMBER_FITS(ff_mind, measured, -SPEED_MAX, SPEED_MAX)) return "a velocity is out of range";
    if (!MEMBER_FITS(ff_mind, stance.ease, 0.0, 1.0)) return "how far a line has come in is not from 0 to 1";
    if (mind->stance.foot > 2) REFUSE_MEMBER(ff_mind, stance.foot, "a foot is neither left nor right");
    if (mind->standing > FF_SETTLED)
        REFUSE_MEMBER(ff_mind, standing, "somebody neither walks nor stands nor has settled");
    return NULL;
}

const char *ff_crowd_check_body(const ff_crowd *crowd, const void *element, size_t *byte)
{
    (void)crowd;
    if (!MEMBER_FITS(ff_body, position, -PLACE_MAX, PLACE_MAX)) return "a position is no place";
    if (!MEMBER_FITS(ff_body, heading, -HEADING_MAX, HEADING_MAX)) return "a heading is out of range";
    if (!MEMBER_FITS(ff_body, rates, -SPEED_MAX, SPEED_MAX)) return "the rates of a body are out of range";
    if (!MEMBER_FITS(ff_body, phase, 0.0, 1.0)) return "the phase of a step is not from 0 to 1";
    return NULL;
}

const char *ff_crowd_check_velocity(const ff_crowd *crowd, const void *element, size_t *byte)
{
    (void)crowd;
    bool fits = ff_crowd_doubles_fit(element, 0, sizeof(ff_vec2), -SPEED_MAX, SPEED_MAX, byte);
    return fits ? NULL : "a velocity is out of range";
}

const char *ff_crowd_check_conduct(const ff_crowd *crowd, const void *element, size_t *byte)
{
    const ff_conduct *conduct = element;
    const ff_behaviour_def *def = &crowd->behaviour->def;
    if (!MEMBER_FITS(ff_conduct, place, -PLACE_MAX, PLACE_MAX)) return "a spot at a goal is no place";
    if (!MEMBER_FITS(ff_conduct, speed, 1e-3, 1e2)) return "a preferred speed is out of range";
    if (!MEMBER_FITS(ff_conduct, tolerance, 1e-3, 1e4)) return "a goal's tolerance is out of range";
    if (!MEMBER_FITS(ff_conduct, blocked, 0.0, NUMBER_MAX)) return "a time is negative or no number";
    if (!MEMBER_FITS(ff_conduct, variable, -NUMBER_MAX, NUMBER_MAX)) return "a variable is no number";
    if (conduct->born > crowd->steps || conduct->entered > crowd->steps)
        REFUSE_MEMBER(ff_conduct, born, "somebody came, or entered a state, in the future");
    if (conduct->state != FF_NONE && conduct->state >= def->state_count)
        REFUSE_MEMBER(ff_conduct, state, "a state is none");
    if (conduct->goal != FF_NONE && conduct->goal >= def->goal_count)
        REFUSE_MEMBER(ff_conduct, goal, "a goal is none");
    if (conduct->set != FF_NONE && conduct->set >= def->set_count)
        REFUSE_MEMBER(ff_conduct, set, "a set of goals is none");
    if (conduct->spawner != FF_NONE && conduct->spawner >= def->spawner_count)
        REFUSE_MEMBER(ff_conduct, spawner, "a spawner is none");
    return NULL;
}

/* ------------------------------------------------------------------------------------------------- gait */

static const char *check_blend(const ff_crowd *crowd, const void *element, size_t *byte)
{
    const ff_gait *gait = element;
    for (int i = 0; i < FF_BLEND_MAX; ++i) {
        int32_t vertex = gait->blend.vertex[i];
        if (vertex < -1 || vertex >= (int32_t)crowd->space->vertex_count) {
            *byte = offsetof(ff_gait, blend.vertex) + (size_t)i * sizeof vertex;
            return "an example of a blend is not in the pack";
        }
    }
    if (!MEMBER_FITS(ff_gait, blend.weight, 0.0, 1.0 + 1e-6)) return "a weight is not from 0 to 1";
    if (!MEMBER_FITS(ff_gait, blend.period, 1e-3, 1e3)) return "the period of a gait is out of range";
    if (!MEMBER_FITS(ff_gait, blend.rates, -SPEED_MAX, SPEED_MAX)) return "the rates of a blend are no rates";
    if (!MEMBER_FITS(ff_gait, blend.stance, 0.0, 1.0)) return "the stance of the clip is not from 0 to 1";
    if (!MEMBER_FITS(ff_gait, blend.hips, -10.0, 10.0)) return "the height of the hips is out of range";
    return NULL;
}

static const char *check_way(const ff_crowd *crowd, uint32_t way)
{
    bool known = way < FF_LOCOMOTION_COUNT && ff_locomotion_available(crowd->space, (ff_locomotion)way);
    return known ? NULL : "somebody moves in a way that the pack does not know";
}

static const char *check_switch(const ff_crowd *crowd, const void *element, size_t *byte)
{
    const ff_gait *gait = element;
    const size_t offset = offsetof(ff_gait, offset);
    if (!MEMBER_FITS(ff_gait, offset.age, 0.0, NUMBER_MAX)) return "the age of a switch is negative or none";
    if (!floats_fit(element, offset + offsetof(ff_pose_offset, time), offset + sizeof(ff_pose_offset), 1e3f,
                    byte))
        return "what is left of a switch is out of range";
    if (!MEMBERS_FIT(ff_gait, since_switch, seconds, 0.0, NUMBER_MAX)) return "a time is negative or none";
    *byte = offsetof(ff_gait, blend.way);
    const char *wrong = check_way(crowd, gait->blend.way);
    if (wrong) return wrong;
    *byte = offsetof(ff_gait, wanted);
    wrong = check_way(crowd, gait->wanted);
    if (wrong) return wrong;
    if (gait->urgent > 1) REFUSE_MEMBER(ff_gait, urgent, "a switch is neither urgent nor not");
    return NULL;
}

static const char *check_feet(const void *element, size_t *byte)
{
    const ff_gait *gait = element;
    for (int f = 0; f < 2; ++f) {
        size_t foot = offsetof(ff_gait, foot) + (size_t)f * sizeof gait->foot[f];
        if (!ff_crowd_doubles_fit(element, foot, foot + offsetof(ff_gait_foot, planted), -PLACE_MAX,
                                  PLACE_MAX, byte))
            return "a number of a foot is out of range";
        if (gait->foot[f].planted > 1) {
            *byte = foot + offsetof(ff_gait_foot, planted);
            return "a foot is neither planted nor in the air";
        }
    }
    return NULL;
}

const char *ff_crowd_check_gait(const ff_crowd *crowd, const void *element, size_t *byte)
{
    const ff_gait *gait = element;
    const char *wrong = check_feet(element, byte);
    if (!wrong) wrong = check_blend(crowd, element, byte);
    if (!wrong) wrong = check_switch(crowd, element, byte);
    if (wrong) return wrong;
    if (!MEMBER_FITS(ff_gait, rates, -SPEED_MAX, SPEED_MAX)) return "the rates of a gait are out of range";
    if (!MEMBER_FITS(ff_gait, phase, 0.0, FF_GAIT_KEYS)) return "the phase of a gait is not from 0 to 4";
    if (!MEMBER_FITS(ff_gait, stand, 0.0, 1.0)) return "the share of standing is not from 0 to 1";
    if (!MEMBER_FITS(ff_gait, idle_time, 0.0, 1e6)) return "the time in the idle example is out of range";
    if (!MEMBERS_FIT(ff_gait, hips_drop, hips_speed, -1e2, 1e2)) return "hips are lowered out of range";
    if (!MEMBER_FITS(ff_gait, style, -1e2, 1e2)) return "a style is out of range";
    if (!MEMBER_FITS(ff_gait, style.scale, 0.5, 2.0)) return "a body is half or twice the size of the pack's";
    if (gait->mode > FF_GAIT_STEP) REFUSE_MEMBER(ff_gait, mode, "somebody neither stands nor steps");
    if (gait->first_foot > 1) REFUSE_MEMBER(ff_gait, first_foot, "a foot is neither left nor right");
    return NULL;
}
