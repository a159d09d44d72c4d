/* crowd_glides.c - mutual passive safety of those who go by velocity and those who plan.
 *
 * A plan is public and ends in a stand, so where its owner will be is known. Who goes by velocity publishes the same: a glide, going on
 * with what was decided for a while and then braking to a stand, as bodies do (navigation study, section 1). After navigation has decided,
 * the velocity nearest to it is taken from which a glide leads that is free of all plans in force; and a plan comes into force only when
 * it is free of the glides of this step (crowd_plan.c). Who finds nothing else keeps the glide, or the plan, of the step before,
 * which was free. Navigation comes before planning in a step, so each decides on what the other has published.
 */
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/nav/nav_forces.h"
#include "runtime/core/plan/plan_set.h"
#include "runtime/core/plan/plan_solids.h"

#define WIDE 0.36      /* m from the root: elbows and hands, and feet of who steps aside */
#define STRIDE 0.20    /* m more before and behind, of who walks briskly */
#define BRISK 1.2      /* m/s */
#define MARGIN 0.04    /* m, between a glide and a track */
#define REGAIN 0.4     /* m/s, at which room is regained of those who are too near */
#define LAG 0.3        /* s, of a body (body.c) */
#define CHANGE_MAX 4.0 /* m/s^2 */
#define SLOW 0.03      /* m/s: stands */
#define REACH 4.0      /* m, within which tracks and glides are looked at: no glide is longer */
#define SWEPT 0.5      /* m, that two bodies come nearer in a knot, and some */
/* s: whose glide is free for so long goes on as decided; who plans leaves the end of a glide free for ever. Were both to look as far,
 * people would stand and wait for plans that are changed long before they come (circle of 40: 0.62 instead of 0.71 m/s). */
#define FORESEEN 3.0
#define PEOPLE 1.5    /* s, for which others who go by velocity are believed to go on as they do ... */
#define SOON 1.0      /* ... and in which their discs must not be met, or something else is looked for */
#define OF_PEOPLE 0.5 /* how much a disc counts beside a plan, whose owner gives no way */
#define STANDING 0.7  /* m/s, at which one who stands steps aside at most */
#define TOUCH 0.02    /* m: what comes nearer to a plan than that takes its owner by surprise */

enum { SUBSTEPS = 2, PLANS_MOST = 128, HOLDS = 5, WAYS = 31 };
/* s, after which it is braked; the last is at once. */
static const double holds[HOLDS] = {2.0, 1.2, 0.7, 0.35, 0.0};

/* ------------------------------------------------------------------------------------------------- one glide */

void ff_glide_roll(ff_vec2 position, ff_vec2 velocity, ff_vec2 command, double hold, ff_glide *out)
{
    const double dt = FF_TRACK_STEP / SUBSTEPS;
    ff_vec2 p = ff_v2(0.0, 0.0), v = velocity;
    out->origin = position;
    for (int j = 0; j < FF_GLIDE_POINTS; ++j) {
        out->a[j] = (float)p.a;
        out->b[j] = (float)p.b;
        for (int k = 0; k < SUBSTEPS; ++k) {
            double t = j * FF_TRACK_STEP + k * dt;
            ff_vec2 target = t < hold ? command : ff_v2(0.0, 0.0);
            ff_vec2 change = ff_shorten2(ff_scale2(ff_sub2(target, v), 1.0 / LAG), CHANGE_MAX);
            v = ff_madd2(v, change, dt);
            if (t >= hold && ff_dot2(v, v) < SLOW * SLOW) v = ff_v2(0.0, 0.0);
            p = ff_madd2(p, v, dt);
        }
    }
}

static ff_vec2 glide_at(const ff_glide *g, int j)
{
    j = j < FF_GLIDE_POINTS ? j : FF_GLIDE_POINTS - 1;
    return ff_add2(g->origin, ff_v2((double)g->a[j], (double)g->b[j]));
}

