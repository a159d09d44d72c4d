#include "mocap/generator/generator.h"
#include "preprocess/base/filter.h"
#include "preprocess/build/build_clip.h"
#include "preprocess/report/report_parts.h"
#include "preprocess/report/validate.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/tasks.h"
#include "runtime/tool/progress.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct validation {
    const ff_pack *pack;
    const ff_catalogue *catalogue;
    json_t *meta;
    ff_settings settings;
    ff_cache cache; /* of nothing: what is checked is worked out again */
    ff_rig rig;
    ff_progress *progress;
    ff_valid_clip *out;
} validation;

/* The pack's skeleton as the stages want it. */
static ff_rig rig_of(const ff_pack *pack)
{
    static const int points[FF_POINT_COUNT] = {FF_ROLE_HEAD_TOP, FF_ROLE_HAND_L, FF_ROLE_HAND_R,
                                               FF_ROLE_TOE_L,    FF_ROLE_TOE_R,  FF_BODY_HEEL_L,
                                               FF_BODY_HEEL_R};
    ff_rig rig;
    memset(&rig, 0, sizeof rig);
    for (uint32_t j = 0; j < FF_ROLE_JOINT_COUNT && j < pack->joint_count; ++j)
        rig.offset[j] = ff_pack_joint_offset(pack, j);
    for (uint32_t i = 0; i < pack->point_count; ++i) {
        const ff_pack_point *p = &pack->points[i];
        rig.offset[points[p->kind]] = ff_v3((double)p->offset[0], (double)p->offset[1], (double)p->offset[2]);
    }
    rig.leg = -(rig.offset[FF_ROLE_KNEE_L].y + rig.offset[FF_ROLE_ANKLE_L].y);
    return rig;
}

/* The settings the pack was built with; what it does not say has its default. */
static ff_settings settings_of(json_t *meta)
{
    ff_settings settings = ff_settings_default();
    char *text = json_dumps(json_object_get(meta, "settings"), 0);
    if (text) ff_settings_parse(text, strlen(text), "settings", &settings, NULL);
    free(text);
    return settings;
}

/* The entry of a clip: its path ends in the clip's source, and it begins at the same frame. */
static const ff_catalogue_entry *entry_of(const validation *v, const char *source, int first_frame)
{
    size_t length = strlen(source);
    for (int i = 0; v->catalogue && i < v->catalogue->count; ++i) {
        const ff_catalogue_entry *entry = &v->catalogue->entries[i];
        size_t size = strlen(entry->path);
        if (size < length || strcmp(entry->path + size - length, source) != 0) continue;
        if (size > length && entry->path[size - length - 1] != '/') continue;
        if (entry->trim_first == first_frame) return entry;
    }
    return NULL;
}

/* Begin as a build does; false when nothing that was given is this clip. */
static bool find_source(const validation *v, uint32_t index, ff_build_clip *clip)
{
    const char *source = ff_pack_string(v->pack, v->pack->clips[index].source);
    const json_t *said = json_array_get(json_object_get(v->meta, "clips"), index);
    int first_frame = (int)json_integer_value(json_object_get(said, "first_frame"));
    const ff_catalogue_entry *entry = entry_of(v, source, first_frame);
    int built_in = strncmp(source, "built-in/", 9) == 0 ? ff_generator_find(source + 9) : -1;
    if (!entry && built_in < 0) return false;
    ff_build_clip_begin(clip, entry, built_in);
    size_t size = strlen(source) + 1;
    clip->source = malloc(size);
    if (clip->source) memcpy(clip->source, source, size);
    return clip->source != NULL;
}

/* ------------------------------------------------------------------------------------------------------ comparing */

static bool far(float a, double b, double most)
{
    return fabs((double)a - b) > most;
}

static bool plants_differ(const ff_pack *pack, const ff_pack_clip *record, const ff_build_clip *clip,
                          char *why, size_t size)
{
    double dt = clip->motion.frame_time, most = FF_VALID_FRAMES * dt;
    if (record->plant_count != (uint32_t)clip->plants.count) {
        snprintf(why, size, "%u plants, %d are found", record->plant_count, clip->plants.count);
        return true;
    }
    for (uint32_t i = 0; i < record->plant_count; ++i) {
        const ff_pack_plant *p = &pack->plants[record->first_plant + i];
        const ff_plant *q = &clip->plants.items[i];
        if (p->foot == (uint32_t)q->foot && !far(p->start, (q->start + clip->first_frame) * dt, most) &&
            !far(p->end, (q->end + clip->first_frame) * dt, most))
            continue;
        snprintf(why, size, "the %s foot's plant at %.2f s is found at %.2f s", p->foot ? "right" : "left",
                 (double)p->start, (q->start + clip->first_frame) * dt);
        return true;
    }
    return false;
}

/* Every action of the pack must be found again; a build may have left some out of a small set. */
static bool actions_differ(const ff_pack *pack, const ff_pack_clip *record, const ff_build_clip *clip,
                           char *why, size_t size)
{
    double dt = clip->motion.frame_time, most = FF_VALID_FRAMES * dt, offset = clip->first_frame * dt;
    for (uint32_t i = 0; i < record->action_count; ++i) {
        const ff_pack_action *a = &pack->actions[record->first_action + i];
        bool found = false;
        for (int k = 0; k < clip->actions.count && !found; ++k) {
            const ff_pack_action *b = &clip->actions.items[k].record;
            found = a->support == b->support && !far(a->t_0, (double)b->t_0 + offset, most) &&
                    !far(a->t_end, (double)b->t_end + offset, most);
        }
        if (found) continue;
        snprintf(why, size, "its action from %.2f to %.2f s is not found", (double)a->t_0, (double)a->t_end);
        return true;
    }
    return false;
}

