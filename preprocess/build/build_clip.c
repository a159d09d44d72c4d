#define _POSIX_C_SOURCE 200809L
#include "preprocess/build/build_clip.h"

#include "mocap/generator/generator.h"
#include "preprocess/base/code_version.h"
#include "preprocess/build/carry.h"
#include "preprocess/examples/example_judge.h"
#include "preprocess/plants/plant_edit.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <xxhash.h>

void ff_build_clip_free(ff_build_clip *clip)
{
    free(clip->source);
    ff_clip_free(&clip->clip);
    ff_breaks_free(&clip->repaired);
    ff_plants_free(&clip->plants);
    ff_motion_free(&clip->motion);
    ff_actions_free(&clip->actions);
    ff_cycles_free(&clip->cycles);
    ff_pose_coded_free(&clip->pose);
    memset(clip, 0, sizeof *clip);
}

void ff_build_clip_begin(ff_build_clip *clip, const ff_catalogue_entry *entry, int index)
{
    clip->entry = entry;
    if (entry) {
        clip->licence = entry->licence;
        clip->citation = entry->citation;
        clip->tags = entry->tags;
        clip->mode = entry->mode;
        clip->mirror = entry->mirror;
        clip->first_frame = entry->trim_first;
        return;
    }
    ff_generator_info info = ff_generator_describe(index);
    clip->built_in = index;
    clip->licence = "MIT";
    clip->citation =
        "The data used in this project was obtained from mocap.cs.cmu.edu. The database was created with "
        "funding from NSF EIA-0196217.";
    clip->tags = info.tags;
    clip->mode = info.mode;
    clip->mirror = true;
}

static ff_status generate(const ff_build_clip *clip, ff_clip *out, ff_error *error)
{
    ff_generated made;
    ff_status status = ff_generator_make(clip->built_in, NULL, &made, error);
    if (status != FF_OK) return status;
    *out = made.clip;
    memset(&made.clip, 0, sizeof made.clip);
    ff_generated_free(&made);
    return FF_OK;
}

/* All frames of the clip that the catalogue wants, single broken ones put back. */
static ff_status read_frames(const ff_build_clip *clip, const ff_find_settings *settings, ff_clip *out,
                             ff_breaks *repaired, ff_error *error)
{
    const ff_catalogue_entry *entry = clip->entry;
    memset(repaired, 0, sizeof *repaired);
    if (!entry) return generate(clip, out, error);
    ff_status status = ff_clip_load(entry->path, &entry->options, out, error);
    if (status == FF_OK) status = ff_clip_keep(out, entry->trim_first, entry->trim_last, error);
    if (status == FF_OK) status = ff_breaks_repair(out, &settings->breaks, repaired, error);
    if (status != FF_OK) ff_clip_free(out);
    return status;
}

/* Give the memory of all frames back but for the last: the rig is made from the skeletons, and skeletons whose identity
 * pose is not a standing person are measured in a pose. */
static void keep_last_frame(ff_clip *clip)
{
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count,
           last = (size_t)clip->frame_count - 1;
    memmove(clip->rotations, clip->rotations + last * joints, joints * sizeof *clip->rotations);
    ff_quat *rotations = realloc(clip->rotations, joints * sizeof *rotations);
    if (rotations) clip->rotations = rotations;
    if (tracks) {
        memmove(clip->positions, clip->positions + last * tracks, tracks * sizeof *clip->positions);
        ff_vec3 *positions = realloc(clip->positions, tracks * sizeof *positions);
        if (positions) clip->positions = positions;
    }
    clip->frame_count = 1;
}

/* --------------------------------------------------------------------------------------------------------- keys */

static uint64_t hash_text(const char *text, uint64_t seed)
{
    return XXH64(text, strlen(text) + 1, seed);
}

/* Everything about a catalogue entry that what is read from its file depends on. */
static uint64_t hash_entry(const ff_catalogue_entry *entry, uint64_t seed)
{
    const ff_load_options *o = &entry->options;
    const char *slash = strrchr(entry->path, '/');
    const double numbers[] = {o->in_place, o->unit_m,         o->fps,          o->up,
                              o->strict,   entry->trim_first, entry->trim_last};
    seed = hash_text(slash ? slash + 1 : entry->path,
                     seed); /* clips are named after their files and animations */
    seed = XXH64(numbers, sizeof numbers, seed);
    for (int i = 0; i < o->override_count; ++i) {
        int32_t role = o->overrides[i].role;
        seed = XXH64(&role, sizeof role, hash_text(o->overrides[i].joint, seed));
    }
    return seed;
}