/* m between the body that goes from p to q and colliders that go from x0 to x1, about an origin, in a knot's time. */
static double gap_between(ff_vec2 p, ff_vec2 q, ff_vec2 origin, const ff_knot *x0, const ff_knot *x1,
                          const float *radii)
{
    ff_vec2 moved = ff_sub2(q, p);
    double far = ff_length2(moved), speed = far / FF_TRACK_STEP, least = INFINITY;
    ff_solid body = {.centre = p,
                     .axis = far > 1e-6 ? ff_scale2(moved, 1.0 / far) : ff_v2(1.0, 0.0),
                     .half_length = STRIDE * ff_min(speed / BRISK, 1.0)};
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
        ff_vec2 from = ff_add2(origin, ff_v2((double)x0->a[i], (double)x0->b[i]));
        ff_vec2 to = ff_sub2(ff_add2(origin, ff_v2((double)x1->a[i], (double)x1->b[i])), moved);
        least = ff_min(least, sqrt(ff_solid_distance2(&body, from, to)) - (double)radii[i]);
    }
    return least - WIDE;
}

/* Colliders at a place between two knots. */
static void track_at(const ff_track *track, double k, ff_knot *out)
{
    double last = (double)(track->count - 1), at = ff_clamp(k, 0.0, last);
    uint32_t i = (uint32_t)at;
    const ff_knot *p = &track->knots[i], *q = p + (i + 1 < track->count);
    float share = (float)(at - (double)i);
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
        out->a[c] = p->a[c] + share * (q->a[c] - p->a[c]);
        out->b[c] = p->b[c] + share * (q->b[c] - p->b[c]);
        out->y[c] = p->y[c];
    }
}

/* Are they too far from each other, from one knot to the next, to come within the margin? */
static bool far_apart(const ff_track *track, double k, ff_vec2 p)
{
    uint32_t i = (uint32_t)ff_clamp(k, 0.0, (double)(track->count - 1));
    const ff_knot *at = &track->knots[i];
    ff_vec2 root =
        ff_add2(track->origin, ff_v2((double)at->a[FF_COLLIDER_ROOT], (double)at->b[FF_COLLIDER_ROOT]));
    ff_vec2 x = ff_sub2(root, p);
    double reach = (double)track->radius[i] + WIDE + STRIDE + MARGIN + SWEPT;
    return ff_dot2(x, x) > reach * reach;
}

double ff_glide_meets(const ff_glide *glide, const ff_track *track, double time, double seconds, double *when)
{
    double first = time / FF_TRACK_STEP - (double)track->first, most = -INFINITY, start = INFINITY;
    if (when) *when = INFINITY;
    /* From when both stand on nothing changes. */
    double stand = ff_max((double)track->count - first + 1.0, FF_GLIDE_POINTS);
    int end = (int)ff_min(ff_min(seconds / FF_TRACK_STEP, stand), FF_TRACK_KNOTS_MAX);
    for (int j = 0; j < end; ++j) {
        ff_vec2 p = glide_at(glide, j), q = glide_at(glide, j + 1);
        if (far_apart(track, first + j, p)) continue;
        ff_knot x0, x1;
        track_at(track, first + j, &x0);
        track_at(track, first + j + 1, &x1);
        if (j == 0) start = gap_between(p, p, track->origin, &x0, &x0, track->radii) - 1e-3;
        double need = ff_min(MARGIN, start + REGAIN * (j * FF_TRACK_STEP));
        double lacks = need - gap_between(p, q, track->origin, &x0, &x1, track->radii);
        if (lacks > 0.0 && when && *when == INFINITY) *when = j * FF_TRACK_STEP;
        most = ff_max(most, lacks);
    }
    return most;
}

/* ------------------------------------------------------------------------------------------------- who is near */

typedef struct around {
    const ff_crowd *crowd;
    const ff_seen *me;
    const ff_neighbour *neighbours;
    uint32_t neighbour_count, count;
    double time;
    const ff_track *plans[PLANS_MOST];
} around;

static void look_around(const ff_crowd *crowd, uint32_t index, around *out)
{
    const ff_footsteps *f = crowd->footsteps;
    const ff_seen *me = &crowd->grid.seen[index];
    ff_vec2 reach = ff_v2(REACH, REACH);
    ff_bounds view = {ff_sub2(me->position, reach), ff_add2(me->position, reach)};
    *out = (around){.crowd = crowd,
                    .me = me,
                    .neighbours = crowd->neighbours[index],
                    .neighbour_count = crowd->neighbour_count[index],
                    .time = ff_crowd_time(crowd)};
    for (uint32_t i = 0; i < crowd->slot_count && out->count < PLANS_MOST; ++i)
        if (ff_bounds_meet(&f->bounds[i], &view)) out->plans[out->count++] = &crowd->steppers[i].track;
}

