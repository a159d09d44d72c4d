#include "runtime/core/gait/gait_switch.h"

#include "runtime/core/gait/foot_lock.h"

#include <string.h>

#define LATER (1.0 / 240.0) /* s, over which speeds are taken */
/* m: mean distance of the poses of two cycles at equal phase, up to which any moment is as good as a pair. The study found
 * that in straight walking and turns it is 2 to 7 cm all the time, and waiting for pairs gains nothing. */
#define AT_ONCE 0.08
#define JUST_NOW 0.12     /* of a cycle: so long a pair is still good, should a foot have to land first */
#define IN_REACH 0.12     /* m/s, by which rates may be outside what the new way can do */
#define LEAST_FLIGHT 0.1  /* s to the landing: a foot that is about to land does so first */
#define LEAST_STANCE 0.08 /* s to the lift: no sooner is a foot lifted in the new way */
#define MOST_DELAY 1.5    /* of the time to the landing: no foot waits over the floor or is hurried down */
#define SHORT_SWING 1.0   /* u: a foot that has landed is not lifted again for less */
#define OFF_BEFORE 0.8    /* of the time to the landing: steps may quicken yet */
#define URGENT_WAIT 0.3   /* s: who must switch waits no longer for a pair */
#define PACE_TIME 0.5f    /* s, of hips and joints between a walk and a run: elbows have 70 degrees to go */
#define RUN_FROM 1.35     /* m/s, from where on one may break into a run */
#define WALK_FROM 1.95    /* m/s, below which a run may become a walk */
/* Of a step: the part of the stance on one foot in which a walk may become a run, and back; and the shares of the stance at
 * which a walk's other foot leaves and lands, by which one is laid on the other. */
#define ONE_FOOT_FROM 0.1
#define ONE_FOOT_TO 0.5
#define OTHER_LEAVES 0.2
#define OTHER_LANDS 0.8

/* ------------------------------------------------------------------------------------------------- phases */

static int32_t main_vertex(const ff_blend *blend)
{
    int best = 0;
    for (int i = 1; i < FF_BLEND_MAX; ++i)
        if (blend->vertex[i] >= 0 && blend->weight[i] > blend->weight[best]) best = i;
    return blend->vertex[best];
}

static double fraction_of(double x)
{
    return x - floor(x);
}

/* How a walking example corresponds to the semi-procedural clip; NULL if the pack does not say. */
static const ff_pack_correspondence *to_clip(const ff_blend_space *space, int32_t vertex)
{
    const ff_pack *pack = space->pack;
    uint32_t low = 0, high = pack->correspondence_count, example = space->vertices[vertex].example;
    while (low < high) { /* in order of from, then of to; the clip is the last `to` of an example */
        uint32_t middle = low + (high - low) / 2;
        if (pack->correspondences[middle].from <= example)
            low = middle + 1;
        else
            high = middle;
    }
    const ff_pack_correspondence *c = low > 0 ? &pack->correspondences[low - 1] : NULL;
    return c && c->from == example && c->to == FF_CORRESPOND_GAIT ? c : NULL;
}

/* Eq 10 and 15: when the time of a pair in the present cycle is reached, or a moment later, its time in the new one. */
static bool at_a_pair(const ff_blend_space *space, const ff_gait *gait, const ff_blend *next, double *phase)
{
    bool leaving = gait->blend.way == FF_BLENDING; /* the examples, for the clip */
    int32_t vertex = main_vertex(leaving ? &gait->blend : next);
    const ff_blend *clip = leaving ? next : &gait->blend;
    const ff_pack_correspondence *c = to_clip(space, vertex);
    if (!c || (double)c->mean <= AT_ONCE) return true;
    double now =
        leaving ? ff_vertex_fraction(space, vertex, gait->phase) : ff_clip_fraction(clip, gait->phase);
    for (uint32_t i = 0; i < c->pair_count; ++i) {
        const ff_pack_pair *pair = &space->pack->pairs[c->first_pair + i];
        double late = fraction_of(now - (double)pair->phase[leaving ? 0 : 1]);
        if (late > JUST_NOW) continue;
        double then = fraction_of((double)pair->phase[leaving ? 1 : 0] + late);
        *phase = leaving ? ff_clip_phase(clip, then) : ff_vertex_phase(space, vertex, then);
        return true;
    }
    return false;
}

