/* detour.h - Detour's crowd (librecast) on the same layout: an outside peer for navigation alone, without bodies. */
#ifndef FF_DETOUR_H
#define FF_DETOUR_H

#include "runtime/footfall.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ff_detour ff_detour;

typedef struct ff_detour_agent {
    ff_vec2 position, goal; /* m */
    double radius, preferred_speed;
} ff_detour_agent;

/* 1 when this build has it. */
int ff_detour_here(void);

/* A crowd on an open square of the given half side (m) about the origin. FF_ERR_UNSUPPORTED without librecast. */
ff_status ff_detour_create(const ff_detour_agent *agents, uint32_t count, double half_side, ff_detour **out,
                           ff_error *error);
void ff_detour_destroy(ff_detour *detour);
void ff_detour_step(ff_detour *detour, double dt);
ff_vec2 ff_detour_position(const ff_detour *detour, uint32_t agent);
ff_vec2 ff_detour_velocity(const ff_detour *detour, uint32_t agent);

#ifdef __cplusplus
}
#endif
#endif
