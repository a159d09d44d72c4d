/* crowd_trial.h - the layouts of the navigation study (section 2) through the public API, and what is measured of them:
 * arrivals, interval penetration (G.1), acceleration (G.2). */
#ifndef FF_CROWD_TRIAL_H
#define FF_CROWD_TRIAL_H

#include "runtime/core/base/random.h"
#include "runtime/footfall.h"
#include "tests/check.h"

typedef enum trial_layout { TRIAL_CIRCLE, TRIAL_CROSS, TRIAL_CORRIDOR, TRIAL_FOUR } trial_layout;

typedef struct trial {
    trial_layout layout;
    uint32_t agents; /* of a circle */
    double step;     /* s */
    uint64_t seed;
    double limit; /* s */
    uint32_t threads;
    int leave;           /* 1: who arrives is taken away */
    double speed_spread; /* m/s, standard deviation of the preferred speed */
} trial;

typedef struct trial_result {
    uint32_t agents, arrived;
    double last;         /* s, of the last arrival */
    double mean;         /* s, of all arrivals */
    double deepest;      /* m, of any pair, swept between steps */
    double collisions;   /* C of G.1 */
    double acceleration; /* A of G.2, raw */
    double us_per_agent; /* and step */
    double wall_gap;     /* m, least distance of a root from a wall */
    uint64_t hash;
} trial_result;

#define TRIAL_MAX 1024

static inline void trial_add(ff_crowd *crowd, const trial *t, ff_random *random, ff_vec2 from, ff_vec2 goal)
{
    ff_error error;
    ff_agent agent;
    ff_agent_def def = ff_agent_def_default();
    def.position = from;
    def.goal = goal;
    ff_vec2 way = ff_sub2(goal, from);
    def.heading = ff_atan2(way.b, way.a);
    def.preferred_speed = ff_clamp(1.3 + t->speed_spread * ff_random_normal(random), 0.9, 1.7);
    FF_ASSERT_OK(ff_crowd_add_agent(crowd, &def, &agent, &error), error);
}

static inline void trial_block(ff_crowd *crowd, const trial *t, ff_random *random, ff_vec2 corner,
                               ff_vec2 way, double travel, uint32_t count, uint32_t columns, double spacing,
                               double jitter)
{
    /* Columns across the way, rows backwards from the corner's row. */
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t row = i / columns;
        double back = row * spacing + ff_random_range(random, -jitter, jitter);
        double across = ((double)(i % columns) - 0.5 * (columns - 1)) * spacing +
                        ff_random_range(random, -jitter, jitter);
        ff_vec2 p = ff_madd2(ff_madd2(corner, way, -back), ff_left2(way), across);
        trial_add(crowd, t, random, p, ff_madd2(p, way, travel));
    }
}

static inline void trial_wall(ff_crowd *crowd, ff_vec2 p, ff_vec2 q)
{
    ff_error error;
    FF_ASSERT_OK(ff_crowd_add_wall(crowd, p, q, &error), error);
}

static inline void trial_lay_out(ff_crowd *crowd, const trial *t)
{
    ff_random random = {t->seed, 77, 0};
    if (t->layout == TRIAL_CIRCLE) {
        double radius = ff_max(4.0, 0.16 * t->agents);
        for (uint32_t i = 0; i < t->agents; ++i) {
            double angle = FF_TAU * i / t->agents + ff_random_range(&random, -0.01, 0.01);
            ff_vec2 p = ff_scale2(ff_fwd2(angle), radius);
            trial_add(crowd, t, &random, p, ff_scale2(p, -1.0));
        }
    } else if (t->layout == TRIAL_CROSS) {
        trial_block(crowd, t, &random, ff_v2(-8.7, 0.0), ff_v2(1.0, 0.0), 20.0, 15, 3, 0.66, 0.02);
        trial_block(crowd, t, &random, ff_v2(0.0, -8.7), ff_v2(0.0, 1.0), 20.0, 15, 3, 0.66, 0.02);
    } else if (t->layout == TRIAL_CORRIDOR) {
        for (int side = -1; side <= 1; side += 2)
            trial_wall(crowd, ff_v2(-40.0, 2.0 * side), ff_v2(40.0, 2.0 * side));
        trial_block(crowd, t, &random, ff_v2(-7.0, 0.0), ff_v2(1.0, 0.0), 24.0, 27, 4, 0.90, 0.05);
        trial_block(crowd, t, &random, ff_v2(7.0, 0.0), ff_v2(-1.0, 0.0), 24.0, 26, 4, 0.90, 0.05);
    } else {
        for (int corner = 0; corner < 4; ++corner) {
            ff_vec2 way = ff_fwd2(FF_PI * (0.25 + 0.5 * corner));
            ff_vec2 centre = ff_scale2(way, -12.0 * sqrt(2.0)), axis = ff_fwd2(0.5 * FF_PI * corner);
            for (int i = 0; i < 25; ++i) {
                int row = i / 5 - 2, column = i % 5 - 2;
                ff_vec2 p = ff_madd2(centre, axis, column * 1.11 + ff_random_range(&random, -0.125, 0.125));
                p = ff_madd2(p, ff_left2(axis), row * 1.11 + ff_random_range(&random, -0.125, 0.125));
                trial_add(crowd, t, &random, p, ff_madd2(p, way, 24.0 * sqrt(2.0)));
            }
        }
    }
}

