#include "runtime/core/plan/plan_joint.h"

#include "runtime/core/play/play_set.h"

#define LEAST 0.02f /* s, that anything takes to fade */

/* The greatest share of a rush that the cubic ever adds. */
static const float MOST_OF_SPEED = 4.0f / 27.0f;

/* ------------------------------------------------------------------------------------------------- of an action */

/* m/s at the first sample of three that are h apart; the last one for a negative h. */
static float slope(float p, float q, float r, float h)
{
    return (4.0f * q - 3.0f * p - r) / (2.0f * h);
}

static void find_speeds(const ff_knot *samples, uint32_t knots, float duration, ff_set_ends *out)
{
    const ff_knot *last = samples + knots - 1;
    float h = duration / (float)(knots - 1);
    for (int i = 0; i < FF_TRACK_LANES && knots > 2; ++i) {
        out->begin[0][i] = slope(samples[0].a[i], samples[1].a[i], samples[2].a[i], h);
        out->begin[1][i] = slope(samples[0].b[i], samples[1].b[i], samples[2].b[i], h);
        out->end[0][i] = slope(last[0].a[i], last[-1].a[i], last[-2].a[i], -h);
        out->end[1][i] = slope(last[0].b[i], last[-1].b[i], last[-2].b[i], -h);
    }
}

/* When a foot lifts and comes down, as play.c has it: by the last knot before the end at the latest, as what follows begins with
 * the pose at the end. */
static void find_foot(const ff_play_action *action, int foot, float last, ff_set_ends *out)
{
    uint32_t count = action->stance_count[foot];
    const ff_play_stance *stance = action->stance[foot];
    bool begins = count > 0 && stance[0].from <= 0.0;
    uint32_t next = begins ? 1 : 0;
    float lift = begins ? (float)stance[0].to : 0.0f;
    float land =
        next < count ? (float)stance[next].from : (begins ? lift + (float)FF_PLAY_SETTLE : FF_JOINT_TIME);
    out->begins[foot] = begins;
    out->ends[foot] = count > 0 && stance[count - 1].to >= action->duration;
    out->lift[foot] = lift < last - LEAST ? lift : 0.0f; /* else it stands all the time */
    out->land[foot] = land < last ? land : last;
}

void ff_set_ends_find(const ff_pack *pack, const ff_body_frame *body, uint32_t action, const ff_knot *samples,
                      uint32_t knots, ff_set_ends *out)
{
    ff_play_action played;
    ff_play_action_make(pack, body, action, &played);
    *out = (ff_set_ends){.last = pack->actions[action].duration - (float)FF_TRACK_STEP};
    find_speeds(samples, knots, pack->actions[action].duration, out);
    for (int foot = 0; foot < 2; ++foot)
        find_foot(&played, foot, out->last, out);
}

void ff_set_ends_pace(const ff_set_ends *own, float pace, float duration, ff_set_ends *out)
{
    *out = *own;
    out->last = duration - (float)FF_TRACK_STEP;
    for (int i = 0; i < FF_TRACK_LANES; ++i) {
        out->begin[0][i] *= pace, out->begin[1][i] *= pace;
        out->end[0][i] *= pace, out->end[1][i] *= pace;
    }
    for (int foot = 0; foot < 2; ++foot) {
        out->lift[foot] /= pace;
        out->land[foot] /= pace;
    }
}

/* --------------------------------------------------------------------------------------------------- of a pair */

/* When one of the colliders loses the difference; returns for how long. */
static float fade(ff_joint *joint, int i, float from, float span, float last)
{
    span = span < last - from ? span : last - from;
    span = span > LEAST ? span : LEAST;
    joint->from[i] = from;
    joint->rate[i] = 1.0f / span;
    joint->over = from + span > joint->over ? from + span : joint->over;
    return span;
}

/* What the speeds of one of the colliders at the end of before and at the beginning of next differ by, times a span. */
static void rush(ff_joint *joint, int i, float span, const ff_set_ends *before, const float turn[2],
                 const ff_set_ends *next)
{
    float a = 0.0f, b = 0.0f;
    if (before) {
        a = turn[0] * before->end[0][i] + turn[1] * before->end[1][i];
        b = turn[0] * before->end[1][i] - turn[1] * before->end[0][i];
    }
    joint->rush_a[i] = span * (a - next->begin[0][i]);
    joint->rush_b[i] = span * (b - next->begin[1][i]);
}

/* The greatest length of the vectors [first, last]. */
static float longest(const float *a, const float *b, int first, int last)
{
    float most = 0.0f;
    for (int i = first; i <= last; ++i) {
        float square = a[i] * a[i] + b[i] * b[i];
        most = square > most ? square : most;
    }
    return sqrtf(most);
}

void ff_joint_make(const ff_set_ends *before, const float turn[2], const ff_set_ends *next,
                   const ff_knot *jump, ff_joint *out)
{
    enum { LEFT = FF_COLLIDER_FOOT_L, RIGHT = FF_COLLIDER_FOOT_R };
    *out = (ff_joint){.jump = *jump};
    for (int i = 0; i < FF_TRACK_LANES; ++i)
        if (i < LEFT || i > RIGHT)
            rush(out, i, fade(out, i, 0.0f, FF_JOINT_TIME, next->last), before, turn, next);
    for (int foot = 0; foot < 2; ++foot) {
        bool stood = !before || before->ends[foot];
        float lift = next->lift[foot], land = next->land[foot];
        if (stood && next->begins[foot])
            fade(out, LEFT + foot, lift, land - lift, next->last);
        else
            rush(out, LEFT + foot, fade(out, LEFT + foot, 0.0f, fminf(land, FF_JOINT_TIME), next->last),
                 stood ? NULL : before, turn, next);
    }
    out->last_from = fmaxf(out->from[LEFT], out->from[RIGHT]);
    out->last_rate = 1.0f / (out->over - out->last_from);
    ff_joint_measure(out);
}

void ff_joint_measure(ff_joint *joint)
{
    enum { HAND = FF_COLLIDER_HAND_R, LEFT, RIGHT, ROOT };
    const float *a = joint->jump.a, *b = joint->jump.b, *u = joint->rush_a, *v = joint->rush_b;
    joint->most_body = longest(a, b, 0, HAND);
    joint->most_feet = longest(a, b, LEFT, RIGHT);
    joint->most_root = longest(a, b, ROOT, ROOT);
    joint->most_rush = longest(u, v, 0, RIGHT) + longest(u, v, ROOT, ROOT);
    joint->most_arc = longest(joint->arc_a, joint->arc_b, 0, HAND);
}

const ff_joint *ff_set_joint(const ff_action_set *set, uint32_t before, uint32_t next)
{
    const ff_set_action *a = &set->actions[before];
    for (uint32_t k = a->first_next; k < a->first_next + a->next_count; ++k)
        if (set->next[k].action == next) return &set->joints[k];
    return NULL;
}

float ff_joint_most(const ff_joint *joint)
{
    return longest(joint->jump.a, joint->jump.b, 0, FF_COLLIDER_ROOT) +
           MOST_OF_SPEED * longest(joint->rush_a, joint->rush_b, 0, FF_COLLIDER_ROOT) + joint->most_arc;
}
