/* example_kinds.h - the kinds of locomotion a pack should have: the 19 of FbCrowd's database (Shapiro 2011; algorithms
 * A.10), and what blending needs beside them. */
#ifndef FF_EXAMPLE_KINDS_H
#define FF_EXAMPLE_KINDS_H

#include "runtime/core/base/maths.h"
#include "runtime/core/pack/pack_format.h"

/* Metres per second that 1 rad/s counts for, as the runtime measures rates. */
#define FF_KIND_TURN_SCALE 0.5

typedef struct ff_example_kind {
    const char *name;
    double forward, left,
        turn;      /* m/s, m/s, rad/s; turning and going left, the other side is its mirror image */
    double period; /* s, when it has to be made up; 0 = as the model has it */
    double within; /* m/s: a captured example this near does instead */
    uint32_t gait;
    bool idle, of_paper;
} ff_example_kind;

#define FF_EXAMPLE_KINDS 14
extern const ff_example_kind ff_example_kinds[FF_EXAMPLE_KINDS];

/* Is there a right-handed one too? */
static inline bool ff_kind_has_sides(const ff_example_kind *kind)
{
    return kind->left != 0.0 || kind->turn != 0.0;
}

/* How far (m/s) an example is from a kind; side 1 left, -1 right. Huge for another gait. */
double ff_kind_distance(const ff_example_kind *kind, double side, const ff_pack_example *example);

#endif
