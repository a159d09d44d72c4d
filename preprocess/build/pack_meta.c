/* What a pack says of its own making, as JSON. Nothing in it depends on when, where or by whom it was built. */
#include "preprocess/build/pack_fill.h"
#include "runtime/core/base/fail.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

static json_t *rejections_of(const ff_build_clip *clip)
{
    json_t *list = json_array();
    double dt = clip->motion.frame_time;
    for (int i = 0; i < clip->actions.rejection_count; ++i) {
        const ff_rejection *r = &clip->actions.rejections[i];
        json_array_append_new(list,
                              json_pack("{s:f, s:f, s:s}", "from", (r->first_frame + clip->first_frame) * dt,
                                        "to", (r->last_frame + clip->first_frame) * dt, "why", r->reason));
    }
    return list;
}

/* What is wrong with the capture: put back, or cut out. */
static json_t *breaks_of(const ff_build_clip *clip)
{
    json_t *list = json_array();
    double dt = clip->motion.frame_time;
    for (int i = 0; i < clip->repaired.count; ++i) {
        ff_break b = clip->repaired.items[i];
        char text[160];
        b.first += clip->first_frame; /* frames of the file */
        b.last += clip->first_frame;
        ff_break_say(&b, text, sizeof text);
        json_array_append_new(list, json_pack("{s:s, s:f, s:f, s:b, s:s}", "kind", ff_break_kind_name(b.kind),
                                              "from", b.first * dt, "to", b.last * dt, "cut",
                                              b.body && !b.repaired, "what", text));
    }
    return list;
}

static json_t *change_entry(ff_change change, double scale)
{
    return json_pack("[f, f]", scale * change.before, scale * change.after);
}

/* What the clean-up did: pairs are before and after; mm and degrees. */
static json_t *clean_entry(const ff_clean_report *r)
{
    double mm = 1e3, deg = 1.0 / FF_DEG;
    return json_pack("{s:b, s:o, s:o, s:o, s:o, s:o, s:f, s:f, s:f, s:s, s:i, s:f, s:f, s:f, s:f, s:i, s:i}",
                     "was_clean", r->was_clean ? 1 : 0, "pin_median_mm", change_entry(r->pin_median, mm),
                     "pin_worst_mm", change_entry(r->pin_worst, mm), "skate_mm_per_s",
                     change_entry(r->skate, mm), "floor_dip_mm", change_entry(r->floor_dip, mm),
                     "knee_least_deg", change_entry(r->knee_least, deg), "turned_mean_deg",
                     deg * r->turn_mean, "turned_95_deg", deg * r->turn_most_95, "turned_most_deg",
                     deg * r->turn_most, "turned_most_joint", ff_role_name((ff_role)r->turn_role),
                     "turned_most_frame", r->turn_frame, "hips_moved_mean_mm", mm * r->shift_mean,
                     "hips_moved_most_mm", mm * r->shift_most, "acceleration_ratio", r->acceleration,
                     "residual_mm", mm * r->residual, "solves", r->solves, "unconverged", r->unconverged);
}

/* What was found where a person's word holds instead. */
static json_t *found_plants(const ff_build_clip *clip)
{
    json_t *list = json_array();
    double dt = clip->motion.frame_time;
    for (int i = 0; i < clip->plants.found_count; ++i) {
        const ff_plant *p = &clip->plants.found[i];
        json_array_append_new(list,
                              json_pack("{s:s, s:f, s:f}", "foot", p->foot == FF_LEFT ? "left" : "right",
                                        "from", (p->start + clip->first_frame) * dt, "to",
                                        (p->end + 1 + clip->first_frame) * dt));
    }
    return list;
}

/* m, as in the pack: joints and points over all frames of the clip. */
static json_t *error_entry(const ff_pose_error *error)
{
    return json_pack("{s:f, s:f, s:f}", "mean", error->mean, "p99", error->p99, "max", error->max);
}

static json_t *clip_entry(const ff_build_clip *clip, const ff_build_settings *settings)
{
    char hash[20];
    snprintf(hash, sizeof hash, "%016" PRIx64, clip->hash);
    json_t *entry =
        json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:s, s:i, s:b, s:i, s:f, s:i, s:o}", "name",
                  clip->clip.name, "source", clip->source, "hash", hash, "licence", clip->licence, "citation",
                  clip->citation, "tags", clip->tags, "mode", clip->mode, "first_frame", clip->first_frame,
                  "mirror", clip->mirror ? 1 : 0, "subject", clip->subject, "unit_m", clip->clip.unit_m,
                  "frames", clip->frames, "rejected", rejections_of(clip));
    if (entry && clip->plants.found_count > 0) json_object_set_new(entry, "found", found_plants(clip));
    if (entry && clip->repaired.count > 0) json_object_set_new(entry, "broken", breaks_of(clip));
    if (entry && settings->pack.cut.motion.clean && !clip->derived)
        json_object_set_new(entry, "clean", clean_entry(&clip->cleaned));
    json_object_set_new(entry, "poses",
                        json_pack("{s:f, s:o, s:o}", "bytes_per_second", clip->pose.bytes_per_second,
                                  "quantised", error_entry(&clip->pose.quantised), "whole",
                                  error_entry(&clip->pose.whole)));
    if (entry && clip->clip.warning_count > 0)
        json_object_set_new(entry, "warning", json_string(clip->clip.warning));
    return entry;
}

static json_t *skipped_entry(const ff_build_clip *clip)
{
    return json_pack("{s:s, s:i, s:i, s:s}", "source", clip->source, "line", (int)clip->error.line, "column",
                     (int)clip->error.column, "why", clip->error.message);
}

static const char *const level_names[] = {[FF_LEVEL_FIRM] = "whole cycles that close well",
                                          [FF_LEVEL_HALF] = "one step and its mirror image",
                                          [FF_LEVEL_LOOSE] = "a cycle that closes badly"};

static json_t *left_out_entries(const ff_example_set *set)
{
    json_t *list = json_array();
    for (int i = 0; i < set->left_out_count; ++i)
        json_array_append_new(
            list, json_pack("{s:s, s:s}", "name", set->left_out[i].name, "why", set->left_out[i].why));
    return list;
}

ff_status ff_pack_add_meta(ff_pack_content *content, const ff_build_settings *settings,
                           const ff_build_clip *clips, int count, const ff_build_clip *skipped,
                           int skipped_count, const ff_example_set *set, ff_error *error)
{
    json_t *clip_list = json_array(), *skipped_list = json_array();
    for (int i = 0; i < count; ++i)
        json_array_append_new(clip_list, clip_entry(&clips[i], settings));
    for (int i = 0; i < skipped_count; ++i)
        json_array_append_new(skipped_list, skipped_entry(&skipped[i]));
    json_t *root =
        json_pack("{s:s, s:s, s:o, s:{s:i, s:i, s:s, s:o}, s:o, s:o}", "tool", "footfall-pack", "version",
                  FF_VERSION, "settings", ff_settings_json(&settings->pack), "examples", "base_subject",
                  set->base, "candidates", set->candidates, "walks_with", level_names[set->level], "left_out",
                  left_out_entries(set), "clips", clip_list, "skipped", skipped_list);
    char *text = root ? json_dumps(root, JSON_INDENT(1)) : NULL;
    json_decref(root);
    ff_status status = text ? ff_pack_set_meta(content, text, error)
                            : ff_fail(error, FF_ERR_NO_MEMORY, "out of memory describing the pack");
    free(text);
    return status;
}
