/* clean_pins.h - where planted feet are to stand, and how firmly in which frame. */
#ifndef FF_CLEAN_PINS_H
#define FF_CLEAN_PINS_H

#include "preprocess/clean/clean_problem.h"

/* One plant's share in the clean-up. Heel and ball stand still from first to last frame, both inclusive; before, the
 * foot comes down over its heel, after, it rolls off over its ball. A foot that is never flat stands on its ball. */
typedef struct ff_clean_pin {
    int foot;
    int start, first, last, end; /* frames: contact, flat, still flat, toe-off */
    bool flat;                   /* by the plant; else the ball alone was found to be still */
    bool heel_free;              /* only the ball is pinned */
} ff_clean_pin;

/* By the order of the plants. */
typedef struct ff_clean_pins {
    ff_clean_pin *items;
    ff_clean_plant *plants; /* the place of each */
    int count;
    const ff_clean_settings *settings;
    double rest; /* m, height of planted points on level ground */
    bool uneven; /* the ground is: each plant has its own height */
} ff_clean_pins;

/* settings are kept. Pins of a motion that stands on its floor, at the balls' captured places times the motion's scale (cleanup study,
 * section 5: anything else shortens steps). */
ff_status ff_clean_pins_find(const ff_rig *rig, const ff_clean_settings *settings, const ff_motion *motion,
                             const ff_plants *plants, ff_clean_pins *out, ff_error *error);
void ff_clean_pins_free(ff_clean_pins *pins);

/* How much heel and ball are pinned, 0 to 1 (cleanup study, section 3.5). */
void ff_clean_pin_weights(const ff_clean_pin *pin, int frame, double frame_time, double *heel, double *ball);

/* How much of the heel's error is taken out exactly in a flat frame, 0 to 1: a heel starts to rise before the foot is
 * called flat no more. */
double ff_clean_heel_share(const ff_clean_pins *pins, const ff_clean_pin *pin, int frame, double frame_time);

/* Height (m) that a planted point of a foot has on the ground it is over in a frame. */
double ff_clean_ground(const ff_clean_pins *pins, int foot, int frame);

/* Where heel and ball of a pinned foot stand. */
void ff_clean_plant_places(const ff_rig *rig, const ff_clean_plant *plant, ff_vec3 *heel, ff_vec3 *ball);

#endif
