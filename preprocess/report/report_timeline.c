#include "preprocess/report/report_parts.h"

#include <string.h>

/* Layout, px: seconds to the right; per foot a band of heights over one of speeds; actions and rejections below. */
enum {
    PER_SECOND = 110,
    MARGIN = 46,
    HEIGHT_BAND = 66,
    SPEED_BAND = 44,
    GAP = 10,
    LANE = 18,
    FOOT = HEIGHT_BAND + SPEED_BAND + GAP
};
static const double HIGHEST = 0.30, FASTEST = 5.0; /* m, m/s at the top of the bands */

static const char *const point_names[3] = {"heel", "ball", "toe"};
static const char *const point_colours[3] = {"#c2571a", "#2c7a3f", "#2456b8"};

typedef struct view {
    ff_text *page;
    const ff_pack *pack;
    const ff_pack_clip *clip;
    const ff_pack_stream *stream;
    double start;        /* s, of the first pose of the stream */
    const json_t *found; /* plants before a person changed them, or NULL */
} view;

static double x_of(const view *v, double seconds)
{
    return MARGIN + (seconds - v->start) * PER_SECOND;
}

static void draw_plants(const view *v, int foot, double top)
{
    for (uint32_t i = 0; i < v->clip->plant_count; ++i) {
        const ff_pack_plant *p = &v->pack->plants[v->clip->first_plant + i];
        if ((int)p->foot != foot) continue;
        double dt = 1.0 / (double)v->clip->source_rate; /* both ends inclusive */
        ff_text_add(v->page,
                    "<rect class=\"plant%s\" x=\"%.1f\" y=\"%.0f\" width=\"%.1f\" height=\"%d\"><title>",
                    p->origin == FF_PLANT_WRITTEN ? " written" : "", x_of(v, (double)p->start), top,
                    ((double)p->end - (double)p->start + dt) * PER_SECOND, HEIGHT_BAND + SPEED_BAND);
        ff_text_add(v->page, "%s foot down %.2f to %.2f s, slides %.1f cm, confidence %.2f%s",
                    foot ? "right" : "left", (double)p->start, (double)p->end, 100.0 * (double)p->slide,
                    (double)p->confidence, p->origin == FF_PLANT_WRITTEN ? ", written by hand" : "");
        if (p->level != 0.0f) ff_text_add(v->page, ", %.0f cm over the floor", 100.0 * (double)p->level);
        ff_text_add(v->page, "</title></rect>");
        if (p->flat_start < 0.0f) continue;
        ff_text_add(v->page, "<rect class=\"flat\" x=\"%.1f\" y=\"%.0f\" width=\"%.1f\" height=\"%d\"/>",
                    x_of(v, (double)p->flat_start), top,
                    ((double)p->flat_end - (double)p->flat_start + dt) * PER_SECOND,
                    HEIGHT_BAND + SPEED_BAND);
    }
}

/* What was found where a person's word holds instead: outlines. */
static void draw_found(const view *v, int foot, double top)
{
    size_t i;
    const json_t *p;
    json_array_foreach(v->found, i, p)
    {
        const char *side = json_string_value(json_object_get(p, "foot"));
        if (!side || (strcmp(side, "right") == 0) != (foot == 1)) continue;
        double from = json_number_value(json_object_get(p, "from")),
               to = json_number_value(json_object_get(p, "to"));
        ff_text_add(
            v->page,
            "<rect class=\"found\" x=\"%.1f\" y=\"%.0f\" width=\"%.1f\" height=\"6\"><title>found: %.2f to "
            "%.2f s</title></rect>",
            x_of(v, from), top, ff_max(1.0, (to - from) * PER_SECOND), from, to);
    }
}

static void draw_curve(const view *v, int foot, int point, bool speed, double top)
{
    double tall = speed ? SPEED_BAND : HEIGHT_BAND, bottom = top + tall - (speed ? 1.0 : 8.0);
    double scale = speed ? (SPEED_BAND - 2.0) / FASTEST * 1e-3 : (HEIGHT_BAND - 10.0) / HIGHEST * 1e-4;
    size_t first = (size_t)v->stream->first_frame - v->pack->foot_count / 2;
    ff_text_add(v->page, "<polyline class=\"p%d\" points=\"", point);
    for (uint32_t k = 0; k < v->stream->frame_count; ++k) {
        const ff_pack_track *t = &v->pack->tracks[2 * (first + k) + (size_t)foot];
        double value = speed ? t->speed[point] : t->height[point];
        double y = ff_clamp(bottom - scale * value, top, top + tall);
        ff_text_add(v->page, "%.1f,%.1f ", MARGIN + k * (double)PER_SECOND / (double)v->stream->rate, y);
    }
    ff_text_add(v->page, "\"/>");
}

