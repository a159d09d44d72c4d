#include "preprocess/build/settings.h"

#include "preprocess/examples/correspond.h"
#include "preprocess/examples/example_judge.h"
#include "preprocess/pack/pose_encode.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/pack/pack_format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

/* group: the struct of settings.h that the section is in, with its dot, or nothing. */
#define NUMBER(group, section, key, stage, unit, standard, low, high, what)                                  \
    {                                                                                                        \
#section, #key, FF_SETTING_NUMBER, stage, unit, standard, low, high, what,                           \
            offsetof(ff_settings, group section.key)                                                         \
    }

#define WHOLE(group, section, key, stage, standard, low, high, what)                                         \
    {                                                                                                        \
#section, #key, FF_SETTING_WHOLE, stage, "", standard, low, high, what,                              \
            offsetof(ff_settings, group section.key)                                                         \
    }

#define SWITCH(group, section, key, stage, standard, what)                                                   \
    {                                                                                                        \
#section, #key, FF_SETTING_SWITCH, stage, "", standard, 0.0, 1.0, what,                              \
            offsetof(ff_settings, group section.key)                                                         \
    }

#define FILE_NAME(group, section, key, stage, what)                                                          \
    {                                                                                                        \
#section, #key, FF_SETTING_FILE, stage, "", 0.0, 0.0, 1.0, what,                                     \
            offsetof(ff_settings, group section.key)                                                         \
    }

