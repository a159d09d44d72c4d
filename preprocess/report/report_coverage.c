#include "preprocess/report/coverage.h"
#include "preprocess/report/report_parts.h"

/* Where steps land: a map of 2 metres around the standing foot, forward up; and how far actions turn. */
enum { SIDE = 460, BARS = 420, TALL = 160, BINS = 36, MARGIN = 24 };
static const double REACH = 1.6; /* m */
static const double BIN = 10.0;  /* degrees */

static double x_of(double left)
{
    return 0.5 * SIDE - ff_clamp(left, -REACH, REACH) / REACH * 0.5 * SIDE;
}

static double y_of(double forward)
{
    return 0.5 * SIDE - ff_clamp(forward, -REACH, REACH) / REACH * 0.5 * SIDE;
}

static void draw_landings(ff_text *page, const ff_pack *pack)
{
    ff_text_add(page, "<div><svg width=\"%d\" height=\"%d\">", SIDE, SIDE);
    for (int ring = 1; ring <= 3; ++ring)
        ff_text_add(
            page,
            "<circle class=\"grid\" cx=\"%d\" cy=\"%d\" r=\"%.0f\"/><text x=\"%d\" y=\"%.0f\">%.1f m</text>",
            SIDE / 2, SIDE / 2, 0.5 * ring / REACH * 0.5 * SIDE, SIDE / 2 + 3,
            0.5 * SIDE - 0.5 * ring / REACH * 0.5 * SIDE - 2.0, 0.5 * ring);
    for (uint32_t i = 0; i < pack->action_count; ++i) {
        const ff_pack_action *a = &pack->actions[i];
        bool hollow = (a->flags & (FF_ACTION_MIRRORED | FF_ACTION_DERIVED)) != 0;
        ff_text_add(
            page,
            "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%s\" fill=\"%s\" stroke=\"%s\"%s><title>%u: "
            "%s</title></circle>",
            x_of((double)a->land[1]), y_of((double)a->land[0]), a->flags & FF_ACTION_DERIVED ? "4" : "2.6",
            hollow ? "none" : ff_report_colour(a->mode), ff_report_colour(a->mode),
            a->flags & FF_ACTION_DERIVED ? " stroke-dasharray=\"2 1.5\"" : "", i, ff_report_mode(a->mode));
    }
    ff_text_add(page,
                "<circle cx=\"%d\" cy=\"%d\" r=\"4\"><title>the standing foot</title></circle></svg>\n"
                "<p class=\"key\">Where steps land, seen from above; the standing foot is in the middle and "
                "faces up. "
                "Hollow: mirrored; dashed: made up.</p></div>\n",
                SIDE / 2, SIDE / 2);
}

static void draw_turns(ff_text *page, const ff_pack *pack)
{
    uint32_t bins[BINS] = {0}, most = 1;
    for (uint32_t i = 0; i < pack->action_count; ++i) {
        double degrees = ff_clamp((double)pack->actions[i].theta / FF_DEG, -179.0, 179.0);
        ++bins[(int)((degrees + 180.0) / BIN)];
    }
    for (int k = 0; k < BINS; ++k)
        most = bins[k] > most ? bins[k] : most;
    ff_text_add(page, "<svg width=\"%d\" height=\"%d\">", BARS + 2 * MARGIN, TALL + MARGIN);
    for (int k = 0; k < BINS; ++k) {
        /* The square root lets single turns be seen beside hundreds of straight steps. Left turns on the left. */
        double high = sqrt((double)bins[k] / most) * (TALL - 16.0), wide = (double)BARS / BINS;
        ff_text_add(page,
                    "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" "
                    "fill=\"#2456b8\"><title>%u</title></rect>",
                    MARGIN + (BINS - 1 - k) * wide + 1.0, TALL - high, wide - 2.0, high, bins[k]);
    }
    for (int degrees = -180; degrees <= 180; degrees += 45)
        ff_text_add(page, "<text class=\"mid\" x=\"%.1f\" y=\"%d\">%d&deg;</text>",
                    MARGIN + (180.0 - degrees) / 360.0 * BARS, TALL + 14, degrees);
    ff_text_add(
        page,
        "</svg>\n<p class=\"key\">How far actions turn, left to the left; heights go with the square root of "
        "their number.</p>\n");
}

static void list_missing(ff_text *page, const ff_pack *pack)
{
    int missing = 0;
    ff_text_add(page, "<ul>");
    for (int k = 0; k < ff_coverage_kinds(); ++k) {
        if (ff_coverage_count(pack, k) > 0) continue;
        ff_text_add(page, "<li>no %s</li>", ff_coverage_words(k));
        ++missing;
    }
    ff_text_add(page, "</ul>%s", missing ? "" : "<p>Nothing that planners like to have is missing.</p>");
}

void ff_report_coverage(ff_text *page, const ff_pack *pack)
{
    if (pack->action_count == 0) return;
    ff_branching b = ff_coverage_branching(pack);
    ff_text_add(page, "<h2>What the actions cover</h2>\n<div class=\"row\">");
    draw_landings(page, pack);
    ff_text_add(page, "<div>");
    draw_turns(page, pack);
    list_missing(page, pack);
    ff_text_add(
        page,
        "<p>%.0f actions may follow one (median; %u to %u); %u joints are further than poses should be, for "
        "want of better ones.</p></div></div>\n",
        b.median, b.least, b.most, b.forced);
}
