#include "runtime/program/pair_contacts.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>

#define NEAR 2.2 /* m between roots, beyond which bodies do not touch */

typedef struct placed {
    double a;
    uint32_t index;
} placed;

static int by_place(const void *x, const void *y)
{
    const placed *p = x, *q = y;
    return p->a != q->a ? (p->a > q->a) - (p->a < q->a) : (p->index > q->index) - (p->index < q->index);
}

static void look_at(const ff_paired_body *p, const ff_paired_body *q, double seconds,
                    ff_pair_contacts out[FF_PAIR_KINDS])
{
    double apart = ff_length2(ff_sub2(p->position, q->position));
    if (apart >= NEAR) return;
    ff_pair_contacts *kind = &out[p->plans + q->plans];
    double deep = ff_cylinders_overlap(&p->body, &q->body);
    if (deep > 0.0) kind->seconds += seconds;
    kind->deepest = ff_max(kind->deepest, deep);
    if (p->reach > 0.0 && apart < p->reach + q->reach) {
        double gap = ff_bodies_gap(p->capsules, q->capsules);
        if (gap < 0.0) kind->body_seconds += seconds;
        kind->body_deepest = ff_max(kind->body_deepest, -gap);
    }
    kind->discs = ff_max(kind->discs, p->radius + q->radius - apart);
}

/* By a sweep along one axis. */
ff_status ff_pair_contacts_count(const ff_paired_body *bodies, uint32_t count, double seconds,
                                 ff_pair_contacts out[FF_PAIR_KINDS], ff_error *error)
{
    placed *order = ff_calloc(count, sizeof *order);
    if (!order) return ff_fail(error, FF_ERR_NO_MEMORY, "the contacts of %u agents", count);
    for (uint32_t i = 0; i < count; ++i)
        order[i] = (placed){bodies[i].position.a, i};
    qsort(order, count, sizeof *order, by_place);
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t j = i + 1; j < count && order[j].a - order[i].a < NEAR; ++j)
            look_at(&bodies[order[i].index], &bodies[order[j].index], seconds, out);
    free(order);
    return FF_OK;
}
