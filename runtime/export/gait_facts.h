/* gait_facts.h - a straight walk in the numbers that people's are known by: steps, events, angles. Measured from poses alone,
 * by the definitions of the reference (Footfall's gait facts, from clips of the CMU Graphics Lab Motion Capture Database). */
#ifndef FF_GAIT_FACTS_H
#define FF_GAIT_FACTS_H

#include "runtime/export/gait_meter.h"

typedef enum ff_fact {
    FF_FACT_CADENCE,
    FF_FACT_STEP,
    FF_FACT_WIDTH,
    FF_FACT_STANCE,
    FF_FACT_DOUBLE,
    FF_FACT_FLAT,
    FF_FACT_HEEL_OFF,
    FF_FACT_PITCH_CONTACT,
    FF_FACT_PITCH_OFF,
    FF_FACT_HIPS,
    FF_FACT_HIPS_RANGE,
    FF_FACT_HIPS_HIGHEST,
    FF_FACT_SWAY,
    FF_FACT_SLOWEST,
    FF_FACT_FASTEST,
    FF_FACT_PELVIS_YAW,
    FF_FACT_PELVIS_ROLL,
    FF_FACT_HIP_MOST,
    FF_FACT_HIP_LEAST,
    FF_FACT_KNEE_CONTACT,
    FF_FACT_KNEE_LOADED,
    FF_FACT_KNEE_LEAST,
    FF_FACT_KNEE_SWING,
    FF_FACT_KNEE_SWING_AT,
    FF_FACT_ANKLE_UP,
    FF_FACT_ANKLE_DOWN,
    FF_FACT_LEAN,
    FF_FACT_SPINE_YAW,
    FF_FACT_THORAX_YAW,
    FF_FACT_HEAD_YAW,
    FF_FACT_ARM_RANGE,
    FF_FACT_ARM_AT,
    FF_FACT_ELBOW,
    FF_FACT_ELBOW_RANGE,
    FF_FACT_COUNT
} ff_fact;

/* Speeds of the reference, m/s: slow 1.02, normal 1.27, fast 1.61. */
enum { FF_BAND_SLOW, FF_BAND_NORMAL, FF_BAND_FAST, FF_BAND_COUNT };

typedef struct ff_fact_reference {
    const char *name;                                     /* with its unit; L = hip joint to ankle */
    double mean[FF_BAND_COUNT], deviation[FF_BAND_COUNT]; /* between people */
} ff_fact_reference;

const ff_fact_reference *ff_fact_references(void); /* [FF_FACT_COUNT] */
double ff_fact_speed(int band);                    /* m/s */

/* One moment of a walk along heading 0. */
typedef struct ff_fact_frame {
    ff_vec3 hips; /* middle of the hip joints */
    ff_vec3 heel[2], ball[2], toe[2];
    double ankle_height[2];
    double pitch[2], hip[2], knee[2], ankle[2], arm[2],
        elbow[2]; /* deg: toes up, flexion, plantarflexion, forward */
    double pelvis_yaw, pelvis_roll, spine_yaw, thorax_yaw, head_yaw, lean; /* deg */
} ff_fact_frame;

ff_fact_frame ff_fact_frame_of(const ff_gait_standard *standard, ff_vec3 hips, const ff_quat *rotations);

/* Means over all whole strides of both feet. Fails with FF_ERR_NO_DATA when there are not at least two of each. */
ff_status ff_gait_facts_find(const ff_gait_standard *standard, const ff_fact_frame *frames, uint32_t count,
                             double facts[FF_FACT_COUNT], ff_error *error);

/* The same of the pack's straight example that is nearest in speed, as it is: what there is to blend from. */
ff_status ff_gait_facts_of_example(const ff_pack *pack, const ff_gait_standard *standard, double speed,
                                   double facts[FF_FACT_COUNT], ff_error *error);

/* Within two deviations of people's mean, or as near to the example that is walked as one person is to another. */
bool ff_fact_holds(ff_fact fact, int band, double value, double example);

#endif
