#include "preprocess/build/carry.h"

#include <stdlib.h>
#include <string.h>

/* Who adds a member to one of these structs: a plain one is carried with the struct; what a pointer leads to must be
 * added to the function below. Then write the new size here. */
_Static_assert(sizeof(ff_clip) == 344, "carry_clip: is everything of ff_clip carried?");
_Static_assert(sizeof(ff_plants) == 240, "carry_plants: is everything of ff_plants carried?");
_Static_assert(sizeof(ff_motion) == 48, "carry_motion: is everything of ff_motion carried?");
_Static_assert(sizeof(ff_actions) == 32, "carry_actions: is everything of ff_actions carried?");
_Static_assert(sizeof(ff_cycles) == 16, "carry_cycles: is everything of ff_cycles carried?");
_Static_assert(sizeof(ff_pose_coded) == 696, "carry_pose: is everything of ff_pose_coded carried?");
_Static_assert(sizeof(ff_example) == 240, "carry_cycles: is everything of ff_example carried?");
_Static_assert(sizeof(ff_build_clip) == 2352, "is everything the stages find carried?");

/* Bytes on their way: to out, or, when that is NULL, from in. */
typedef struct carrier {
    ff_array *out;
    const char *in;
    size_t left;
    bool good;
} carrier;

static void carry(carrier *c, void *data, size_t size)
{
    if (!c->good || size == 0) return;
    if (c->out) {
        void *place = ff_array_grow(c->out, size, 1);
        c->good = place != NULL;
        if (place) memcpy(place, data, size);
    } else if (size <= c->left) {
        memcpy(data, c->in, size);
        c->in += size;
        c->left -= size;
    } else {
        c->good = false;
    }
}

/* pointer is the address of a pointer to count elements; reading allocates them. */
static void carry_list(carrier *c, void *pointer, int64_t count, size_t size)
{
    void *data = NULL;
    if (c->out) {
        memcpy(&data, pointer, sizeof data);
    } else {
        bool fits = c->good && count >= 0 && (uint64_t)count <= c->left / size;
        if (fits) data = ff_calloc((size_t)count, size);
        c->good = fits && data;
        memcpy(pointer, &data, sizeof data);
    }
    if (c->good) carry(c, data, (size_t)count * size);
}

static void carry_text(carrier *c, char **text)
{
    int64_t length = c->out ? (int64_t)strlen(*text) + 1 : 0;
    carry(c, &length, sizeof length);
    carry_list(c, text, length, 1);
    if (!c->out && c->good && (length < 1 || (*text)[length - 1])) c->good = false;
}

/* Each function first carries the struct itself, without its pointers, then what those lead to. */
#define CARRY_HEAD(c, whole, head)                                                                           \
    do {                                                                                                     \
        carry(c, &(head), sizeof(head));                                                                     \
        if (!(c)->out && (c)->good) *(whole) = (head);                                                       \
    } while (0)

static void carry_clip(carrier *c, ff_clip *clip)
{
    ff_clip head = *clip;
    head.name = head.source = NULL;
    head.joints = NULL;
    head.rotations = NULL;
    head.positions = NULL;
    CARRY_HEAD(c, clip, head);
    carry_text(c, &clip->name);
    carry_text(c, &clip->source);
    carry_list(c, &clip->joints, head.joint_count, sizeof *clip->joints);
    carry_list(c, &clip->rotations, (int64_t)head.frame_count * head.joint_count, sizeof *clip->rotations);
    carry_list(c, &clip->positions, (int64_t)head.frame_count * head.track_count, sizeof *clip->positions);
}

static void carry_breaks(carrier *c, ff_breaks *breaks)
{
    ff_breaks head = *breaks;
    head.items = NULL;
    CARRY_HEAD(c, breaks, head);
    carry_list(c, &breaks->items, head.count, sizeof *breaks->items);
}

static void carry_plants(carrier *c, ff_plants *plants)
{
    ff_plants head = *plants;
    head.items = head.found = NULL;
    head.tracks = NULL;
    head.breaks.items = NULL;
    CARRY_HEAD(c, plants, head);
    carry_list(c, &plants->items, head.count, sizeof *plants->items);
    carry_list(c, &plants->found, head.found_count, sizeof *plants->found);
    carry_list(c, &plants->tracks, 2 * (int64_t)head.frame_count, sizeof *plants->tracks);
    carry_breaks(c, &plants->breaks);
}

static void carry_motion(carrier *c, ff_motion *motion)
{
    ff_motion head = *motion;
    head.root = head.hips = NULL;
    head.rotations = NULL;
    CARRY_HEAD(c, motion, head);
}

static void carry_bytes(carrier *c, ff_array *bytes, size_t element)
{
    int64_t count = (int64_t)bytes->count;
    carry(c, &count, sizeof count);
    carry_list(c, &bytes->data, count, element);
    if (!c->out && c->good) bytes->count = bytes->capacity = (size_t)count;
}