/* Distances of all joints and tips at the clip's own frames, mean and 99 %. */
static ff_status compare_poses(const validation *v, const ff_pack_clip *record, const ff_build_clip *clip,
                               ff_valid_clip *out, ff_error *error)
{
    const ff_motion *motion = &clip->motion;
    int rest = clip->clip.rest_frames, frames = motion->frame_count - rest;
    int places = (int)(v->pack->joint_count + v->pack->point_count), count = 0;
    double *distance = ff_calloc((size_t)frames * (size_t)places, sizeof *distance), sum = 0.0;
    if (!distance) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the poses of %s", clip->clip.name);
    for (int k = 0; k < frames; ++k) {
        ff_vec3 is[FF_PACK_MAX_JOINTS + FF_POINT_COUNT], should[FF_BODY_COUNT];
        ff_report_pose(v->pack, record->stream, k * motion->frame_time, is);
        ff_motion_pose(&v->rig, motion, rest + k, should, NULL);
        for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j)
            distance[count++] = ff_length3(ff_sub3(is[j], should[j]));
        for (uint32_t i = 0; i < v->pack->point_count; ++i) {
            static const int points[FF_POINT_COUNT] = {FF_ROLE_HEAD_TOP, FF_ROLE_HAND_L, FF_ROLE_HAND_R,
                                                       FF_ROLE_TOE_L,    FF_ROLE_TOE_R,  FF_BODY_HEEL_L,
                                                       FF_BODY_HEEL_R};
            distance[count++] =
                ff_length3(ff_sub3(is[v->pack->joint_count + i], should[points[v->pack->points[i].kind]]));
        }
    }
    for (int i = 0; i < count; ++i)
        sum += distance[i];
    out->pose_mean = sum / count;
    out->pose_99 = ff_filter_quantile(distance, count, 0.99);
    free(distance);
    return FF_OK;
}

static ff_status work_out(const validation *v, const ff_pack_clip *record, ff_build_clip *clip,
                          ff_valid_clip *out)
{
    ff_build_shared shared = {.settings = &v->settings,
                              .cache = (ff_cache *)(uintptr_t)&v->cache,
                              .rig = &v->rig,
                              .joints = v->pack->joints,
                              .points = v->pack->points};
    ff_build_clip_find(clip, &shared);
    if (clip->status != FF_OK) return clip->status;
    if (clip->hash != record->source_hash) {
        out->state = FF_VALID_CHANGED;
        return FF_OK;
    }
    ff_status status = ff_build_clip_motion(clip, &shared);
    if (status == FF_OK) status = ff_build_clip_actions(clip, &shared);
    if (status == FF_OK) status = compare_poses(v, record, clip, out, &clip->error);
    if (status != FF_OK) return status;
    bool differs = plants_differ(v->pack, record, clip, out->why, sizeof out->why) ||
                   actions_differ(v->pack, record, clip, out->why, sizeof out->why);
    if (!differs && (out->pose_mean > FF_VALID_POSE_MEAN || out->pose_99 > FF_VALID_POSE_99)) {
        differs = true;
        snprintf(out->why, sizeof out->why,
                 "its poses are off by %.2f mm on average, 1 %% by more than %.2f mm", 1e3 * out->pose_mean,
                 1e3 * out->pose_99);
    }
    out->state = differs ? FF_VALID_DIFFERS : FF_VALID_SAME;
    return FF_OK;
}

static void validate_one(void *context, uint32_t index)
{
    validation *v = context;
    ff_valid_clip *out = &v->out[index];
    const ff_pack_clip *record = &v->pack->clips[index];
    ff_build_clip clip;
    memset(&clip, 0, sizeof clip);
    memset(out, 0, sizeof *out);
    if (record->flags & FF_CLIP_DERIVED) {
        out->state = FF_VALID_MADE_UP;
    } else if (!find_source(v, index, &clip)) {
        out->state = FF_VALID_MISSING;
    } else if (work_out(v, record, &clip, out) != FF_OK) {
        out->state = FF_VALID_UNUSABLE;
        ff_error_text(&clip.error, out->why, sizeof out->why);
    }
    ff_build_clip_free(&clip);
    ff_progress_step(v->progress, ff_pack_string(v->pack, record->name));
}

ff_status ff_validate_clips(const ff_pack *pack, const ff_catalogue *catalogue, uint32_t threads, bool quiet,
                            ff_valid_clip *out, ff_error *error)
{
    ff_tasks *tasks;
    json_error_t place;
    if (pack->joint_count != FF_ROLE_JOINT_COUNT)
        return ff_fail(error, FF_ERR_UNSUPPORTED, "the pack has %u joints, those of footfall-pack have %d",
                       pack->joint_count, FF_ROLE_JOINT_COUNT);
    ff_status status = ff_tasks_create(threads, &tasks, error);
    if (status != FF_OK) return status;
    validation v = {.pack = pack, .catalogue = catalogue, .rig = rig_of(pack), .out = out};
    ff_cache_open(&v.cache, NULL);
    v.meta = json_loadb(pack->meta, (size_t)pack->meta_size, 0, &place);
    v.settings = settings_of(v.meta);
    v.progress = ff_progress_start("checking", pack->clip_count, quiet);
    ff_tasks_for(tasks, pack->clip_count, 1, validate_one, &v);
    ff_progress_end(v.progress);
    json_decref(v.meta);
    ff_tasks_destroy(tasks);
    return FF_OK;
}
