/* gltf_pose.h - where the nodes of a glTF document are at a time of one of its animations. */
#ifndef FF_GLTF_POSE_H
#define FF_GLTF_POSE_H

#include "mocap/gltf.h"
#include "runtime/core/base/maths.h"

/* v' = x * v.x + y * v.y + z * v.z + at */
typedef struct ff_affine {
    ff_vec3 x, y, z, at;
} ff_affine;

static inline ff_vec3 ff_affine_turn(const ff_affine *a, ff_vec3 v)
{
    return ff_madd3(ff_madd3(ff_scale3(a->x, v.x), a->y, v.y), a->z, v.z);
}
ff_affine ff_affine_mul(const ff_affine *a, const ff_affine *b); /* first b, then a */
bool ff_affine_invert(const ff_affine *a, ff_affine *out);       /* false when it flattens space */
ff_affine ff_affine_from_columns(const double m[16]);
/* The rotation of the axes, whatever their lengths; shear is taken out by Gram and Schmidt. False when flat. */
bool ff_affine_rotation(const ff_affine *a, ff_quat *out);

/* The keys of one channel. */
typedef struct ff_gltf_curve {
    int node;
    ff_gltf_path path;
    ff_gltf_interpolation interpolation;
    size_t count;
    double *times, *values;
    size_t cursor; /* key before the last time that was asked for */
} ff_gltf_curve;

typedef struct ff_gltf_motion {
    const ff_gltf *gltf;
    ff_gltf_curve *curves;
    int curve_count;
    double start, end;   /* s: first and last key of all curves */
    ff_affine *local;    /* [node_count] */
    double (*parts)[10]; /* [node_count] translation, rotation, scale */
    bool *moving;        /* [node_count] has a curve */
    double largest_scale_change;
} ff_gltf_motion;

/* Read the keys of an animation; -1 = none: the nodes as the file places them. Free with ff_gltf_motion_free, also
 * after a failure. */
ff_status ff_gltf_motion_start(const ff_gltf *gltf, int animation, ff_gltf_motion *out, ff_error *error);
void ff_gltf_motion_free(ff_gltf_motion *motion);

/* World transforms [node_count] at a time (s); times before the first and after the last key hold these. */
void ff_gltf_motion_at(ff_gltf_motion *motion, double time, ff_affine *world);
/* World transforms of the nodes as the file places them, without any animation. */
void ff_gltf_placed(const ff_gltf *gltf, ff_affine *world);

#endif
