/* posture.h - what is a captured person's own in how it holds itself, taken out of the examples, so that blends of people, and
 * of an example with its mirror image, do not shrug, nod or tilt whenever the weights change.
 *
 * Captures hardly move the clavicles (optical skeletons have no markers that would), but each person's stand somewhere else,
 * by up to 20 degrees. Pitch of pelvis, trunk and head has offsets that come from how each skeleton was calibrated (gait facts,
 * limits): subject 49 of the CMU clips tilts the pelvis by 9 degrees and bends the spine back by 10. And hardly anybody holds
 * trunk and head quite upright seen from the front: mirrored, subject 16 tilts the head to the other side, by 20 degrees.
 */
#ifndef FF_POSTURE_H
#define FF_POSTURE_H

#include "runtime/core/pack/joints.h"
#include "runtime/core/pack/pack.h"

typedef struct ff_posture {
    ff_quat mean[FF_JOINT_COUNT]; /* of each joint, over a cycle */
} ff_posture;

ff_posture ff_posture_of_stream(const ff_pack *pack, uint32_t stream);

/* The mean of all examples of a gait (FF_GAIT_WALK, FF_GAIT_RUN). */
ff_posture ff_posture_of_gait(const ff_pack *pack, uint32_t gait);

/* A pose of a stream with posture own, held as common: clavicles, pitch of pelvis, trunk and head as there; trunk and head upright
 * on average, seen from the front. Upper arms and thighs stay turned as they are. */
void ff_posture_level(const ff_posture *own, const ff_posture *common, ff_quat *rotations);

#endif