static void carry_pose(carrier *c, ff_pose_coded *pose)
{
    ff_pose_coded head = *pose;
    head.lanes = head.keys = head.roots = (ff_array){0};
    CARRY_HEAD(c, pose, head);
    carry_bytes(c, &pose->lanes, sizeof(ff_pack_lanes));
    carry_bytes(c, &pose->keys, 1);
    carry_bytes(c, &pose->roots, 3 * sizeof(float));
}

static void carry_actions(carrier *c, ff_actions *actions)
{
    ff_actions head = *actions;
    head.items = NULL;
    head.rejections = NULL;
    CARRY_HEAD(c, actions, head);
    carry_list(c, &actions->items, head.count, sizeof *actions->items);
    carry_list(c, &actions->rejections, head.rejection_count, sizeof *actions->rejections);
}

static void carry_example(carrier *c, ff_example *example)
{
    ff_example head = *example;
    head.hips = NULL;
    head.rotations = NULL;
    head.feet = NULL;
    CARRY_HEAD(c, example, head);
    carry_list(c, &example->hips, head.frame_count, sizeof *example->hips);
    carry_list(c, &example->rotations, (int64_t)head.frame_count * FF_ROLE_JOINT_COUNT,
               sizeof *example->rotations);
    carry_list(c, &example->feet, 2 * (int64_t)head.frame_count, sizeof *example->feet);
}

static void carry_cycles(carrier *c, ff_cycles *cycles)
{
    ff_cycles head = *cycles;
    head.items = NULL;
    carry(c, &head, sizeof head);
    if (!c->out) {
        /* Zeroed before anything can go wrong, so that what was read so far can be freed. */
        bool fits = c->good && head.count >= 0 && (size_t)head.count <= c->left / sizeof *cycles->items;
        *cycles = (ff_cycles){.rejected = head.rejected};
        if (fits) cycles->items = ff_calloc((size_t)head.count, sizeof *cycles->items);
        c->good = fits && cycles->items;
        if (c->good) cycles->count = head.count;
    }
    for (int i = 0; i < cycles->count; ++i)
        carry_example(c, &cycles->items[i]);
}

/* ------------------------------------------------------------------------------------------------------ stages */

static void carry_found(carrier *c, ff_build_clip *clip)
{
    carry(c, &clip->hash, sizeof clip->hash);
    carry(c, &clip->frames, sizeof clip->frames);
    carry_clip(c, &clip->clip);
    carry_breaks(c, &clip->repaired);
    carry_plants(c, &clip->plants);
}

static void carry_cut(carrier *c, ff_build_clip *clip)
{
    carry(c, &clip->status, sizeof clip->status);
    carry(c, &clip->error, sizeof clip->error);
    carry_motion(c, &clip->motion);
    carry(c, &clip->cleaned, sizeof clip->cleaned);
    carry_actions(c, &clip->actions);
    carry_cycles(c, &clip->cycles);
    carry_pose(c, &clip->pose);
}

static bool carry_out(const ff_build_clip *clip, void (*part)(carrier *, ff_build_clip *), ff_array *out)
{
    ff_build_clip copy = *clip; /* what is carried out is only looked at */
    carrier c = {.out = out, .good = true};
    part(&c, &copy);
    return c.good;
}

bool ff_carry_found_out(const ff_build_clip *clip, ff_array *out)
{
    return carry_out(clip, carry_found, out);
}

bool ff_carry_cut_out(const ff_build_clip *clip, ff_array *out)
{
    return carry_out(clip, carry_cut, out);
}

bool ff_carry_found_in(ff_build_clip *clip, const void *data, size_t size)
{
    ff_build_clip read = {0};
    carrier c = {.in = data, .left = size, .good = true};
    carry_found(&c, &read);
    bool whole = c.good && c.left == 0;
    if (whole) {
        clip->hash = read.hash;
        clip->frames = read.frames;
        clip->clip = read.clip;
        clip->repaired = read.repaired;
        clip->plants = read.plants;
    } else {
        ff_build_clip_free(&read);
    }
    return whole;
}

bool ff_carry_cut_in(ff_build_clip *clip, const void *data, size_t size)
{
    ff_build_clip read = {0};
    carrier c = {.in = data, .left = size, .good = true};
    carry_cut(&c, &read);
    bool whole = c.good && c.left == 0;
    if (whole) {
        clip->status = read.status;
        clip->error = read.error;
        clip->motion = read.motion;
        clip->cleaned = read.cleaned;
        clip->actions = read.actions;
        clip->cycles = read.cycles;
        clip->pose = read.pose;
    } else {
        ff_build_clip_free(&read);
    }
    return whole;
}