/* How deep discs of others who go by velocity would be met, within so many seconds; how deep more than now. */
static double meets_people(const around *r, const ff_glide *glide, double seconds)
{
    double most = -INFINITY;
    for (uint32_t i = 0; i < r->neighbour_count; ++i) {
        const ff_seen *other = &r->crowd->grid.seen[r->neighbours[i].index];
        if (other->firm) continue;
        double reach = r->me->radius + other->radius;
        double start = ff_length2(ff_sub2(other->position, r->me->position)) - reach - 1e-3;
        for (int j = 1; j < FF_GLIDE_POINTS && j * FF_TRACK_STEP <= seconds; ++j) {
            double t = j * FF_TRACK_STEP;
            ff_vec2 x = ff_sub2(ff_madd2(other->position, other->reference, t), glide_at(glide, j));
            double need = ff_min(0.0, start + REGAIN * t);
            most = ff_max(most, need - (ff_length2(x) - reach));
        }
    }
    return most;
}

static double meets_plans(const around *r, const ff_glide *glide)
{
    double most = -INFINITY;
    for (uint32_t i = 0; i < r->count; ++i)
        most = ff_max(most, ff_glide_meets(glide, r->plans[i], r->time, FORESEEN, NULL));
    return most;
}

/* ------------------------------------------------------------------------------------------------- choosing */

/* What a body makes of a command. */
static ff_vec2 can_do(const ff_crowd *crowd, uint32_t slot, ff_vec2 command)
{
    const ff_body *body = &crowd->bodies[slot];
    ff_vec2 ahead = ff_fwd2(body->heading), local = ff_to_frame2(ahead, command);
    bool back = crowd->def.mcn.back_pedal || crowd->minds[slot].standing;
    if (!back) local.a = ff_max(local.a, 0.0);
    ff_rates rates = ff_gait_clamp(crowd->space, &crowd->gaits[slot], (ff_rates){local.a, local.b, 0.0});
    return ff_from_frame2(ahead, ff_v2(rates.forward, rates.left));
}

typedef struct way {
    ff_vec2 command;
    double off;  /* m/s from what was decided */
    double hold; /* s; < 0: any */
} way;

/* What was kept before, and other commands, nearest to what was decided first. */
static int list_ways(ff_vec2 decided, way kept, ff_vec2 ahead, way ways[WAYS])
{
    static const double turn[] = {0.0, 0.45, -0.45, 0.9, -0.9, 1.4, -1.4, 2.2, -2.2},
                        fast[] = {1.0, 0.65, 0.35};
    double speed = ff_length2(decided);
    ff_vec2 axis = speed > 0.1 ? ff_scale2(decided, 1.0 / speed) : ahead;
    way list[WAYS];
    int count = 0, n = 0;
    speed = ff_max(speed, STANDING);
    list[count++] = kept;
    list[count++] = (way){ff_v2(0.0, 0.0), 0.0, 0.0};
    for (int f = 0; f < 3; ++f)
        for (int k = 0; k < 9; ++k)
            list[count++] =
                (way){ff_scale2(ff_from_frame2(axis, ff_fwd2(turn[k])), fast[f] * speed), 0.0, -1.0};
    for (int i = 0; i < count; ++i) {
        way one = list[i];
        one.off = ff_length2(ff_sub2(one.command, decided));
        int at = n++;
        for (; at > 0 && one.off < ways[at - 1].off; --at)
            ways[at] = ways[at - 1];
        ways[at] = one;
    }
    return n;
}

