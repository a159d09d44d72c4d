/* gait_window.h - the stretch of an agent's track that shows best how it walks. */
#ifndef FF_GAIT_WINDOW_H
#define FF_GAIT_WINDOW_H

#include "runtime/export/recording.h"

typedef struct ff_gait_window {
    uint32_t first, last; /* steps */
    bool cycles;          /* it is two whole gait cycles, from left plant to left plant */
} ff_gait_window;

/* Two gait cycles, as fast and as straight as the track has them; the fastest 2.2 s when it has no such cycles. */
ff_gait_window ff_gait_window_find(const ff_recording *recording, uint32_t agent);

#endif
