/* synth.h - from root motion to poses: phase-blended gait examples with planted feet locked (FbCrowd 5;
 * algorithms D.1, D.2, D.6; the lock of the synthesis study, section 4).
 *
 * The body owns the root: navigation asks, ff_body_step moves a body-frame velocity (v_forward, v_left,
 * turn_rate) that the examples can realise towards it, and the root moves by exactly that. The pose is then made
 * to fit the root: blend weights reproduce the velocity, and locked feet stay where they stand.
 */
#ifndef FF_SYNTH_H
#define FF_SYNTH_H

#include "runtime/core/pack/pack.h"

/* Body-frame rates. */
typedef struct ff_rates {
    double forward, left, turn; /* m/s, m/s, rad/s */
} ff_rates;

#define FF_BLEND_MAX                                                                                         \
    8 /* examples blended at once: those of two simplices, as one takes over from the other */

/* What a body moves by. Walking examples, the semi-procedural clip and running examples are never mixed: one passes from
 * one to another within a step (gait_switch.h). */
typedef enum ff_locomotion {
    FF_BLENDING,                                 /* walking examples, blended */
    FF_SEMI_PROCEDURAL = FF_WAY_SEMI_PROCEDURAL, /* the semi-procedural clip at exactly the rates asked for */
    FF_RUNNING = FF_WAY_RUNNING,                 /* running examples, blended */
    FF_LOCOMOTION_COUNT
} ff_locomotion;

typedef struct ff_blend_space ff_blend_space;

/* Prepare the pack's examples for blending. The pack must outlive the space. Fails with FF_ERR_NO_DATA when
 * the pack has no example to walk with. */
ff_status ff_blend_space_create(const ff_pack *pack, ff_blend_space **out, ff_error *error);
void ff_blend_space_destroy(ff_blend_space *space);

/* The rates nearest to target that the examples can be blended to. Allocates nothing; thread-safe. */
ff_rates ff_blend_clamp(const ff_blend_space *space, ff_rates target);

/* The same for bodies: going where one is asked to go comes first, and one turns as fast as goes with it (unless that is
 * hardly at all). The nearest rates would have somebody who is asked for a quick turn stop for it. */
ff_rates ff_blend_clamp_turn(const ff_blend_space *space, ff_rates target);

/* Whether the pack has what this motion needs; FF_BLENDING always is. */
bool ff_locomotion_available(const ff_blend_space *space, ff_locomotion way);

/* The rates nearest to target that a body can move at by this motion: for blending ff_blend_clamp_turn; for the others see
 * locomotion.c. Allocates nothing; thread-safe. */
ff_rates ff_locomotion_clamp(const ff_blend_space *space, ff_locomotion way, ff_rates target);

/* Everything synthesis remembers of one agent: plain data, no pointers, hashed as bytes (so no padding may be
 * left undefined: ff_gait_init zeroes it). */
typedef struct ff_gait ff_gait;
size_t ff_gait_size(void); /* for the crowd's arrays; sizeof(ff_gait) is in synth_state.h */

/* Standing at position/heading with style and phase drawn from variation (any 64 bits). */
void ff_gait_init(const ff_blend_space *space, ff_gait *gait, ff_vec2 position, double heading,
                  uint64_t variation);

/* Make one who has just been initialised scale times as large as the pack's skeleton. Joints then are scale times as far from
 * their parents, steps as long and speeds as high; a smaller person takes as many steps in a second as a larger one. */
void ff_gait_set_scale(const ff_blend_space *space, ff_gait *gait, ff_vec2 position, double heading,
                       double scale);

/* How the agent shall move from the next step on that allows the change. urgent: somebody is about to be run into. What is not
 * available is not asked for. */
void ff_gait_want(const ff_blend_space *space, ff_gait *gait, ff_locomotion way, bool urgent);

/* ff_locomotion_clamp for how it moves now, and, if it shall move otherwise, for both. */
ff_rates ff_gait_clamp(const ff_blend_space *space, const ff_gait *gait, ff_rates target);

/* The root has just moved over dt to position/heading with these rates (already clamped): advance phase, weights
 * and foot locks. Pure function of its arguments; allocates nothing. */
void ff_gait_step(const ff_blend_space *space, ff_gait *gait, ff_vec2 position, double heading,
                  ff_rates rates, double dt);

/* Pose at the current state: world position of the hips joint and local rotations [pack joint_count] (joint 0 in
 * world). Allocates nothing; thread-safe for different gaits. */
void ff_gait_pose(const ff_blend_space *space, const ff_gait *gait, ff_vec2 position, double heading,
                  ff_vec3 *hips, ff_quat *rotations);

/* 1 when foot (0 left, 1 right) is locked to the ground now. */
int ff_gait_planted(const ff_gait *gait, int foot);

/* The foot that alone is on the ground (0 left, 1 right): where its ball stands and where it points, in the world. -1 when
 * both are. */
int ff_gait_stance(const ff_gait *gait, ff_vec2 *ball, double *heading);

#endif
