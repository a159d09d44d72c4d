/* stage_settings.h - what each stage may be told, as plain structs that are passed down to it. Names, units, defaults, ranges
 * and meanings stand in the table of settings.c; a stage that is not given a struct does not depend on it. */
#ifndef FF_STAGE_SETTINGS_H
#define FF_STAGE_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

/* Where a capture is broken. */
typedef struct ff_break_settings {
    double off, blow, jump, moving, torn;
} ff_break_settings;

/* When a foot stands. */
typedef struct ff_plant_settings {
    double cutoff, slow_share, slow_least, slow_most, shortest_swing, shortest, carried, above_floor,
        own_level, walking, running, heel_low, ball_low, at_level, lifted, still, flat_ball_speed,
        flat_heel_speed, flat_ball_up, flat_heel_up;
} ff_plant_settings;

/* The floor that plants lie on. */
typedef struct ff_floor_settings {
    double slope, feet, spread, outlier;
} ff_floor_settings;

/* Clips on the skeleton of the pack. */
typedef struct ff_motion_settings {
    bool clean;
} ff_motion_settings;

/* Feet that are made to stand still. */
typedef struct ff_clean_settings {
    double pin, ground, under, under_toe, knee, tie, fade, heel_off, heel_up, most_slide, most_turned,
        most_turned_95, most_moved, most_shaking;
} ff_clean_settings;

/* What becomes an action. */
typedef struct ff_step_settings {
    double shortest, longest, shortest_run, longest_run, farthest, farthest_run, highest, doubtful, foot_up,
        run_speed, flight, turn_travel, turn_angle, crouched, stops_within, idle;
} ff_step_settings;

/* What is called standing. */
typedef struct ff_standing_settings {
    double shortest, body, foot, turn;
} ff_standing_settings;

/* What is played as a whole: turns on the spot, jumps, ducks. */
typedef struct ff_whole_settings {
    double longest, longest_duck, turn_travel, turn_angle, upright, jump, together;
} ff_whole_settings;

/* What an action costs. */
typedef struct ff_energy_settings {
    double standing, moving;
} ff_energy_settings;

/* The body that planners avoid, at times inside an action. */
typedef struct ff_collider_settings {
    double rate, head, hand, foot, root;
} ff_collider_settings;

/* Gait cycles cut from clips. */
typedef struct ff_cycle_settings {
    double shortest, longest, straight, drift, idle_shortest, idle_longest;
} ff_cycle_settings;

/* Which cycles a pack may walk with. */
typedef struct ff_example_settings {
    double moved_straight, moved, moved_loose, seam_straight, seam, wander, crossed, stance, upright,
        walk_speed, walk_turn, run_speed, run_period, walk_spacing, run_spacing;
} ff_example_settings;

/* When one example may pass into another. */
typedef struct ff_correspondence_settings {
    double straight, other, window, spacing;
} ff_correspondence_settings;

/* Which action may follow which. */
typedef struct ff_successor_settings {
    double few, many, cost, walk_change, run_change, turn_change;
} ff_successor_settings;

/* The set of actions. */
typedef struct ff_actions_settings {
    double start, stop, lift, walk;
    int64_t count;
    bool derive;
} ff_actions_settings;

/* Poses in the pack. */
typedef struct ff_poses_settings {
    double rate, bytes;
} ff_poses_settings;

/* The surface of a character. */
typedef struct ff_skin_settings {
    double second, third, crease;
    int64_t triangles, least;
} ff_skin_settings;

/* What is found in one clip by itself depends on these .... */
typedef struct ff_find_settings {
    ff_break_settings breaks;
    ff_plant_settings plants;
    ff_floor_settings floor;
} ff_find_settings;

/* ... what becomes of it on the skeleton of the pack on these as well. */
typedef struct ff_cut_settings {
    ff_motion_settings motion;
    ff_clean_settings clean;
    ff_step_settings steps;
    ff_standing_settings standing;
    ff_whole_settings whole;
    ff_energy_settings energy;
    ff_collider_settings colliders;
    ff_cycle_settings cycles;
    ff_example_settings examples;
} ff_cut_settings;

#endif
