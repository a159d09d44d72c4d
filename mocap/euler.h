/* euler.h - the angles that motion files hold, out of a unit quaternion. Degrees; files are the only place for them. */
#ifndef FF_EULER_H
#define FF_EULER_H

#include "runtime/core/base/maths.h"

/* R = Rz(out.z) Rx(out.x) Ry(out.y): BVH's "Zrotation Xrotation Yrotation". */
ff_vec3 ff_euler_zxy(ff_quat q);

/* R = Rz(out.z) Ry(out.y) Rx(out.x): ASF's axis order XYZ and its dof "rx ry rz". */
ff_vec3 ff_euler_zyx(ff_quat q);

#endif
