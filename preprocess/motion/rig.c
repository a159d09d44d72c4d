#include "preprocess/base/filter.h"
#include "preprocess/motion/retarget.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>

/* Ball of the foot and heel over the sole, and how far the ankle is over the ball: m at leg 0.836 and share of the leg
 * (gait facts, proportions of 13 people). The heel is the labels' virtual heel, 4 cm behind the ankle. */
#define BALL_HEIGHT 0.025
#define ANKLE_OVER_BALL 0.0427
#define HEEL_BEHIND 0.04

/* Mean proportions of 13 people, in leg lengths (gait facts): what a bone is when no clip has it. */
static const ff_vec3 fallback[FF_BODY_COUNT] = {
    [FF_ROLE_SPINE] = {0.0, 0.05, 0.0},        [FF_ROLE_CHEST] = {0.0, 0.20, 0.0},
    [FF_ROLE_NECK] = {0.0, 0.25, -0.01},       [FF_ROLE_HEAD] = {0.0, 0.15, 0.02},
    [FF_ROLE_HEAD_TOP] = {0.0, 0.20, 0.0},     [FF_ROLE_CLAVICLE_L] = {0.02, 0.20, 0.0},
    [FF_ROLE_SHOULDER_L] = {0.197, 0.02, 0.0}, [FF_ROLE_ELBOW_L] = {0.3535, 0.0, 0.0},
    [FF_ROLE_WRIST_L] = {0.2254, 0.0, 0.0},    [FF_ROLE_HAND_L] = {0.15, 0.0, 0.0},
    [FF_ROLE_HIP_L] = {0.1106, -0.1197, 0.0},  [FF_ROLE_KNEE_L] = {0.0, -0.4815, 0.0},
    [FF_ROLE_ANKLE_L] = {0.0, -0.5185, 0.0},   [FF_ROLE_BALL_L] = {0.0, -ANKLE_OVER_BALL, 0.1372},
    [FF_ROLE_TOE_L] = {0.0, 0.0, 0.0720},
};

/* Rest directions that are the rig's own: straight legs, arms out, toes ahead. Zero = the clips' own mean direction. */
static ff_vec3 rig_direction(int role)
{
    switch (role) {
    case FF_ROLE_KNEE_L:
    case FF_ROLE_ANKLE_L:
        return ff_v3(0.0, -1.0, 0.0);
    case FF_ROLE_ELBOW_L:
    case FF_ROLE_WRIST_L:
    case FF_ROLE_HAND_L:
        return ff_v3(1.0, 0.0, 0.0);
    case FF_ROLE_TOE_L:
        return ff_v3(0.0, 0.0, 1.0);
    default:
        return ff_v3(0.0, 0.0, 0.0);
    }
}

typedef struct samples {
    double *x, *y, *z, *length;
    int directions, lengths;
} samples;

/* One clip's bone from a role's parent to the role: its length, mean of both sides, and, when the file's identity pose
 * is a standing person, its direction, facing +Z, as on the left side; all in legs. */
static void sample_clip(const ff_clip *clip, int role, samples *s)
{
    int joint[FF_ROLE_COUNT];
    for (int r = 0; r < FF_ROLE_COUNT; ++r)
        joint[r] = ff_clip_find(clip, (ff_role)r);
    ff_vec3 at[FF_CLIP_MAX_JOINTS], sum = {0.0, 0.0, 0.0};
    double heading, length = 0.0;
    bool standing = ff_rest_is_standing(clip, joint, at, &heading);
    if (!standing) ff_clip_pose(clip, clip->frame_count - 1, at, NULL);
    double leg = ff_clip_leg_length(joint, at);
    if (!(leg > 0.0)) return;
    ff_role mirrored = ff_role_mirror((ff_role)role);
    int sides = mirrored == (ff_role)role ? 1 : 2, found = 0;
    for (int side = 0; side < sides; ++side) {
        ff_role here = side ? mirrored : (ff_role)role, parent = ff_role_parent(here);
        if (joint[here] < 0 || joint[parent] < 0) continue;
        ff_vec3 bone = ff_scale3(ff_sub3(at[joint[here]], at[joint[parent]]), 1.0 / leg);
        length += ff_length3(bone);
        bone = ff_quat_rotate(ff_quat_yaw(-heading), bone);
        sum = ff_add3(sum, ff_v3(side ? -bone.x : bone.x, bone.y, bone.z));
        ++found;
    }
    if (found == 0) return;
    s->length[s->lengths++] = length / found;
    if (!standing) return;
    s->x[s->directions] = sum.x / found;
    s->y[s->directions] = sum.y / found;
    s->z[s->directions++] = sum.z / found;
}

/* Median length over the clips; 0 when no clip has the bone, or only as a tip that coincides with its joint (an empty
 * End Site says nothing about a hand). */
