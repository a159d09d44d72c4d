#include "runtime/export/trajectories.h"

#include "runtime/core/base/fail.h"
#include "runtime/export/look.h"
#include "runtime/export/obstacle_outline.h"
#include "runtime/export/picture.h"
#include "runtime/export/watch.h"

#include <stdio.h>
#include <stdlib.h>

#define PICTURE_SIDE 1400.0 /* pixels, of the longer side of the map */
#define MARGIN 60.0
#define HEAD 110.0
#define FOOT 80.0

static const ff_colour paper = {252, 251, 248}, ink = {40, 42, 48}, faint = {232, 231, 226},
                       grey = {130, 132, 138};

/* Seen from above: z runs up and x to the left, or, where that suits the scene better, z to the right and x up. */
typedef struct map {
    ff_vec2 low, high; /* m, plane */
    double scale;      /* pixels per m */
    bool lying;        /* z to the right */
} map;

static ff_pixel to_pixel(const map *m, ff_vec2 p)
{
    if (m->lying)
        return (ff_pixel){MARGIN + (p.a - m->low.a) * m->scale, HEAD + (m->high.b - p.b) * m->scale};
    return (ff_pixel){MARGIN + (m->high.b - p.b) * m->scale, HEAD + (m->high.a - p.a) * m->scale};
}

static void include(map *m, ff_vec2 p)
{
    m->low = ff_v2(ff_min(m->low.a, p.a), ff_min(m->low.b, p.b));
    m->high = ff_v2(ff_max(m->high.a, p.a), ff_max(m->high.b, p.b));
}

static map fit(const ff_scene *scene, const ff_recording *recording)
{
    map m = {ff_v2(1e9, 1e9), ff_v2(-1e9, -1e9), 1.0, false};
    for (uint32_t i = 0; i < ff_scene_agent_count(scene); ++i) {
        ff_span there = ff_recording_span(recording, i);
        if (there.end > 0) include(&m, ff_scene_agents(scene)[i].goal);
        for (uint32_t k = there.first; k < there.end; ++k)
            include(&m, ff_recording_track(recording, k, i)->position);
    }
    for (uint32_t i = 0; i < ff_scene_wall_count(scene); ++i) {
        include(&m, ff_scene_walls(scene)[i].p);
        include(&m, ff_scene_walls(scene)[i].q);
    }
    const ff_obstacle_def *obstacles = scene->obstacles.data;
    for (size_t i = 0; i < scene->obstacles.count; ++i) {
        include(&m, obstacles[i].position);
        for (uint32_t k = 0; k < obstacles[i].path_count; ++k)
            include(&m, ff_add2(obstacles[i].position, obstacles[i].path[k].at));
    }
    m.low = ff_sub2(m.low, ff_v2(0.8, 0.8));
    m.high = ff_add2(m.high, ff_v2(0.8, 0.8));
    m.lying = m.high.a - m.low.a > 1.2 * (m.high.b - m.low.b);
    m.scale = PICTURE_SIDE / ff_max(m.high.a - m.low.a, m.high.b - m.low.b);
    return m;
}

static void draw_grid(ff_picture *picture, const map *m)
{
    double extent = ff_max(m->high.a - m->low.a, m->high.b - m->low.b), every = 1.0;
    while (extent > 45.0 * every)
        every *= 5.0;
    for (int k = (int)ceil(m->low.a / every); k * every <= m->high.a; ++k)
        ff_picture_line(picture, to_pixel(m, ff_v2(k * every, m->low.b)),
                        to_pixel(m, ff_v2(k * every, m->high.b)), 1.0, faint);
    for (int k = (int)ceil(m->low.b / every); k * every <= m->high.b; ++k)
        ff_picture_line(picture, to_pixel(m, ff_v2(m->low.a, k * every)),
                        to_pixel(m, ff_v2(m->high.a, k * every)), 1.0, faint);
}

/* The places of goals. */
static void draw_goals(ff_picture *picture, const map *m, const ff_scene *scene)
{
    static const ff_colour patch = {240, 230, 196};
    const ff_goal_def *goals = scene->behaviour.goals.data;
    for (size_t i = 0; i < scene->behaviour.goals.count; ++i) {
        ff_vec2 outline[FF_OUTLINE_MOST];
        ff_pixel corners[FF_OUTLINE_MOST];
        uint32_t count = ff_region_outline(&goals[i].place, outline);
        for (uint32_t c = 0; c < count; ++c)
            corners[c] = to_pixel(m, outline[c]);
        if (count > 0) ff_picture_polygon(picture, corners, (int)count, patch);
    }
}

