/* skeleton.h - the built-in person: joints, lengths and an empty clip of it (internal to the generator). */
#ifndef FF_GENERATOR_SKELETON_H
#define FF_GENERATOR_SKELETON_H

#include "mocap/clip.h"

/* Lengths in metres; the proportions are the means of 13 CMU people (hip to ankle = 1) at a leg of 0.82 m. */
#define FF_BODY_LEG 0.82
#define FF_BODY_THIGH (0.4815 * FF_BODY_LEG)
#define FF_BODY_SHANK (0.5185 * FF_BODY_LEG)
#define FF_BODY_BALL_HEIGHT 0.030                                         /* ball joint over the sole */
#define FF_BODY_ANKLE_HEIGHT (FF_BODY_BALL_HEIGHT + 0.0427 * FF_BODY_LEG) /* ankle joint over the sole */
#define FF_BODY_FOOT 0.1125                                               /* ankle to ball along the ground */
#define FF_BODY_HEEL 0.040                                                /* virtual heel behind the ankle */
#define FF_BODY_TOES (0.0720 * FF_BODY_LEG)
#define FF_BODY_HIP_HALF (0.5 * 0.2212 * FF_BODY_LEG)
#define FF_BODY_ROOT_UP (0.1197 * FF_BODY_LEG) /* root joint above and behind the middle of the hip joints */
#define FF_BODY_ROOT_BACK 0.020

/* Offset of a role's joint from its parent's in the rest pose: facing +Z, arms out, legs straight down, feet flat,
 * soles at y = 0. HIPS: its rest position. */
ff_vec3 ff_body_offset(ff_role role);

/* A clip of frame_count rest poses at 120 Hz with every role. The caller frees it. */
ff_status ff_body_clip(const char *name, int frame_count, ff_clip *out, ff_error *error);

#endif
