#include "preprocess/report/report.h"

#include "preprocess/report/report_parts.h"
#include "runtime/core/base/file.h"
#include "runtime/tool/command_line.h"

#include <stdio.h>
#include <string.h>

static const char *const PROGRAM = "footfall-pack";

static const char *const style[] = {
    "body{font:13px/1.45 system-ui,sans-serif;margin:24px;color:#222;max-width:1500px}",
    "h1{font-size:22px}h2{font-size:17px;margin:28px 0 6px}small,.key{color:#666;font-weight:normal}",
    "svg{background:#fff;display:block}svg text{font:10px system-ui,sans-serif;fill:#666}svg "
    ".mid{text-anchor:middle;fill:#111}",
    "svg .side{font-weight:bold;fill:#222}.scroll{overflow-x:auto;border:1px solid #ddd}polyline{fill:none}",
    ".plant{fill:#dbe7f3}.written{stroke:#7a2c7a;stroke-width:2}.found{fill:#999}.flat{fill:#b3cfe9}.axis{"
    "stroke:#bbb}.second,.grid{stroke:#e6e6e6;fill:none}",
    ".p0{stroke:#c2571a}.p1{stroke:#2c7a3f}.p2{stroke:#2456b8}.rejected{fill:#f3d5d5;stroke:#c66}",
    ".path{fill:none;stroke-width:0.7}.path.l{stroke:#2456b8}.path.r{stroke:#c2571a}.map{font-size:10px;"
    "width:132px}",
    ".row{display:flex;flex-wrap:wrap;gap:30px;align-items:flex-start}",
    ".cards{display:flex;flex-wrap:wrap;gap:8px;margin-top:8px}",
    ".card{border:1px solid #ddd;border-top:4px solid;padding:5px 8px;font-size:11px;line-height:1.35}",
    ".r{stroke:#c2571a;stroke-width:1.6}.l{stroke:#2456b8;stroke-width:1.6}.t{stroke:#333;stroke-width:2}",
    ".head{fill:#fff;stroke:#333;stroke-width:1.5}.mark.l{fill:#2456b8}.mark.r{fill:#c2571a}.ground{stroke:#"
    "999}.hull{fill:#e3f1e6;stroke:#2c7a3f;stroke-"
    "width:1.5}",
    ".walk{fill:#2c7a3f;stroke:#2c7a3f}.run{fill:#c2571a;stroke:#c2571a}.idle{fill:#222;stroke:#222}.made{"
    "fill:#fff}",
    "table{border-collapse:collapse}td,th{padding:1px 10px 1px "
    "0;text-align:left;font-weight:normal}th{color:#666}",
    "summary{cursor:pointer}ul{margin:4px 0}",
};

static void write_head(ff_text *page, const char *title)
{
    ff_text_add(page, "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>");
    ff_report_text(page, title);
    ff_text_add(page, "</title>\n<style>");
    for (size_t i = 0; i < sizeof style / sizeof *style; ++i)
        ff_text_add(page, "%s\n", style[i]);
    ff_text_add(page, "</style>\n<h1>");
    ff_report_text(page, title);
    ff_text_add(page, "</h1>\n");
}

static void write_summary(ff_text *page, const ff_pack *pack)
{
    uint32_t modes[FF_MODE_COUNT] = {0}, mirrored = 0;
    for (uint32_t i = 0; i < pack->action_count; ++i) {
        if (pack->actions[i].flags & FF_ACTION_MIRRORED)
            ++mirrored;
        else if (pack->actions[i].mode < FF_MODE_COUNT)
            ++modes[pack->actions[i].mode];
    }
    ff_text_add(page, "<p>%u clips, %u foot plants, %u actions and %u mirrored ones, %u examples.</p>\n<p>",
                pack->clip_count, pack->plant_count, pack->action_count - mirrored, mirrored,
                pack->example_count);
    for (uint32_t m = 0; m < FF_MODE_COUNT; ++m)
        if (modes[m])
            ff_text_add(page, "<span style=\"border-bottom:4px solid %s;margin-right:14px\">%u %s</span>\n",
                        ff_report_colour(m), modes[m], ff_report_mode(m));
    ff_text_add(page, "</p>\n");
}

static void write_skipped(ff_text *page, const json_t *meta)
{
    size_t i;
    const json_t *entry, *skipped = json_object_get(meta, "skipped");
    if (json_array_size(skipped) == 0) return;
    ff_text_add(page, "<h2>Left out</h2>\n<ul>");
    json_array_foreach(skipped, i, entry)
    {
        const char *source = json_string_value(json_object_get(entry, "source"));
        const char *why = json_string_value(json_object_get(entry, "why"));
        ff_text_add(page, "<li>");
        ff_report_text(page, source ? source : "?");
        ff_text_add(page, ": ");
        ff_report_text(page, why ? why : "");
        ff_text_add(page, "</li>\n");
    }
    ff_text_add(page, "</ul>\n");
}

static void write_breaks(ff_text *page, const json_t *broken)
{
    size_t i;
    const json_t *b;
    if (json_array_size(broken) == 0) return;
    ff_text_add(page, "<details open><summary>broken capture</summary><ul>");
    json_array_foreach(broken, i, b)
    {
        const char *what = json_string_value(json_object_get(b, "what"));
        ff_text_add(page, "<li>%.2f to %.2f s, ", json_number_value(json_object_get(b, "from")),
                    json_number_value(json_object_get(b, "to")));
        ff_report_text(page, what ? what : "?");
        ff_text_add(page,
                    json_is_true(json_object_get(b, "cut")) ? ": nothing is cut across it</li>" : "</li>");
    }
    ff_text_add(page, "</ul></details>\n");
}

