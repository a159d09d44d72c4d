/* Distance maps of the examples that correspond, as pictures, with the moments found and the way between them. */
#include "preprocess/examples/pose_distance.h"
#include "preprocess/report/pack_read.h"
#include "preprocess/report/report_parts.h"
#include "runtime/export/picture.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 2 * FF_MAP_SIDE, LEVELS = 20, LARGE = FF_MAP_SIDE * FF_PICTURE_SCALE }; /* px; 1 cm each */

typedef struct maps {
    ff_text *page;
    const ff_pack *pack;
    ff_rig rig;
    ff_map_windows *windows; /* [example_count] */
} maps;

/* Three bytes of a PNG become four letters. */
static void add_base64(ff_text *page, const unsigned char *bytes, size_t size)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char line[401];
    size_t used = 0;
    for (size_t i = 0; i < size; i += 3) {
        unsigned long block = (unsigned long)bytes[i] << 16;
        if (i + 1 < size) block |= (unsigned long)bytes[i + 1] << 8;
        if (i + 2 < size) block |= bytes[i + 2];
        for (int k = 0; k < 4; ++k)
            line[used++] = i + (size_t)k > size ? '=' : letters[block >> (18 - 6 * k) & 63];
        if (used < sizeof line - 1 && i + 3 < size) continue;
        line[used] = 0;
        ff_text_add(page, "%s", line);
        used = 0;
    }
}

/* Bands of a centimetre: from dark, where poses agree, to white. */
static void paint(const double *map, uint8_t *rgb)
{
    for (int y = 0; y < LARGE; ++y) {
        for (int x = 0; x < LARGE; ++x) {
            /* phase of the first cycle to the right, of the second upwards */
            int row = x / FF_PICTURE_SCALE, column = FF_MAP_SIDE - 1 - y / FF_PICTURE_SCALE;
            double level = ff_min(floor(100.0 * map[row * FF_MAP_SIDE + column]), LEVELS) / LEVELS;
            ff_colour c = ff_colour_hsv(0.6 - 0.45 * level, 0.75 * (1.0 - level), 0.25 + 0.75 * level);
            uint8_t *pixel = rgb + 3 * (y * LARGE + x);
            pixel[0] = c.r, pixel[1] = c.g, pixel[2] = c.b;
        }
    }
}

static ff_status add_picture(const maps *m, const double *map, ff_error *error)
{
    static const ff_colour white = {255, 255, 255};
    ff_picture *picture = NULL;
    void *bytes = NULL;
    size_t size = 0;
    uint8_t *rgb = malloc((size_t)3 * LARGE * LARGE);
    ff_status status = rgb ? ff_picture_create(FF_MAP_SIDE, FF_MAP_SIDE, white, &picture, error)
                           : ff_fail(error, FF_ERR_NO_MEMORY, "the picture of a distance map");
    if (status == FF_OK) {
        paint(map, rgb);
        ff_picture_paste(picture, 0, 0, rgb, LARGE, LARGE);
        status = ff_picture_encode_png(picture, &bytes, &size, error);
        ff_picture_destroy(picture);
    }
    if (status == FF_OK) {
        ff_text_add(m->page, "<image width=\"%d\" height=\"%d\" href=\"data:image/png;base64,", SIDE, SIDE);
        add_base64(m->page, bytes, size);
        ff_text_add(m->page, "\"/>");
    }
    free(bytes);
    free(rgb);
    return status;
}

/* Half a cell aside, as a cell is drawn from its phase on. */
static double pixel_of(double phase)
{
    return (phase + 0.5 / FF_MAP_SIDE) * SIDE;
}

/* The way through the pairs, cut where it goes round. */
static void draw_way(const maps *m, const ff_pack_correspondence *c)
{
    const ff_pack_pair *pairs = &m->pack->pairs[c->first_pair];
    for (uint32_t k = 0; k < c->pair_count && c->pair_count > 1; ++k) {
        const ff_pack_pair *from = &pairs[k], *to = &pairs[(k + 1) % c->pair_count];
        double x[2] = {(double)from->phase[0], (double)to->phase[0]};
        double y[2] = {(double)from->phase[1], (double)to->phase[1]};
        double over_x = x[1] <= x[0] ? 1.0 : 0.0, over_y = y[1] <= y[0] ? 1.0 : 0.0;
        for (int copy = 0; copy < 2;
             ++copy) { /* once from here on, once up to there; the picture cuts off the rest */
            double sx = copy ? -over_x : 0.0, sy = copy ? -over_y : 0.0;
            if (copy && over_x == 0.0 && over_y == 0.0) continue;
            ff_text_add(m->page, "<path d=\"M%.1f %.1fL%.1f %.1f\" stroke=\"#fff\" stroke-opacity=\"0.6\"/>",
                        pixel_of(x[0] + sx), SIDE - pixel_of(y[0] + sy), pixel_of(x[1] + over_x + sx),
                        SIDE - pixel_of(y[1] + over_y + sy));
        }
    }
    for (uint32_t k = 0; k < c->pair_count; ++k)
        ff_text_add(m->page,
                    "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.6\" fill=\"#e4572e\" stroke=\"#fff\"><title>%.2f "
                    "and %.2f: "
                    "joints %.1f cm apart, windows %.1f cm</title></circle>",
                    pixel_of((double)pairs[k].phase[0]), SIDE - pixel_of((double)pairs[k].phase[1]),
                    (double)pairs[k].phase[0], (double)pairs[k].phase[1], 100.0 * (double)pairs[k].rms,
                    100.0 * (double)pairs[k].distance);
}

