#include "runtime/export/film_walk.h"

#include "runtime/core/base/fail.h"
#include "runtime/export/gait_window.h"
#include "runtime/export/stage.h"

#include <stdio.h>

/* Layout, in pixels of the finished sheet. */
enum {
    POSES = 12,
    CELL_WIDTH = 160,
    CELL_GROUND = 34, /* below the ground line */
    UPRIGHT = 312,    /* height of a strip seen from the side or the front */
    ABOVE = 190,      /* and from above */
    LABEL = 44,       /* above each strip */
    TIMELINE = 70,
    MARGIN = (FF_FILM_WIDTH - POSES * CELL_WIDTH) / 2
};
#define PIXELS_PER_METRE 138.0
#define FINE 0.016 /* m, mesh of the single figure */

static const ff_colour paper = {250, 249, 246}, ink = {40, 42, 48}, grey = {128, 130, 136};
static const ff_colour left_colour = {232, 126, 52}, right_colour = {58, 122, 204},
                       trunk_colour = {196, 192, 186};
static const ff_colour planted_colour = {40, 150, 84}, ground_colour = {150, 148, 142},
                       band = {241, 240, 235};

typedef struct walk {
    const ff_figure *figure;
    const ff_recording *recording;
    ff_picture *picture;
} walk;

typedef enum view { VIEW_SIDE, VIEW_FRONT, VIEW_ABOVE } view;

static int strip_height(view from)
{
    return from == VIEW_ABOVE ? ABOVE : UPRIGHT;
}

/* A parallel camera that goes with the agent: the ground line and the agent's middle stay put in the cell. */
static ff_camera cell_camera(view from, const ff_track *track)
{
    ff_vec2 fwd = ff_fwd2((double)track->heading), left = ff_left2(fwd);
    ff_vec3 foot = ff_ground(track->position, 0.0), forward = ff_ground(fwd, 0.0),
            aside = ff_ground(left, 0.0);
    ff_vec3 up = from == VIEW_ABOVE ? aside : ff_v3(0.0, 1.0, 0.0);
    ff_vec3 back =
        from == VIEW_SIDE ? ff_scale3(aside, -1.0) : (from == VIEW_FRONT ? forward : ff_v3(0.0, 1.0, 0.0));
    ff_camera camera = ff_camera_look(ff_madd3(foot, back, 10.0), foot, up, false);
    camera.scale = PIXELS_PER_METRE * FF_PICTURE_SCALE;
    camera.centre_x = 0.5 * CELL_WIDTH * FF_PICTURE_SCALE;
    camera.centre_y = (from == VIEW_ABOVE ? 0.5 * ABOVE : UPRIGHT - CELL_GROUND) * FF_PICTURE_SCALE;
    return camera;
}

static ff_pixel on_sheet(const ff_camera *camera, ff_vec3 point, int x, int y)
{
    ff_pixel p = ff_camera_project(camera, point, NULL);
    return (ff_pixel){x + p.x / FF_PICTURE_SCALE, y + p.y / FF_PICTURE_SCALE};
}

/* A green bar under each planted foot, from heel to toe. */
static void mark_plants(const walk *f, view from, const ff_camera *camera, const ff_vec3 *joints,
                        const ff_track *track, int x, int y)
{
    for (uint32_t foot = 0; foot < 2; ++foot) {
        if (!track->planted[foot]) continue;
        uint32_t ankle = FF_JOINT_ANKLE_L + foot * FF_JOINT_LEG_STRIDE;
        ff_pixel heel = on_sheet(camera, joints[ankle], x, y),
                 ball = on_sheet(camera, joints[ankle + 1], x, y);
        if (from == VIEW_ABOVE) {
            ff_picture_disc(f->picture, ball, 5.0, planted_colour);
            continue;
        }
        double line = y + UPRIGHT - CELL_GROUND + 7.0 + 6.0 * foot;
        double reach = ff_max(8.0, fabs(ball.x - heel.x));
        double middle = 0.5 * (ball.x + heel.x);
        ff_picture_line(f->picture, (ff_pixel){middle - reach * 0.75, line},
                        (ff_pixel){middle + reach * 0.75, line}, 4.0, foot == 0 ? left_colour : right_colour);
    }
}

static void draw_cell(const walk *f, ff_stage *stage, ff_raster *raster, view from, uint32_t pose, int x,
                      int y)
{
    const ff_track *track = ff_recording_track(f->recording, pose * f->recording->pose_stride, 0);
    ff_camera camera = cell_camera(from, track);
    ff_vec3 joints[FF_FIGURE_MAX_JOINTS];
    ff_stage_pose(stage, f->recording, pose, 0, joints);
    ff_stage_mark_sides(stage, left_colour, right_colour, trunk_colour);
    ff_raster_clear(raster, band, band);
    ff_stage_draw(stage, raster, &camera);
    ff_picture_paste(f->picture, x, y, raster->rgb, raster->width, raster->height);
    mark_plants(f, from, &camera, joints, track, x, y);
}

static uint32_t cell_pose(const walk *f, const ff_gait_window *window, int cell)
{
    double step = ff_lerp(window->first, window->last, (double)cell / POSES);
    uint32_t pose = (uint32_t)(step / f->recording->pose_stride + 0.5);
    return pose < f->recording->pose_count ? pose : f->recording->pose_count - 1;
}

