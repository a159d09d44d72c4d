/* scene_behaviour.h - what people do in a scene: the keys "goals", "regions", "signals", "variables", "behaviours", "groups"
 * and "spawners" (runtime/scenes/README.md), read into the plain records that a crowd takes (runtime/footfall.h). */
#ifndef FF_SCENE_BEHAVIOUR_H
#define FF_SCENE_BEHAVIOUR_H

#include "runtime/core/base/memory.h"
#include "runtime/tool/json.h"

/* Lists of records, as in ff_behaviour_def. Zero it to start. */
typedef struct ff_scene_behaviour {
    ff_array machines, states, transitions, targets, conditions, acts, sets, goals, regions, signals, phases,
        variables, spawners;
} ff_scene_behaviour;

/* So many people who begin somewhere in a region and follow a machine. */
typedef struct ff_scene_group {
    uint32_t machine, count;
    ff_region place;
    ff_amount preferred_speed, radius;
    double heading; /* rad; NAN: towards the goal */
} ff_scene_group;

/* What groups and spawners do not say themselves. */
typedef struct ff_scene_usual {
    double preferred_speed, speed_spread, radius;
} ff_scene_usual;

/* All but groups, of a document's top level. groups: ff_scene_group. */
ff_status ff_scene_behaviour_read(const ff_json *json, const ff_scene_usual *usual, ff_scene_behaviour *out,
                                  ff_array *groups, ff_error *error);
void ff_scene_behaviour_free(ff_scene_behaviour *behaviour);
ff_status ff_scene_behaviour_copy(const ff_scene_behaviour *from, ff_scene_behaviour *to, ff_error *error);

/* The lists as a crowd takes them; they must outlive it. */
ff_behaviour_def ff_scene_behaviour_def(const ff_scene_behaviour *behaviour);

/* "behaviour" of an object, by name; *machine stays when the key is absent. */
ff_status ff_scene_machine_read(const ff_json *json, const json_t *object,
                                const ff_scene_behaviour *behaviour, uint32_t *machine, ff_error *error);

/* ---------------------------------------------------------------------------- shared by the reader's parts */

/* Everything that goes along while reading. */
typedef struct ff_behaviour_reading {
    const ff_json *json;
    ff_scene_behaviour *out;
    ff_error *error;
} ff_behaviour_reading;

#define FF_REGION_KEYS "point", "circle", "box", "turned_degrees"

/* One of the keys "point": [x, z], "circle": [x, z, radius], "box": [x1, z1, x2, z2] (with "turned_degrees") of object. */
ff_status ff_read_region(const ff_behaviour_reading *r, const json_t *object, ff_region *out);
/* Where to complain about a value: itself, or, of true, false, null and nothing, which have no place of their own, what it
 * is in. */
static inline const json_t *ff_place_of(const json_t *value, const json_t *within)
{
    return json_is_object(value) || json_is_array(value) || json_is_string(value) || json_is_number(value)
               ? value
               : within;
}

/* Numbers of metres: [x, z] and the like. within: the object or list that value is in, as below. */
ff_status ff_read_metres(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                         size_t count, const char *what, double *out);
/* A number, [low, high], or {"mean": m, "deviation": d}; each of it in [low, high]. */
ff_status ff_read_amount(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                         const char *what, double low, double high, ff_amount *out);
/* One named thing of a section of the scene: its value there under its name. */
typedef ff_status ff_read_named(const ff_behaviour_reading *r, const json_t *all, const char *name,
                                const json_t *value);
/* Read everything in the section under key, in the file's order; without the section there is nothing to do. With what
 * ("a region is {...}") each must be an object, and that is said of one that is not. */
ff_status ff_read_each(const ff_behaviour_reading *r, const char *key, const char *what, ff_read_named *read);

/* A name for a record: not empty, and short enough. at: where to complain. */
ff_status ff_take_name(const ff_behaviour_reading *r, const json_t *at, const char *name,
                       char out[FF_NAME_SIZE]);
/* Which of list's records from first on, whose first member is a name, is called so; else an error at value that says of
 * what kind there is none, and which one may be meant. */
ff_status ff_find_named(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                        const ff_array *list, size_t size, uint32_t first, const char *kind, uint32_t *out);
/* A new record at the end of a list, zeroed, or count of them side by side: the index of the first. */
ff_status ff_grow_list(const ff_behaviour_reading *r, ff_array *list, size_t size, size_t count,
                       uint32_t *out);

ff_status ff_read_goals(const ff_behaviour_reading *r);
ff_status ff_read_regions(const ff_behaviour_reading *r);
ff_status ff_read_signals(const ff_behaviour_reading *r);
ff_status ff_read_variables(const ff_behaviour_reading *r);
ff_status ff_read_machines(const ff_behaviour_reading *r);
/* A condition and all its parts; out: the index of it. */
ff_status ff_read_condition(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                            uint32_t *out);
/* A property by its name in files: "speed", ... or a variable's. */
ff_status ff_read_property(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                           uint32_t *out);
ff_status ff_read_spawners(const ff_behaviour_reading *r, const ff_scene_usual *usual);
ff_status ff_read_groups(const ff_behaviour_reading *r, const ff_scene_usual *usual, ff_array *groups);

#endif
