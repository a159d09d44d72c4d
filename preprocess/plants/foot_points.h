/* foot_points.h - ankle, heel, ball and toe tip of a clip's foot, straight from its poses. */
#ifndef FF_FOOT_POINTS_H
#define FF_FOOT_POINTS_H

#include "preprocess/plants/plants.h"

typedef struct ff_foot_points {
    int count;                          /* clip frames after the leading rest frames */
    ff_vec3 *ankle, *heel, *ball, *toe; /* m, world, as the file has them */
    ff_quat *turn;                      /* world rotation of the ankle joint */
    void *memory;
} ff_foot_points;

/* Ball and toe tip that the skeleton lacks are put where a foot of the leg's size has them. The virtual heel is fixed
 * in the ankle's frame, 4 cm behind the ankle along the foot and at the height of the ball when the foot is flat. */
ff_status ff_foot_points_read(const ff_clip *clip, int foot, ff_foot_points *out, ff_foot_shape *shape,
                              ff_error *error);
void ff_foot_points_free(ff_foot_points *points);

#endif
