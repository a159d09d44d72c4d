/* Roles of a clip's joints: names, then shape, then what follows from both, then the caller's overrides. */
#include "mocap/roles_find.h"

#include "mocap/text.h"

#include <string.h>

static int parent_of(const ff_clip *clip, int joint)
{
    return clip->joints[joint].parent;
}

static bool is_below(const ff_clip *clip, int joint, int ancestor)
{
    while (joint > ancestor)
        joint = parent_of(clip, joint);
    return joint == ancestor;
}

static void give(ff_clip *clip, int joint, ff_role role)
{
    if (joint >= 0 && clip->joints[joint].role == FF_ROLE_NONE && ff_clip_find(clip, role) < 0)
        clip->joints[joint].role = role;
}

/* Length of the chain of offsets from ancestor down to joint. */
static double chain_length(const ff_clip *clip, int joint, int ancestor)
{
    double length = 0.0;
    for (; joint > ancestor; joint = parent_of(clip, joint))
        length += ff_length3(clip->joints[joint].offset);
    return length;
}

static bool is_leaf(const ff_clip *clip, int joint)
{
    return joint + 1 >= clip->joint_count || parent_of(clip, joint + 1) != joint;
}

/* The tip farthest down the chains below joint, or -1. */
static int farthest_tip(const ff_clip *clip, int joint)
{
    int best = -1;
    double longest = 0.0;
    for (int j = joint + 1; joint >= 0 && j < clip->joint_count; ++j) {
        if (!is_below(clip, j, joint) || !is_leaf(clip, j)) continue;
        double length = chain_length(clip, j, joint);
        if (length > longest) longest = length, best = j;
    }
    return best;
}

static int common_ancestor(const ff_clip *clip, int a, int b)
{
    while (a != b && a >= 0 && b >= 0) {
        if (a > b) {
            a = parent_of(clip, a);
        } else {
            b = parent_of(clip, b);
        }
    }
    return a == b ? a : -1;
}

/* The joint below another one on the way to its farthest tip, or -1: a hand whose fingers begin at the forearm, a foot
 * that is only the shin's end. */
static int next_joint(const ff_clip *clip, int joint)
{
    int tip = farthest_tip(clip, joint);
    while (tip >= 0 && parent_of(clip, tip) != joint)
        tip = parent_of(clip, tip);
    return tip;
}

/* A "root" under everything is the hips only where the legs hang from it. */
static void lift_hips(ff_clip *clip)
{
    int hips = ff_clip_find(clip, FF_ROLE_HIPS), left = ff_clip_find(clip, FF_ROLE_HIP_L);
    int right = ff_clip_find(clip, FF_ROLE_HIP_R);
    int legs = left >= 0 && right >= 0 ? common_ancestor(clip, left, right) : -1;
    if (hips < 0 || legs <= hips || !is_below(clip, legs, hips) || clip->joints[legs].role != FF_ROLE_NONE)
        return;
    clip->joints[hips].role = FF_ROLE_NONE;
    clip->joints[legs].role = FF_ROLE_HIPS;
}

static void complete_limbs(ff_clip *clip)
{
    static const ff_role above[4] = {FF_ROLE_ELBOW_L, FF_ROLE_ELBOW_R, FF_ROLE_KNEE_L, FF_ROLE_KNEE_R};
    for (int i = 0; i < 4; ++i) /* wrist and ankle follow elbow and knee */
        if (ff_clip_find(clip, above[i] + 1) < 0)
            give(clip, next_joint(clip, ff_clip_find(clip, above[i])), above[i] + 1);
}

static void complete_foot(ff_clip *clip, ff_role ankle_role, ff_role ball_role, ff_role toe_role)
{
    int ankle = ff_clip_find(clip, ankle_role);
    if (ankle < 0) return;
    int tip = farthest_tip(clip, ankle);
    int ball = ff_clip_find(clip, ball_role);
    if (ball < 0 && tip >= 0) {
        /* the joint below the ankle on the way to the tip, if it can turn */
        for (ball = tip; parent_of(clip, ball) != ankle;)
            ball = parent_of(clip, ball);
        if (!clip->joints[ball].end_site && !is_leaf(clip, ball)) give(clip, ball, ball_role);
    }
    give(clip, tip, toe_role);
}

/* Never turned where it is looked at: a bone without degrees of freedom, there only to bridge a distance. */
static bool is_rigid(const ff_clip *clip, int joint)
{
    int frame = ff_clip_typical_frame(clip), last = clip->frame_count - 1;
    for (int i = 0; i < 3; ++i) {
        int at = frame + (last - frame) * i / 2;
        ff_quat q = clip->rotations[(size_t)at * (size_t)clip->joint_count + (size_t)joint];
        if (q.x != 0.0 || q.y != 0.0 || q.z != 0.0) return false;
    }
    return true;
}