static void draw_foot(const view *v, int foot, double width)
{
    double top = 16.0 + foot * FOOT, speeds = top + HEIGHT_BAND;
    draw_plants(v, foot, top);
    draw_found(v, foot, top);
    ff_text_add(v->page, "<line class=\"axis\" x1=\"%d\" x2=\"%.0f\" y1=\"%.0f\" y2=\"%.0f\"/>", MARGIN,
                width, top + HEIGHT_BAND - 8, top + HEIGHT_BAND - 8);
    ff_text_add(v->page, "<line class=\"axis\" x1=\"%d\" x2=\"%.0f\" y1=\"%.0f\" y2=\"%.0f\"/>", MARGIN,
                width, speeds + SPEED_BAND, speeds + SPEED_BAND);
    ff_text_add(v->page, "<text x=\"2\" y=\"%.0f\" class=\"side\">%s</text>", top + 12,
                foot ? "right" : "left");
    ff_text_add(v->page, "<text x=\"2\" y=\"%.0f\">30 cm</text><text x=\"2\" y=\"%.0f\">5 m/s</text>",
                top + 26, speeds + 12);
    if (!v->pack->tracks) return;
    for (int point = 0; point < 3; ++point) {
        draw_curve(v, foot, point, false, top);
        draw_curve(v, foot, point, true, speeds);
    }
}

static void draw_actions(const view *v, double top)
{
    for (uint32_t i = 0; i < v->clip->action_count; ++i) {
        const ff_pack_action *a = &v->pack->actions[v->clip->first_action + i];
        double x = x_of(v, (double)a->t_0), wide = (double)a->duration * PER_SECOND;
        ff_text_add(v->page,
                    "<rect x=\"%.1f\" y=\"%.0f\" width=\"%.1f\" height=\"%d\" fill=\"%s\" stroke=\"#fff\">"
                    "<title>%u: %s</title></rect><text class=\"mid\" x=\"%.1f\" y=\"%.0f\">%u</text>",
                    x, top, wide, LANE, ff_report_colour(a->mode), v->clip->first_action + i,
                    ff_report_mode(a->mode), x + wide / 2, top + 13, v->clip->first_action + i);
    }
}

static void draw_rejections(const view *v, const json_t *rejected, double top)
{
    size_t i;
    const json_t *entry;
    json_array_foreach(rejected, i, entry)
    {
        double from = json_number_value(json_object_get(entry, "from")),
               to = json_number_value(json_object_get(entry, "to"));
        const char *why = json_string_value(json_object_get(entry, "why"));
        ff_text_add(v->page,
                    "<rect class=\"rejected\" x=\"%.1f\" y=\"%.0f\" width=\"%.1f\" height=\"%d\"><title>",
                    x_of(v, from), top, ff_max(1.0, (to - from) * PER_SECOND), LANE);
        ff_report_text(v->page, why ? why : "");
        ff_text_add(v->page, "</title></rect>");
    }
}

static void draw_seconds(const view *v, double seconds, double height)
{
    for (int s = 0; s <= (int)seconds; ++s)
        ff_text_add(v->page,
                    "<line class=\"second\" x1=\"%.1f\" x2=\"%.1f\" y1=\"12\" y2=\"%.0f\"/><text x=\"%.1f\" "
                    "y=\"10\">%g s</text>",
                    (double)MARGIN + s * PER_SECOND, (double)MARGIN + s * PER_SECOND, height,
                    (double)MARGIN + s * PER_SECOND + 2, floor(100.0 * (v->start + s) + 0.5) / 100.0);
}

static void list_rejections(ff_text *page, const json_t *rejected)
{
    size_t i;
    const json_t *entry;
    if (json_array_size(rejected) == 0) return;
    ff_text_add(page, "<details open><summary>not cut into actions</summary><ul>");
    json_array_foreach(rejected, i, entry)
    {
        const char *why = json_string_value(json_object_get(entry, "why"));
        ff_text_add(page, "<li>%.2f to %.2f s: ", json_number_value(json_object_get(entry, "from")),
                    json_number_value(json_object_get(entry, "to")));
        ff_report_text(page, why ? why : "");
        ff_text_add(page, "</li>");
    }
    ff_text_add(page, "</ul></details>\n");
}

void ff_report_timeline(ff_text *page, const ff_pack *pack, const ff_pack_clip *clip, const json_t *entry)
{
    const json_t *rejected = json_object_get(entry, "rejected");
    view v = {page,
              pack,
              clip,
              &pack->streams[clip->stream],
              (double)clip->time_offset,
              json_object_get(entry, "found")};
    double seconds = (v.stream->frame_count - 1) / (double)v.stream->rate;
    double width = 2.0 * MARGIN + seconds * PER_SECOND, lanes = 16.0 + 2.0 * FOOT;
    ff_text_add(page, "<div class=\"scroll\"><svg width=\"%.0f\" height=\"%.0f\">", width,
                lanes + 2 * LANE + 6);
    draw_seconds(&v, seconds, lanes);
    for (int foot = 0; foot < 2; ++foot)
        draw_foot(&v, foot, width - MARGIN);
    draw_actions(&v, lanes);
    draw_rejections(&v, rejected, lanes + LANE + 2);
    ff_text_add(
        page, "<text x=\"2\" y=\"%.0f\">actions</text><text x=\"2\" y=\"%.0f\">rejected</text></svg></div>\n",
        lanes + 13, lanes + LANE + 15);
    if (!pack->tracks) ff_text_add(page, "<p>This pack holds no foot tracks: built without them.</p>\n");
    ff_text_add(page, "<p class=\"key\">");
    for (int point = 0; point < 3; ++point)
        ff_text_add(page, "<span style=\"color:%s\">%s</span> ", point_colours[point], point_names[point]);
    ff_text_add(
        page,
        "over their rest level and below their speeds; shaded: foot down, darker: flat and still%s</p>\n",
        v.found ? "; framed: written by hand, bars on top: what was found" : "");
    list_rejections(page, rejected);
}
