/* gait_model.h - the semi-procedural clip: one walking cycle at any rates, without blending (FbCrowd 5; synthesis study,
 * section 5). The clip's foot path in the root frame is scaled by the step ratio and laid along the root's own arc, so a
 * foot that stood in the clip stands here at every speed and turn; trunk and arms come from the example `gait->example`
 * at the same phase, scaled by ff_gait_model_size, and the legs are solved to the feet.
 *
 * Phases are of the cycle, [0, 1), 0 = left contact; the right foot is half a cycle later. All functions are pure.
 */
#ifndef FF_GAIT_MODEL_H
#define FF_GAIT_MODEL_H

#include "runtime/core/gait/synth.h"

typedef struct ff_gait_model {
    const ff_pack_gait *gait;
    const ff_pack_gait_path *path; /* [FF_GAIT_SAMPLES] */
} ff_gait_model;

/* Rates within which a clip looks right (study, section 5): forward, backward, sideways m/s, turn rad/s. */
#define FF_MODEL_FORWARD 1.8
#define FF_MODEL_BACKWARD 1.5
#define FF_MODEL_SIDEWAYS 0.7
#define FF_MODEL_TURN FF_PI
#define FF_MODEL_TURN_ABOUT 0.12 /* m/s ahead or back, within which the cycle is read both ways */

/* A foot in the root frame: ball, and the foot's yaw from the root's heading and pitch (toes up +). */
typedef struct ff_model_foot {
    double forward, left, height, yaw, pitch;
    double swing; /* 0 at toe-off to 1 at contact; -1 on the ground */
} ff_model_foot;

/* Cycle time (s) for the rates: forward by the fitted cadence, shorter sideways and in turns. */
double ff_gait_model_period(const ff_gait_model *model, ff_rates rates);

/* Share of the cycle from a foot's contact to its toe-off. */
double ff_gait_model_stance(const ff_gait_model *model, ff_rates rates);

/* How large the gait is beside the clip's, 0.12 to 1.15: what trunk and arms are scaled by. */
double ff_gait_model_size(const ff_gait_model *model, ff_rates rates);

/* A foot (0 left, 1 right) at a phase of the cycle; period as above or the caller's own. */
ff_model_foot ff_gait_model_foot(const ff_gait_model *model, ff_rates rates, double period, int foot,
                                 double phase);

/* Hips at a phase: forward and left of the root, and up from their mean height (which follows from the legs' reach). Who
 * steps sideways has them over the standing foot. */
ff_vec3 ff_gait_model_hips(const ff_gait_model *model, ff_rates rates, double phase);

/* How far the body leans to the left (rad, at the hips): to where one side-steps, and a little over the standing foot. */
double ff_gait_model_lean(const ff_gait_model *model, ff_rates rates, double phase);

/* How far a side step lifts the hips (m): up while the feet are together, which is when the following foot lands, down while
 * they are apart. Not in ff_gait_model_hips, which examples are derived with as well: their knees would pop for it. */
double ff_gait_model_rise(const ff_gait_model *model, ff_rates rates, double phase);

/* Share of the cycle that is read backwards, 0 to 1: all of it by who goes backwards, both readings about equally by who does
 * neither, so that nothing jumps in between. */
double ff_gait_model_backward(ff_rates rates);

#endif
