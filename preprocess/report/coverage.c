#include "preprocess/report/coverage.h"

#include "preprocess/actions/successors.h"
#include "preprocess/build/settings.h"

#include <stdlib.h>

#define MODE(m) (1u << (FF_MODE_##m))
#define WALKS (MODE(WALK_SHORT) | MODE(WALK_LONG))
#define STEPS (WALKS | MODE(START) | MODE(STOP))
enum { STANDS = FF_ACTION_FROM_STANDING, STOPS = FF_ACTION_TO_STANDING, WHOLE = FF_ACTION_WHOLE };

/* A kind of action. Zero widths and equal ends say nothing. */
typedef struct action_kind {
    const char *words;
    uint32_t modes, flags;
    double way, around;       /* degrees: direction of the swing foot's way, left +, and how far from it */
    double shortest, longest; /* m, of that way */
    double least, most;       /* degrees of turn, left + */
    double slowest, fastest;  /* m/s */
} action_kind;

static const action_kind kinds[] = {
    {"standing", MODE(IDLE), 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {"start from standing", MODE(START), STANDS, 0, 35, 0.2, 9, 0, 0, 0, 0},
    {"stop", MODE(STOP), STOPS, 0, 35, 0.2, 9, 0, 0, 0, 0},
    {"turn on the spot to the left by about 20 degrees", MODE(TURN), WHOLE, 0, 0, 0, 0, 12, 32, 0, 0},
    {"turn on the spot to the right by about 20 degrees", MODE(TURN), WHOLE, 0, 0, 0, 0, -32, -12, 0, 0},
    {"turn on the spot to the left by about 45 degrees", MODE(TURN), WHOLE, 0, 0, 0, 0, 32, 65, 0, 0},
    {"turn on the spot to the right by about 45 degrees", MODE(TURN), WHOLE, 0, 0, 0, 0, -65, -32, 0, 0},
    {"turn on the spot to the left by more than 65 degrees", MODE(TURN), WHOLE, 0, 0, 0, 0, 65, 999, 0, 0},
    {"turn on the spot to the right by more than 65 degrees", MODE(TURN), WHOLE, 0, 0, 0, 0, -999, -65, 0, 0},
    {"side step to the left up to 0.3 m", STEPS, 0, 90, 35, 0.05, 0.31, 0, 0, 0, 0},
    {"side step to the right up to 0.3 m", STEPS, 0, -90, 35, 0.05, 0.31, 0, 0, 0, 0},
    {"side step to the left longer than 0.3 m", STEPS, 0, 90, 35, 0.31, 9, 0, 0, 0, 0},
    {"side step to the right longer than 0.3 m", STEPS, 0, -90, 35, 0.31, 9, 0, 0, 0, 0},
    {"step back up to 0.5 m", STEPS, 0, 180, 30, 0.05, 0.5, 0, 0, 0, 0},
    {"step back longer than 0.5 m", STEPS, 0, 180, 30, 0.5, 9, 0, 0, 0, 0},
    {"step ahead and to the left", STEPS, 0, 45, 20, 0.3, 9, 0, 0, 0, 0},
    {"step ahead and to the right", STEPS, 0, -45, 20, 0.3, 9, 0, 0, 0, 0},
    {"step back and to the left", STEPS, 0, 135, 20, 0.2, 9, 0, 0, 0, 0},
    {"step back and to the right", STEPS, 0, -135, 20, 0.2, 9, 0, 0, 0, 0},
    {"walk slower than 0.6 m/s", WALKS, 0, 0, 30, 0.1, 9, 0, 0, 0.15, 0.6},
    {"walk at 0.6 to 1 m/s", WALKS, 0, 0, 30, 0.1, 9, 0, 0, 0.6, 1.0},
    {"walk at 1 to 1.5 m/s", WALKS, 0, 0, 30, 0.1, 9, 0, 0, 1.0, 1.5},
    {"walk faster than 1.5 m/s", WALKS, 0, 0, 30, 0.1, 9, 0, 0, 1.5, 9},
    {"walking step that turns left by 10 to 30 degrees", WALKS, 0, 0, 60, 0.3, 9, 10, 30, 0, 0},
    {"walking step that turns right by 10 to 30 degrees", WALKS, 0, 0, 60, 0.3, 9, -30, -10, 0, 0},
    {"walking step that turns left by more than 30 degrees", WALKS, 0, 0, 90, 0.3, 9, 30, 999, 0, 0},
    {"walking step that turns right by more than 30 degrees", WALKS, 0, 0, 90, 0.3, 9, -999, -30, 0, 0},
    {"running step", MODE(RUN), 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {"jump", MODE(JUMP), 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {"duck or crouched step", MODE(CROUCH), 0, 0, 0, 0, 0, 0, 0, 0, 0},
};

int ff_coverage_kinds(void)
{
    return (int)(sizeof kinds / sizeof kinds[0]);
}

const char *ff_coverage_words(int kind)
{
    return kinds[kind].words;
}

static bool within(double value, double low, double high)
{
    return low == high || (value >= low && value < high);
}

static bool is_of(const ff_pack_action *a, const action_kind *k)
{
    if (!(k->modes >> a->mode & 1u) || (a->flags & k->flags) != k->flags) return false;
    ff_vec2 way = ff_v2((double)a->swing_displacement[0], (double)a->swing_displacement[1]);
    double off = fabs(ff_wrap(ff_atan2(way.b, way.a) - k->way * FF_DEG)) / FF_DEG;
    if (k->around > 0.0 && off > k->around) return false;
    return within(ff_length2(way), k->shortest, k->longest) &&
           within((double)a->theta / FF_DEG, k->least, k->most) &&
           within((double)a->speed, k->slowest, k->fastest);
}

uint32_t ff_coverage_count(const ff_pack *pack, int kind)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pack->action_count; ++i)
        count += is_of(&pack->actions[i], &kinds[kind]);
    return count;
}

ff_branching ff_coverage_branching(const ff_pack *pack)
{
    ff_branching b = {.least = pack->action_count ? UINT32_MAX : 0};
    uint32_t own = 0;
    for (uint32_t i = 0; i < pack->action_count; ++i)
        own += !(pack->actions[i].flags & FF_ACTION_MIRRORED);
    ff_settings usual = ff_settings_default();
    double limit = ff_join_limit(&usual.successors, (int)own);
    for (uint32_t i = 0; i < pack->action_count; ++i) {
        const ff_pack_action *a = &pack->actions[i];
        b.least = a->successor_count < b.least ? a->successor_count : b.least;
        b.most = a->successor_count > b.most ? a->successor_count : b.most;
        b.forced += a->successor_count > 0 && (double)pack->successors[a->first_successor].distance > limit;
    }
    /* The median: as many have more as have fewer. */
    uint32_t passed = 0, value = b.least;
    for (; value < b.most; ++value) {
        for (uint32_t i = 0; i < pack->action_count; ++i)
            passed += pack->actions[i].successor_count == value;
        if (2 * passed >= pack->action_count) break;
    }
    b.median = value;
    return b;
}
