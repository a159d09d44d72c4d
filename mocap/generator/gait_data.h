/* gait_data.h - the measured gait curves behind the built-in clips (internal to the generator).
 *
 * Phase 0 is a foot's initial contact, 1 its next. Curves of the middle (pelvis, thorax, head) go by the left foot's
 * phase; curves of a limb by the phase of its own side. Forward is the direction of travel; lengths are in leg
 * lengths (hip to ankle), angles in degrees.
 *   pelvis_x left, pelvis_z forward of a point that moves at constant speed; pelvis_y above the flat foot's ankle
 *   yaw left +, pitch forward +, roll left side up +, all in the frame of travel
 *   shoulder flexion forward +, abduction outward +, rotation inward +, elbow flexion +, relative to the thorax
 *   foot pitch toes up +; ankle_y above its height in the flat foot; ankle_z like pelvis_z
 */
#ifndef FF_GAIT_DATA_H
#define FF_GAIT_DATA_H

typedef enum ff_band { FF_BAND_SLOW, FF_BAND_NORMAL, FF_BAND_FAST, FF_BAND_RUN, FF_BAND_COUNT } ff_band;

typedef enum ff_curve {
    FF_CURVE_PELVIS_X,
    FF_CURVE_PELVIS_Y,
    FF_CURVE_PELVIS_Z,
    FF_CURVE_PELVIS_YAW,
    FF_CURVE_PELVIS_PITCH_FWD,
    FF_CURVE_PELVIS_ROLL,
    FF_CURVE_THORAX_YAW,
    FF_CURVE_THORAX_PITCH_FWD,
    FF_CURVE_THORAX_ROLL,
    FF_CURVE_HEAD_YAW,
    FF_CURVE_HEAD_PITCH_FWD,
    FF_CURVE_HEAD_ROLL,
    FF_CURVE_SHOULDER_FLEXION,
    FF_CURVE_SHOULDER_ABDUCTION,
    FF_CURVE_SHOULDER_ROTATION_IN,
    FF_CURVE_ELBOW_FLEXION,
    FF_CURVE_PERSONAL_COUNT, /* the curves above are also stored for single people */
    FF_CURVE_FOOT_PITCH_UP = FF_CURVE_PERSONAL_COUNT,
    FF_CURVE_ANKLE_Y,
    FF_CURVE_ANKLE_Z,
    FF_CURVE_COUNT
} ff_curve;

typedef struct ff_fourier {
    double c[13]; /* c0, a1, b1 ... a6, b6 */
} ff_fourier;

typedef struct ff_person_gait {
    int person; /* 1-based */
    ff_band band;
    ff_fourier curves[FF_CURVE_PERSONAL_COUNT];
} ff_person_gait;

enum { FF_PEOPLE = 7, FF_PERSON_SETS = 18 };

extern const double ff_band_speed[FF_BAND_COUNT]; /* m/s */
extern const ff_fourier ff_mean_gait[FF_BAND_COUNT][FF_CURVE_COUNT];
extern const ff_person_gait ff_people_gait[FF_PERSON_SETS];

#endif
