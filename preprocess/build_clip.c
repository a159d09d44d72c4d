#define _POSIX_C_SOURCE 200809L
#include "preprocess/build_clip.h"

#include "mocap/generator/generator.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

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
    memset(clip, 0, sizeof *clip);
}

/* Keep frames first to last (-1 = to the end) of the clip. */
static ff_status trim(ff_clip *clip, int first, int last, ff_error *error)
{
    if (last < 0) last = clip->frame_count - 1;
    if (first == 0 && last == clip->frame_count - 1) return FF_OK;
    if (first > last || last >= clip->frame_count) {
        ff_fail(error, FF_ERR_RANGE, "trim keeps frames %d to %d, but the file has frames 0 to %d", first,
                last, clip->frame_count - 1);
        ff_error_in_file(error, clip->source);
        return FF_ERR_RANGE;
    }
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count,
           n = (size_t)last - (size_t)first + 1;
    memmove(clip->rotations, clip->rotations + (size_t)first * joints, n * joints * sizeof *clip->rotations);
    if (tracks)
        memmove(clip->positions, clip->positions + (size_t)first * tracks,
                n * tracks * sizeof *clip->positions);
    clip->frame_count = last - first + 1;
    clip->rest_frames = clip->rest_frames > first ? clip->rest_frames - first : 0;
    return FF_OK;
}

static ff_status hash_file(const char *path, uint64_t *hash, ff_error *error)
{
    ff_file file;
    char *name = strndup(path, ff_clip_file_length(path));
    if (!name) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the name of %s", path);
    ff_status status = ff_file_map(name, &file, error);
    free(name);
    if (status != FF_OK) return status;
    *hash = XXH64(file.data, file.size, 0);
    ff_file_unmap(&file);
    return FF_OK;
}

void ff_build_clip_load(ff_build_clip *clip, const ff_catalogue_entry *entry)
{
    ff_status status = ff_clip_load(entry->path, &entry->options, &clip->clip, &clip->error);
    if (status == FF_OK) status = hash_file(entry->path, &clip->hash, &clip->error);
    if (status == FF_OK) status = trim(&clip->clip, entry->trim_first, entry->trim_last, &clip->error);
    clip->licence = entry->licence;
    clip->citation = entry->citation;
    clip->tags = entry->tags;
    clip->mode = entry->mode;
    clip->mirror = entry->mirror;
    clip->first_frame = entry->trim_first;
    if (status == FF_OK) status = ff_breaks_repair(&clip->clip, &clip->repaired, &clip->error);
    if (status == FF_OK) status = ff_plants_find(&clip->clip, &clip->plants, &clip->error);
    clip->status = status;
}

void ff_build_clip_generate(ff_build_clip *clip, int index)
{
    ff_generated made;
    ff_generator_info info = ff_generator_describe(index);
    ff_status status = ff_generator_make(index, NULL, &made, &clip->error);
    clip->licence = "MIT";
    clip->citation =
        "The data used in this project was obtained from mocap.cs.cmu.edu. The database was created with "
        "funding from NSF EIA-0196217.";
    clip->tags = info.tags;
    clip->mode = info.mode;
    clip->mirror = true;
    if (status == FF_OK) {
        clip->clip = made.clip;
        memset(&made.clip, 0, sizeof made.clip);
        ff_generated_free(&made);
        size_t poses = (size_t)clip->clip.frame_count * (size_t)clip->clip.joint_count;
        clip->hash = XXH64(clip->clip.rotations, poses * sizeof *clip->clip.rotations, 0);
        status = ff_plants_find(&clip->clip, &clip->plants, &clip->error);
    }
    clip->status = status;
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

void ff_build_clip_cut(ff_build_clip *clip, const ff_rig *rig, bool clean)
{
    const ff_plants *plants = &clip->plants;
    int mode = mode_tag(clip->mode), rest = clip->clip.rest_frames;
    bool walks = mode != FF_MODE_JUMP && mode != FF_MODE_CLIMB && mode != FF_MODE_CROUCH &&
                 !has_tag(clip->tags, FF_TAG_NO_EXAMPLE);
    ff_status status = ff_motion_from_clip(rig, &clip->clip, plants, &clip->motion, &clip->error);
    if (status == FF_OK && clean) {
        status = ff_motion_clean(rig, &clip->motion, plants, &clip->cleaned, &clip->error);
        if (status != FF_OK)
            ff_error_in_file(&clip->error, clip->clip.source ? clip->clip.source : clip->source);
    }
    if (status == FF_OK)
        status = ff_actions_cut(rig, &clip->motion, plants, mode, &clip->actions, &clip->error);
    if (status == FF_OK && walks)
        status =
            ff_cycles_cut(rig, &clip->motion, plants, rest, clip->clip.name, &clip->cycles, &clip->error);
    if (status == FF_OK && walks)
        status = ff_cycles_cut_idle(rig, &clip->motion, plants, rest, clip->clip.name, &clip->cycles,
                                    &clip->error);
    clip->status = status;
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
