/* play_stance.c - when and where either foot stands in an action, read from the poses that are played: the clip's plants say about
 * when, and of captured feet they say too little (README, Playing). */
#include "runtime/core/play/play_set.h"

#define STILL 0.004    /* m, that a ball may be off its place on the ground ... */
#define STILL_UP 0.02  /* ... and over its height there (it rises as the toes bend) */
#define SLIDE 0.02     /* m: so near to its place, with the ball no higher ... */
#define BALL_UP 0.0035 /* ... than this, ... */
#define HEEL_UP 0.012  /* ... and the heel than this, a foot has arrived: what it still slides is taken out */
#define CARRIES 0.1    /* m, that a foot on which the body is may slide in its clip, ... */
#define CARRIES_UP 0.012   /* ... the ball no higher than this */
#define SOONER 0.1         /* s, by which a foot may arrive before the contact in the clip's signals */
#define SHORTEST 0.05      /* s: what is still for less as an action begins is leaving already */
#define LOOK (1.0 / 120.0) /* s between two looks */

typedef struct finding {
    const ff_pack *pack;
    const ff_body_frame *body;
    ff_play_action *action;
    double lands; /* s from t_0: the swing foot's contact */
} finding;

/* A plant of the clip, s from t_0. */
typedef struct plant_times {
    double start, end, flat_start, flat_end;
    int foot; /* of the action: the other one where it is mirrored */
} plant_times;

/* A foot at one moment. */
typedef struct still_foot {
    ff_vec3 ball;
    double yaw;
    double up; /* m, of the ball over where it rests */
    ff_play_over over;
} still_foot;

static still_foot look_at(const finding *f, int foot, double time)
{
    ff_play_sample at;
    ff_play_action_sample(f->pack, f->body, f->action, time, &at);
    still_foot out = {.ball = at.ball[foot], .yaw = ff_play_foot_yaw(at.foot[foot])};
    out.up = out.ball.y - f->body->ball_rest;
    out.over = ff_play_over_ground(f->body, foot, out.ball.y, at.foot[foot]);
    return out;
}

static bool is_within(still_foot now, still_foot there, double distance)
{
    ff_vec2 off = ff_plane(ff_sub3(now.ball, there.ball));
    return ff_dot2(off, off) < distance * distance;
}

static bool is_still(still_foot now, still_foot there)
{
    return is_within(now, there, STILL) && now.ball.y - there.ball.y < STILL_UP;
}

/* Does the whole foot lie on the ground, all but at its place? */
static bool has_arrived(still_foot now, still_foot there)
{
    return is_within(now, there, SLIDE) && now.up < BALL_UP && now.over.heel < HEEL_UP;
}

/* Is the foot on the ground, though it slides, or turns on its ball? */
static bool carries(still_foot now, still_foot there)
{
    return is_within(now, there, CARRIES) && now.up < CARRIES_UP;
}

/* From a moment at which the foot stands, until when it goes on: still until high; carries until limit. */
static double stance_ends(const finding *f, int foot, double time, still_foot there, double high,
                          double limit)
{
    while (time < high || time < limit) {
        double next = ff_min(time + LOOK, time < high ? high : limit);
        still_foot now = look_at(f, foot, next);
        if (!(next <= high && is_still(now, there)) && !(next <= limit && carries(now, there))) break;
        time = next;
    }
    return time;
}

/* Since when a foot stands that surely does at a time: still, but not before the contact at low, or arrived. */
static double stance_begins(const finding *f, int foot, double time, still_foot there, double low)
{
    const ff_play_action *action = f->action;
    double limit = low;
    uint32_t count = action->stance_count[foot];
    if (low > 0.0) limit = ff_clamp(low - SOONER, 0.0, low);
    if (low > 0.0 && count > 0) limit = ff_clamp(action->stance[foot][count - 1].to + SHORTEST, limit, low);
    while (time > limit) {
        double next = ff_max(time - LOOK, time > low ? low : limit);
        still_foot now = look_at(f, foot, next);
        if (!(next >= low && is_still(now, there)) && !has_arrived(now, there)) break;
        time = next;
    }
    return time;
}

/* From when on a foot that stands in [from, to] is down until then: its ball, and, if it comes down at all, its heel. */
static double comes_down(const finding *f, int foot, double from, double to)
{
    bool on_ball = look_at(f, foot, to).over.heel >= HEEL_UP; /* all the time */
    double time = to;
    while (time > from) {
        double next = ff_max(time - LOOK, from);
        still_foot now = look_at(f, foot, next);
        if (now.up >= BALL_UP || (!on_ball && now.over.heel >= HEEL_UP)) break;
        time = next;
    }
    return time;
}