/* Between a walk and a run, on one foot: the same share of its stance. */
static bool on_one_foot(const ff_gait *gait, double *phase)
{
    if (gait->foot[0].planted == gait->foot[1].planted) return false;
    int foot = gait->foot[0].planted ? 0 : 1;
    bool runs = gait->blend.way == FF_RUNNING;
    double begin = 2.0 * foot + (runs ? 0.0 : 1.0), share = ff_phase_wrap(gait->phase - begin);
    if (share < ONE_FOOT_FROM || share > ONE_FOOT_TO) return false;
    share = runs ? (share - OTHER_LEAVES) / (OTHER_LANDS - OTHER_LEAVES)
                 : ff_lerp(OTHER_LEAVES, OTHER_LANDS, share);
    *phase = ff_phase_wrap(2.0 * foot + (runs ? 1.0 + ff_clamp(share, 0.02, 0.98) : share));
    return true;
}

/* Never a blend of walk and run (study, section 2): a change-over within a step. Fast enough for it, and not too fast. */
static bool changes_pace(const ff_gait *gait, double *phase)
{
    double speed = gait->rates.forward;
    if (gait->wanted == FF_RUNNING ? speed < RUN_FROM : speed > WALK_FROM) return false;
    return on_one_foot(gait, phase);
}

/* "Bring parameters together first": the new way must be able to do what the body does. */
static bool in_reach(const ff_blend_space *space, const ff_gait *gait)
{
    ff_rates near = ff_locomotion_clamp(space, (ff_locomotion)gait->wanted, gait->rates);
    return ff_length3(ff_sub3(ff_blend_point(near), ff_blend_point(gait->rates))) <= IN_REACH;
}

static bool is_the_moment(const ff_blend_space *space, const ff_gait *gait, const ff_blend *next,
                          double *phase)
{
    *phase = gait->phase;
    if (gait->wanted == FF_RUNNING || gait->blend.way == FF_RUNNING) return changes_pace(gait, phase);
    if (gait->urgent && gait->waited >= URGENT_WAIT) return true;
    return in_reach(space, gait) && at_a_pair(space, gait, next, phase);
}

/* ------------------------------------------------------------------------------------------------- the switch */

void ff_gait_targets(const ff_blend_space *space, const ff_gait *gait, const ff_gait_root *root,
                     ff_pose_targets *out)
{
    ff_cursor cursor = ff_cursor_at(space, &gait->blend, gait->phase, gait->idle_time);
    memset(out->foot, 0, sizeof out->foot); /* feet are shown with their offset already */
    out->hips = ff_sample_hips(space, &cursor);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        out->turn[j] = ff_sample_rotation(space, &cursor, j);
    ff_pose_offset_apply(&gait->offset, out);
    ff_vec2 ahead = ff_fwd2(root->heading);
    for (int f = 0; f < 2; ++f) {
        const ff_gait_foot *foot = &gait->foot[f];
        ff_vec2 at = ff_to_frame2(ahead, ff_sub2(ff_v2(foot->path.a, foot->path.b), root->position));
        out->foot[f] = (ff_pose_foot){at.a, at.b, foot->path.height, ff_wrap(foot->path.yaw - root->heading),
                                      foot->pitch};
    }
}

static ff_gait_root root_later(const ff_gait_root *root, double time)
{
    ff_gait_root later = *root;
    ff_vec2 ahead = ff_fwd2(root->heading + 0.5 * root->rates.turn * time);
    ff_vec2 moved = ff_from_frame2(ahead, ff_v2(root->rates.forward, root->rates.left));
    later.position = ff_madd2(root->position, moved, time);
    later.heading += root->rates.turn * time;
    return later;
}

/* Of a foot in the air, s, as things are. */
static double time_to_landing(const ff_blend_space *space, const ff_gait *gait, int foot)
{
    double start, length;
    ff_blend_lock(space, &gait->blend, foot, &start, &length);
    double left = ff_phase_wrap(start - gait->phase);
    return ff_phase_duration(space, &gait->blend, gait->phase, gait->phase + left) / gait->pace;
}

