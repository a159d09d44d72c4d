#include "runtime/export/gait_window.h"

#define LEAST 1.2 /* s, of two cycles */
#define MOST 4.5
#define FALLBACK 2.2
#define TURN_COST 0.8 /* m/s per rad: a turning agent shows its gait less well than a slower straight one */

static double score(const ff_recording *recording, uint32_t agent, uint32_t first, uint32_t last)
{
    const ff_track *from = ff_recording_track(recording, first, agent);
    const ff_track *to = ff_recording_track(recording, last, agent);
    double seconds = (last - first) * recording->step;
    double speed = ff_length2(ff_sub2(to->position, from->position)) / seconds;
    double turned = 0.0;
    for (uint32_t k = first; k <= last; ++k)
        turned = ff_max(turned, fabs(ff_wrap((double)ff_recording_track(recording, k, agent)->heading -
                                             (double)from->heading)));
    return speed - TURN_COST * turned;
}

static bool plants(const ff_recording *recording, uint32_t agent, uint32_t step)
{
    return ff_recording_track(recording, step, agent)->planted[0] &&
           !ff_recording_track(recording, step - 1, agent)->planted[0];
}

ff_gait_window ff_gait_window_find(const ff_recording *recording, uint32_t agent)
{
    uint32_t onset[3] = {0}, count = 0;
    ff_span there = ff_recording_span(recording, agent);
    uint32_t end = there.end;
    ff_gait_window best = {there.first, end > 0 ? end - 1 : 0, false};
    double most = -1e9;
    for (uint32_t k = there.first + 1; k < end; ++k) {
        if (!plants(recording, agent, k)) continue;
        onset[0] = onset[1];
        onset[1] = onset[2];
        onset[2] = k;
        double seconds = (k - onset[0]) * recording->step;
        if (++count < 3 || seconds < LEAST || seconds > MOST) continue;
        double value = score(recording, agent, onset[0], k);
        if (value > most) {
            most = value;
            best = (ff_gait_window){onset[0], k, true};
        }
    }
    uint32_t span = (uint32_t)(FALLBACK / recording->step);
    for (uint32_t k = there.first; !best.cycles && k + span < end; ++k) {
        double value = score(recording, agent, k, k + span);
        if (value > most) {
            most = value;
            best = (ff_gait_window){k, k + span, false};
        }
    }
    return best;
}
