/* One animation of a glTF document as a clip, sampled at a uniform rate.
 *
 * World places of the joints are taken from the nodes' matrices, so whatever stands above the skeleton (an armature
 * scaled by 0.01 and turned by 90 degrees) and every scale on the way is in them. A joint's rotation is told from how it
 * is turned at rest (the pose the skin was bound in), so that identity rotations are the rest pose, as in a BVH. */
#include "mocap/gltf_skeleton.h"
#include "mocap/read.h"
#include "mocap/text.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Frames per second when nobody says otherwise; keys lie at 24 or 30 per second in most files. */
#define USUAL_RATE 60.0
/* Longest animation (s), most rotations of one clip, and the farthest a joint may be (file units). */
#define LONGEST 7200.0
#define MOST_ROTATIONS ((size_t)1 << 23)
#define FARTHEST 1e7

/* ------------------------------------------------------------------------------------------- which animation */

static ff_status choose_animation(const ff_gltf *gltf, const char *wanted, ff_clip *clip, int *out,
                                  ff_error *error)
{
    const char **names = ff_calloc((size_t)gltf->animation_count, sizeof *names);
    if (!names) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d animations", gltf->animation_count);
    for (int i = 0; i < gltf->animation_count; ++i)
        names[i] = gltf->animations[i].name;
    *out = ff_gltf_find_animation(names, gltf->animation_count, wanted);
    free(names);
    if (!wanted && gltf->animation_count > 1)
        ff_clip_warn(clip, "%d animations, the first one is taken: name one as FILE#ANIMATION",
                     gltf->animation_count);
    if (*out >= 0) return FF_OK;
    if (!wanted || gltf->animation_count == 0)
        return ff_fail(error, FF_ERR_NO_DATA, "the file has no animation");
    char list[200] = "";
    for (int i = 0; i < gltf->animation_count; ++i) {
        size_t used = strlen(list);
        if (used + strlen(gltf->animations[i].name) + 8 > sizeof list) break;
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", gltf->animations[i].name);
    }
    return ff_fail(error, FF_ERR_ARGUMENT, "no animation '%.60s' among the %d here: %s", wanted,
                   gltf->animation_count, list);
}

/* ---------------------------------------------------------------------------------------------------- frames */

static ff_status plan_frames(const ff_gltf_motion *motion, int joints, double rate, ff_clip *clip,
                             ff_error *error)
{
    double seconds = motion->end - motion->start, frames = floor(seconds * rate + 1e-6) + 1.0;
    if (!(seconds >= 0.0 && seconds <= LONGEST))
        return ff_fail(error, FF_ERR_RANGE, "the animation lasts %.4g s, at most %g s are read", seconds,
                       LONGEST);
    if (!(frames * joints <= (double)MOST_ROTATIONS))
        return ff_fail(error, FF_ERR_RANGE,
                       "%.0f frames of %d joints are too many for one clip: cut the animation", frames,
                       joints);
    clip->frame_time = 1.0 / rate;
    clip->joint_count = joints;
    clip->track_count = joints; /* until it is known which of them stay where they are */
    int capacity = 0;
    ff_status status = ff_clip_reserve(clip, &capacity, (int)frames, (int)frames, error);
    if (status == FF_OK) clip->frame_count = (int)frames;
    return status;
}

void ff_gltf_joint_name(const ff_gltf *gltf, int node, char name[64])
{
    if (gltf->nodes[node].name[0]) {
        memcpy(name, gltf->nodes[node].name, sizeof gltf->nodes[node].name);
    } else {
        snprintf(name, 64, "node_%d", node);
    }
}

static ff_status make_joints(const ff_gltf *gltf, const ff_gltf_skeleton *s, ff_clip *clip, ff_error *error)
{
    clip->joints = ff_calloc((size_t)s->count, sizeof *clip->joints);
    if (!clip->joints) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d joints", s->count);
    for (int j = 0; j < s->count; ++j) {
        ff_joint *joint = &clip->joints[j];
        joint->end_site = s->node[j] < 0;
        int named = joint->end_site ? s->node[s->parent[j]] : s->node[j];
        ff_gltf_joint_name(gltf, named, joint->name);
        if (joint->end_site) {
            joint->name[59] = '\0';
            memcpy(joint->name + strlen(joint->name), "_end", 5);
        }
        joint->parent = s->parent[j];
        joint->track = j;
        joint->role = FF_ROLE_NONE;
        joint->offset = joint->parent < 0 ? s->at[j] : ff_sub3(s->at[j], s->at[joint->parent]);
    }
    return FF_OK;
}

/* World transforms into local rotations and offsets; false when a joint is nowhere. */
static bool store_frame(const ff_gltf_skeleton *s, const ff_affine *world, ff_quat *turned,
                        ff_quat *rotations, ff_vec3 *positions)
{
    for (int j = 0; j < s->count; ++j) {
        int parent = s->parent[j];
        if (s->node[j] < 0) {
            rotations[j] = FF_QUAT_IDENTITY;
            positions[j] = ff_sub3(s->at[j], s->at[parent]);
            continue;
        }
        const ff_affine *here = &world[s->node[j]];
        ff_quat q;
        /* A joint that is scaled to nothing (a way to hide things) turns with its parent. */
        turned[j] = ff_affine_rotation(here, &q) ? ff_quat_mul(q, ff_quat_conj(s->turned[j]))
                    : parent >= 0                ? turned[parent]
                                                 : FF_QUAT_IDENTITY;
        rotations[j] = turned[j];
        positions[j] = here->at;
        if (!(fabs(here->at.x) <= FARTHEST && fabs(here->at.y) <= FARTHEST && fabs(here->at.z) <= FARTHEST))
            return false;
        if (parent < 0) continue;
        ff_quat back = ff_quat_conj(turned[parent]);
        rotations[j] = ff_quat_unit(ff_quat_mul(back, turned[j]));
        positions[j] = ff_quat_rotate(back, ff_sub3(here->at, world[s->node[parent]].at));
    }
    return true;
}