static ff_status windows_of(const maps *m, const ff_example *e, ff_map_windows *out, ff_error *error)
{
    ff_point_cycle cycle;
    ff_status status = ff_point_cycle_from_example(&m->rig, e, &cycle, error);
    if (status == FF_OK) status = ff_map_windows_make(&cycle, out, error);
    if (status == FF_OK) ff_point_cycle_free(&cycle);
    return status;
}

static ff_status gait_windows(const maps *m, uint32_t example, ff_map_windows *out, ff_error *error)
{
    ff_example e;
    ff_status status = ff_pack_play_gait(m->pack, &m->rig, example, &e, error);
    if (status != FF_OK) return status;
    status = windows_of(m, &e, out, error);
    ff_example_free(&e);
    return status;
}

static ff_status draw_map(const maps *m, const ff_pack_correspondence *c, double *map, ff_error *error)
{
    bool gait = c->to == FF_CORRESPOND_GAIT;
    ff_map_windows own = {0};
    if (gait) {
        ff_status status = gait_windows(m, c->from, &own, error);
        if (status != FF_OK) return status;
    }
    ff_distance_map(&m->windows[c->from], gait ? &own : &m->windows[c->to], map);
    ff_map_windows_free(&own);
    ff_text_add(m->page, "<div class=\"map\"><svg width=\"%d\" height=\"%d\">", SIDE, SIDE);
    ff_status status = add_picture(m, map, error);
    draw_way(m, c);
    ff_text_add(m->page, "</svg>");
    ff_report_text(m->page,
                   gait ? "semi-procedural clip" : ff_pack_string(m->pack, m->pack->examples[c->to].name));
    ff_text_add(m->page, "<br>%u%s, wait %.2f s, %.2f s</div>\n", c->pair_count,
                c->flags & FF_CORRESPOND_KEYS ? " by keys" : "", (double)c->wait[0], (double)c->wait[1]);
    return status;
}

static ff_status prepare(maps *m, ff_error *error)
{
    ff_pack_read_rig(m->pack, &m->rig);
    m->windows = calloc(m->pack->example_count + 1, sizeof *m->windows);
    if (!m->windows) return ff_fail(error, FF_ERR_NO_MEMORY, "the distance maps");
    ff_status status = FF_OK;
    for (uint32_t i = 0; i < m->pack->example_count && status == FF_OK; ++i) {
        ff_example e;
        status = ff_pack_read_example(m->pack, i, &e, error);
        if (status != FF_OK) break;
        status = windows_of(m, &e, &m->windows[i], error);
        ff_example_free(&e);
    }
    return status;
}

ff_status ff_report_maps(ff_text *page, const ff_pack *pack, ff_error *error)
{
    if (pack->correspondence_count == 0) return FF_OK;
    maps m = {.page = page, .pack = pack};
    double *map = malloc(FF_MAP_SIDE * FF_MAP_SIDE * sizeof *map);
    ff_status status = map ? prepare(&m, error) : ff_fail(error, FF_ERR_NO_MEMORY, "a distance map");
    ff_text_add(
        page,
        "<h2>Correspondence times</h2>\n<p class=\"key\">Distance of the poses of two cycles (Kovar et al. "
        "2002), a band per centimetre, dark = alike; first cycle to the right, second upwards; the moments "
        "at "
        "which one may pass into the other.</p>\n");
    for (uint32_t i = 0; i < pack->correspondence_count && status == FF_OK; ++i) {
        const ff_pack_correspondence *c = &pack->correspondences[i];
        if (i == 0 || c->from != c[-1].from) {
            ff_text_add(page, "%s<details><summary>", i ? "</div></details>\n" : "");
            ff_report_text(page, ff_pack_string(pack, pack->examples[c->from].name));
            ff_text_add(page, " with</summary><div class=\"cards\">\n");
        }
        status = draw_map(&m, c, map, error);
    }
    ff_text_add(page, "</div></details>\n");
    for (uint32_t i = 0; m.windows && i < pack->example_count; ++i)
        ff_map_windows_free(&m.windows[i]);
    free(m.windows);
    free(map);
    return status;
}