static void add_end(const finding *f, int foot, int end, ff_play_stance *stance)
{
    double time = end == 0 ? stance->from : stance->to;
    ff_vec2 now = ff_plane(look_at(f, foot, time).ball);
    ff_vec2 later = ff_plane(look_at(f, foot, time + LOOK).ball);
    stance->off[end] = ff_sub2(now, ff_v2(stance->a, stance->b));
    stance->speed[end] = ff_scale2(ff_sub2(later, now), 1.0 / LOOK);
    ff_play_over over = look_at(f, foot, end == 0 ? stance->down : stance->to).over;
    stance->over[end] = over.toes + over.sole;
    if (end == 0 && stance->over[0] < BALL_UP) stance->over[0] = 0.0; /* it comes down by itself */
}

/* The moment of a plant at which the foot surely stands: the place of a support foot is where it is when the action begins, that
 * of a landing where it is at the end (pack_format.h, S0 and land); else the middle. */
static double surely_still(const plant_times *plant, double low, double high, double duration)
{
    if (plant->flat_start <= LOOK && plant->flat_end >= 0.0) return low;
    if (plant->flat_start <= duration + LOOK && plant->flat_end >= duration) return high;
    return ff_clamp(0.5 * (ff_max(plant->flat_start, low) + ff_min(plant->flat_end, high)), low, high);
}

static void add_stance(const finding *f, const plant_times *plant)
{
    ff_play_action *action = f->action;
    int foot = plant->foot;
    uint32_t count = action->stance_count[foot];
    double low = ff_clamp(plant->start, 0.0, action->duration), high = ff_min(plant->end, action->duration);
    if (count == FF_PLAY_STANCES || high < low) return;
    double surely = surely_still(plant, low, high, action->duration);
    still_foot there = look_at(f, foot, surely), first = look_at(f, foot, 0.0);
    /* The body is on its support foot, though in the clip that may only come to rest a little later, and slide or turn on its ball before
     * the other one has landed. A foot that comes to rest soon after the action begins, and is on the ground already, stood before. */
    bool support = count == 0 && low <= LOOK && foot == (int)action->support;
    double from = stance_begins(f, foot, surely, there, low);
    double to = stance_ends(f, foot, surely, there, high, support ? ff_min(high, f->lands) : 0.0);
    if (support || (count == 0 && from < SOONER && carries(first, there))) from = 0.0;
    if (to > action->duration - LOOK) to = action->duration; /* the plant's own times are rounded */
    if (to - from < SHORTEST && to < action->duration) return;
    if (support) there = first;
    ff_play_stance *stance = &action->stance[foot][count];
    *stance =
        (ff_play_stance){.from = from, .to = to, .a = there.ball.z, .b = there.ball.x, .yaw = there.yaw};
    stance->down = from > 0.0 ? comes_down(f, foot, from, to) : from;
    add_end(f, foot, 0, stance);
    add_end(f, foot, 1, stance);
    action->stance_count[foot] = count + 1;
}

static plant_times times_of(const finding *f, const ff_pack_plant *plant, double t_0)
{
    plant_times out = {.start = (double)plant->start - t_0, .end = (double)plant->end - t_0};
    bool flat = plant->flat_start >= 0.0f && plant->flat_end >= plant->flat_start;
    out.flat_start = flat ? (double)plant->flat_start - t_0 : out.start;
    out.flat_end = flat ? (double)plant->flat_end - t_0 : out.end;
    out.foot = f->action->mirrored ? 1 - (int)plant->foot : (int)plant->foot;
    return out;
}

void ff_play_find_stances(const ff_pack *pack, const ff_body_frame *body, const ff_pack_action *record,
                          ff_play_action *action)
{
    const ff_pack_clip *clip = &pack->clips[record->clip];
    const ff_pack_plant *plants = &pack->plants[clip->first_plant];
    finding f = {pack, body, action, action->duration};
    for (uint32_t p = 0; p < clip->plant_count; ++p) {
        plant_times plant = times_of(&f, &plants[p], (double)record->t_0);
        bool lands = plant.start > 0.0 && plant.end >= action->duration;
        if (lands && plant.foot != (int)action->support) f.lands = ff_min(f.lands, plant.start);
    }
    for (uint32_t p = 0; p < clip->plant_count; ++p) {
        plant_times plant = times_of(&f, &plants[p], (double)record->t_0);
        if (plant.end >= 0.0 && plant.start <= action->duration + LOOK) add_stance(&f, &plant);
    }
}
