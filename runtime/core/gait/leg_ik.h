/* leg_ik.h - two-bone leg: from hip and foot to joint rotations, without flips, pops or a locked knee. */
#ifndef FF_LEG_IK_H
#define FF_LEG_IK_H

#include "runtime/core/base/pair.h"

/* A leg as the clip has it, in the world: where its joints are and how its bones are turned. */
typedef struct ff_leg {
    ff_vec3 hip, knee, ankle;
    ff_quat thigh, shank, foot;
} ff_leg;

/* Both legs of a body, left and right. */
typedef struct ff_legs {
    ff_pair3 hip, knee, ankle;
    ff_pairq thigh, shank, foot;
} ff_legs;

/* The longest hip to ankle distance that a planted leg is planned with, as a share of its length; the knee is then
 * bent by 13 degrees, as people's are at least (gait facts: 6 to 10). */
#define FF_LEG_REACH 0.9935

/* Distance that the leg really takes for a wanted one: the same up to 0.99 of the leg, easing to 0.998 (study, section
 * 4.5), so that the knee never snaps straight. */
double ff_leg_soft_reach(double distance, double leg_length);
/* What ff_leg_soft_reach makes this distance of. */
double ff_leg_hard_reach(double distance, double leg_length);

/* The same for a leg in the air, which need not arrive: eases from 0.95 of the leg to 0.993, so that a foot that is flung
 * ahead does not stop short where the leg ends. share: 0 reaches like a standing leg, 1 eases fully. */
double ff_leg_swing_reach(double distance, double leg_length, double share);

/* The same at a time of the swing, 0 to 1: at both ends the leg has to reach its foot. */
double ff_leg_swing_distance(double swing, double distance, double leg_length);

/* Move the leg's hip to hip and its ankle to (towards, when out of reach) ankle. The knee keeps the side the clip has
 * it on, carried over with the smallest rotation from the old hip-ankle line to the new one; bones keep their twist.
 * The foot's rotation is left alone. */
void ff_leg_solve(ff_leg *leg, ff_vec3 hip, ff_vec3 ankle);

/* The same of both legs at once, in little more than the time of one. */
void ff_legs_solve(ff_legs *legs, ff_pair3 hip, ff_pair3 ankle);

#endif