/* Obstacles where they are at the start, and the ways of those that move. */
static void draw_obstacles(ff_picture *picture, const map *m, const ff_scene *scene)
{
    static const ff_colour fixed = {168, 140, 108}, way = {206, 188, 164};
    const ff_obstacle_def *obstacles = scene->obstacles.data;
    for (size_t i = 0; i < scene->obstacles.count; ++i) {
        const ff_obstacle_def *obstacle = &obstacles[i];
        for (uint32_t k = 1; k < obstacle->path_count; ++k)
            ff_picture_line(picture, to_pixel(m, ff_add2(obstacle->position, obstacle->path[k - 1].at)),
                            to_pixel(m, ff_add2(obstacle->position, obstacle->path[k].at)), 3.0, way);
        ff_vec2 outline[FF_OBSTACLE_CORNERS];
        ff_pixel corners[FF_OBSTACLE_CORNERS];
        ff_obstacle_outline(obstacle, 0.0, outline);
        for (int c = 0; c < FF_OBSTACLE_CORNERS; ++c)
            corners[c] = to_pixel(m, outline[c]);
        ff_picture_polygon(picture, corners, FF_OBSTACLE_CORNERS, fixed);
    }
}

static void draw_scale_bar(ff_picture *picture, const map *m, int width, int height)
{
    double metres = 1.0; /* 1, 2, 5, 10 ...: the first that is long enough to see */
    for (int k = 0; metres * m->scale < 60.0; ++k)
        metres *= k % 3 == 1 ? 2.5 : 2.0;
    double right = width - MARGIN, y = height - 0.5 * FOOT, left = right - metres * m->scale;
    char text[32];
    snprintf(text, sizeof text, "%.0f m", metres);
    ff_picture_line(picture, (ff_pixel){left, y}, (ff_pixel){right, y}, 3.0, ink);
    ff_picture_line(picture, (ff_pixel){left, y - 7}, (ff_pixel){left, y + 7}, 2.0, ink);
    ff_picture_line(picture, (ff_pixel){right, y - 7}, (ff_pixel){right, y + 7}, 2.0, ink);
    ff_picture_text(picture, (ff_pixel){0.5 * (left + right), y + 26}, 13, FF_ALIGN_MIDDLE, ink, text);
}

/* Which way x and z run: pictures lie or stand. */
static void draw_axes(ff_picture *picture, const map *m, int height)
{
    const double length = 34.0, head = 6.0;
    ff_pixel corner = {MARGIN + (m->lying ? 6.0 : 58.0), height - FOOT - 6.0};
    ff_pixel up = {corner.x, corner.y - length};
    double side = m->lying ? 1.0 : -1.0;
    ff_pixel aside = {corner.x + side * length, corner.y};
    ff_picture_line(picture, corner, up, 2.0, grey);
    ff_picture_line(picture, (ff_pixel){up.x - head, up.y + head}, up, 2.0, grey);
    ff_picture_line(picture, (ff_pixel){up.x + head, up.y + head}, up, 2.0, grey);
    ff_picture_line(picture, corner, aside, 2.0, grey);
    ff_picture_line(picture, (ff_pixel){aside.x - side * head, aside.y - head}, aside, 2.0, grey);
    ff_picture_line(picture, (ff_pixel){aside.x - side * head, aside.y + head}, aside, 2.0, grey);
    ff_picture_text(picture, (ff_pixel){up.x, up.y - 8}, 12, FF_ALIGN_MIDDLE, grey, m->lying ? "x" : "z");
    ff_picture_text(picture, (ff_pixel){aside.x + side * 12, aside.y + 5}, 12, FF_ALIGN_MIDDLE, grey,
                    m->lying ? "z" : "x");
}