static double median_length(samples *s)
{
    double length = s->lengths > 0 ? ff_filter_quantile(s->length, s->lengths, 0.5) : 0.0;
    return length > 0.01 ? length : 0.0;
}

/* The bone from its parent to a role of the left side or the middle, in legs. */
static ff_vec3 median_bone(const ff_clip *const *clips, int clip_count, int role, samples *s)
{
    s->directions = s->lengths = 0;
    for (int c = 0; c < clip_count; ++c)
        sample_clip(clips[c], role, s);
    ff_vec3 direction = rig_direction(role);
    if (ff_length3(direction) > 0.0) {
        double length = median_length(s);
        return length > 0.0 ? ff_scale3(direction, length) : fallback[role];
    }
    if (role == FF_ROLE_BALL_L) {
        double length = ff_max(median_length(s), ff_length3(fallback[role]) * 0.5);
        return ff_v3(0.0, -ANKLE_OVER_BALL, sqrt(length * length - ANKLE_OVER_BALL * ANKLE_OVER_BALL));
    }
    if (s->directions == 0) {
        double length = median_length(s);
        return length > 0.0 ? ff_scale3(ff_unit3(fallback[role]), length) : fallback[role];
    }
    ff_vec3 bone =
        ff_v3(ff_filter_quantile(s->x, s->directions, 0.5), ff_filter_quantile(s->y, s->directions, 0.5),
              ff_filter_quantile(s->z, s->directions, 0.5));
    if (ff_role_mirror((ff_role)role) == (ff_role)role) bone.x = 0.0;
    return bone;
}

static bool is_right(int role)
{
    return (int)ff_role_mirror((ff_role)role) < role;
}

static ff_status median_leg(const ff_clip *const *clips, int clip_count, double *legs, double *leg,
                            ff_error *error)
{
    int count = 0;
    for (int c = 0; c < clip_count; ++c) {
        int joint[FF_ROLE_COUNT];
        ff_vec3 at[FF_CLIP_MAX_JOINTS];
        for (int r = 0; r < FF_ROLE_COUNT; ++r)
            joint[r] = ff_clip_find(clips[c], (ff_role)r);
        ff_clip_pose(clips[c], clips[c]->frame_count - 1, at, NULL);
        double length = ff_clip_leg_length(joint, at);
        if (length > 0.0) legs[count++] = length;
    }
    if (count == 0)
        return ff_fail(
            error, FF_ERR_NO_DATA,
            "no clip has both legs (hip, knee and ankle joints); name them in the catalogue's roles");
    *leg = ff_filter_quantile(legs, count, 0.5);
    return FF_OK;
}

static void stand_on_floor(ff_rig *rig)
{
    double down = 0.0;
    for (int r = FF_ROLE_BALL_L; r != FF_ROLE_HIPS; r = (int)ff_role_parent((ff_role)r))
        down += rig->offset[r].y;
    rig->offset[FF_ROLE_HIPS] = ff_v3(0.0, BALL_HEIGHT - down, 0.0);
    double ball = rig->offset[FF_ROLE_BALL_L].y;
    rig->offset[FF_BODY_HEEL_L] = rig->offset[FF_BODY_HEEL_R] = ff_v3(0.0, ball, -HEEL_BEHIND);
}

ff_status ff_rig_from_clips(const ff_clip *const *clips, int clip_count, ff_rig *out, ff_error *error)
{
    *out = (ff_rig){0};
    if (clip_count < 1) return ff_fail(error, FF_ERR_NO_DATA, "no clip to make a skeleton from");
    size_t n = (size_t)clip_count;
    double *block = ff_calloc(4 * n, sizeof *block);
    if (!block) return ff_fail(error, FF_ERR_NO_MEMORY, "the skeleton of %d clips", clip_count);
    samples s = {block, block + n, block + 2 * n, block + 3 * n, 0, 0};
    double leg = 0.0;
    ff_status status = median_leg(clips, clip_count, block, &leg, error);
    for (int r = FF_ROLE_SPINE; status == FF_OK && r < FF_ROLE_COUNT; ++r)
        if (!is_right(r)) out->offset[r] = ff_scale3(median_bone(clips, clip_count, r, &s), leg);
    free(block);
    if (status != FF_OK) return status;
    /* Medians of thigh and shank need not add up to one leg exactly: the rig's leg is what its bones are. */
    out->leg = -(out->offset[FF_ROLE_KNEE_L].y + out->offset[FF_ROLE_ANKLE_L].y);
    for (int r = FF_ROLE_SPINE; r < FF_ROLE_COUNT; ++r) {
        ff_vec3 left = out->offset[ff_role_mirror((ff_role)r)];
        if (is_right(r)) out->offset[r] = ff_v3(-left.x, left.y, left.z);
    }
    stand_on_floor(out);
    return FF_OK;
}