/* Settings of one section stand together. Where a value comes from is told where it is used. */
const ff_setting ff_setting_table[] = {
    FILE_NAME(, rig, skeleton, FF_STAGE_PACK,
              "clip or skeleton file (.asf, .bvh, .gltf, .glb, .amc) whose body the pack has; else the "
              "median of all"),
    /* where a capture is broken */
    NUMBER(find., breaks, off, FF_STAGE_FIND, "m", 0.012, 0.001, 0.5,
           "a joint further from the cubic through the frames around it is off its course"),
    NUMBER(find., breaks, blow, FF_STAGE_FIND, "m/s", 4.0, 0.1, 50.0,
           "change of speed within one frame that a landing makes, and that is no fault"),
    NUMBER(find., breaks, jump, FF_STAGE_FIND, "m", 0.03, 0.001, 1.0,
           "what stays further apart before and after is a jump"),
    NUMBER(find., breaks, moving, FF_STAGE_FIND, "m/s", 0.15, 0.01, 20.0,
           "a body that is this fast does not stand still: the same pose again is frozen capture"),
    NUMBER(find., breaks, torn, FF_STAGE_FIND, "m", 0.08, 0.001, 1.0,
           "a foot that jumps further did not stand while it did"),
    /* when a foot stands */
    NUMBER(find., plants, cutoff, FF_STAGE_FIND, "Hz", 15.0, 4.0, 40.0, "low-pass of the points of a foot"),
    NUMBER(find., plants, slow_share, FF_STAGE_FIND, "of the fastest nearby", 0.25, 0.05, 0.8,
           "a foot that is slower may stand ..."),
    NUMBER(find., plants, slow_least, FF_STAGE_FIND, "m/s", 0.35, 0.05, 1.5,
           "... and when it is slower than this at any rate ..."),
    NUMBER(find., plants, slow_most, FF_STAGE_FIND, "m/s", 1.7, 0.5, 5.0,
           "... but not when it is faster than this"),
    NUMBER(find., plants, shortest_swing, FF_STAGE_FIND, "s", 0.08, 0.02, 0.5,
           "shorter lifts do not end a plant"),
    NUMBER(find., plants, shortest, FF_STAGE_FIND, "s", 0.06, 0.02, 0.5, "shorter plants are none"),
    NUMBER(find., plants, carried, FF_STAGE_FIND, "m", 0.03, 0.002, 0.3,
           "a foot that is lifted and carried less far stays where it was"),
    NUMBER(find., plants, above_floor, FF_STAGE_FIND, "m", 0.05, 0.01, 0.5,
           "a foot that far over the floor may stand on something"),
    NUMBER(find., plants, own_level, FF_STAGE_FIND, "m", 0.045, 0.01, 0.5,
           "a foot that far off the floor stands on a level of its own"),
    NUMBER(find., plants, walking, FF_STAGE_FIND, "m/s", 1.85, 0.5, 5.0,
           "slower bodies walk, and their feet are judged as walking ones ..."),
    NUMBER(find., plants, running, FF_STAGE_FIND, "m/s", 2.15, 0.5, 6.0,
           "... faster ones run; a blend between the two"),
    NUMBER(find., plants, heel_low, FF_STAGE_FIND, "m", 0.05, 0.005, 0.2,
           "how far over its rest the heel may be when it lands"),
    NUMBER(find., plants, ball_low, FF_STAGE_FIND, "m", 0.02, 0.002, 0.2,
           "how far over its rest the ball may be when it lands"),
    NUMBER(find., plants, at_level, FF_STAGE_FIND, "m", 0.002, 0.0002, 0.05,
           "a point that bears weight is no further over its rest"),
    NUMBER(find., plants, lifted, FF_STAGE_FIND, "m", 0.005, 0.0005, 0.05,
           "a point that is further over its rest bears none"),
    NUMBER(find., plants, still, FF_STAGE_FIND, "m/s", 0.3, 0.05, 2.0, "a point that is slower rests"),
    NUMBER(find., plants, flat_ball_speed, FF_STAGE_FIND, "m/s", 0.30, 0.05, 2.0,
           "the ball of a flat foot is slower (running: twice that) ..."),
    NUMBER(find., plants, flat_heel_speed, FF_STAGE_FIND, "m/s", 0.35, 0.05, 2.0,
           "... and its heel than this"),
    NUMBER(find., plants, flat_ball_up, FF_STAGE_FIND, "m", 0.02, 0.002, 0.2,
           "the ball of a flat foot is no further over its rest ..."),
    NUMBER(find., plants, flat_heel_up, FF_STAGE_FIND, "m", 0.015, 0.002, 0.2, "... and its heel than this"),
    /* the floor that plants lie on */
    NUMBER(find., floor, slope, FF_STAGE_FIND, "m per m", 0.02, 0.001, 0.5,
           "how much floors of capture rooms slope"),
    NUMBER(find., floor, feet, FF_STAGE_FIND, "m", 0.01, 0.001, 0.1,
           "how far apart in height the two feet of a skeleton stand"),
    NUMBER(find., floor, spread, FF_STAGE_FIND, "m", 0.005, 0.0005, 0.1,
           "how well heights of resting feet repeat"),
    NUMBER(find., floor, outlier, FF_STAGE_FIND, "m", 0.015, 0.002, 0.2,
           "a resting foot further off the floor hardly counts"),
    /* clips on the skeleton of the pack */
    SWITCH(cut., motion, clean, FF_STAGE_CUT, true, "planted feet are made to stand still"),
    /* feet that are made to stand still */
    NUMBER(cut., clean, pin, FF_STAGE_CUT, "m", 0.002, 0.0002, 0.05,
           "how far a planted point may be from its place"),
    NUMBER(cut., clean, ground, FF_STAGE_CUT, "m", 0.002, 0.0002, 0.05,
           "how far a point may be under what is allowed"),
    NUMBER(cut., clean, under, FF_STAGE_CUT, "m", 0.003, 0.0, 0.05,
           "heel and ball may be so far under the ground at no cost ..."),
    NUMBER(cut., clean, under_toe, FF_STAGE_CUT, "m", 0.005, 0.0, 0.05, "... and the tip of the toes"),
    NUMBER(cut., clean, knee, FF_STAGE_CUT, "degrees", 3.0, 0.0, 30.0, "knees are bent at least so much"),
    NUMBER(cut., clean, tie, FF_STAGE_CUT, "m", 0.003, 0.0002, 0.1,
           "how far a plant may move from where the clip has it"),
    NUMBER(cut., clean, fade, FF_STAGE_CUT, "s", 0.083, 0.01, 0.5,
           "time over which what is corrected at the end of a plant fades out"),
    NUMBER(cut., clean, heel_off, FF_STAGE_CUT, "s", 0.067, 0.01, 0.5,
           "time before the foot is flat no more in which the heel is let go"),
    NUMBER(cut., clean, heel_up, FF_STAGE_CUT, "m", 0.02, 0.001, 0.2,
           "a flat foot whose heel is further over its ball stands on the ball alone"),
    NUMBER(cut., clean, most_slide, FF_STAGE_CUT, "m", 0.02, 0.0, 1.0,
           "a clip whose planted feet still slide further is left out"),
    NUMBER(cut., clean, most_turned, FF_STAGE_CUT, "degrees", 5.0, 0.1, 90.0,
           "a clip whose hips and legs had to be turned more on average is left out"),
    NUMBER(cut., clean, most_turned_95, FF_STAGE_CUT, "degrees", 20.0, 0.5, 180.0,
           "the same for one time in twenty"),
    NUMBER(cut., clean, most_moved, FF_STAGE_CUT, "m", 0.08, 0.001, 1.0,
           "a clip whose hips had to be moved further on average is left out"),
    NUMBER(cut., clean, most_shaking, FF_STAGE_CUT, "times", 1.6, 0.5, 100.0,
           "a clip whose knees and ankles shake this much more than captured is left out"),
    /* what becomes an action */
    NUMBER(cut., steps, shortest, FF_STAGE_CUT, "s", 0.2, 0.05, 2.0, "shorter walking steps are none"),
    NUMBER(cut., steps, longest, FF_STAGE_CUT, "s", 1.5, 0.2, 6.0, "longer walking steps are none"),
    NUMBER(cut., steps, shortest_run, FF_STAGE_CUT, "s", 0.15, 0.05, 2.0, "shorter running steps are none"),
    NUMBER(cut., steps, longest_run, FF_STAGE_CUT, "s", 0.7, 0.1, 6.0, "longer running steps are none"),
    NUMBER(cut., steps, farthest, FF_STAGE_CUT, "m", 2.2, 0.2, 10.0,
           "how far a walking step carries a foot at most"),
    NUMBER(cut., steps, farthest_run, FF_STAGE_CUT, "m", 3.5, 0.2, 10.0,
           "how far a running step carries a foot at most"),
    NUMBER(cut., steps, highest, FF_STAGE_CUT, "m", 0.45, 0.01, 2.0,
           "how much higher or lower than the other one a foot may land"),
    NUMBER(cut., steps, doubtful, FF_STAGE_CUT, "confidence", 0.3, 0.0, 1.0,
           "plants that are less sure give no step"),
    NUMBER(cut., steps, foot_up, FF_STAGE_CUT, "m", 0.045, 0.005, 0.5,
           "a foot that stands at the start or end of an action is no higher over its level"),
    NUMBER(cut., steps, run_speed, FF_STAGE_CUT, "m/s", 2.1, 0.5, 8.0, "faster steps are running ones"),
    NUMBER(cut., steps, flight, FF_STAGE_CUT, "s", 0.03, 0.005, 1.0,
           "steps with both feet in the air that long are running ones"),
    NUMBER(cut., steps, turn_travel, FF_STAGE_CUT, "m", 0.25, 0.01, 2.0, "who goes less far in a step ..."),
    NUMBER(cut., steps, turn_angle, FF_STAGE_CUT, "degrees", 20.0, 1.0, 180.0,
           "... and turns more, turns on the spot"),
    NUMBER(cut., steps, crouched, FF_STAGE_CUT, "of standing", 0.8, 0.2, 1.0, "hips that are lower crouch"),
    NUMBER(cut., steps, stops_within, FF_STAGE_CUT, "s", 0.4, 0.02, 3.0,
           "a step stops when one stands so soon after it"),
    NUMBER(cut., steps, idle, FF_STAGE_CUT, "s", 0.5, 0.2, 5.0, "length of the action that waits"),
    /* what is called standing */
    NUMBER(cut., standing, shortest, FF_STAGE_CUT, "s", 0.3, 0.05, 5.0, "shorter rests are none"),
    NUMBER(cut., standing, body, FF_STAGE_CUT, "m/s", 0.12, 0.01, 1.0,
           "the root of who stands is slower ..."),
    NUMBER(cut., standing, foot, FF_STAGE_CUT, "m/s", 0.25, 0.01, 1.0,
           "... and so are the balls of the feet ..."),
    NUMBER(cut., standing, turn, FF_STAGE_CUT, "degrees/s", 25.0, 1.0, 180.0, "... and the turning"),
    /* what is played as a whole: turns on the spot, jumps, ducks */
    NUMBER(cut., whole, longest, FF_STAGE_CUT, "s", 6.0, 0.5, 6.3, "longer ones are none"),
    NUMBER(cut., whole, longest_duck, FF_STAGE_CUT, "s", 3.0, 0.2, 6.3,
           "who stays down longer walks crouched"),
    NUMBER(cut., whole, turn_travel, FF_STAGE_CUT, "m", 0.4, 0.01, 3.0,
           "who goes less far from one standing to the next ..."),
    NUMBER(cut., whole, turn_angle, FF_STAGE_CUT, "degrees", 12.0, 1.0, 180.0,
           "... and turns more, turns on the spot"),
    NUMBER(cut., whole, upright, FF_STAGE_CUT, "of standing", 0.9, 0.3, 1.0,
           "a duck begins and ends with the hips up again"),
    NUMBER(cut., whole, jump, FF_STAGE_CUT, "s", 0.3, 0.05, 2.0, "longer flights are jumps"),
    NUMBER(cut., whole, together, FF_STAGE_CUT, "s", 0.06, 0.005, 1.0,
           "feet that leave or land within this time do so as one"),
    /* what an action costs */
    NUMBER(cut., energy, standing, FF_STAGE_CUT, "J/kg per s", 2.23, 0.0, 100.0, "of being on one's feet"),
    NUMBER(cut., energy, moving, FF_STAGE_CUT, "J s/(kg m2)", 1.26, 0.0, 100.0, "of the square of the speed"),
    /* the body that planners avoid, at times inside an action */
    NUMBER(cut., colliders, rate, FF_STAGE_CUT, "Hz", 20.0, 2.0, 20.0, "how often it is sampled"),
    NUMBER(cut., colliders, head, FF_STAGE_CUT, "m", 0.12, 0.01, 0.5,
           "radius of the head; with a skin its own"),
    NUMBER(cut., colliders, hand, FF_STAGE_CUT, "m", 0.08, 0.01, 0.5,
           "radius of a hand; with a skin its own"),
    NUMBER(cut., colliders, foot, FF_STAGE_CUT, "m", 0.11, 0.01, 0.5,
           "radius of a foot; with a skin its own"),
    NUMBER(cut., colliders, root, FF_STAGE_CUT, "m", 0.18, 0.01, 0.8,
           "radius of the hips; with a skin its own"),
    /* gait cycles cut from clips */
    NUMBER(cut., cycles, shortest, FF_STAGE_CUT, "s", 0.4, 0.2, 3.0, "shorter ones are none"),
    NUMBER(cut., cycles, longest, FF_STAGE_CUT, "s", 2.0, 0.5, 6.0, "longer ones are none"),
    NUMBER(cut., cycles, straight, FF_STAGE_CUT, "rad/s", 0.1, 0.0, 1.0, "who turns less walks straight"),
    NUMBER(cut., cycles, drift, FF_STAGE_CUT, "m/s", 0.04, 0.0, 0.5, "who drifts aside less does not"),
    NUMBER(cut., cycles, idle_shortest, FF_STAGE_CUT, "s", 2.0, 0.3, 10.0, "shortest loop of standing"),
    NUMBER(cut., cycles, idle_longest, FF_STAGE_CUT, "s", 4.0, 0.5, 20.0, "longest loop of standing"),
    /* which cycles a pack may walk with */
    NUMBER(cut., examples, moved_straight, FF_STAGE_CUT, "m", FF_LOOP_MOVED_STRAIGHT, 0.001, 0.5,
           "closing a straight walk moves no joint further"),
    NUMBER(cut., examples, moved, FF_STAGE_CUT, "m", FF_LOOP_MOVED, 0.001, 0.5,
           "closing any other cycle moves no joint further"),
    NUMBER(cut., examples, moved_loose, FF_STAGE_CUT, "m", 0.10, 0.001, 1.0,
           "... and when nothing else is there"),
    NUMBER(cut., examples, seam_straight, FF_STAGE_CUT, "m", 0.05, 0.001, 0.5,
           "mean distance of the joints between the ends of a straight walk"),
    NUMBER(cut., examples, seam, FF_STAGE_CUT, "m", 0.08, 0.001, 0.5,
           "mean distance of the joints between the ends of any other cycle"),
    NUMBER(cut., examples, wander, FF_STAGE_CUT, "rad", 0.2, 0.01, 2.0,
           "how far the heading may be from a steady turn"),
    NUMBER(cut., examples, crossed, FF_STAGE_CUT, "m", 0.08, 0.0, 0.5, "how far the legs may cross"),
    NUMBER(cut., examples, stance, FF_STAGE_CUT, "of the cycle", 0.4, 0.0, 1.0,
           "a walking foot stands still at least so long"),
    NUMBER(cut., examples, upright, FF_STAGE_CUT, "of standing", 0.9, 0.3, 1.0, "hips that are lower crouch"),
    NUMBER(cut., examples, walk_speed, FF_STAGE_CUT, "m/s", 2.4, 0.2, 6.0, "faster walks are none"),
    NUMBER(cut., examples, walk_turn, FF_STAGE_CUT, "rad/s", 2.6, 0.1, 6.0,
           "walks that turn faster are none"),
    NUMBER(cut., examples, run_speed, FF_STAGE_CUT, "m/s", 1.5, 0.1, 6.0, "slower runs are none"),
    NUMBER(cut., examples, run_period, FF_STAGE_CUT, "s", 0.6, 0.1, 2.0, "shorter running cycles are none"),
    NUMBER(cut., examples, walk_spacing, FF_STAGE_CUT, "m/s", 0.15, 0.02, 2.0,
           "walks are at least so far apart in speed"),
    NUMBER(cut., examples, run_spacing, FF_STAGE_CUT, "m/s", 0.4, 0.02, 2.0,
           "runs are at least so far apart in speed"),
    /* when one example may pass into another */
    NUMBER(, correspondences, straight, FF_STAGE_PACK, "m", FF_PAIR_LIMIT_STRAIGHT, 0.005, 1.0,
           "root mean square distance of the joints of two straight walks at most"),
    NUMBER(, correspondences, other, FF_STAGE_PACK, "m", FF_PAIR_LIMIT, 0.005, 1.0,
           "root mean square distance of the joints of any other two at most"),
    NUMBER(, correspondences, window, FF_STAGE_PACK, "m", FF_MAP_LIMIT, 0.005, 1.0,
           "distance of the motions over 0.3 s at most"),
    NUMBER(, correspondences, spacing, FF_STAGE_PACK, "of the cycle", FF_PAIR_SPACING, 0.02, 0.5,
           "how far two such moments are apart at least"),
    /* which action may follow which */
    NUMBER(, successors, few, FF_STAGE_PACK, "m", 0.15, 0.005, 1.0,
           "distance of the poses at most in sets of up to 28 actions ..."),
    NUMBER(, successors, many, FF_STAGE_PACK, "m", 0.10, 0.005, 1.0, "... and of 100 and more"),
    NUMBER(, successors, cost, FF_STAGE_PACK, "J/kg per m", 20.0, 0.0, 1000.0,
           "what a joint costs a planner, by distance of the poses"),
    NUMBER(, successors, walk_change, FF_STAGE_PACK, "m/s", 0.9, 0.05, 10.0,
           "how much the speed may change from one walking action to the next"),
    NUMBER(, successors, run_change, FF_STAGE_PACK, "m/s", 1.8, 0.05, 10.0,
           "how much the speed may change from one running action to the next"),
    NUMBER(, successors, turn_change, FF_STAGE_PACK, "degrees", 70.0, 1.0, 360.0,
           "how much the direction may change"),
    /* the set of actions */
    WHOLE(, actions, count, FF_STAGE_PACK, 0.0, 0.0, 100000.0,
          "how many actions the pack has, without mirror images; the best are chosen; 0 = all"),
    SWITCH(, actions, derive, FF_STAGE_PACK, true,
           "starts, stops, turns on the spot and side steps are made up when no clip shows them"),
    NUMBER(, actions, start, FF_STAGE_PACK, "s", 0.85, 0.3, 2.0, "how long a start that is made up takes"),
    NUMBER(, actions, stop, FF_STAGE_PACK, "s", 0.75, 0.3, 2.0, "how long a stop that is made up takes"),
    NUMBER(, actions, lift, FF_STAGE_PACK, "m", 0.05, 0.01, 0.2,
           "how high a foot is lifted in a step that is made up"),
    NUMBER(, actions, walk, FF_STAGE_PACK, "m/s", 1.2, 0.3, 2.5,
           "speed of the walk that starts and stops that are made up lead to"),
    /* poses in the pack */
    NUMBER(, poses, rate, FF_STAGE_PACK, "Hz", FF_PACK_RATE, 10.0, 240.0,
           "how often the report shows heights and speeds of feet"),
    NUMBER(, poses, bytes, FF_STAGE_CUT, "bytes per second", FF_POSE_BYTES, 1000.0, 100000.0,
           "how many a clip's motion may take; smooth motion takes less"),
    /* the surface of a character */
    WHOLE(, skin, triangles, FF_STAGE_PACK, 20000.0, 100.0, 200000.0, "of the finest level at most"),
    WHOLE(, skin, least, FF_STAGE_PACK, 400.0, 10.0, 10000.0, "of any level at least"),
    NUMBER(, skin, second, FF_STAGE_PACK, "of all", 0.35, 0.01, 1.0, "triangles of the second level"),
    NUMBER(, skin, third, FF_STAGE_PACK, "of all", 0.1, 0.001, 1.0, "triangles of the third level"),
    NUMBER(, skin, crease, FF_STAGE_PACK, "degrees", 60.0, 0.0, 180.0,
           "faces that meet at more than this turn have an edge between them"),
};
const int ff_setting_count = sizeof ff_setting_table / sizeof ff_setting_table[0];

