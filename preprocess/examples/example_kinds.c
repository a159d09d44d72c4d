#include "preprocess/examples/example_kinds.h"

/* Rates that have to be made up keep the limits of the synthesis study, section 5. */
const ff_example_kind ff_example_kinds[FF_EXAMPLE_KINDS] = {
    {"idle", 0.0, 0.0, 0.0, 0.0, 0.1, FF_GAIT_WALK, true, true},
    {"slow walk", 0.45, 0.0, 0.0, 1.3, 0.25, FF_GAIT_WALK, false, true},
    {"walk", 1.2, 0.0, 0.0, 0.0, 0.3, FF_GAIT_WALK, false, true},
    {"jog", 2.2, 0.0, 0.0, 0.0, 0.4, FF_GAIT_RUN, false, true},
    {"run", 3.1, 0.0, 0.0, 0.0, 0.5, FF_GAIT_RUN, false, true},
    {"walk circle", 1.1, 0.0, 0.6, 0.0, 0.3, FF_GAIT_WALK, false, true},
    {"tight circle", 0.7, 0.0, 1.5, 1.0, 0.3, FF_GAIT_WALK, false, true},
    {"run circle", 2.6, 0.0, 0.6, 0.0, 0.45, FF_GAIT_RUN, false, true},
    {"run tight circle", 2.1, 0.0, 1.2, 0.0, 0.4, FF_GAIT_RUN, false, true},
    {"turn in place", 0.0, 0.0, 1.57, 0.95, 0.35, FF_GAIT_WALK, false, true},
    {"strafe slow", 0.0, 0.3, 0.0, 0.0, 0.15, FF_GAIT_WALK, false, true},
    {"strafe fast", 0.0, 0.6, 0.0, 0.82, 0.2, FF_GAIT_WALK, false, true},
    {"step in place", 0.0, 0.0, 0.0, 1.1, 0.1, FF_GAIT_WALK, false, false},
    {"back", -0.7, 0.0, 0.0, 1.1, 0.35, FF_GAIT_WALK, false, false},
};

double ff_kind_distance(const ff_example_kind *kind, double side, const ff_pack_example *example)
{
    if (example->gait != kind->gait || kind->idle != ((example->flags & FF_EXAMPLE_IDLE) != 0)) return 1e9;
    return ff_length3(ff_v3((double)example->v_forward - kind->forward,
                            (double)example->v_left - side * kind->left,
                            FF_KIND_TURN_SCALE * ((double)example->turn_rate - side * kind->turn)));
}
