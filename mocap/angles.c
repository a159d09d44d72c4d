#include "mocap/angles.h"

#include "runtime/core/base/maths.h"
#include "runtime/core/base/trig_kernel.h"

#include <string.h>

/* Adding and taking away 1.5 * 2^52 rounds to the nearest integer, which then stands in the low bits. */
#define ROUND_SHIFT 6755399441055744.0
#define SIGN_BIT (UINT64_C(1) << 63)

typedef struct reduction {
    double per_half_turn, half_turn, half_turn_rest, to_half_radians;
} reduction;
static const reduction of_degrees = {1.0 / 180.0, 180.0, 0.0, 0.5 * FF_DEG};
/* pi in two parts, the first with 33 bits so that its multiples are exact. */
static const reduction of_radians = {1.0 / FF_PI, 3.14159265346825122833, 1.21542010130123852e-10, 0.5};

static inline double flip(double value, uint64_t sign)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits ^= sign & SIGN_BIT;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double choose(uint64_t mask, double yes, double no)
{
    uint64_t a, b;
    memcpy(&a, &yes, sizeof a);
    memcpy(&b, &no, sizeof b);
    a = (a & mask) | (b & ~mask);
    memcpy(&yes, &a, sizeof yes);
    return yes;
}

/* Half the angle is n quarter turns plus a rest of at most an eighth of a turn. A block has a fixed size and no
 * branches, so that compilers turn it into vector code. */
static void half_sincos_block(const double *restrict angle, const reduction *by, double *restrict sine,
                              double *restrict cosine)
{
    for (int i = 0; i < FF_ANGLE_BLOCK; ++i) {
        double shifted = angle[i] * by->per_half_turn + ROUND_SHIFT;
        double n = shifted - ROUND_SHIFT;
        double rest = ((angle[i] - n * by->half_turn) - n * by->half_turn_rest) * by->to_half_radians;
        double s = ff_kernel_sin(rest), c = ff_kernel_cos(rest);
        uint64_t quarter;
        memcpy(&quarter, &shifted, sizeof quarter);
        uint64_t odd = (uint64_t)0 - (quarter & 1u);
        uint64_t half = quarter << 62; /* bit 1 moved to the sign */
        sine[i] = flip(choose(odd, c, s), half);
        cosine[i] = flip(choose(odd, s, c), half ^ (odd & SIGN_BIT));
    }
}

void ff_half_sincos(const double *angles, size_t count, bool degrees, double *sine, double *cosine)
{
    for (size_t i = 0; i < count; i += FF_ANGLE_BLOCK)
        half_sincos_block(angles + i, degrees ? &of_degrees : &of_radians, sine + i, cosine + i);
}
