/* plants.h - when and where each foot of a clip stands on the ground. */
#ifndef FF_PLANTS_H
#define FF_PLANTS_H

#include "mocap/clip.h"
#include "preprocess/plants/breaks.h"

enum { FF_LEFT = 0, FF_RIGHT = 1 };

/* The clip's floor: height of the sole's rest level over (z, x): y = base + slope.a * a + slope.b * b. */
typedef struct ff_floor {
    double base;     /* m */
    ff_vec2 slope;   /* m per m */
    double residual; /* m, largest distance of a planted ball from the plane */
} ff_floor;

/* Fixed points of one foot, as vectors in the ankle joint's frame whose identity is the clip's rest pose. */
typedef struct ff_foot_shape {
    /* virtual heel: 4 cm behind the ankle along the foot, at ball height when flat (labels' rule) */
    ff_vec3 heel;
    ff_vec3 ball;
    double ball_height;  /* m above the floor plane when flat */
    double ankle_height; /* m */
    double length;       /* m, heel to ball */
} ff_foot_shape;

/* One stretch in which a foot is on the ground. Frames count from 0 at the file's first pose, both ends
 * inclusive. flat_* is -1, -1 when the foot was never flat and still. */
typedef struct ff_plant {
    int foot; /* FF_LEFT, FF_RIGHT */
    int start, end;
    int flat_start, flat_end;
    bool cut_start, cut_end; /* the plant goes on beyond the clip's first or last frame */
    double confidence;       /* 0 to 1 */
    ff_vec2 ball;            /* m, plane coordinates, median over the flat stretch */
    double ball_y;           /* m */
    double yaw;              /* rad, direction heel to ball on the ground */
    double slide;            /* m, path length of the ball in the flat stretch */
    /* m over the floor plane; 0 on the floor: what feet and markers make of a level floor does not count */
    double level;
    bool written; /* by a person, in an override file */
} ff_plant;

/* Per frame and foot, for reports: heights over the floor and ground speeds of heel and ball. */
typedef struct ff_foot_track {
    double heel_height, ball_height, toe_height; /* m over their own rest level */
    double heel_speed, ball_speed, toe_speed;    /* m/s */
} ff_foot_track;

typedef struct ff_plants {
    ff_plant *items; /* by start frame */
    int count;
    ff_floor floor;
    ff_foot_shape shape[2];
    ff_foot_track *tracks; /* [frame_count][2] */
    int frame_count;
    ff_plant *found; /* what was found before a person's word changed it: NULL when nobody wrote anything */
    int found_count;
    ff_breaks breaks; /* where the clip is broken: no plant goes across a jump or a frozen stretch */
} ff_plants;

/* Find the plants of a clip by height and velocity over a fitted floor plane (footstep planning, section 4;
 * algorithms A.5). Needs hips, knees and ankles of both sides. On failure *out is zeroed. */
ff_status ff_plants_find(const ff_clip *clip, const ff_find_settings *settings, ff_plants *out,
                         ff_error *error);
/* The same, then what a person wrote (plant_edit.h; NULL: nothing). Edits that do not fit fail with their line. */
typedef struct ff_plant_edits ff_plant_edits;
ff_status ff_plants_find_edited(const ff_clip *clip, const ff_find_settings *settings,
                                const ff_plant_edits *edits, ff_plants *out, ff_error *error);
void ff_plants_free(ff_plants *plants);

#endif
