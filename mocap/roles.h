/* roles.h - what each joint is for. Nothing after the readers looks at a joint's name. */
#ifndef FF_ROLES_H
#define FF_ROLES_H

#include <stdbool.h>

/* A role names the joint where the bone STARTS: FF_ROLE_HIP_L is the hip joint (start of the thigh), KNEE the
 * start of the shank, ANKLE the start of the foot, BALL the start of the toes. Tips are end sites or leaf joints.
 * The order is the order of joints in a motion pack's skeleton (parents first). */
typedef enum ff_role {
    FF_ROLE_NONE = -1,
    FF_ROLE_HIPS = 0,
    FF_ROLE_SPINE, /* lowest spine joint above the hips */
    FF_ROLE_CHEST, /* joint that carries the clavicles */
    FF_ROLE_NECK,
    FF_ROLE_HEAD,
    FF_ROLE_CLAVICLE_L,
    FF_ROLE_SHOULDER_L,
    FF_ROLE_ELBOW_L,
    FF_ROLE_WRIST_L,
    FF_ROLE_CLAVICLE_R,
    FF_ROLE_SHOULDER_R,
    FF_ROLE_ELBOW_R,
    FF_ROLE_WRIST_R,
    FF_ROLE_HIP_L,
    FF_ROLE_KNEE_L,
    FF_ROLE_ANKLE_L,
    FF_ROLE_BALL_L,
    FF_ROLE_HIP_R,
    FF_ROLE_KNEE_R,
    FF_ROLE_ANKLE_R,
    FF_ROLE_BALL_R,
    FF_ROLE_JOINT_COUNT, /* roles below this rotate; the rest are points */
    FF_ROLE_HEAD_TOP = FF_ROLE_JOINT_COUNT,
    FF_ROLE_HAND_L, /* fingertip or end of the wrist bone */
    FF_ROLE_HAND_R,
    FF_ROLE_TOE_L, /* toe tip */
    FF_ROLE_TOE_R,
    FF_ROLE_COUNT
} ff_role;

/* "hips", "left knee" ...; "none". */
const char *ff_role_name(ff_role role);
/* The role of a name that ff_role_name gives ("none" too); false for any other. */
bool ff_role_from_name(const char *name, ff_role *out);
/* The same role on the other side; middle roles map to themselves. */
ff_role ff_role_mirror(ff_role role);
/* Parent of a role in the pack's skeleton; FF_ROLE_NONE for the hips. Points have parents too. */
ff_role ff_role_parent(ff_role role);

#endif
