/* gait_meter.h - how well one walker walks, from its poses alone: feet that slide, knees that pop, joints that are faster
 * than the database's, feet that scrape the floor or brush each other. */
#ifndef FF_GAIT_METER_H
#define FF_GAIT_METER_H

#include "runtime/export/figure.h"
#include "runtime/export/skate.h"

/* The body and what is natural for it; the same for all walkers of a pack. */
typedef struct ff_gait_standard {
    const ff_figure *figure; /* borrowed */
    double step;             /* s between poses */
    double ball_rest[2];     /* m, height of the balls of a flat foot */
    ff_vec3 heel[2], toe[2]; /* m, in the ankle's and in the ball's frame */
    /* rad/s, the fastest that each joint is turned in any captured example of the pack, left or right (the hips against the
     * heading); where the captures do not move it (clavicles, wrists), the fastest of the bone against the heading. */
    double fastest[FF_FIGURE_MAX_JOINTS];
    bool as_bone[FF_FIGURE_MAX_JOINTS];
} ff_gait_standard;

/* Reads all the pack's streams. figure is that of the pack. */
ff_status ff_gait_standard_make(const ff_pack *pack, const ff_figure *figure, double step,
                                ff_gait_standard *out, ff_error *error);

/* The worst moment of a measure. */
typedef struct ff_gait_extreme {
    double value, time; /* s since the first pose */
    int32_t part;       /* joint, or foot */
    uint32_t known;
} ff_gait_extreme;

#define FF_METER_SWING 512 /* poses of a swing that are looked at */

typedef struct ff_gait_meter_foot {
    double clear[FF_METER_SWING]; /* m, of the lowest of heel, ball and toe over the floor, in the swing */
    uint32_t swing;               /* poses in it */
    double knee[2];               /* deg, bend of the last pose and the one before */
} ff_gait_meter_foot;

typedef struct ff_gait_meter {
    const ff_gait_standard *standard; /* borrowed */
    ff_skate skate;
    ff_gait_meter_foot foot[2];
    ff_quat last[2 * FF_FIGURE_MAX_JOINTS]; /* joints, bones */
    uint64_t poses;
    uint64_t pops, bends;      /* knee accelerations above FF_KNEE_POP, and all */
    uint64_t fast;             /* poses with a joint above FF_JOINT_FASTER times its fastest */
    uint64_t scraping, swings; /* swings lower than FF_SWING_CLEAR in their middle, and all */
    uint64_t close;            /* poses with ankles closer than FF_ANKLE_GAP */
    ff_gait_extreme knee;      /* deg/s2, largest second difference of the bend */
    ff_gait_extreme joint;     /* largest speed of a joint against its fastest in the database */
    ff_gait_extreme ankles;    /* m, least distance of the ankles on the ground */
    ff_gait_extreme clearance; /* m, least in mid swing */
} ff_gait_meter;

#define FF_KNEE_POP 30000.0 /* deg/s2 (synthesis study, section 8) */
#define FF_JOINT_FASTER 1.5
#define FF_SWING_CLEAR 0.01 /* m */
#define FF_ANKLE_GAP 0.04   /* m */

ff_status ff_gait_meter_create(const ff_gait_standard *standard, ff_gait_meter *out, ff_error *error);
void ff_gait_meter_free(ff_gait_meter *meter);

/* The next pose. rotations[joint_count] as ff_crowd_agent_pose gives them. */
ff_status ff_gait_meter_add(ff_gait_meter *meter, double heading, const uint8_t planted[2], ff_vec3 hips,
                            const ff_quat *rotations, ff_error *error);

/* Close the plants still open, and count another walker's measures in. */
ff_status ff_gait_meter_finish(ff_gait_meter *meter, ff_error *error);
ff_status ff_gait_meter_merge(ff_gait_meter *into, const ff_gait_meter *from, ff_error *error);

#endif
