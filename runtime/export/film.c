#include "runtime/export/film.h"

#include "runtime/core/base/fail.h"
#include "runtime/export/film_crowd.h"
#include "runtime/export/film_walk.h"
#include "runtime/export/watch.h"

#include <stdio.h>

/* Layout, in pixels of the finished sheet. */
enum {
    MARGIN = 40,
    CROWD_HEIGHT = 876, /* of the four pictures of the crowd */
    PANEL_GAP = 16,
    HEAD = 110,
    FOOT = 30
};
#define COARSE 0.030 /* m, mesh of the crowd's bodies */

static const ff_colour paper = {250, 249, 246}, ink = {40, 42, 48}, grey = {128, 130, 136};

typedef struct film {
    const ff_figure *figure;
    const ff_scene *scene;
    const ff_recording *recording;
    ff_picture *picture;
} film;

static void draw_title(const film *f)
{
    char caption[160], text[200];
    ff_watch_caption(f->scene, f->recording, caption, sizeof caption);
    snprintf(text, sizeof text, "%s. Ground tiles are %.0f m.", caption, ff_film_crowd_tile(f->recording));
    const char *title = f->scene->title[0] ? f->scene->title : ff_scene_kind_name(f->scene->kind);
    ff_picture_text(f->picture, (ff_pixel){MARGIN, 56}, 24, FF_ALIGN_LEFT, ink, title);
    ff_picture_text(f->picture, (ff_pixel){MARGIN, 88}, 14, FF_ALIGN_LEFT, grey, text);
}

/* The last pose with at least half of the agents still in the scene. */
static uint32_t last_crowded_pose(const ff_recording *recording)
{
    for (uint32_t pose = recording->pose_count - 1; pose > 0; --pose) {
        uint32_t present = 0;
        for (uint32_t i = 0; i < recording->agent_count; ++i)
            present += ff_recording_track(recording, pose * recording->pose_stride, i)->present;
        if (2 * present >= recording->agent_count) return pose;
    }
    return 0;
}

/* The first pose with anybody in the scene. */
static uint32_t first_peopled_pose(const ff_recording *recording)
{
    for (uint32_t pose = 0; pose < recording->pose_count; ++pose)
        for (uint32_t i = 0; i < recording->agent_count; ++i)
            if (ff_recording_track(recording, pose * recording->pose_stride, i)->present) return pose;
    return 0;
}

static ff_status draw_crowd(const film *f, ff_error *error)
{
    static const double moments[4] = {0.07, 0.30, 0.55, 1.0};
    /* Two by two, or below each other where the crowd is long and narrow. */
    const int columns = ff_film_crowd_is_long(f->recording) ? 1 : 2, rows = 4 / columns;
    const int panel_width = (FF_FILM_WIDTH - 2 * MARGIN - (columns - 1) * PANEL_GAP) / columns;
    const int panel_height = (CROWD_HEIGHT - (rows - 1) * PANEL_GAP) / rows;
    const int width = panel_width * FF_PICTURE_SCALE, height = panel_height * FF_PICTURE_SCALE;
    ff_stage stage;
    ff_raster raster = {0};
    ff_status status = ff_stage_create(f->figure, COARSE, &stage, error);
    if (status == FF_OK) status = ff_raster_create(width, height, &raster, error);
    uint32_t first = first_peopled_pose(f->recording), last = last_crowded_pose(f->recording);
    if (last < first) last = first;
    for (int k = 0; k < 4 && status == FF_OK; ++k) {
        uint32_t pose = first + (uint32_t)(moments[k] * (last - first) + 0.5);
        int x = MARGIN + (k % columns) * (panel_width + PANEL_GAP);
        int y = HEAD + (k / columns) * (panel_height + PANEL_GAP);
        char text[32];
        ff_camera camera = ff_film_crowd_camera(f->recording, pose, width, height);
        ff_film_crowd_draw(&stage, f->scene, f->recording, pose, &camera, &raster);
        ff_picture_paste(f->picture, x, y, raster.rgb, width, height);
        snprintf(text, sizeof text, "%.1f s", pose * ff_recording_pose_step(f->recording));
        ff_picture_text(f->picture, (ff_pixel){x + 14.0, y + 30.0}, 16, FF_ALIGN_LEFT, ink, text);
    }
    ff_raster_destroy(&raster);
    ff_stage_destroy(&stage);
    return status;
}

ff_status ff_film_write(const char *path, const ff_figure *figure, const ff_scene *scene,
                        const ff_recording *recording, ff_error *error)
{
    int walk = HEAD + CROWD_HEIGHT;
    int height = walk + ff_film_walk_height() + FOOT;
    film f = {figure, scene, recording, NULL};
    ff_status status = ff_picture_create(FF_FILM_WIDTH, height, paper, &f.picture, error);
    if (status != FF_OK) return status;
    draw_title(&f);
    status = draw_crowd(&f, error);
    if (status == FF_OK) status = ff_film_walk_draw(f.picture, figure, recording, "Agent 0", walk, error);
    if (status == FF_OK) status = ff_picture_write_png(f.picture, path, error);
    ff_picture_destroy(f.picture);
    return status;
}