/* The glide that goes on longest of those that are free; else the least deep. Returns how deep. */
static double best_glide(const around *r, way *w, double people, ff_glide *out)
{
    uint32_t slot = r->me->slot;
    ff_vec2 velocity = ff_body_velocity(&r->crowd->bodies[slot]), goes = can_do(r->crowd, slot, w->command);
    double least = INFINITY, given = w->hold;
    for (int h = 0; h < (given < 0.0 ? HOLDS : 1) && least > 0.0; ++h) {
        ff_glide one;
        double hold = ff_max(given < 0.0 ? holds[h] : given, r->crowd->def.step);
        ff_glide_roll(r->me->position, velocity, goes, hold, &one);
        double deep = meets_plans(r, &one);
        if (deep < least && people > 0.0) deep = ff_max(deep, OF_PEOPLE * meets_people(r, &one, people));
        if (deep >= least) continue;
        least = deep;
        w->hold = hold;
        *out = one;
    }
    return least;
}

/* Others than what was decided, if that is not free. */
static way choose(const around *r, const way *decided, double deep, ff_glide *out)
{
    const ff_stepper *s = &r->crowd->steppers[r->me->slot];
    way ways[WAYS], best = *decided;
    ff_glide one;
    way kept = {s->goes, 0.0, ff_max(s->brakes - r->crowd->def.step, 0.0)};
    int count = list_ways(decided->command, kept, ff_fwd2(r->crowd->bodies[r->me->slot].heading), ways);
    for (int i = 0; i < count && deep > 0.0; ++i) {
        double other = best_glide(r, &ways[i], PEOPLE, &one);
        if (other >= deep) continue;
        deep = other;
        best = ways[i];
        *out = one;
    }
    return best;
}

void ff_glide_choose(ff_crowd *crowd, uint32_t index)
{
    around r;
    look_around(crowd, index, &r);
    uint32_t slot = r.me->slot;
    ff_glide *out = &crowd->footsteps->glides[slot];
    ff_mind *mind = &crowd->minds[slot];
    way taken = {mind->command, 0.0, -1.0};
    double deep = best_glide(&r, &taken, 0.0, out);
    if (r.count > 0 && crowd->traits[slot].navigation == FF_NAVIGATION_MCN &&
        (deep > 0.0 || meets_people(&r, out, SOON) > 0.0)) {
        taken = choose(&r, &taken, ff_max(deep, OF_PEOPLE * meets_people(&r, out, PEOPLE)), out);
        mind->command = taken.command;
    }
    crowd->steppers[slot].goes = taken.command;
    crowd->steppers[slot].brakes = taken.hold;
}

/* ------------------------------------------------------------------------------------------------- who plans */

/* Can it be met by somebody within bounds? */
static bool is_near(const ff_seen *other, uint32_t slot, const ff_bounds *bounds)
{
    if (other->firm || other->slot == slot) return false;
    ff_vec2 reach = ff_v2(REACH, REACH);
    ff_bounds near = {ff_sub2(other->position, reach), ff_add2(other->position, reach)};
    return ff_bounds_meet(&near, bounds);
}

double ff_glides_met(const ff_crowd *crowd, uint32_t slot, const ff_track *track, const ff_bounds *bounds,
                     double time, double seconds)
{
    double least = INFINITY, when;
    if (crowd->stepper_count == crowd->agent_count) return INFINITY;
    for (uint32_t i = 0; i < crowd->grid.count; ++i) {
        const ff_seen *other = &crowd->grid.seen[i];
        if (!is_near(other, slot, bounds)) continue;
        if (ff_glide_meets(&crowd->footsteps->glides[other->slot], track, time, seconds, &when) > TOUCH)
            least = ff_min(least, when);
    }
    return least;
}

bool ff_glides_allow(const ff_crowd *crowd, const ff_plan_job *job, double time)
{
    if (crowd->stepper_count == crowd->agent_count) return true;
    for (uint32_t i = 0; i < crowd->grid.count; ++i) {
        const ff_seen *other = &crowd->grid.seen[i];
        if (!is_near(other, job->slot, &job->bounds)) continue;
        const ff_glide *glide = &crowd->footsteps->glides[other->slot];
        double deep = ff_glide_meets(glide, &job->track, time, INFINITY, NULL);
        if (deep <= 0.0) continue;
        if (!ff_is_stepper(crowd, job->slot) ||
            ff_glide_meets(glide, &crowd->steppers[job->slot].track, time, INFINITY, NULL) < deep)
            return false;
    }
    return true;
}
