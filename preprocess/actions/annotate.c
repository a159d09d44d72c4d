#include "preprocess/actions/annotate.h"

#include "preprocess/motion/standing.h"

#include <string.h>

static const double NO_DIRECTION = 0.02; /* m: a displacement below it has no angle */
/* m: median forward step of the CMU walks (footstep study), for a pack of a single clip; ff_actions_split_walks sets
 * the median of all clips. */
static const double MEDIAN_STEP = 0.71;

/* Is the foot down and nearly at rest? Forefoot runners stand on the ball alone. */
static bool is_down(const ff_foot_track *t, bool forefoot)
{
    bool heel = forefoot || (t->heel_height < 0.02 && t->heel_speed < 0.6);
    return heel && t->ball_height < 0.02 && t->ball_speed < 0.6;
}

int ff_plant_full(const ff_plants *plants, int plant)
{
    const ff_plant *p = &plants->items[plant];
    const ff_foot_track *tracks = plants->tracks + p->foot;
    int down = p->start, slowest = down;
    if (p->written && p->flat_start >= 0) return p->flat_start;
    while (down <= p->end && !is_down(&tracks[2 * down], p->flat_start < 0))
        ++down;
    for (int i = p->start; i <= p->end; ++i)
        if (tracks[2 * i].ball_speed < tracks[2 * slowest].ball_speed) slowest = i;
    if (p->flat_start < 0) {
        if (p->cut_end) return -1; /* what follows would tell */
        if (down <= p->end) return down;
        return tracks[2 * slowest].ball_speed > 1.0 ? -1 : slowest;
    }
    /* A clip that ends on the heel: what looks flat is not yet down. */
    if (p->cut_end && tracks[2 * p->flat_start].ball_height > 0.03) return -1;
    /* A foot that slides when it comes down is still only much later: it stood long before that. */
    return down + (p->end - p->start) / 6 < p->flat_start ? down : p->flat_start;
}

static double ground_speed(const ff_vec3 *root, int first, int last, int i, double frame_time)
{
    int before = i > first ? i - 1 : first, after = i < last ? i + 1 : last;
    if (after == before) return 0.0;
    ff_vec3 moved = ff_sub3(root[after], root[before]);
    return ff_length2(ff_v2(moved.x, moved.y)) / ((after - before) * frame_time);
}

double ff_walk_energy(const ff_energy_settings *energy, const ff_vec3 *root, int first, int last,
                      double frame_time)
{
    double sum = 0.0;
    for (int i = first; i <= last; ++i) {
        double v = ground_speed(root, first, last, i, frame_time);
        double weight = i == first || i == last ? 0.5 : 1.0;
        sum += weight * (energy->standing + energy->moving * v * v) * frame_time;
    }
    return last > first ? sum : 0.0;
}

bool ff_find_flight(const ff_plants *plants, int first, int last, int *from, int *to)
{
    int begin = -1, longest = 0;
    for (int i = first; i <= last + 1; ++i) {
        bool air = i <= last && ff_plant_at(plants, FF_LEFT, i) < 0 && ff_plant_at(plants, FF_RIGHT, i) < 0;
        if (air && begin < 0) begin = i;
        if (!air && begin >= 0) {
            if (i - begin > longest) {
                longest = i - begin;
                *from = begin;
                *to = i - 1;
            }
            begin = -1;
        }
    }
    return longest > 0;
}

/* Where the feet are in one frame. */
typedef struct feet {
    ff_vec2 ball[2];
    double yaw[2]; /* rad, heel to ball */
} feet;

static feet feet_at(const ff_rig *rig, const ff_motion *motion, int frame)
{
    ff_vec3 at[FF_BODY_COUNT];
    feet f;
    ff_motion_pose(rig, motion, frame, at, NULL);
    for (int foot = 0; foot < 2; ++foot) {
        ff_vec2 ball = ff_plane(at[foot == FF_LEFT ? FF_ROLE_BALL_L : FF_ROLE_BALL_R]);
        ff_vec2 along = ff_sub2(ball, ff_plane(at[foot == FF_LEFT ? FF_BODY_HEEL_L : FF_BODY_HEEL_R]));
        f.ball[foot] = ball;
        f.yaw[foot] = ff_atan2(along.b, along.a);
    }
    return f;
}

static void store2(float out[2], ff_vec2 v)
{
    out[0] = (float)v.a;
    out[1] = (float)v.b;
}

static void store3(float out[3], ff_vec2 v, double angle)
{
    store2(out, v);
    out[2] = (float)angle;
}

static uint32_t find_mode(const ff_step_settings *set, const ff_pack_action *r, const ff_step_span *span)
{
    if (span->mode >= 0) return (uint32_t)span->mode;
    if (r->flight[1] - r->flight[0] >= (float)set->flight || r->speed > (float)set->run_speed)
        return FF_MODE_RUN;
    return ff_length2(ff_v2((double)r->step_length, (double)r->step_width)) < MEDIAN_STEP ? FF_MODE_WALK_SHORT
                                                                                          : FF_MODE_WALK_LONG;
}

