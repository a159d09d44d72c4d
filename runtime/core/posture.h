/* posture.h - what is a captured person's own in how it holds itself, taken out of the examples, so that blends of people, and
 * of an example with its mirror image, do not shrug or tilt whenever the weights change.
 *
 * Captures hardly move the clavicles (optical skeletons have no markers that would), but each person's stand somewhere else,
 * by up to 20 degrees; and hardly anybody holds trunk and head quite upright seen from the front: mirrored, subject 16 of the
 * CMU clips tilts the head to the other side, by 20 degrees.
 */
#ifndef FF_POSTURE_H
#define FF_POSTURE_H

#include "runtime/core/joints.h"
#include "runtime/core/pack.h"

typedef struct ff_posture {
    ff_quat mean[FF_JOINT_COUNT]; /* of the joints from the spine to the clavicles, over a cycle */
} ff_posture;

ff_posture ff_posture_of_stream(const ff_pack *pack, uint32_t stream);

/* The mean clavicles of all examples, left and right. */
void ff_posture_clavicles(const ff_pack *pack, ff_quat out[2]);

/* A pose of a stream with this posture: the clavicles about those given (the upper arms stay turned as they are), trunk and
 * head upright on average, seen from the front. */
void ff_posture_level(const ff_posture *own, const ff_quat clavicles[2], ff_quat *rotations);

#endif
