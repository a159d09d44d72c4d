/* blend_follow.c - from one blend to another, gradually: "weights change smoothly" (synthesis study, section 6). */
#include "runtime/core/gait/blend.h"

#define TURN_ABOUT_SPEED 1.2 /* m/s2 */
#define CATCH_UP_TIME 0.05   /* s */
#define PERIOD_SPEED 2.0 /* s per s: steps that shorten quicker would throw the foot that is behind ahead */

/* Weights of all examples of either blend, those of both at the same place; at most twice FF_BLEND_MAX. */
typedef struct weighing {
    int32_t vertex[2 * FF_BLEND_MAX];
    double now[2 * FF_BLEND_MAX], wanted[2 * FF_BLEND_MAX];
    int count;
} weighing;

static int place_of(weighing *all, int32_t vertex)
{
    int i = 0;
    while (i < all->count && all->vertex[i] != vertex)
        ++i;
    if (i < all->count) return i;
    all->vertex[i] = vertex;
    all->now[i] = all->wanted[i] = 0.0;
    return all->count++;
}

/* By how much weights must change in all. */
static double weigh_both(const ff_blend *now, const ff_blend *wanted, weighing *all)
{
    double change = 0.0;
    all->count = 0;
    for (int k = 0; k < FF_BLEND_MAX; ++k) {
        if (now->vertex[k] >= 0) all->now[place_of(all, now->vertex[k])] += now->weight[k];
        if (wanted->vertex[k] >= 0) all->wanted[place_of(all, wanted->vertex[k])] += wanted->weight[k];
    }
    for (int i = 0; i < all->count; ++i)
        change += fabs(all->wanted[i] - all->now[i]);
    return change;
}

/* Of what is left to take: what is wanted comes first, or it would never get in. */
static int next_of(const weighing *all)
{
    int best = -1;
    for (int i = 0; i < all->count; ++i) {
        if (!(all->now[i] > 0.0)) continue;
        bool wanted = all->wanted[i] > 0.0, best_wanted = best >= 0 && all->wanted[best] > 0.0;
        if (best < 0 || (wanted == best_wanted ? all->now[i] > all->now[best] : wanted)) best = i;
    }
    return best;
}

/* The FF_BLEND_MAX most important of the weights, and what the blend's cycle and root then are: both are sums over warped time. */
static void take_most(const ff_blend_space *space, weighing *all, ff_blend *blend)
{
    ff_vec3 way = ff_v3(0.0, 0.0, 0.0);
    double sum = 0.0, period = 0.0;
    int best;
    ff_blend_clear(blend);
    for (int k = 0; k < FF_BLEND_MAX && (best = next_of(all)) >= 0; ++k) {
        blend->vertex[k] = all->vertex[best];
        blend->weight[k] = all->now[best];
        sum += blend->weight[k];
        all->now[best] = 0.0;
    }
    for (int k = 0; k < FF_BLEND_MAX && blend->vertex[k] >= 0; ++k) {
        blend->weight[k] /= sum;
        double share = blend->weight[k] * space->vertices[blend->vertex[k]].period;
        period += share;
        way = ff_madd3(way, space->points[blend->vertex[k]], share);
    }
    blend->period = period;
    blend->rates = ff_blend_rates(ff_scale3(way, 1.0 / period));
}

void ff_blend_follow(const ff_blend_space *space, const ff_blend *wanted, double most, ff_blend *blend)
{
    weighing all;
    uint32_t way = wanted->way;
    double change = weigh_both(blend, wanted, &all);
    if (blend->way != way || way == FF_SEMI_PROCEDURAL || change <= most) {
        *blend = *wanted;
        return;
    }
    for (int i = 0; i < all.count; ++i)
        all.now[i] += (all.wanted[i] - all.now[i]) * most / change;
    take_most(space, &all, blend);
    if (blend->vertex[0] < 0) *blend = *wanted; /* it was a blend of nothing */
    blend->way = way;
}

/* Between going ahead and going back the clip is turned about, so that feet lift otherwise: who brakes and backs off at once would
 * be through that within a tenth of a second, in the middle of a swing. */
static double turn_about(double now, double wanted, double dt)
{
    double past = ff_max(fabs(now) - FF_MODEL_TURN_ABOUT, 0.0);
    double most = (TURN_ABOUT_SPEED + past / CATCH_UP_TIME) * dt;
    return ff_clamp(wanted, now - most, now + most);
}

void ff_clip_follow(const ff_blend_space *space, ff_rates wanted, double dt, ff_blend *blend)
{
    double forward = blend->rates.forward, period = blend->period, most = PERIOD_SPEED * dt;
    wanted.forward = turn_about(forward, wanted.forward, dt);
    ff_locomotion_find(space, FF_SEMI_PROCEDURAL, wanted, blend);
    blend->period = ff_clamp(blend->period, period - most, period + most);
}
