#include "runtime/core/gait/synth_choice.h"

/* Algorithms D.5. The time must be longer than a switch takes (0.4 s until the next pair, 0.3 s for the pose) and shorter
 * than ORCA's horizon of 2.5 s. With the 1.0 s proposed there control came too late on the obstacle course: people who are
 * not steered in time already brush each other (bench hybrid). */
#define TRANSITION_TIME 2.0
#define DENSITY 1.0 /* 1/m2 */
/* Back to blending only with a margin in both, for a while; and nobody changes twice within DWELL. */
#define TIME_MARGIN 1.3
#define DENSITY_MARGIN 0.85
#define CALM 0.75  /* s */
#define DWELL 0.5  /* s */
#define URGENT 0.4 /* s to the collision */
#define RUN 2.0    /* m/s ahead, from where on who hurries breaks into a run ... */
#define WALK 1.75  /* ... and below which he walks again */
#define DEVIATION 0.8
#define REACH (3.0 * DEVIATION)

static void choose_control(const ff_choice_view *view, ff_choice *choice, bool *urgent)
{
    bool critical = view->time < TRANSITION_TIME || view->density > DENSITY;
    bool clear = view->time >= TIME_MARGIN * TRANSITION_TIME && view->density <= DENSITY_MARGIN * DENSITY;
    choice->calm = clear ? ff_min(choice->calm + view->step, CALM) : 0.0;
    *urgent = view->time < URGENT;
    if (critical && (*urgent || view->since_switch >= DWELL)) choice->control = 1;
    if (choice->calm >= CALM && view->since_switch >= DWELL) choice->control = 0;
}

ff_locomotion ff_choose_locomotion(ff_synthesis synthesis, const ff_choice_view *view, ff_choice *choice,
                                   bool *urgent)
{
    *urgent = false;
    if (synthesis == FF_SYNTHESIS_HYBRID)
        choose_control(view, choice, urgent);
    else
        choice->control = synthesis == FF_SYNTHESIS_SEMI_PROCEDURAL;
    choice->runs = view->hurries && view->ahead > (choice->runs ? WALK : RUN);
    if (choice->runs) return FF_RUNNING;
    return choice->control ? FF_SEMI_PROCEDURAL : FF_BLENDING;
}

double ff_choice_time(const ff_seen *me, const ff_neighbour *neighbours, uint32_t count,
                      const ff_wall *const *walls, uint32_t wall_count)
{
    double time = count > 0 ? neighbours[0].time : INFINITY;
    for (uint32_t i = 0; i < wall_count; ++i)
        time = ff_min(time, ff_time_to_wall(walls[i], me->position, me->velocity, me->radius, NULL));
    return time;
}

double ff_choice_density(const ff_grid *grid, uint32_t self)
{
    ff_vec2 p = grid->seen[self].position;
    ff_run runs[FF_GRID_RUNS_MAX];
    uint32_t run_count = ff_grid_runs(grid, p, REACH, runs);
    double sum = 0.0;
    for (uint32_t r = 0; r < run_count; ++r)
        for (uint32_t i = runs[r].first; i < runs[r].end; ++i) {
            ff_vec2 apart = ff_sub2(grid->seen[i].position, p);
            double square = ff_dot2(apart, apart);
            if (i != self && square < REACH * REACH) sum += ff_exp(-square / (2.0 * DEVIATION * DEVIATION));
        }
    return sum / (FF_TAU * DEVIATION * DEVIATION);
}