static ff_status sample(const ff_gltf_skeleton *s, ff_gltf_motion *motion, double rate, ff_clip *clip,
                        ff_error *error)
{
    ff_affine *world = ff_calloc((size_t)motion->gltf->node_count, sizeof *world);
    ff_quat *turned = ff_calloc((size_t)s->count, sizeof *turned);
    ff_status status = FF_OK;
    if (!world || !turned) status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a pose");
    for (int k = 0; status == FF_OK && k < clip->frame_count; ++k) {
        size_t at = (size_t)k * (size_t)s->count;
        ff_gltf_motion_at(motion, motion->start + k / rate, world);
        if (!store_frame(s, world, turned, clip->rotations + at, clip->positions + at))
            status = ff_fail(error, FF_ERR_RANGE, "at %.3f s a joint is more than %g from the origin",
                             k / rate, FARTHEST);
    }
    free(world);
    free(turned);
    return status;
}

/* ------------------------------------------------------------------------------- which joints need a position track */

/* Keys are floats: a bone whose length differs by less than this share of the body's size does not change. */
#define STILL 1e-6
/* One that is longer or shorter than at rest by more than this share is kept as a track: the rest pose stays what it is. */
#define AS_AT_REST 2e-3

static bool stays(const ff_clip *clip, int joint, double size)
{
    size_t count = (size_t)clip->joint_count;
    ff_vec3 first = clip->positions[joint];
    for (size_t k = 1; k < (size_t)clip->frame_count; ++k)
        if (ff_length3(ff_sub3(clip->positions[k * count + (size_t)joint], first)) > STILL * size)
            return false;
    return ff_length3(ff_sub3(first, clip->joints[joint].offset)) <= AS_AT_REST * size;
}

static double size_of_body(const ff_clip *clip)
{
    double size = 0.0;
    for (int j = 0; j < clip->joint_count; ++j)
        if (clip->joints[j].parent >= 0) size = ff_max(size, ff_length3(clip->positions[j]));
    return size;
}

static void drop_still_tracks(ff_clip *clip)
{
    double size = size_of_body(clip);
    size_t joints = (size_t)clip->joint_count, kept = 0;
    int tracks = 0;
    for (int j = 0; j < clip->joint_count; ++j) {
        ff_joint *joint = &clip->joints[j];
        if (joint->parent >= 0 && stays(clip, j, size)) {
            joint->track = -1;
            joint->offset = clip->positions[j];
        } else {
            joint->track = tracks++;
        }
    }
    for (size_t k = 0; k < (size_t)clip->frame_count; ++k)
        for (size_t j = 0; j < joints; ++j)
            if (clip->joints[j].track >= 0) clip->positions[kept++] = clip->positions[k * joints + j];
    clip->track_count = tracks;
    ff_clip_trim(clip, clip->frame_count + 1);
}

/* --------------------------------------------------------------------------------------------------------- all */

/* Scales of joints that change by more than this are told about. */
#define SCALE_CHANGE 1e-3

static ff_status odd(ff_clip *clip, bool strict, ff_error *error, const char *message)
{
    if (strict) return ff_fail(error, FF_ERR_RANGE, "%s", message);
    ff_clip_warn(clip, "%s", message);
    return FF_OK;
}

static ff_status build(const ff_gltf *gltf, const char *animation, const ff_load_options *options,
                       ff_clip *clip, ff_gltf_skeleton *skeleton, ff_gltf_motion *motion, ff_error *error)
{
    double rate = options->fps > 0.0 ? options->fps : USUAL_RATE;
    int index = -1;
    ff_status status = choose_animation(gltf, animation, clip, &index, error);
    if (status == FF_OK) status = ff_gltf_skeleton_find(gltf, index, skeleton, error);
    if (status == FF_OK) status = ff_gltf_skeleton_add_tips(gltf, skeleton, error);
    if (status == FF_OK) status = ff_gltf_motion_start(gltf, index, motion, error);
    if (status == FF_OK) status = plan_frames(motion, skeleton->count, rate, clip, error);
    if (status == FF_OK) status = make_joints(gltf, skeleton, clip, error);
    if (status == FF_OK) status = sample(skeleton, motion, rate, clip, error);
    if (status != FF_OK) return status;
    drop_still_tracks(clip);
    if (motion->largest_scale_change > SCALE_CHANGE)
        status = odd(clip, options->strict, error,
                     "joints change their scale in time: bones change their lengths");
    if (status == FF_OK && skeleton->left_out > 0)
        status = odd(clip, options->strict, error, "skins of other bodies in the file are left out");
    return status;
}

ff_status ff_gltf_parse(const char *data, size_t size, const char *name, const char *animation,
                        const ff_load_options *options, ff_clip *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    ff_gltf gltf;
    ff_status status = ff_gltf_open(data, size, name, (ff_gltf_keys){false, animation}, &gltf, error);
    if (status != FF_OK) return status;
    ff_gltf_skeleton skeleton = {0};
    ff_gltf_motion motion = {0};
    status = build(&gltf, animation, options, out, &skeleton, &motion, error);
    ff_gltf_motion_free(&motion);
    ff_gltf_skeleton_free(&skeleton);
    ff_gltf_close(&gltf);
    return ff_clip_read_end(status, name, out, error);
}
