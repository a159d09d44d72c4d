/* capture.h - what real motion capture adds to a clip: creeping feet, a floor that is neither level nor at zero, noise
 * and lost frames. */
#ifndef FF_CAPTURE_H
#define FF_CAPTURE_H

#include "mocap/generator/generator.h"

/* Change the clip and the places of its true plants by the options; does nothing when they are all 0. */
void ff_capture_spoil(const ff_generator_options *options, uint64_t stream, ff_generated *generated);

#endif
