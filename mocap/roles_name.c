/* Roles by name. A name is split into a side and a base ("mixamorig:LeftUpLeg" = left + "upleg", "lfemur" = left +
 * "femur", "Bip01 R Thigh" = right + "thigh", "UpperLeg_L" = left + "upperleg"), and the base is looked up. Known to
 * work: CMU's ASF, its BVH conversions (cgspeed's and the ones with rButtock), Mixamo, 3ds max Biped, LAFAN1,
 * Bandai-Namco, Xsens, Blender's Rigify, VRM, KayKit, Quaternius, what Sketchfab makes of them, and plain English. */
#include "mocap/roles_find.h"

#include <ctype.h>
#include <string.h>

typedef struct parsed_name {
    int side; /* 1 left, -1 right, 0 none */
    char base[64];
} parsed_name;

typedef struct base_entry {
    const char *base;
    ff_role role; /* the left one where there are two */
    bool sided;
    int rank; /* of several joints that fit, the one of lowest rank plays the role */
} base_entry;

static const base_entry bases[] = {
    {"hips", FF_ROLE_HIPS, false, 0},          {"pelvis", FF_ROLE_HIPS, false, 1},
    {"hip", FF_ROLE_HIPS, false, 2},           {"root", FF_ROLE_HIPS, false, 3},
    {"head", FF_ROLE_HEAD, false, 0},          {"neck", FF_ROLE_NECK, false, 0},
    {"collar", FF_ROLE_CLAVICLE_L, true, 0},   {"clavicle", FF_ROLE_CLAVICLE_L, true, 0},
    {"upperarm", FF_ROLE_SHOULDER_L, true, 0}, {"uparm", FF_ROLE_SHOULDER_L, true, 0},
    {"humerus", FF_ROLE_SHOULDER_L, true, 0},  {"shldr", FF_ROLE_SHOULDER_L, true, 0},
    {"arm", FF_ROLE_SHOULDER_L, true, 1},      {"shoulder", FF_ROLE_SHOULDER_L, true, 2},
    {"elbow", FF_ROLE_ELBOW_L, true, 0},       {"forearm", FF_ROLE_ELBOW_L, true, 0},
    {"lowerarm", FF_ROLE_ELBOW_L, true, 0},    {"lowarm", FF_ROLE_ELBOW_L, true, 0},
    {"radius", FF_ROLE_ELBOW_L, true, 0},      {"wrist", FF_ROLE_WRIST_L, true, 0},
    {"hand", FF_ROLE_WRIST_L, true, 1},        {"upleg", FF_ROLE_HIP_L, true, 0},
    {"upperleg", FF_ROLE_HIP_L, true, 0},      {"thigh", FF_ROLE_HIP_L, true, 0},
    {"femur", FF_ROLE_HIP_L, true, 0},         {"hip", FF_ROLE_HIP_L, true, 1},
    {"knee", FF_ROLE_KNEE_L, true, 0},         {"shin", FF_ROLE_KNEE_L, true, 0},
    {"calf", FF_ROLE_KNEE_L, true, 0},         {"tibia", FF_ROLE_KNEE_L, true, 0},
    {"shank", FF_ROLE_KNEE_L, true, 0},        {"lowerleg", FF_ROLE_KNEE_L, true, 0},
    {"lowleg", FF_ROLE_KNEE_L, true, 0},       {"leg", FF_ROLE_KNEE_L, true, 1},
    {"ankle", FF_ROLE_ANKLE_L, true, 0},       {"foot", FF_ROLE_ANKLE_L, true, 1},
    {"ball", FF_ROLE_BALL_L, true, 0},         {"toebase", FF_ROLE_BALL_L, true, 0},
    {"toe", FF_ROLE_BALL_L, true, 0},          {"toes", FF_ROLE_BALL_L, true, 0},
    {"toe0", FF_ROLE_BALL_L, true, 0},         {"forefoot", FF_ROLE_BALL_L, true, 0},
    {"armupper", FF_ROLE_SHOULDER_L, true, 0}, {"armlower", FF_ROLE_ELBOW_L, true, 0},
    {"legupper", FF_ROLE_HIP_L, true, 0},      {"leglower", FF_ROLE_KNEE_L, true, 0},
};
enum { BASE_COUNT = sizeof bases / sizeof bases[0] };

static const base_entry *find_base(const char *base, bool sided)
{
    for (int i = 0; i < BASE_COUNT; ++i)
        if (bases[i].sided == sided && strcmp(bases[i].base, base) == 0) return &bases[i];
    return NULL;
}