static void *place_of(ff_settings *settings, const ff_setting *setting)
{
    return (char *)settings + setting->place;
}

double ff_setting_value(const ff_settings *settings, const ff_setting *setting)
{
    const void *place = (const char *)settings + setting->place;
    switch (setting->kind) {
    case FF_SETTING_WHOLE:
        return (double)*(const int64_t *)place;
    case FF_SETTING_SWITCH:
        return *(const bool *)place ? 1.0 : 0.0;
    case FF_SETTING_FILE:
        return *(const char *)place ? 1.0 : 0.0;
    default:
        return *(const double *)place;
    }
}

static void set_value(ff_settings *settings, const ff_setting *setting, double value)
{
    void *place = place_of(settings, setting);
    switch (setting->kind) {
    case FF_SETTING_WHOLE:
        *(int64_t *)place = (int64_t)value;
        break;
    case FF_SETTING_SWITCH:
        *(bool *)place = value != 0.0;
        break;
    case FF_SETTING_FILE:
        *(char *)place = '\0';
        break;
    default:
        *(double *)place = value;
    }
}

ff_settings ff_settings_default(void)
{
    ff_settings settings;
    memset(&settings, 0, sizeof settings);
    for (int i = 0; i < ff_setting_count; ++i)
        set_value(&settings, &ff_setting_table[i], ff_setting_table[i].standard);
    return settings;
}