/* A foot that stands, with its lift at a phase, in the new way already. One that is late for it is not: it may step at once. */
static bool about_to_lift(const ff_blend_space *space, const ff_gait *gait, double lift)
{
    double left = ff_phase_wrap(lift - gait->phase);
    return ff_phase_duration(space, &gait->blend, gait->phase, gait->phase + left) <
           LEAST_STANCE * gait->pace;
}

/* Put the clock where the new way has this phase; feet in the air keep their share of the swing. False: the new way would
 * have a foot standing that is in the air, one is about to land or to lift or sets off, or would land much later or sooner. */
static bool set_clock(const ff_blend_space *space, ff_gait *gait, const ff_blend *next, double phase,
                      double until[2])
{
    double before[2];
    for (int f = 0; f < 2; ++f)
        before[f] = time_to_landing(space, gait, f);
    gait->blend = *next;
    gait->phase = phase;
    for (int f = 0; f < 2; ++f) {
        ff_gait_foot *foot = &gait->foot[f];
        double start, length;
        ff_blend_lock(space, next, f, &start, &length);
        double left = ff_phase_wrap(start - phase);
        until[f] = FF_POSE_OFFSET_TIME;
        if (foot->planted && left < SHORT_SWING) return false;
        if (foot->planted && about_to_lift(space, gait, start + length)) return false;
        if (foot->planted) continue;
        if (ff_foot_sets_off(foot)) return false; /* from where it stood, which is the old way's affair */
        foot->stood = 0.0;
        double time = ff_phase_duration(space, next, phase, phase + left) / gait->pace;
        if (left >= FF_GAIT_KEYS - length || time < LEAST_FLIGHT) return false;
        if (before[f] < LEAST_FLIGHT || time > MOST_DELAY * before[f]) return false;
        if (next->way != FF_RUNNING && before[f] > MOST_DELAY * time) return false;
        double done = ff_min(foot->progress, 0.95);
        foot->phase_left = left;
        foot->elapsed = done * time / (1.0 - done);
        until[f] = OFF_BEFORE * time;
    }
    return true;
}

/* Becomes the new way in place; the poses of both, now and a little later, tell the offset. False: either begins or ends
 * stepping just now, which makes the clip's poses jump, and the speeds with them. */
static bool take_over(const ff_blend_space *space, ff_gait *gait, const ff_gait *next,
                      const ff_gait_root *root, const double until[2])
{
    ff_gait_root later = root_later(root, LATER);
    ff_pose_targets old_now, old_later, new_now, new_later;
    ff_gait old = *gait, taken = *next, ahead;
    ff_gait_targets(space, &old, root, &old_now);
    ff_gait_advance(space, &old, &later, LATER);
    ff_gait_targets(space, &old, &later, &old_later);
    memset(&taken.offset, 0, sizeof taken.offset);
    ff_gait_advance(space, &taken, root, 0.0);
    ff_gait_targets(space, &taken, root, &new_now);
    ahead = taken;
    ff_gait_advance(space, &ahead, &later, LATER);
    ff_gait_targets(space, &ahead, &later, &new_later);
    if (old.mode != gait->mode || ahead.mode != next->mode) return false;
    ff_pose_switch change = {&old_now, &old_later,           &new_now,      &new_later,
                             LATER,    {until[0], until[1]}, {false, false}};
    *gait = taken;
    ff_pose_offset_begin(&gait->offset, &change);
    if ((old.blend.way == FF_RUNNING) != (gait->blend.way == FF_RUNNING)) gait->offset.time[0] = PACE_TIME;
    ff_gait_advance(space, gait, root, 0.0); /* feet with their offset */
    return true;
}

void ff_gait_try_switch(const ff_blend_space *space, ff_gait *gait, const ff_gait_root *root)
{
    ff_gait next = *gait;
    ff_blend blend;
    double phase, until[2];
    ff_locomotion_find(space, (ff_locomotion)gait->wanted, gait->rates, &blend);
    if (gait->mode == FF_GAIT_STAND && gait->stand >= 1.0) { /* nothing of either way shows */
        if (gait->wanted == FF_RUNNING) return;
        gait->blend = blend;
    } else {
        if (!is_the_moment(space, gait, &blend, &phase)) return;
        if (!set_clock(space, &next, &blend, phase, until)) return;
        if (!take_over(space, gait, &next, root, until)) return;
        ++gait->switches;
        gait->urgent_switches += gait->urgent;
    }
    gait->since_switch = gait->waited = 0.0;
}
