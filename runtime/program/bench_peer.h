/* bench_peer.h - Detour's crowd on a scene's layout, measured like a trial. */
#ifndef FF_BENCH_PEER_H
#define FF_BENCH_PEER_H

#include "runtime/program/bench_trial.h"

/* Fills trial->measures and times from trial->def, and hands out what was recorded (free both). Agents arrive when they
 * stand within the tolerance, as ours do. */
ff_status ff_peer_run(const ff_figure *figure, ff_trial *trial, ff_scene *scene, ff_recording *recording,
                      ff_error *error);

#endif
