/* body_contacts.h - whether bodies touch: five upright cylinders round head, hands and feet (Beacco et al. 2013;
 * algorithms A.9 and B.4). Discs that stay apart may still belong to bodies that do not, and the other way round. */
#ifndef FF_BODY_CONTACTS_H
#define FF_BODY_CONTACTS_H

#include "runtime/core/pack/pack.h"
#include "runtime/export/figure.h"

#include <stdbool.h>

enum {
    FF_CYLINDER_HEAD,
    FF_CYLINDER_HAND_L,
    FF_CYLINDER_HAND_R,
    FF_CYLINDER_FOOT_L,
    FF_CYLINDER_FOOT_R,
    FF_CYLINDER_COUNT
};

typedef struct ff_cylinders {
    ff_vec3 at[FF_CYLINDER_COUNT];
    bool present;
} ff_cylinders;

typedef struct ff_contacts {
    ff_cylinders *bodies; /* one per agent: fill in, then ff_contacts_count */
    uint32_t agent_count;
    double deepest; /* m */
    uint64_t pairs; /* different pairs of bodies that ever touched */
    uint8_t *seen;  /* one bit per pair counted */
} ff_contacts;

ff_status ff_contacts_create(uint32_t agents, ff_contacts *out, ff_error *error);
void ff_contacts_free(ff_contacts *contacts);

/* From the places of all joints. */
ff_cylinders ff_cylinders_of(const ff_vec3 *joints);

/* About the middles of head, hands and feet, where a pack's actions have their colliders: what planners keep apart. Places and
 * rotations of all joints, in the world. */
ff_cylinders ff_cylinders_of_colliders(const ff_pack *pack, const ff_vec3 *joints, const ff_quat *rotations);

/* How deep the two bodies are in each other, 0 = apart (m, on the ground). */
double ff_cylinders_overlap(const ff_cylinders *p, const ff_cylinders *q);

/* How deep the body is in a wall from p to q. */
double ff_cylinders_in_wall(const ff_cylinders *body, ff_vec2 p, ff_vec2 q);

/* Look at every pair of those present, then forget who was. */
void ff_contacts_count(ff_contacts *contacts);

#endif