/* What a person wrote beside the clip is part of it. */
static ff_status hash_override(const ff_catalogue_entry *entry, uint64_t *all, ff_error *error)
{
    char path[1024];
    ff_file file;
    if (!ff_plant_edits_path(entry->path, path, sizeof path) || access(path, F_OK) != 0) return FF_OK;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    *all = XXH64(file.data, file.size, *all + 1);
    ff_file_unmap(&file);
    return FF_OK;
}

static ff_status make_find_key(ff_build_clip *clip, const ff_build_shared *shared)
{
    uint64_t all = 0, key = hash_text(ff_code_version(), 0);
    if (clip->entry) {
        ff_status status =
            ff_clip_hash(clip->entry->path, &clip->entry->options, &clip->hash, &all, &clip->error);
        if (status == FF_OK) status = hash_override(clip->entry, &all, &clip->error);
        if (status != FF_OK) return status;
        key = hash_entry(clip->entry, key);
    } else {
        key = hash_text(clip->source, key);
    }
    key = XXH64(&all, sizeof all, key);
    clip->find_key = ff_settings_hash(shared->settings, FF_STAGE_FIND, key);
    return FF_OK;
}

static void make_cut_key(ff_build_clip *clip, const ff_build_shared *shared)
{
    uint64_t key = hash_text(clip->mode, hash_text(clip->tags, clip->find_key + 1));
    key = XXH64(shared->rig, sizeof *shared->rig, key); /* doubles only: no padding */
    clip->cut_key = ff_settings_hash(shared->settings, FF_STAGE_CUT, key);
}

/* ----------------------------------------------------------------------------------------------------- stage 1 */

/* Found, then what a person wrote beside the clip; frames in that file are the clip file's. */
static ff_status find_plants(ff_build_clip *clip, const ff_find_settings *settings)
{
    ff_plant_edits edits;
    bool written = false;
    if (!clip->entry) return ff_plants_find(&clip->clip, settings, &clip->plants, &clip->error);
    ff_status status = ff_plant_edits_load(clip->entry->path, &edits, &written, &clip->error);
    if (status != FF_OK) return status;
    ff_plant_edits_trim(&edits, clip->first_frame, clip->clip.frame_count);
    status =
        ff_plants_find_edited(&clip->clip, settings, written ? &edits : NULL, &clip->plants, &clip->error);
    ff_plant_edits_free(&edits);
    return status;
}

static ff_status find(ff_build_clip *clip, const ff_find_settings *settings)
{
    ff_status status = read_frames(clip, settings, &clip->clip, &clip->repaired, &clip->error);
    if (status != FF_OK) return status;
    if (!clip->entry) {
        size_t poses = (size_t)clip->clip.frame_count * (size_t)clip->clip.joint_count;
        clip->hash = XXH64(clip->clip.rotations, poses * sizeof *clip->clip.rotations, 0);
    }
    clip->frames = clip->clip.frame_count;
    status = find_plants(clip, settings);
    keep_last_frame(&clip->clip);
    return status;
}

static void name_error(ff_build_clip *clip)
{
    if (clip->status != FF_OK) ff_error_in_file(&clip->error, clip->entry ? clip->entry->path : clip->source);
}

void ff_build_clip_find(ff_build_clip *clip, const ff_build_shared *shared)
{
    void *data;
    size_t size;
    clip->status = make_find_key(clip, shared);
    if (clip->status == FF_OK && ff_cache_load(shared->cache, "find", clip->find_key, &data, &size)) {
        bool whole = ff_carry_found_in(clip, data, size);
        free(data);
        if (whole) return;
    }
    if (clip->status == FF_OK) clip->status = find(clip, &shared->settings->find);
    ff_array entry = {0};
    if (clip->status == FF_OK && ff_carry_found_out(clip, &entry))
        ff_cache_store(shared->cache, "find", clip->find_key, entry.data, entry.count);
    ff_array_free(&entry);
    name_error(clip);
}