/* Times, feet and the flight. */
static void describe_time(const ff_energy_settings *energy, const ff_motion *motion, const ff_plants *plants,
                          const ff_step_span *span, ff_pack_action *r)
{
    double dt = motion->frame_time;
    int from = 0, to = 0;
    r->support = (uint32_t)plants->items[span->support].foot;
    r->swing = 1u - r->support;
    r->support_plant = (uint32_t)span->support;
    r->swing_plant = (uint32_t)span->swing;
    r->t_0 = (float)(span->first * dt);
    r->t_end = (float)(span->last * dt);
    r->duration = (float)((span->last - span->first) * dt);
    r->energy = (float)ff_walk_energy(energy, motion->root, span->first, span->last, dt);
    r->flight[0] = r->flight[1] = -1.0f;
    if (ff_find_flight(plants, span->first, span->last, &from, &to)) {
        r->flight[0] = (float)(from * dt);
        r->flight[1] = (float)((to + 1) * dt);
    }
}

/* Displacements and angles in frame S0. */
static void describe_step(const ff_motion *motion, const ff_step_span *span, const feet *start,
                          const feet *end, ff_vec2 left, ff_pack_action *r)
{
    ff_vec3 from = motion->root[span->first], to = motion->root[span->last];
    ff_vec2 axis = ff_fwd2(from.z), origin = start->ball[r->support];
    double side = r->swing == FF_LEFT ? 1.0 : -1.0;
    ff_vec2 moved = ff_to_frame2(axis, ff_v2(to.x - from.x, to.y - from.y));
    ff_vec2 swung = ff_to_frame2(axis, ff_sub2(end->ball[r->swing], left));
    ff_vec2 landed = ff_to_frame2(axis, ff_sub2(end->ball[r->swing], origin));
    store2(r->root_displacement, moved);
    r->speed = r->duration > 0.0f
                   ? (float)(ff_length2(moved) / ((span->last - span->first) * motion->frame_time))
                   : 0.0f;
    r->direction = (float)ff_atan2(moved.b, moved.a);
    store2(r->swing_displacement, swung);
    if (ff_length2(swung) < NO_DIRECTION)
        r->flags |= FF_ACTION_ALPHA_UNDEFINED;
    else
        r->alpha = (float)ff_wrap(side * ff_atan2(swung.b, swung.a));
    r->theta = (float)(to.z - from.z);
    r->step_length = (float)landed.a;
    r->step_width = (float)(side * landed.b); /* positive: the left foot is on the left */
    store3(r->root_start, ff_to_frame2(axis, ff_sub2(ff_v2(from.x, from.y), origin)), 0.0);
    store3(r->root_end, ff_to_frame2(axis, ff_sub2(ff_v2(to.x, to.y), origin)), to.z - from.z);
    store3(r->land, landed, ff_wrap(end->yaw[r->swing] - from.z));
    r->support_yaw = (float)ff_wrap(start->yaw[r->support] - from.z);
}

/* Contacts, flat stretches and lifts of both feet from first to last. What the clip cuts was not seen and is no event. */
static void list_events(const ff_motion *motion, const ff_plants *plants, ff_action *out)
{
    ff_pack_action *r = &out->record;
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *p = &plants->items[i];
        const int frames[FF_EVENT_KIND_COUNT] = {
            [FF_EVENT_CONTACT] = p->cut_start ? -1 : p->start,
            [FF_EVENT_FLAT] = p->cut_start && p->flat_start == p->start ? -1 : p->flat_start,
            [FF_EVENT_HEEL_OFF] =
                p->flat_end < 0 || (p->cut_end && p->flat_end == p->end) ? -1 : p->flat_end + 1,
            [FF_EVENT_TOE_OFF] = p->cut_end ? -1 : p->end + 1};
        for (uint32_t kind = 0; kind < FF_EVENT_KIND_COUNT; ++kind) {
            if (frames[kind] < out->first_frame || frames[kind] > out->last_frame) continue;
            if (r->event_count >= FF_ACTION_EVENTS_MAX) return;
            ff_pack_event event = {(float)(frames[kind] * motion->frame_time), (uint32_t)p->foot, kind,
                                   (uint32_t)i};
            uint32_t at = r->event_count++;
            for (; at > 0 && out->events[at - 1].time > event.time; --at)
                out->events[at] = out->events[at - 1];
            out->events[at] = event;
        }
    }
}

void ff_action_annotate(const ff_cut_settings *settings, const ff_rig *rig, const ff_motion *motion,
                        const ff_plants *plants, const ff_step_span *span, ff_action *out)
{
    memset(out, 0, sizeof *out);
    ff_pack_action *r = &out->record;
    out->first_frame = span->first;
    out->last_frame = span->last;
    r->flags = span->flags;
    double level = plants->items[span->support].level, landing = plants->items[span->swing].level;
    r->height = (float)(level * motion->scale);
    r->rise = (float)((landing - level) * motion->scale);
    describe_time(&settings->energy, motion, plants, span, r);
    feet start = feet_at(rig, motion, span->first), end = feet_at(rig, motion, span->last);
    /* The swing foot's old footstep is its ball at its full plant, so that one action's f starts where the last one
     * landed. */
    ff_vec2 left = start.ball[r->swing];
    if (span->swing_from >= 0) {
        int full = ff_plant_full(plants, span->swing_from);
        left = feet_at(rig, motion, full >= 0 && full < span->first ? full : span->first).ball[r->swing];
    }
    describe_step(motion, span, &start, &end, left, r);
    r->mode = find_mode(&settings->steps, r, span);
    list_events(motion, plants, out);
    ff_action_sample(&settings->colliders, rig, motion, start.ball[r->support], motion->root[span->first].z,
                     out);
    ff_join_read(rig, motion, span->first, start.ball[r->support], motion->root[span->first].z,
                 (double)r->height, &out->start);
    ff_join_read(rig, motion, span->last, end.ball[r->swing], motion->root[span->last].z,
                 (double)r->height + (double)r->rise, &out->end);
}