static bool is_rig_prefix(const char *word)
{
    static const char *const prefixes[] = {"bip",   "bip01", "bip001", "mixamorig", "character1",
                                           "joint", "def",   "cc",     "base",      "b",
                                           "bone",  "jnt",   "j"};
    for (size_t i = 0; i < sizeof prefixes / sizeof prefixes[0]; ++i)
        if (strcmp(word, prefixes[i]) == 0) return true;
    return false;
}

static int side_of(const char *word)
{
    if (strcmp(word, "l") == 0 || strcmp(word, "left") == 0) return 1;
    return strcmp(word, "r") == 0 || strcmp(word, "right") == 0 ? -1 : 0;
}

/* ".001" of Blender's copies, "_065" that Sketchfab puts behind every name; "toe0" and "leg_1" are names. */
static bool is_serial_number(const char *word)
{
    return strlen(word) >= 2 && strspn(word, "0123456789") == strlen(word);
}

/* Take one word (a run of letters and digits without a change from lower to upper case) off the name, in lower case. */
static const char *take_word(const char *p, char word[64])
{
    size_t length = 0;
    while (*p && !isalnum((unsigned char)*p))
        ++p;
    for (; isalnum((unsigned char)*p); ++p) {
        bool upper = isupper((unsigned char)*p);
        bool after_lower = length > 0 && islower((unsigned char)p[-1]);
        bool before_lower = length > 0 && islower((unsigned char)p[1]) && isupper((unsigned char)p[-1]);
        if (upper && (after_lower || before_lower)) break;
        word[length++] = (char)tolower((unsigned char)*p);
    }
    word[length] = '\0';
    return p;
}

/* "lfemur", "leftfoot": a side written without any mark. */
static void split_plain_side(parsed_name *name)
{
    static const struct {
        const char *text;
        int side;
    } marks[] = {{"left", 1}, {"right", -1}, {"l", 1}, {"r", -1}};
    if (name->side != 0 || find_base(name->base, false)) return;
    for (size_t i = 0; i < sizeof marks / sizeof marks[0]; ++i) {
        size_t length = strlen(marks[i].text);
        if (strncmp(name->base, marks[i].text, length) != 0 || !find_base(name->base + length, true))
            continue;
        memmove(name->base, name->base + length, strlen(name->base + length) + 1);
        name->side = marks[i].side;
        return;
    }
}

static parsed_name parse(const char *text)
{
    const char *space = strrchr(text, ':');
    parsed_name name = {0, {0}};
    size_t length = 0;
    char word[64];
    for (const char *p = take_word(space ? space + 1 : text, word); word[0]; p = take_word(p, word)) {
        int side = side_of(word);
        if (side != 0 && name.side == 0) {
            name.side = side;
        } else if (!(length == 0 && is_rig_prefix(word)) && !is_serial_number(word)) {
            size_t more = strlen(word);
            memcpy(name.base + length, word, more + 1);
            length += more;
        }
    }
    split_plain_side(&name);
    return name;
}

static bool any_arm(const ff_clip *clip)
{
    for (int j = 0; j < clip->joint_count; ++j) {
        parsed_name name = parse(clip->joints[j].name);
        const base_entry *entry = name.side ? find_base(name.base, true) : NULL;
        if (entry && entry->role == FF_ROLE_SHOULDER_L && entry->rank < 2) return true;
    }
    return false;
}

void ff_roles_by_name(ff_clip *clip)
{
    int holder[FF_ROLE_COUNT], rank[FF_ROLE_COUNT];
    for (int i = 0; i < FF_ROLE_COUNT; ++i)
        holder[i] = -1, rank[i] = 1000;
    /* "LeftShoulder" is the clavicle where there is a "LeftArm" too, the shoulder joint where there is not. */
    bool arms = any_arm(clip);
    for (int j = 0; j < clip->joint_count; ++j) {
        if (clip->joints[j].end_site) continue;
        parsed_name name = parse(clip->joints[j].name);
        const base_entry *entry = find_base(name.base, name.side != 0);
        if (!entry) continue;
        ff_role role = entry->role;
        if (arms && role == FF_ROLE_SHOULDER_L && entry->rank == 2) role = FF_ROLE_CLAVICLE_L;
        if (name.side < 0) role = ff_role_mirror(role);
        if (entry->rank < rank[role]) holder[role] = j, rank[role] = entry->rank;
    }
    for (int i = 0; i < FF_ROLE_COUNT; ++i)
        if (holder[i] >= 0) clip->joints[holder[i]].role = (ff_role)i;
}