uint64_t ff_settings_hash(const ff_settings *settings, ff_setting_stage up_to, uint64_t seed)
{
    for (int i = 0; i < ff_setting_count; ++i) {
        const ff_setting *s = &ff_setting_table[i];
        double value = ff_setting_value(settings, s);
        if (s->stage <= up_to && s->kind != FF_SETTING_FILE) seed = XXH64(&value, sizeof value, seed);
    }
    return seed;
}

static json_t *json_of(const ff_settings *settings, const ff_setting *setting)
{
    double value = ff_setting_value(settings, setting);
    const char *path = (const char *)settings + setting->place;
    switch (setting->kind) {
    case FF_SETTING_WHOLE:
        return json_integer((json_int_t)value);
    case FF_SETTING_SWITCH:
        return json_boolean(value != 0.0);
    case FF_SETTING_FILE:
        return json_string(strrchr(path, '/') ? strrchr(path, '/') + 1 : path);
    default:
        return json_real(value);
    }
}

json_t *ff_settings_json(const ff_settings *settings)
{
    json_t *root = json_object();
    for (int i = 0; i < ff_setting_count; ++i) {
        const ff_setting *s = &ff_setting_table[i];
        json_t *section = json_object_get(root, s->section);
        if (!section) {
            section = json_object();
            json_object_set_new(root, s->section, section);
        }
        json_object_set_new(section, s->key, json_of(settings, s));
    }
    return root;
}