/* Deepest overlap of the pair while both move in a straight line from step to step (G.1, corrected). */
static inline double trial_depth(ff_vec2 start, ff_vec2 end, double reach)
{
    ff_vec2 move = ff_sub2(end, start);
    double square = ff_dot2(move, move);
    double s = square < 1e-12 ? 0.0 : ff_clamp(-ff_dot2(start, move) / square, 0.0, 1.0);
    return ff_max(0.0, reach - ff_length2(ff_madd2(start, move, s)));
}

static inline trial_result trial_run(const ff_pack *pack, const trial *t)
{
    ff_error error;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = TRIAL_MAX;
    def.step = t->step;
    def.threads = t->threads ? t->threads : 1;
    ff_crowd *crowd = NULL;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    trial_lay_out(crowd, t);
    static ff_agent_state before[TRIAL_MAX], after[TRIAL_MAX];
    static uint8_t done[TRIAL_MAX];
    static ff_agent agents[TRIAL_MAX];
    uint32_t n = ff_crowd_agents(crowd, agents, TRIAL_MAX);
    trial_result r = {.agents = n, .wall_gap = 1e9};
    double agent_steps = 0.0;
    memset(done, 0, sizeof done);
    for (uint32_t i = 0; i < n; ++i)
        FF_ASSERT_OK(ff_crowd_agent_state(crowd, agents[i], &before[i], &error), error);
    while (r.arrived < n && (double)ff_crowd_step_count(crowd) * t->step < t->limit) {
        ff_crowd_step(crowd);
        double time = (double)ff_crowd_step_count(crowd) * t->step;
        for (uint32_t i = 0; i < n; ++i) {
            if (done[i] == 2) continue;
            FF_ASSERT_OK(ff_crowd_agent_state(crowd, agents[i], &after[i], &error), error);
            assert_true(isfinite(after[i].position.a) && isfinite(after[i].position.b));
            agent_steps += 1.0;
            if (t->layout == TRIAL_CORRIDOR) r.wall_gap = ff_min(r.wall_gap, 2.0 - fabs(after[i].position.b));
            r.acceleration += ff_length2(ff_sub2(after[i].velocity, before[i].velocity)) / t->step;
            for (uint32_t j = 0; j < i; ++j) {
                if (done[j] == 2) continue;
                double reach = after[i].radius + after[j].radius;
                double depth = trial_depth(ff_sub2(before[i].position, before[j].position),
                                           ff_sub2(after[i].position, after[j].position), reach);
                r.deepest = ff_max(r.deepest, depth);
                r.collisions += depth / reach;
            }
        }
        for (uint32_t i = 0; i < n; ++i) {
            if (done[i] == 2) continue;
            before[i] = after[i];
            if (!done[i] && after[i].reached) {
                done[i] = 1;
                ++r.arrived;
                r.mean += time;
                r.last = time;
                if (t->leave) {
                    done[i] = 2;
                    FF_ASSERT_OK(ff_crowd_remove_agent(crowd, agents[i], &error), error);
                }
            }
        }
    }
    r.mean /= ff_max(r.arrived, 1);
    r.collisions /= ff_max(agent_steps, 1.0);
    r.acceleration /= ff_max(agent_steps, 1.0);
    r.us_per_agent = ff_crowd_time_spent(crowd).total * 1e6 / ff_max(agent_steps, 1.0);
    r.hash = ff_crowd_state_hash(crowd);
    ff_crowd_destroy(crowd);
    return r;
}

#endif
