/* sharp_turn.h - which velocities somebody who wants to turn round may still use (FbCrowd 4.1; algorithms A.11, step 5). */
#ifndef FF_SHARP_TURN_H
#define FF_SHARP_TURN_H

#include "runtime/core/base/memory.h"
#include "runtime/core/pack/pack_format.h"

/* A motion of the velocity set: m/s along its path, rad/s; no strafes. */
typedef struct ff_turning {
    double speed, turn;
} ff_turning;

/* Half-planes of both sides, appended to out as ff_pack_sharp, left ones first. The motions' velocities, joined in order
 * of their direction, make a star round standing still; where it falls back behind the hull and one end of an edge turns by more than 90
 * degrees per second, that edge is a limit. A side without such an edge gets the line at 0.3 m/s to that side. Every
 * half-plane holds the origin. Overwrites the order of motions. */
ff_status ff_sharp_turns_find(ff_turning *motions, int count, ff_array *out, ff_error *error);

#endif