/* ----------------------------------------------------------------------------------------------------- reading */

static bool is_comment(const char *key)
{
    return strncmp(key, "//", 2) == 0;
}

/* Refuse members that are neither in known (count names) nor comments, and comments that are no text. */
static ff_status check_keys(const ff_json *json, json_t *object, const char *const *known, size_t count,
                            ff_error *error)
{
    const char **allowed = ff_calloc(count + json_object_size(object) + 1, sizeof *allowed), *key;
    if (!allowed) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the configuration");
    memcpy(allowed, known, count * sizeof *allowed);
    json_t *value;
    ff_status status = FF_OK;
    json_object_foreach(object, key, value)
    {
        if (!is_comment(key)) continue;
        allowed[count++] = key;
        if (!json_is_string(value) && status == FF_OK)
            status = ff_json_fail_key(json, object, key, error,
                                      "a key that begins with // is a comment; its value must be a text");
    }
    if (status == FF_OK) status = ff_json_only_keys(json, object, allowed, error);
    free(allowed);
    return status;
}

/* A path of the document, relative to the document's folder. */
static ff_status read_path(const ff_json *json, const json_t *section, const char *key, char *out,
                           ff_error *error)
{
    const char *value = NULL, *slash = strrchr(json->path, '/');
    ff_status status = ff_json_string(json, section, key, &value, error);
    if (status != FF_OK || !value) return status;
    int folder = slash && *value && *value != '/' ? (int)(slash + 1 - json->path) : 0;
    int length = snprintf(out, FF_SETTING_PATH, "%.*s%s", folder, json->path, value);
    if (length < FF_SETTING_PATH) return FF_OK;
    return ff_json_fail(json, json_object_get(section, key), error, "\"%s\": a path of more than %d bytes",
                        key, FF_SETTING_PATH - 1);
}