static void draw_legend(ff_picture *picture, int height)
{
    double y = height - 0.5 * FOOT, x = MARGIN;
    ff_picture_disc(picture, (ff_pixel){x + 6, y}, 6, ink);
    ff_picture_text(picture, (ff_pixel){x + 22, y + 6}, 13, FF_ALIGN_LEFT, ink, "start");
    ff_picture_ring(picture, (ff_pixel){x + 106, y}, 7, 2, ink);
    ff_picture_text(picture, (ff_pixel){x + 122, y + 6}, 13, FF_ALIGN_LEFT, ink, "goal");
    ff_picture_disc(picture, (ff_pixel){x + 200, y}, 3, ink);
    ff_picture_text(picture, (ff_pixel){x + 214, y + 6}, 13, FF_ALIGN_LEFT, ink, "every second");
}

static void draw_marks(ff_picture *picture, const map *m, const ff_scene *scene, uint32_t agent)
{
    ff_colour colour = ff_look_of(scene, agent).cover[FF_COVER_SHIRT];
    const ff_scene_agent *who = &ff_scene_agents(scene)[agent];
    double size = ff_clamp(0.16 * m->scale, 4.0, 11.0);
    if (who->radius <= 0.0) return; /* nobody */
    if (who->machine == FF_NONE) ff_picture_ring(picture, to_pixel(m, who->goal), size, 2.0, colour);
    ff_picture_disc(picture, to_pixel(m, who->position), size, colour);
}

static void draw_path(ff_picture *picture, const map *m, const ff_scene *scene, const ff_recording *recording,
                      uint32_t agent, ff_pixel *points)
{
    ff_colour colour = ff_look_of(scene, agent).cover[FF_COVER_SHIRT];
    uint32_t second = (uint32_t)(1.0 / recording->step + 0.5);
    int count = 0;
    ff_span there = ff_recording_span(recording, agent);
    for (uint32_t k = there.first; k < there.end; ++k)
        points[count++] = to_pixel(m, ff_recording_track(recording, k, agent)->position);
    ff_picture_lines(picture, points, count, ff_clamp(0.035 * m->scale, 1.5, 3.0), colour);
    for (int k = (int)second; k < count; k += (int)second)
        ff_picture_disc(picture, points[k], ff_clamp(0.05 * m->scale, 2.2, 4.0), colour);
}

static void draw_title(ff_picture *picture, const ff_scene *scene, const ff_recording *recording)
{
    char text[160];
    ff_watch_caption(scene, recording, text, sizeof text);
    const char *title = scene->title[0] ? scene->title : ff_scene_kind_name(scene->kind);
    ff_picture_text(picture, (ff_pixel){MARGIN, 58}, 24, FF_ALIGN_LEFT, ink, title);
    ff_picture_text(picture, (ff_pixel){MARGIN, 88}, 14, FF_ALIGN_LEFT, grey, text);
}

ff_status ff_trajectories_write(const char *path, const ff_scene *scene, const ff_recording *recording,
                                ff_error *error)
{
    map m = fit(scene, recording);
    double along = (m.high.a - m.low.a) * m.scale, aside = (m.high.b - m.low.b) * m.scale;
    int width = (int)((m.lying ? along : aside) + 2.0 * MARGIN);
    int height = (int)((m.lying ? aside : along) + HEAD + FOOT);
    ff_pixel *points = ff_calloc(recording->step_count, sizeof *points);
    ff_picture *picture = NULL;
    ff_status status = points ? ff_picture_create(width, height, paper, &picture, error)
                              : ff_fail(error, FF_ERR_NO_MEMORY, "no memory to draw %s", path);
    if (status == FF_OK) {
        draw_goals(picture, &m, scene);
        draw_grid(picture, &m);
        draw_obstacles(picture, &m, scene);
        for (uint32_t i = 0; i < ff_scene_wall_count(scene); ++i)
            ff_picture_line(picture, to_pixel(&m, ff_scene_walls(scene)[i].p),
                            to_pixel(&m, ff_scene_walls(scene)[i].q), 5.0, ink);
        for (uint32_t i = 0; i < recording->agent_count; ++i)
            draw_path(picture, &m, scene, recording, i, points);
        for (uint32_t i = 0; i < recording->agent_count; ++i)
            draw_marks(picture, &m, scene, i);
        draw_title(picture, scene, recording);
        draw_axes(picture, &m, height);
        draw_legend(picture, height);
        draw_scale_bar(picture, &m, width, height);
        status = ff_picture_write_png(picture, path, error);
    }
    ff_picture_destroy(picture);
    free(points);
    return status;
}
