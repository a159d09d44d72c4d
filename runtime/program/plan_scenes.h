/* plan_scenes.h - four plans from above, for bench astar: past walls, out of a trap, among a few people, among many. */
#ifndef FF_PLAN_SCENES_H
#define FF_PLAN_SCENES_H

#include "runtime/program/plan_load.h"

ff_status ff_plan_scenes_write(const char *path, const ff_plan_street *empty, const ff_plan_street *few,
                               const ff_plan_street *many, ff_error *error);

#endif