/* The first joint below ancestor on the way down to joint, one that turns if any does; -1 when joint is not below it. */
static int first_below(const ff_clip *clip, int joint, int ancestor)
{
    if (joint < 0 || ancestor < 0 || joint == ancestor || !is_below(clip, joint, ancestor)) return -1;
    int turning = -1;
    for (; parent_of(clip, joint) != ancestor; joint = parent_of(clip, joint))
        if (!is_rigid(clip, parent_of(clip, joint))) turning = parent_of(clip, joint);
    return turning >= 0 ? turning : joint;
}

static void complete_trunk(ff_clip *clip)
{
    int left = ff_clip_find(clip, FF_ROLE_SHOULDER_L), right = ff_clip_find(clip, FF_ROLE_SHOULDER_R);
    int head = ff_clip_find(clip, FF_ROLE_HEAD), hips = ff_clip_find(clip, FF_ROLE_HIPS);
    if (left >= 0 && right >= 0) {
        int chest = common_ancestor(clip, left, right);
        int between_left = parent_of(clip, left), between_right = parent_of(clip, right);
        if (between_left != chest && between_right != chest) {
            give(clip, between_left, FF_ROLE_CLAVICLE_L);
            give(clip, between_right, FF_ROLE_CLAVICLE_R);
        }
        give(clip, chest, FF_ROLE_CHEST);
    }
    int chest = ff_clip_find(clip, FF_ROLE_CHEST);
    give(clip, first_below(clip, chest, hips), FF_ROLE_SPINE);
    give(clip, first_below(clip, head, chest), FF_ROLE_NECK);
}

void ff_roles_complete(ff_clip *clip)
{
    lift_hips(clip);
    complete_limbs(clip);
    complete_foot(clip, FF_ROLE_ANKLE_L, FF_ROLE_BALL_L, FF_ROLE_TOE_L);
    complete_foot(clip, FF_ROLE_ANKLE_R, FF_ROLE_BALL_R, FF_ROLE_TOE_R);
    complete_trunk(clip);
    give(clip, farthest_tip(clip, ff_clip_find(clip, FF_ROLE_HEAD)), FF_ROLE_HEAD_TOP);
    give(clip, farthest_tip(clip, ff_clip_find(clip, FF_ROLE_WRIST_L)), FF_ROLE_HAND_L);
    give(clip, farthest_tip(clip, ff_clip_find(clip, FF_ROLE_WRIST_R)), FF_ROLE_HAND_R);
}

static const ff_role needed[] = {FF_ROLE_HIPS,  FF_ROLE_HIP_L,  FF_ROLE_KNEE_L, FF_ROLE_ANKLE_L,
                                 FF_ROLE_HIP_R, FF_ROLE_KNEE_R, FF_ROLE_ANKLE_R};
enum { NEEDED_COUNT = sizeof needed / sizeof needed[0] };

static ff_role first_missing(const ff_clip *clip)
{
    for (int i = 0; i < NEEDED_COUNT; ++i)
        if (ff_clip_find(clip, needed[i]) < 0) return needed[i];
    return FF_ROLE_NONE;
}

ff_status ff_roles_require(const ff_clip *clip, ff_error *error)
{
    ff_role missing = first_missing(clip);
    if (missing == FF_ROLE_NONE) return FF_OK;
    ff_fail(error, FF_ERR_NO_DATA, "no joint was recognised as %s: name it in the catalogue (\"roles\")",
            ff_role_name(missing));
    ff_error_in_file(error, clip->source);
    return FF_ERR_NO_DATA;
}

/* Exactly the name, or the same name but for upper and lower case. */
static int find_joint(const ff_clip *clip, const char *name)
{
    for (int j = 0; j < clip->joint_count; ++j)
        if (strcmp(clip->joints[j].name, name) == 0) return j;
    return -1;
}

ff_status ff_roles_find(ff_clip *clip, const ff_role_override *overrides, int override_count, ff_error *error)
{
    ff_roles_by_name(clip);
    complete_limbs(clip);
    if (first_missing(clip) != FF_ROLE_NONE) ff_roles_by_shape(clip);
    bool seen[FF_CLIP_MAX_JOINTS] = {false};
    for (int i = 0; i < override_count; ++i) {
        int joint = find_joint(clip, overrides[i].joint);
        if (joint < 0) {
            ff_fail(error, FF_ERR_ARGUMENT, "a role is given to joint '%.63s', which this file does not have",
                    overrides[i].joint);
            ff_error_in_file(error, clip->source);
            return FF_ERR_ARGUMENT;
        }
        int before = ff_clip_find(clip, overrides[i].role);
        if (before >= 0) clip->joints[before].role = FF_ROLE_NONE;
        clip->joints[joint].role = overrides[i].role;
        seen[joint] = true;
    }
    ff_roles_complete(clip);
    for (int i = 0; i < override_count; ++i) { /* a joint that was given no role keeps none */
        int joint = find_joint(clip, overrides[i].joint);
        if (seen[joint] && overrides[i].role == FF_ROLE_NONE) clip->joints[joint].role = FF_ROLE_NONE;
    }
    ff_role missing = first_missing(clip);
    if (missing != FF_ROLE_NONE) ff_clip_warn(clip, "no joint was recognised as %s", ff_role_name(missing));
    return FF_OK;
}