/* FF_MODE_* of a whole clip, or -1: found from the motion. */
static int mode_tag(const char *mode)
{
    static const struct {
        const char *name;
        int mode;
    } known[] = {{"idle", FF_MODE_IDLE},
                 {"jump", FF_MODE_JUMP},
                 {"climb", FF_MODE_CLIMB},
                 {"turn", FF_MODE_TURN},
                 {"crouch", FF_MODE_CROUCH}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i)
        if (mode && strcmp(mode, known[i].name) == 0) return known[i].mode;
    return -1;
}

/* Is word one of the space-separated tags? */
static bool has_tag(const char *tags, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = tags; (at = strstr(at, word)) != NULL; at += length)
        if ((at == tags || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return true;
    return false;
}

/* ----------------------------------------------------------------------------------------------------- stage 2 */

ff_status ff_build_clip_read(const ff_build_clip *clip, const ff_find_settings *settings, ff_clip *out,
                             ff_error *error)
{
    uint64_t own = clip->hash, all;
    ff_status status = FF_OK;
    if (clip->entry) status = ff_clip_hash(clip->entry->path, &clip->entry->options, &own, &all, error);
    if (status == FF_OK && own != clip->hash)
        status = ff_fail(error, FF_ERR_IO, "the file changed while it was worked on");
    ff_breaks repaired; /* the same as the first time */
    if (status == FF_OK) status = read_frames(clip, settings, out, &repaired, error);
    if (status == FF_OK) ff_breaks_free(&repaired);
    return status;
}

ff_status ff_build_clip_store(ff_build_clip *clip, const ff_build_shared *shared)
{
    ff_motion *motion = &clip->motion;
    size_t rest = (size_t)clip->clip.rest_frames;
    ff_pose_motion poses = {.frame_count = motion->frame_count - (int)rest,
                            .frame_time = motion->frame_time,
                            .bytes = shared->settings->poses.bytes,
                            .root = motion->root + rest,
                            .hips = motion->hips + rest,
                            .rotations = motion->rotations + rest * FF_ROLE_JOINT_COUNT};
    ff_status status = ff_pose_encode(shared->joints, shared->points, &poses, &clip->pose, &clip->error);
    ff_motion head = *motion;
    ff_motion_free(motion);
    motion->frame_count = head.frame_count;
    motion->frame_time = head.frame_time;
    motion->scale = head.scale;
    return status;
}

ff_status ff_build_clip_motion(ff_build_clip *clip, const ff_build_shared *shared)
{
    const ff_plants *plants = &clip->plants;
    ff_clip whole;
    ff_status status = ff_build_clip_read(clip, &shared->settings->find, &whole, &clip->error);
    if (status != FF_OK) return status;
    status = ff_motion_from_clip(shared->rig, &whole, plants, &clip->motion, &clip->error);
    ff_clip_free(&whole);
    if (status == FF_OK && shared->settings->cut.motion.clean)
        status = ff_motion_clean(shared->rig, &shared->settings->cut.clean, &clip->motion, plants,
                                 &clip->cleaned, &clip->error);
    return status;
}

ff_status ff_build_clip_actions(ff_build_clip *clip, const ff_build_shared *shared)
{
    return ff_actions_cut(&shared->settings->cut, shared->rig, &clip->motion, &clip->plants,
                          mode_tag(clip->mode), &clip->actions, &clip->error);
}

/* Is there a straight walk among the whole cycles that a pack can walk with? */
static bool has_firm_walk(const ff_example_settings *settings, const ff_rig *rig, const ff_cycles *cycles)
{
    char why[96];
    for (int i = 0; i < cycles->count; ++i)
        if (ff_example_is_model(&cycles->items[i]) &&
            ff_example_judge(settings, rig, &cycles->items[i], why, sizeof why))
            return true;
    return false;
}

static ff_status cut(ff_build_clip *clip, const ff_build_shared *shared)
{
    const ff_plants *plants = &clip->plants;
    int mode = mode_tag(clip->mode), rest = clip->clip.rest_frames;
    bool walks = mode != FF_MODE_JUMP && mode != FF_MODE_CLIMB && mode != FF_MODE_CROUCH &&
                 !has_tag(clip->tags, FF_TAG_NO_EXAMPLE);
    const ff_rig *rig = shared->rig;
    const ff_cut_settings *set = &shared->settings->cut;
    ff_status status = ff_build_clip_motion(clip, shared);
    if (status == FF_OK) status = ff_build_clip_actions(clip, shared);
    if (status == FF_OK && walks)
        status = ff_cycles_cut(&set->cycles, rig, &clip->motion, plants, rest, clip->clip.name, &clip->cycles,
                               &clip->error);
    if (status == FF_OK && walks && !has_firm_walk(&set->examples, rig, &clip->cycles))
        status = ff_cycles_cut_half(&set->cycles, rig, &clip->motion, plants, rest, clip->clip.name,
                                    &clip->cycles, &clip->error);
    if (status == FF_OK && walks)
        status = ff_cycles_cut_idle(&set->cycles, rig, &clip->motion, plants, rest, clip->clip.name,
                                    &clip->cycles, &clip->error);
    if (status == FF_OK) status = ff_build_clip_store(clip, shared);
    return status;
}

/* That a clip cannot be used may have cost as much to find out as its actions: it is kept too. But not a lack of
 * memory or a file that could not be read, which another time may be better. */
static bool may_be_kept(ff_status status)
{
    return status != FF_ERR_NO_MEMORY && status != FF_ERR_IO;
}

void ff_build_clip_cut(ff_build_clip *clip, const ff_build_shared *shared)
{
    void *data;
    size_t size;
    make_cut_key(clip, shared);
    if (ff_cache_load(shared->cache, "cut", clip->cut_key, &data, &size)) {
        bool whole = ff_carry_cut_in(clip, data, size);
        free(data);
        name_error(clip);
        if (whole) return;
    }
    clip->status = cut(clip, shared);
    ff_array entry = {0};
    if (may_be_kept(clip->status) && ff_carry_cut_out(clip, &entry))
        ff_cache_store(shared->cache, "cut", clip->cut_key, entry.data, entry.count);
    ff_array_free(&entry);
    name_error(clip);
}

/* -------------------------------------------------------------------------------------------------- subjects */

#define SAME_BONE 0.0015 /* m: files write lengths with three to six digits */

static bool same_skeleton(const ff_clip *a, const ff_clip *b)
{
    for (int r = FF_ROLE_HIP_L; r <= FF_ROLE_ANKLE_R; ++r) {
        int i = ff_clip_find(a, (ff_role)r), k = ff_clip_find(b, (ff_role)r);
        if (i < 0 || k < 0) return false;
        double difference = ff_length3(a->joints[i].offset) - ff_length3(b->joints[k].offset);
        if (fabs(difference) > SAME_BONE) return false;
    }
    return true;
}

void ff_build_find_subjects(ff_build_clip *clips, int count)
{
    int subjects = 0;
    for (int i = 0; i < count; ++i) {
        clips[i].subject = -1;
        /* compared with the first clip of each subject, the latest subject first: files of one person lie together */
        for (int k = i - 1, looked_at = subjects; k >= 0 && clips[i].subject < 0; --k) {
            if (clips[k].subject != looked_at - 1 || !clips[k].first_of_subject) continue;
            --looked_at;
            if (same_skeleton(&clips[i].clip, &clips[k].clip)) clips[i].subject = clips[k].subject;
        }
        clips[i].first_of_subject = clips[i].subject < 0;
        if (clips[i].subject < 0) clips[i].subject = subjects++;
    }
}

ff_status ff_build_median_rig(ff_build_clip *clips, int count, ff_rig *out, ff_error *error)
{
    const ff_clip **people = ff_calloc((size_t)count, sizeof(const ff_clip *));
    if (!people) return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory for %d clips", count);
    ff_build_find_subjects(clips, count);
    int n = 0;
    for (int i = 0; i < count; ++i)
        if (clips[i].status == FF_OK && clips[i].first_of_subject) people[n++] = &clips[i].clip;
    ff_status status = ff_rig_from_clips(people, n, out, error);
    free(people);
    return status;
}
