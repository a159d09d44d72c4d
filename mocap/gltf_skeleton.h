/* gltf_skeleton.h - which nodes of a glTF document are the joints of a clip, and how the body stands at rest. */
#ifndef FF_GLTF_SKELETON_H
#define FF_GLTF_SKELETON_H

#include "mocap/gltf_pose.h"

typedef struct ff_gltf_skeleton {
    int count;
    int *node;         /* [count] of each joint, parents first, depth first */
    int *parent;       /* [count] joint, -1 = a root */
    int *joint;        /* [node_count] joint of a node, -1 = none */
    ff_quat *turned;   /* [count] at rest: world rotation of the node, */
    ff_vec3 *at;       /*         world position; only differences between joints mean anything */
    int skin;          /* the one with most joints, -1 = the file has none for this body */
    int left_out;      /* skins of other bodies */
    double bind_scale; /* world lengths per length in the skin's own space */
    ff_quat bind_turn; /* from the skin's own space to the world */
} ff_gltf_skeleton;

/* animation -1 = any. Free with ff_gltf_skeleton_free, also after a failure. */
ff_status ff_gltf_skeleton_find(const ff_gltf *gltf, int animation, ff_gltf_skeleton *out, ff_error *error);
/* Add the tips of the last joints (fingertips, crown, toes), which files leave out, as far as the skin reaches from
 * them. A skin that cannot be read adds none. */
ff_status ff_gltf_skeleton_add_tips(const ff_gltf *gltf, ff_gltf_skeleton *skeleton, ff_error *error);
void ff_gltf_skeleton_free(ff_gltf_skeleton *skeleton);

/* A node's name as a joint's; "node_7" when the file gives none. */
void ff_gltf_joint_name(const ff_gltf *gltf, int node, char name[64]);

#endif
