/* behave_fair.h - a small fair as a behaviour: visitors come in through a gate, look at booths that hold two each, wait at a
 * light, and go. Written out as the plain records that a crowd takes. */
#ifndef FF_TEST_BEHAVE_FAIR_H
#define FF_TEST_BEHAVE_FAIR_H

#include "runtime/footfall.h"

enum { FAIR_WALK, FAIR_LOOK, FAIR_WAIT, FAIR_GO, FAIR_STATES };
enum { FAIR_BOOTHS = 4, FAIR_EXIT = FAIR_BOOTHS, FAIR_GOALS };
enum { FAIR_VISITOR, FAIR_MACHINES };

#define FAIR_LOOK_LEAST 4.0
#define FAIR_LOOK_MOST 5.0

#define BOX(x, y, length, width)                                                                             \
    {                                                                                                        \
        FF_REGION_BOX, 0, {x, y}, {0.5 * (length), 0.5 * (width)}, 0.0                                       \
    }

static const ff_machine_def fair_machines[FAIR_MACHINES] = {{"visitor", FAIR_WALK, 0}};

static const ff_state_def fair_states[FAIR_STATES] = {
    {.name = "Walk",
     .choice = FF_CHOOSE_WEIGHTED,
     .from = 0,
     .not_last = 1,
     .motion = FF_MOTION_GOAL,
     .first_transition = 0,
     .transition_count = 1,
     .speed = 1.0},
    {.name = "Look",
     .choice = FF_CHOOSE_SHARED,
     .motion = FF_MOTION_STAND,
     .face = FF_FACE_GOAL,
     .first_enter = 0,
     .enter_count = 1,
     .first_transition = 1,
     .transition_count = 2,
     .speed = 1.0},
    {.name = "Wait",
     .choice = FF_CHOOSE_IDENTITY,
     .motion = FF_MOTION_STAND,
     .first_transition = 3,
     .transition_count = 1,
     .speed = 1.0},
    {.name = "Go", .choice = FF_CHOOSE_NEAREST, .from = 1, .motion = FF_MOTION_GOAL, .speed = 1.2},
};

static const ff_transition_def fair_transitions[4] = {
    {0, 0, 1, 0}, /* Walk: arrived -> Look */
    {1, 1, 1, 0}, /* Look: seen enough and time over -> Wait */
    {4, 2, 2, 0}, /* Look: time over -> Walk, or Wait now and then */
    {5, 4, 1, 0}, /* Wait: green -> Go */
};

static const ff_target_def fair_targets[5] = {
    {FAIR_LOOK, 0, 1.0}, {FAIR_WAIT, 0, 1.0}, {FAIR_WALK, 0, 0.9}, {FAIR_WAIT, 0, 0.1}, {FAIR_GO, 0, 1.0}};

static const ff_condition_def fair_conditions[6] = {
    {.kind = FF_IF_ARRIVED, .amount = {.a = 0.4}},
    {.kind = FF_IF_ALL, .first = 2, .count = 2},
    {.kind = FF_IF_TIMER, .amount = {FF_AMOUNT_UNIFORM, 0, FAIR_LOOK_LEAST, FAIR_LOOK_MOST}},
    {.kind = FF_IF_MORE, .index = FF_PROPERTY_VARIABLE, .amount = {.a = 2.5}},
    {.kind = FF_IF_TIMER, .amount = {FF_AMOUNT_UNIFORM, 0, FAIR_LOOK_LEAST, FAIR_LOOK_MOST}},
    {.kind = FF_IF_SIGNAL, .index = 0, .value = 1},
};

static const ff_act_def fair_acts[1] = {{FF_ACT_ADD, FF_PROPERTY_VARIABLE, {.a = 1.0}}};

static const ff_goal_set_def fair_sets[2] = {{"booths", 0, FAIR_BOOTHS, 0, 0}, {"exits", FAIR_EXIT, 1, 1, 0}};

static const ff_goal_def fair_goals[FAIR_GOALS] = {
    {"north", BOX(4.0, 0.0, 0.9, 2.4), {6.0, 0.0}, 1.0, 2, 0},
    {"south", BOX(-4.0, 0.0, 0.9, 2.4), {-6.0, 0.0}, 1.0, 2, 0},
    {"east", BOX(0.0, -4.0, 2.4, 0.9), {0.0, -6.0}, 2.0, 2, 0},
    {"west", BOX(0.0, 4.0, 2.4, 0.9), {0.0, 6.0}, 1.0, 2, 0},
    {"gate", BOX(8.0, 8.0, 2.0, 2.0), {8.0, 8.0}, 1.0, 0, 0},
};

static const ff_signal_def fair_signals[1] = {{"light", 0, 2, 0.0}};
static const ff_phase_def fair_phases[2] = {{"red", 4.0}, {"green", 2.0}};
static const ff_variable_def fair_variables[1] = {{"seen", 0.0}};

static const ff_spawner_def fair_spawners[1] = {{.name = "gate",
                                                 .place = BOX(-8.0, -8.0, 3.0, 3.0),
                                                 .machine = FAIR_VISITOR,
                                                 .most = 9,
                                                 .rate = 0.5,
                                                 .preferred_speed = {FF_AMOUNT_NORMAL, 0, 1.3, 0.15},
                                                 .radius = {FF_AMOUNT_UNIFORM, 0, 0.24, 0.3}}};

static inline ff_behaviour_def fair_behaviour(void)
{
    return (ff_behaviour_def){fair_machines,
                              fair_states,
                              fair_transitions,
                              fair_targets,
                              fair_conditions,
                              fair_acts,
                              fair_sets,
                              fair_goals,
                              NULL,
                              fair_signals,
                              fair_phases,
                              fair_variables,
                              fair_spawners,
                              FAIR_MACHINES,
                              FAIR_STATES,
                              4,
                              5,
                              6,
                              1,
                              2,
                              FAIR_GOALS,
                              0,
                              1,
                              2,
                              1,
                              1,
                              0};
}

#endif
