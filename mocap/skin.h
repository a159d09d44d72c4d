/* skin.h - the surface of a character, bound to the joints of a clip, as plain arrays. */
#ifndef FF_SKIN_H
#define FF_SKIN_H

#include "mocap/load.h"

enum { FF_SKIN_BONES = 4 }; /* joints a vertex hangs on at most */

typedef struct ff_skin_vertex {
    ff_vec3 at;     /* in the rest pose, as joint.at is */
    ff_vec3 normal; /* unit; zero when the file gives none */
    double uv[2];
    int joint[FF_SKIN_BONES];     /* into ff_skin.joints; where the weight is 0 it means nothing */
    double weight[FF_SKIN_BONES]; /* of joint[i]; they add up to 1, largest first */
} ff_skin_vertex;

/* A joint at rest: what turns with it is where it is turned to from there. */
typedef struct ff_skin_joint {
    char name[64];
    int parent;
    ff_vec3 at;
    ff_role role; /* FF_ROLE_NONE: none of its own */
    ff_role near; /* its own role, or that of the nearest joint above that has one (hips at the top) */
} ff_skin_joint;

/* Everything is in metres at the size of a clip loaded from the same file (toys are scaled as ff_clip_load does), Y up. */
typedef struct ff_skin {
    ff_skin_vertex *vertices;
    int vertex_count;
    uint32_t (*triangles)[3];
    int triangle_count;
    ff_skin_joint *joints;
    int joint_count;
    double unit_m;
    int warning_count;
    char warning[256];
} ff_skin;

/* Read the skin of a .gltf or .glb. Of several bodies the one with most joints is taken. Meshes that merely hang on a joint
 * (swords, hats) are not part of it. FF_ERR_NO_DATA when there is none. Free with ff_skin_free. */
ff_status ff_skin_load(const char *path, const ff_load_options *options, ff_skin *out, ff_error *error);
void ff_skin_free(ff_skin *skin);

/* The joints as a clip of one frame, at rest. The caller frees it with ff_clip_free. */
ff_status ff_skin_rest_clip(const ff_skin *skin, ff_clip *out, ff_error *error);

#endif
