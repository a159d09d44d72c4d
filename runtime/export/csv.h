/* csv.h - the tracks as a table: time,id,x,z,heading,speed,goal_x,goal_z,radius,reached (m, s, rad; rows by time,
 * then id; agents that have left the scene are left out). */
#ifndef FF_CSV_H
#define FF_CSV_H

#include "runtime/export/recording.h"
#include "runtime/export/scene.h"

/* Rows every `interval` seconds, rounded to whole steps. */
ff_status ff_csv_write(const char *path, const ff_scene *scene, const ff_recording *recording,
                       double interval, ff_error *error);

#endif