static void write_error(ff_text *page, const char *what, const json_t *error)
{
    ff_text_add(page, "; %s %.2f mm on average, %.2f mm at the 99th percentile, %.1f mm at worst", what,
                1e3 * json_number_value(json_object_get(error, "mean")),
                1e3 * json_number_value(json_object_get(error, "p99")),
                1e3 * json_number_value(json_object_get(error, "max")));
}

/* What storing the motion cost: poses is the clip's entry of META. */
static void write_poses(ff_text *page, const json_t *poses)
{
    if (!poses) return;
    ff_text_add(page, "<p><small>Stored in %.1f kB per second",
                1e-3 * json_number_value(json_object_get(poses, "bytes_per_second")));
    write_error(page, "joints and tips are off by", json_object_get(poses, "whole"));
    write_error(page, "of that quantising alone", json_object_get(poses, "quantised"));
    ff_text_add(page, ".</small></p>\n");
}

static void write_clip(ff_text *page, const ff_pack *pack, uint32_t index, const json_t *meta)
{
    const ff_pack_clip *clip = &pack->clips[index];
    const ff_pack_stream *stream = &pack->streams[clip->stream];
    ff_text_add(page, "<h2 id=\"clip-%u\">", index);
    ff_report_text(page, ff_pack_string(pack, clip->name));
    ff_text_add(page, " <small>%.1f s at %.4g Hz, floor %.1f cm, slope %.1f cm/m",
                stream->frame_count / (double)stream->rate, (double)clip->source_rate,
                100.0 * (double)clip->floor_base,
                100.0 * ff_length2(ff_v2((double)clip->floor_slope[0], (double)clip->floor_slope[1])));
    const uint32_t more[2] = {clip->tags, clip->licence};
    for (int i = 0; i < 2; ++i) {
        if (!*ff_pack_string(pack, more[i])) continue;
        ff_text_add(page, "; ");
        ff_report_text(page, ff_pack_string(pack, more[i]));
    }
    ff_text_add(page, "</small></h2>\n");
    const json_t *entry = json_array_get(json_object_get(meta, "clips"), index);
    ff_report_timeline(page, pack, clip, entry);
    write_breaks(page, json_object_get(entry, "broken"));
    ff_report_clean(page, json_object_get(entry, "clean"));
    write_poses(page, json_object_get(entry, "poses"));
    ff_report_steps(page, pack, clip);
}

ff_status ff_report_write(const ff_pack *pack, const char *pack_name, const char *folder, ff_error *error)
{
    ff_text page = {.failed = false};
    /* META is JSON that the builder wrote; a pack of another origin may lack it, then only the reasons are missing. */
    json_t *meta = pack->meta_size ? json_loadb(pack->meta, pack->meta_size, 0, NULL) : NULL;
    char path[1024];
    ff_status status = ff_folder_create(folder, error);
    if (status == FF_OK && (size_t)snprintf(path, sizeof path, "%s/index.html", folder) >= sizeof path)
        status = ff_fail(error, FF_ERR_RANGE, "the folder's name is too long: %.60s...", folder);
    if (status == FF_OK) {
        write_head(&page, pack_name);
        write_summary(&page, pack);
        write_skipped(&page, meta);
        ff_report_coverage(&page, pack);
        ff_report_hull(&page, pack);
        status = ff_report_examples(&page, pack, meta, error);
        if (status == FF_OK) status = ff_report_maps(&page, pack, error);
        for (uint32_t i = 0; i < pack->clip_count; ++i)
            write_clip(&page, pack, i, meta);
        ff_text_add(&page, "</html>\n");
        if (status == FF_OK) status = ff_text_write(&page, path, error);
        ff_text_free(&page);
    }
    json_decref(meta);
    return status;
}

static int report(const char *path, const char *folder)
{
    ff_error error;
    ff_pack *pack = NULL;
    ff_status status = ff_pack_open(path, &pack, &error);
    if (status == FF_OK) {
        const char *slash = strrchr(path, '/');
        status = ff_report_write(pack, slash ? slash + 1 : path, folder, &error);
    }
    ff_pack_close(pack);
    if (status != FF_OK) return ff_command_fail(PROGRAM, &error);
    printf("%s/index.html\n", folder);
    return FF_EXIT_OK;
}

int ff_report_command(int argc, char **argv)
{
    const char *folder = NULL;
    ff_option options[] = {{.name = "--out",
                            .alias = "-o",
                            .value_name = "DIR",
                            .help = "folder for index.html, made if missing (needed)",
                            .text = &folder},
                           {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "report",
        .arguments = "PACK.ffpack",
        .summary = "show a pack as one HTML page",
        .details = "Per clip: heights and speeds of the feet with the plants shaded, the steps cut from it "
                   "as stick figures with\n"
                   "their annotation, what was rejected and why; and the velocity hull. The page needs no "
                   "other file.",
        .options = options,
        .min_operands = 1,
        .max_operands = 1,
    };
    ff_operands operands;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result < 0)
        result = folder ? report(operands.items[0], folder)
                        : ff_command_misuse(&command, "--out DIR (-o) is missing");
    return result;
}
