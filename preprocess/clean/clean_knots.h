/* clean_knots.h - the clean-up of a whole motion as least-squares problems over knots in time. */
#ifndef FF_CLEAN_KNOTS_H
#define FF_CLEAN_KNOTS_H

#include "preprocess/clean/clean.h"
#include "preprocess/clean/clean_pins.h"

/* Find the changes at about 60 knots per second, window by window, and add them to every frame of the motion. Places of
 * the pins become the ones found. Fills residual, solves, unconverged and iterations of the report. */
ff_status ff_clean_by_knots(const ff_rig *rig, ff_motion *motion, ff_clean_pins *pins,
                            ff_clean_report *report, ff_error *error);

#endif
