/* step_check.h - what kind of step a span is, and whether it is fit to be an action. */
#ifndef FF_STEP_CHECK_H
#define FF_STEP_CHECK_H

#include "preprocess/actions/annotate.h"

/* FF_MODE_* of a step from what surrounds it, or -1 to tell walk from run by its own figures. */
int ff_step_mode(const ff_cut_settings *settings, const ff_rig *rig, const ff_motion *motion,
                 const ff_plants *plants, const ff_step_span *span, int mode_tag, bool from_standing,
                 bool to_standing);

/* False when the step breaks a limit (algorithms A.6, but a run of 4 m/s carries its feet 2.7 m); reason (size bytes) then says which. */
bool ff_step_acceptable(const ff_step_settings *settings, const ff_rig *rig, const ff_motion *motion,
                        const ff_plants *plants, const ff_step_span *span, const ff_pack_action *record,
                        char *reason, size_t size);

/* Are the hips, on average, as low as those of someone who crouches, sits or lies? */
bool ff_is_crouched(const ff_step_settings *settings, const ff_rig *rig, const ff_motion *motion,
                    const ff_plants *plants, int first, int last);

#endif
