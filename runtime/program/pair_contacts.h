/* pair_contacts.h - how deep people are in each other, by how the two of a pair move: by velocity or on footsteps. */
#ifndef FF_PAIR_CONTACTS_H
#define FF_PAIR_CONTACTS_H

#include "runtime/core/plan/plan_body.h"
#include "runtime/export/body_contacts.h"

typedef struct ff_paired_body {
    ff_cylinders body;
    ff_vec2 position; /* m, of the root */
    double radius;    /* m, of the disc */
    bool plans;       /* on footsteps */
    double reach;     /* m, from the position, of all capsules; 0: whole bodies are not looked at */
    ff_body_capsule capsules[FF_BODY_CAPSULES];
} ff_paired_body;

typedef enum ff_pair_kind {
    FF_PAIR_VELOCITY, /* both go by velocity */
    FF_PAIR_MIXED,
    FF_PAIR_FOOTSTEPS,
    FF_PAIR_KINDS,
} ff_pair_kind;

/* Zero at first. */
typedef struct ff_pair_contacts {
    double seconds;                    /* that pairs' five cylinders touched, all pairs together */
    double deepest;                    /* m, of the five cylinders */
    double body_seconds, body_deepest; /* the same of whole bodies, of capsules about the bones */
    double discs; /* m, deepest of the discs, which are what velocity navigation keeps apart */
} ff_pair_contacts;

/* Look at all pairs of one moment, which stands for so many seconds. */
ff_status ff_pair_contacts_count(const ff_paired_body *bodies, uint32_t count, double seconds,
                                 ff_pair_contacts out[FF_PAIR_KINDS], ff_error *error);

#endif
