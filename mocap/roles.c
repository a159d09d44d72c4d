#include "mocap/roles.h"

#include <stddef.h>
#include <string.h>

typedef struct role_entry {
    const char *name;
    ff_role mirror, parent;
} role_entry;

#define LEFT_AND_RIGHT(what, role, parent_l, parent_r)                                                       \
    [FF_ROLE_##role##_L] = {"left " what, FF_ROLE_##role##_R, parent_l},                                     \
    [FF_ROLE_##role##_R] = {"right " what, FF_ROLE_##role##_L, parent_r}
#define LIMB(what, role, parent) LEFT_AND_RIGHT(what, role, FF_ROLE_##parent##_L, FF_ROLE_##parent##_R)

static const role_entry entries[FF_ROLE_COUNT] = {
    [FF_ROLE_HIPS] = {"hips", FF_ROLE_HIPS, FF_ROLE_NONE},
    [FF_ROLE_SPINE] = {"spine", FF_ROLE_SPINE, FF_ROLE_HIPS},
    [FF_ROLE_CHEST] = {"chest", FF_ROLE_CHEST, FF_ROLE_SPINE},
    [FF_ROLE_NECK] = {"neck", FF_ROLE_NECK, FF_ROLE_CHEST},
    [FF_ROLE_HEAD] = {"head", FF_ROLE_HEAD, FF_ROLE_NECK},
    LEFT_AND_RIGHT("clavicle", CLAVICLE, FF_ROLE_CHEST, FF_ROLE_CHEST),
    LIMB("shoulder", SHOULDER, CLAVICLE),
    LIMB("elbow", ELBOW, SHOULDER),
    LIMB("wrist", WRIST, ELBOW),
    LEFT_AND_RIGHT("hip", HIP, FF_ROLE_HIPS, FF_ROLE_HIPS),
    LIMB("knee", KNEE, HIP),
    LIMB("ankle", ANKLE, KNEE),
    LIMB("ball", BALL, ANKLE),
    [FF_ROLE_HEAD_TOP] = {"head top", FF_ROLE_HEAD_TOP, FF_ROLE_HEAD},
    LIMB("hand", HAND, WRIST),
    LIMB("toe", TOE, BALL),
};

const char *ff_role_name(ff_role role)
{
    return role >= 0 && role < FF_ROLE_COUNT ? entries[role].name : "none";
}

ff_role ff_role_mirror(ff_role role)
{
    return role >= 0 && role < FF_ROLE_COUNT ? entries[role].mirror : FF_ROLE_NONE;
}

ff_role ff_role_parent(ff_role role)
{
    return role >= 0 && role < FF_ROLE_COUNT ? entries[role].parent : FF_ROLE_NONE;
}

bool ff_role_from_name(const char *name, ff_role *out)
{
    *out = FF_ROLE_NONE;
    if (strcmp(name, "none") == 0) return true;
    for (int i = 0; i < FF_ROLE_COUNT; ++i) {
        if (strcmp(name, entries[i].name) != 0) continue;
        *out = (ff_role)i;
        return true;
    }
    return false;
}