static ff_status draw_strip(const walk *f, ff_stage *stage, const ff_gait_window *window, view from, int top,
                            ff_error *error)
{
    int height = strip_height(from);
    ff_raster raster;
    ff_status status =
        ff_raster_create(CELL_WIDTH * FF_PICTURE_SCALE, height * FF_PICTURE_SCALE, &raster, error);
    if (status != FF_OK) return status;
    for (int k = 0; k < POSES; ++k) {
        uint32_t pose = cell_pose(f, window, k);
        draw_cell(f, stage, &raster, from, pose, MARGIN + k * CELL_WIDTH, top);
        if (from != VIEW_SIDE) continue;
        char text[32];
        snprintf(text, sizeof text, "%.2f s",
                 (pose * f->recording->pose_stride - window->first) * f->recording->step);
        ff_picture_text(f->picture, (ff_pixel){MARGIN + (k + 0.5) * CELL_WIDTH, top + 20.0}, 10,
                        FF_ALIGN_MIDDLE, grey, text);
    }
    if (from != VIEW_ABOVE) {
        double y = top + UPRIGHT - CELL_GROUND;
        ff_picture_line(f->picture, (ff_pixel){MARGIN, y}, (ff_pixel){FF_FILM_WIDTH - MARGIN, y}, 1.5,
                        ground_colour);
    }
    ff_raster_destroy(&raster);
    return FF_OK;
}

/* When each foot was planted, on the time axis of the side view. */
static void draw_timeline(const walk *f, const ff_gait_window *window, int top)
{
    double left = MARGIN + 0.5 * CELL_WIDTH, width = (double)POSES * CELL_WIDTH;
    double each = width / (window->last - window->first);
    for (int foot = 0; foot < 2; ++foot) {
        double y = top + 8.0 + 26.0 * foot;
        for (uint32_t k = window->first; k < window->last; ++k) {
            double x = left + (k - window->first) * each;
            bool planted = ff_recording_track(f->recording, k, 0)->planted[foot] != 0;
            ff_colour colour =
                !planted ? (ff_colour){232, 231, 227} : (foot == 0 ? left_colour : right_colour);
            double right = ff_min(x + each + 0.5, FF_FILM_WIDTH - MARGIN);
            if (x < right)
                ff_picture_rectangle(f->picture, (ff_pixel){x, y}, (ff_pixel){right, y + 16.0}, colour);
        }
        ff_picture_text(f->picture, (ff_pixel){MARGIN + 4.0, y + 13.0}, 10, FF_ALIGN_LEFT, grey,
                        foot == 0 ? "left" : "right");
    }
}

static void draw_label(const walk *f, int top, const char *text)
{
    ff_picture_text(f->picture, (ff_pixel){MARGIN, top + 30.0}, 15, FF_ALIGN_LEFT, ink, text);
}

static ff_status draw_walk(const walk *f, const char *name, int top, ff_error *error)
{
    ff_gait_window window = ff_gait_window_find(f->recording, 0);
    if (window.last <= window.first) return FF_OK; /* a run of one step has no walk to show */
    ff_stage stage;
    ff_status status = ff_stage_create(f->figure, FINE, &stage, error);
    if (status != FF_OK) return status;
    double seconds = (window.last - window.first) * f->recording->step;
    const ff_track *from = ff_recording_track(f->recording, window.first, 0);
    const ff_track *to = ff_recording_track(f->recording, window.last, 0);
    char text[200];
    snprintf(text, sizeof text,
             "%s from the side: %s in %.2f s from %.1f s on, %.2f m/s. Left limbs orange, right blue; bars: "
             "planted feet",
             name, window.cycles ? "two gait cycles" : "its walk", seconds, window.first * f->recording->step,
             ff_length2(ff_sub2(to->position, from->position)) / seconds);
    draw_label(f, top, text);
    status = draw_strip(f, &stage, &window, VIEW_SIDE, top + LABEL, error);
    top += LABEL + UPRIGHT;
    draw_timeline(f, &window, top);
    top += TIMELINE;
    draw_label(f, top - 6, "From the front");
    if (status == FF_OK) status = draw_strip(f, &stage, &window, VIEW_FRONT, top + LABEL - 6, error);
    top += LABEL + UPRIGHT;
    draw_label(f, top - 6, "From above, walking to the right");
    if (status == FF_OK) status = draw_strip(f, &stage, &window, VIEW_ABOVE, top + LABEL - 6, error);
    ff_stage_destroy(&stage);
    return status;
}

int ff_film_walk_height(void)
{
    return 3 * LABEL + 2 * UPRIGHT + ABOVE + TIMELINE;
}

ff_status ff_film_walk_draw(ff_picture *picture, const ff_figure *figure, const ff_recording *recording,
                            const char *name, int top, ff_error *error)
{
    walk w = {figure, recording, picture};
    return draw_walk(&w, name, top, error);
}

ff_status ff_film_walk_write(const char *path, const ff_figure *figure, const ff_recording *recording,
                             const char *name, ff_error *error)
{
    ff_picture *picture;
    ff_status status = ff_picture_create(FF_FILM_WIDTH, ff_film_walk_height(), paper, &picture, error);
    if (status != FF_OK) return status;
    status = ff_film_walk_draw(picture, figure, recording, name, 0, error);
    if (status == FF_OK) status = ff_picture_write_png(picture, path, error);
    ff_picture_destroy(picture);
    return status;
}
