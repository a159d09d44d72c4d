#include "runtime/export/bars.h"

#include "runtime/core/base/maths.h"

#include <stdio.h>

#define WIDTH 1400
#define MARGIN 70.0
#define HEAD 150.0
#define PANEL 260.0 /* pixels of height, with its title */
#define BARS 170.0  /* of that, the highest bar */

static const ff_colour paper = {252, 251, 248}, ink = {40, 42, 48}, faint = {226, 225, 220},
                       grey = {130, 132, 138};
static const ff_colour colours[FF_BARS_MAX] = {{34, 113, 178},  {217, 95, 2},    {128, 128, 128},
                                               {244, 177, 131}, {190, 190, 190}, {117, 112, 179},
                                               {27, 158, 119},  {80, 80, 80}};

static double highest(const ff_bar_chart *chart, const ff_bar_panel *panel)
{
    double most = 0.0;
    for (int i = 0; i < chart->group_count * chart->method_count; ++i)
        most = ff_max(most, panel->values[i]);
    return most > 0.0 ? most : 1.0;
}

static void draw_panel(ff_picture *picture, const ff_bar_chart *chart, const ff_bar_panel *panel, double top)
{
    double base = top + PANEL - 40.0, room = (WIDTH - 2.0 * MARGIN) / chart->group_count;
    double width = 0.8 * room / chart->method_count, most = highest(chart, panel);
    char text[96];
    ff_picture_text(picture, (ff_pixel){MARGIN, top + 16.0}, 15, FF_ALIGN_LEFT, ink, panel->title);
    ff_picture_text(picture, (ff_pixel){WIDTH - MARGIN, top + 16.0}, 13, FF_ALIGN_RIGHT, grey, panel->unit);
    ff_picture_line(picture, (ff_pixel){MARGIN, base}, (ff_pixel){WIDTH - MARGIN, base}, 1.5, grey);
    for (int g = 0; g < chart->group_count; ++g) {
        double left = MARGIN + (g + 0.1) * room;
        for (int m = 0; m < chart->method_count; ++m) {
            double value = panel->values[g * chart->method_count + m], height = BARS * value / most;
            double x = left + m * width;
            ff_picture_rectangle(picture, (ff_pixel){x + 1.0, base - height},
                                 (ff_pixel){x + width - 1.0, base}, colours[m]);
            snprintf(text, sizeof text, value < 0.9995 ? "%.2g" : value < 9.995 ? "%.3g" : "%.0f", value);
            ff_picture_text(picture, (ff_pixel){x + 0.5 * width, base - height - 5.0}, 8, FF_ALIGN_MIDDLE,
                            ink, text);
        }
        ff_picture_text(picture, (ff_pixel){left + 0.4 * room, base + 20.0}, 11, FF_ALIGN_MIDDLE, ink,
                        chart->groups[g]);
    }
}

ff_status ff_bars_write(const char *path, const ff_bar_chart *chart, ff_error *error)
{
    ff_picture *picture = NULL;
    int height = (int)(HEAD + PANEL * chart->panel_count + 20.0);
    ff_status status = ff_picture_create(WIDTH, height, paper, &picture, error);
    if (status != FF_OK) return status;
    ff_picture_text(picture, (ff_pixel){MARGIN, 52}, 24, FF_ALIGN_LEFT, ink, chart->title);
    ff_picture_text(picture, (ff_pixel){MARGIN, 82}, 13, FF_ALIGN_LEFT, grey, chart->subtitle);
    for (int m = 0; m < chart->method_count; ++m) {
        double x = MARGIN + m * 200.0;
        ff_picture_rectangle(picture, (ff_pixel){x, 102}, (ff_pixel){x + 16, 118}, colours[m]);
        ff_picture_text(picture, (ff_pixel){x + 24, 116}, 13, FF_ALIGN_LEFT, ink, chart->methods[m]);
    }
    for (int p = 0; p < chart->panel_count; ++p) {
        double top = HEAD + p * PANEL;
        ff_picture_line(picture, (ff_pixel){MARGIN, top - 8.0}, (ff_pixel){WIDTH - MARGIN, top - 8.0}, 1.0,
                        faint);
        draw_panel(picture, chart, &chart->panels[p], top);
    }
    status = ff_picture_write_png(picture, path, error);
    ff_picture_destroy(picture);
    return status;
}