static ff_status read_setting(const ff_json *json, const json_t *section, const ff_setting *setting,
                              ff_settings *out, ff_error *error)
{
    void *place = place_of(out, setting);
    switch (setting->kind) {
    case FF_SETTING_WHOLE:
        return ff_json_integer(json, section, setting->key, (int64_t)setting->low, (int64_t)setting->high,
                               place, error);
    case FF_SETTING_SWITCH:
        return ff_json_bool(json, section, setting->key, place, error);
    case FF_SETTING_FILE:
        return read_path(json, section, setting->key, place, error);
    default:
        return ff_json_number(json, section, setting->key, setting->low, setting->high, place, error);
    }
}

static ff_status read_section(const ff_json *json, json_t *root, const char *name, ff_settings *out,
                              ff_error *error)
{
    json_t *section = json_object_get(root, name);
    if (!section) return FF_OK;
    if (!json_is_object(section))
        return ff_json_fail_key(json, root, name, error, "\"%s\": expected an object { ... } of settings",
                                name);
    const char *keys[64]; /* more than the largest section has */
    size_t count = 0;
    for (int i = 0; i < ff_setting_count && count < sizeof keys / sizeof keys[0]; ++i)
        if (strcmp(ff_setting_table[i].section, name) == 0) keys[count++] = ff_setting_table[i].key;
    ff_status status = check_keys(json, section, keys, count, error);
    for (int i = 0; i < ff_setting_count && status == FF_OK; ++i)
        if (strcmp(ff_setting_table[i].section, name) == 0)
            status = read_setting(json, section, &ff_setting_table[i], out, error);
    return status;
}

static ff_status read_root(const ff_json *json, ff_settings *out, ff_error *error)
{
    const char *sections[32];
    size_t count = 0;
    for (int i = 0; i < ff_setting_count && count < sizeof sections / sizeof sections[0]; ++i)
        if (i == 0 || strcmp(ff_setting_table[i].section, sections[count - 1]) != 0)
            sections[count++] = ff_setting_table[i].section;
    ff_status status = check_keys(json, json->root, sections, count, error);
    for (size_t i = 0; i < count && status == FF_OK; ++i)
        status = read_section(json, json->root, sections[i], out, error);
    return status;
}

ff_status ff_settings_parse(const char *text, size_t size, const char *name, ff_settings *out,
                            ff_error *error)
{
    ff_json json;
    ff_settings read = ff_settings_default();
    ff_status status = ff_json_parse(text, size, name, &json, error);
    if (status != FF_OK) return status;
    status = read_root(&json, &read, error);
    ff_json_free(&json);
    if (status == FF_OK) *out = read;
    return status;
}

ff_status ff_settings_load(const char *path, ff_settings *out, ff_error *error)
{
    ff_file file;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    status = ff_settings_parse(file.data, file.size, path, out, error);
    ff_file_unmap(&file);
    return status;
}
