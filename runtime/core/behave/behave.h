/* behave.h - what agents do one after the other: their state machines (algorithms F; the definition is in footfall.h).
 *
 * A step of it has two parts. First every agent looks which transition of its state holds: that reads the last step's state
 * and is done for all at once. Then those for whom one does change their states, one after the other in the order of their
 * slots, as a goal that one takes may be full for the next; and spawners put people in.
 */
#ifndef FF_BEHAVE_H
#define FF_BEHAVE_H

#include "runtime/core/base/memory.h"
#include "runtime/core/base/random.h"

#define FF_ZERO_TIME_MAX 8u /* transitions of one agent at one moment */

/* What an agent's machine remembers. Plain, without padding: it is hashed and saved as bytes. */
typedef struct ff_conduct {
    ff_vec2 place;    /* m, its spot at the goal */
    double speed;     /* m/s, preferred, without the state's factor */
    double tolerance; /* m, of its goals, unless the state says another */
    double blocked;   /* s, for which it has wanted to go and could not */
    double variable[FF_VARIABLES];
    uint64_t key;     /* of everything it draws */
    uint64_t draws;   /* for choices so far */
    uint64_t born;    /* step */
    uint64_t entered; /* step at which it entered this state */
    uint64_t entries; /* states entered so far */
    uint32_t state;   /* FF_NONE: no machine */
    uint32_t machine;
    uint32_t goal;    /* that it has taken, or FF_NONE */
    uint32_t set;     /* of which that is */
    uint32_t last;    /* the last goal that it had */
    uint32_t spawner; /* FF_NONE: put in by the caller */
} ff_conduct;

/* Of a spawner. */
typedef struct ff_spawning {
    /* people that should have been put in by now and were not; below 1 between steps, if there was room */
    double due;
    uint32_t put_in; /* so far */
    uint32_t alive;
    uint64_t draws;
} ff_spawning;

typedef struct ff_fault {
    uint32_t number; /* of the agent; FF_NONE: none */
    uint32_t state;
    uint64_t step;
} ff_fault;

/* A crowd's behaviour: its own copy of the definition, and what all agents share. */
typedef struct ff_behaviour {
    ff_behaviour_def def;
    void *block;           /* of the definition's arrays */
    uint32_t *set_of;      /* [goals] the first set that it is in */
    double *tolerance;     /* [states] m, within which one has arrived; 0: as the agent has it */
    uint32_t *taken;       /* [goals] by how many */
    uint32_t *shown;       /* [signals] phase that it is made to show, or FF_NONE */
    ff_spawning *spawning; /* [spawners] */
    ff_fault fault;
} ff_behaviour;

/* The arrays of a definition, for whoever copies, saves or loads all of them. */
typedef struct ff_behaviour_array {
    char name[8];          /* of its section in a saved crowd */
    size_t pointer, count; /* offsets in ff_behaviour_def */
    size_t size;
} ff_behaviour_array;
#define FF_BEHAVIOUR_ARRAYS 13
extern const ff_behaviour_array ff_behaviour_arrays[FF_BEHAVIOUR_ARRAYS];
const void *ff_behaviour_array_data(const ff_behaviour_def *def, const ff_behaviour_array *array);
uint32_t ff_behaviour_array_count(const ff_behaviour_def *def, const ff_behaviour_array *array);
void ff_behaviour_array_set(ff_behaviour_def *def, const ff_behaviour_array *array, const void *data,
                            uint32_t count);

/* A checked copy of def. */
ff_status ff_behaviour_create(const ff_behaviour_def *def, ff_behaviour **out, ff_error *error);
void ff_behaviour_destroy(ff_behaviour *behaviour); /* NULL is fine */

/* ------------------------------------------------------------------------------------------------- places */
double ff_region_distance(const ff_region *region, ff_vec2 p); /* m, from p to the region; 0 inside */
/* A point of the region, drawn evenly, `margin` m from its edge where that leaves any. */
ff_vec2 ff_region_point(const ff_region *region, double margin, ff_random *random);
double ff_amount_draw(const ff_amount *amount, ff_random *random);

/* ---------------------------------------------------------------------------------------------- conditions */
/* All that conditions can ask of one agent. */
typedef struct ff_behave_view {
    const ff_behaviour *behaviour;
    const ff_conduct *conduct;
    uint64_t step;    /* now */
    double dt;        /* s */
    ff_vec2 position; /* m */
    double speed;     /* m/s, now */
    double radius;    /* m */
    bool settled;     /* stands as near to its goal as others let it */
} ff_behave_view;

/* The first transition of its state, from the first-th on, whose condition holds; FF_NONE: none. Pure. */
uint32_t ff_behave_find(const ff_behave_view *view, uint32_t first);
double ff_behave_property(const ff_behave_view *view, uint32_t property);
uint32_t ff_behave_phase(const ff_behaviour *behaviour, uint32_t signal, double time);

/* --------------------------------------------------------------------------------------------------- goals */
/* What a state's entry chooses. */
typedef struct ff_pick {
    uint32_t goal, set; /* FF_NONE: none of a set */
    ff_vec2 place;      /* m; of a goal: still to be chosen (ff_crowd_place_at_goal) */
} ff_pick;

/* False when no goal is free. Of conduct only draws changes. */
bool ff_behave_choose(const ff_behaviour *behaviour, const ff_state_def *state, ff_vec2 position,
                      ff_conduct *conduct, ff_pick *out);

#endif
