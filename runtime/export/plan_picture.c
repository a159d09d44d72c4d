#include "runtime/export/plan_picture.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/maths.h"
#include "runtime/export/picture.h"

#include <stdlib.h>
#include <string.h>

#define PANEL 760.0 /* pixels, of the longer side of the map */
#define MARGIN 36.0
#define HEAD 76.0
#define FOOT_LENGTH 0.26 /* m */
#define FOOT_WIDTH 0.095
#define BALL_AHEAD 0.62 /* of the foot's length, from the heel */
#define SAME 0.01       /* m: prints nearer than that are one */
#define ROUND 8         /* points of a quarter circle */
#define PRINTS_MOST 64  /* of one plan */

static const ff_colour paper = {252, 251, 248}, ink = {40, 42, 48}, faint = {232, 231, 226},
                       grey = {130, 132, 138};

static ff_colour colour_of(uint32_t agent)
{
    double hue = agent * 0.381966 + 0.58;
    return ff_colour_hsv(hue - floor(hue), 0.72, 0.78);
}

/* ------------------------------------------------------------------------------------------------- looking */

static bool add(ff_array *array, const void *item, size_t size)
{
    void *at = ff_array_grow(array, 1, size);
    if (at) memcpy(at, item, size);
    return at != NULL;
}

/* The last print of this foot is where it stands already. */
static bool known(const ff_array *stood, const ff_stood_print *print)
{
    const ff_stood_print *all = stood->data;
    for (size_t i = stood->count; i-- > 0;)
        if (all[i].agent == print->agent && all[i].foot == print->foot)
            return ff_length2(ff_sub2(all[i].ball, print->ball)) < SAME;
    return false;
}

static bool look_at(ff_plan_scene *scene, const ff_crowd *crowd, ff_agent agent, uint32_t number)
{
    ff_planned_print prints[PRINTS_MOST];
    ff_agent_state state;
    uint32_t count = 0;
    if (ff_crowd_agent_state(crowd, agent, &state, NULL) != FF_OK ||
        ff_crowd_agent_plan(crowd, agent, prints, PRINTS_MOST, &count, NULL) != FF_OK)
        return true; /* has left */
    bool good = true;
    for (uint32_t i = 0; i < count && i < PRINTS_MOST && good; ++i) {
        ff_stood_print print = {prints[i].ball, prints[i].yaw, number, prints[i].foot};
        bool stands = prints[i].action == UINT32_MAX;
        if (stands && !known(&scene->stood, &print)) good = add(&scene->stood, &print, sizeof print);
        if (!stands) good = add(&scene->planned, &print, sizeof print);
    }
    ff_stood_print body = {state.position, state.heading, number, 0}, goal = {state.goal, 0.0, number, 0};
    return good && add(&scene->bodies, &body, sizeof body) && add(&scene->goals, &goal, sizeof goal);
}

ff_status ff_plan_scene_look(ff_plan_scene *scene, const ff_crowd *crowd, const ff_agent *agents,
                             uint32_t count, ff_error *error)
{
    scene->planned.count = scene->bodies.count = scene->goals.count = 0;
    bool good = true;
    for (uint32_t i = 0; i < count && good; ++i)
        good = look_at(scene, crowd, agents[i], i);
    return good ? FF_OK
                : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the footprints of %u agents", count);
}

void ff_plan_scene_free(ff_plan_scene *scene)
{
    ff_array_free(&scene->stood);
    ff_array_free(&scene->planned);
    ff_array_free(&scene->bodies);
    ff_array_free(&scene->goals);
    ff_array_free(&scene->shapes);
    ff_array_free(&scene->walls);
}

/* ------------------------------------------------------------------------------------------------- the map */

/* Seen from above: z runs up and x to the left. */
typedef struct map {
    ff_vec2 low, high;  /* m */
    double scale, left; /* pixels per m; where the panel begins */
} map;

static ff_pixel to_pixel(const map *m, ff_vec2 p)
{
    return (ff_pixel){m->left + (m->high.b - p.b) * m->scale, HEAD + (m->high.a - p.a) * m->scale};
}

static void include_prints(map *m, const ff_array *array)
{
    const ff_stood_print *all = array->data;
    for (size_t i = 0; i < array->count; ++i) {
        m->low = ff_v2(ff_min(m->low.a, all[i].ball.a), ff_min(m->low.b, all[i].ball.b));
        m->high = ff_v2(ff_max(m->high.a, all[i].ball.a), ff_max(m->high.b, all[i].ball.b));
    }
}

static void include_shapes(map *m, const ff_array *array)
{
    const ff_drawn_shape *all = array->data;
    for (size_t i = 0; i < array->count; ++i) {
        double r = all[i].half_length + all[i].half_width + all[i].radius;
        m->low = ff_v2(ff_min(m->low.a, all[i].centre.a - r), ff_min(m->low.b, all[i].centre.b - r));
        m->high = ff_v2(ff_max(m->high.a, all[i].centre.a + r), ff_max(m->high.b, all[i].centre.b + r));
    }
}

static map fit(const ff_plan_scene *scenes, uint32_t count)
{
    map m = {{1e9, 1e9}, {-1e9, -1e9}, 1.0, MARGIN};
    for (uint32_t i = 0; i < count; ++i) {
        include_prints(&m, &scenes[i].stood);
        include_prints(&m, &scenes[i].planned);
        include_prints(&m, &scenes[i].goals);
        include_shapes(&m, &scenes[i].shapes);
    }
    m.low = ff_sub2(m.low, ff_v2(0.7, 0.7));
    m.high = ff_add2(m.high, ff_v2(0.7, 0.7));
    /* Room for the title. */
    double lack = ff_max(0.6 * (m.high.a - m.low.a) - (m.high.b - m.low.b), 0.0);
    m.low.b -= 0.5 * lack;
    m.high.b += 0.5 * lack;
    m.scale = PANEL / ff_max(m.high.a - m.low.a, m.high.b - m.low.b);
    return m;
}

static void draw_grid(ff_picture *picture, const map *m)
{
    for (int k = (int)ceil(m->low.a); k <= m->high.a; ++k)
        ff_picture_line(picture, to_pixel(m, ff_v2(k, m->low.b)), to_pixel(m, ff_v2(k, m->high.b)), 1.0,
                        faint);
    for (int k = (int)ceil(m->low.b); k <= m->high.b; ++k)
        ff_picture_line(picture, to_pixel(m, ff_v2(m->low.a, k)), to_pixel(m, ff_v2(m->high.a, k)), 1.0,
                        faint);
}

/* ------------------------------------------------------------------------------------------------- things */

/* Sole: a long oval, broader at the ball, seen from above. */
static void draw_print(ff_picture *picture, const map *m, const ff_stood_print *print, bool filled)
{
    enum { POINTS = 20 };
    ff_pixel outline[POINTS + 1];
    ff_vec2 ahead = ff_fwd2(print->yaw);
    ff_vec2 middle = ff_madd2(print->ball, ahead, (0.5 - BALL_AHEAD) * FOOT_LENGTH);
    double side = print->foot == 0 ? 1.0 : -1.0;
    for (int i = 0; i <= POINTS; ++i) {
        ff_vec2 round = ff_fwd2(FF_TAU * (i % POINTS) / POINTS);
        double broad = 0.5 * FOOT_WIDTH *
                       (1.0 + 0.22 * round.a - 0.12 * side * (round.b > 0.0 ? 1.0 : -1.0) * (round.a < 0.0));
        ff_vec2 at = ff_v2(0.5 * FOOT_LENGTH * round.a, broad * round.b);
        outline[i] = to_pixel(m, ff_add2(middle, ff_from_frame2(ahead, at)));
    }
    if (filled) ff_picture_polygon(picture, outline, POINTS, colour_of(print->agent));
    ff_picture_lines(picture, outline, POINTS + 1, filled ? 1.0 : 1.6, colour_of(print->agent));
}

static void draw_shape(ff_picture *picture, const map *m, const ff_drawn_shape *shape)
{
    static const ff_colour fills[3] = {{196, 194, 188}, {150, 178, 214}, {222, 150, 128}};
    ff_pixel outline[4 * ROUND];
    ff_vec2 ahead = ff_fwd2(shape->heading);
    for (int i = 0; i < 4 * ROUND; ++i) {
        int corner = i / ROUND;
        ff_vec2 round =
            ff_scale2(ff_fwd2(0.5 * FF_PI * (corner + (i % ROUND) / (ROUND - 1.0))), shape->radius);
        ff_vec2 at = ff_v2(corner == 0 || corner == 3 ? shape->half_length : -shape->half_length,
                           corner < 2 ? shape->half_width : -shape->half_width);
        outline[i] = to_pixel(m, ff_add2(shape->centre, ff_from_frame2(ahead, ff_add2(at, round))));
    }
    ff_picture_polygon(picture, outline, 4 * ROUND, fills[shape->kind < 3 ? shape->kind : 0]);
}

static void draw_body(ff_picture *picture, const map *m, const ff_stood_print *body)
{
    ff_pixel at = to_pixel(m, body->ball), nose = to_pixel(m, ff_madd2(body->ball, ff_fwd2(body->yaw), 0.26));
    ff_picture_ring(picture, at, 0.18 * m->scale, 2.0, ink);
    ff_picture_line(picture, at, nose, 2.0, ink);
}

static void draw_goal(ff_picture *picture, const map *m, const ff_stood_print *goal)
{
    ff_pixel at = to_pixel(m, goal->ball);
    double r = 6.0;
    ff_picture_line(picture, (ff_pixel){at.x - r, at.y - r}, (ff_pixel){at.x + r, at.y + r}, 2.4,
                    colour_of(goal->agent));
    ff_picture_line(picture, (ff_pixel){at.x - r, at.y + r}, (ff_pixel){at.x + r, at.y - r}, 2.4,
                    colour_of(goal->agent));
}

static void draw_panel(ff_picture *picture, const map *m, const ff_plan_scene *scene)
{
    draw_grid(picture, m);
    const ff_drawn_shape *shapes = scene->shapes.data;
    for (size_t i = 0; i < scene->shapes.count; ++i)
        draw_shape(picture, m, &shapes[i]);
    const ff_vec2(*walls)[2] = scene->walls.data;
    for (size_t i = 0; i < scene->walls.count; ++i)
        ff_picture_line(picture, to_pixel(m, walls[i][0]), to_pixel(m, walls[i][1]), 4.0, ink);
    const ff_stood_print *all = scene->stood.data;
    for (size_t i = 0; i < scene->stood.count; ++i)
        draw_print(picture, m, &all[i], true);
    all = scene->planned.data;
    for (size_t i = 0; i < scene->planned.count; ++i)
        draw_print(picture, m, &all[i], false);
    all = scene->goals.data;
    for (size_t i = 0; i < scene->goals.count; ++i)
        draw_goal(picture, m, &all[i]);
    all = scene->bodies.data;
    for (size_t i = 0; i < scene->bodies.count; ++i)
        draw_body(picture, m, &all[i]);
    ff_picture_text(picture, (ff_pixel){m->left, 34}, 17, FF_ALIGN_LEFT, ink,
                    scene->title ? scene->title : "");
    ff_picture_text(picture, (ff_pixel){m->left, 58}, 12, FF_ALIGN_LEFT, grey,
                    scene->subtitle ? scene->subtitle : "");
}

ff_status ff_plan_picture_write(const char *path, const ff_plan_scene *scenes, uint32_t count,
                                ff_error *error)
{
    map m = fit(scenes, count);
    double across = (m.high.b - m.low.b) * m.scale, up = (m.high.a - m.low.a) * m.scale;
    ff_picture *picture = NULL;
    ff_status status = ff_picture_create((int)(count * (across + MARGIN) + MARGIN), (int)(up + HEAD + MARGIN),
                                         paper, &picture, error);
    for (uint32_t i = 0; i < count && status == FF_OK; ++i) {
        m.left = MARGIN + i * (across + MARGIN);
        draw_panel(picture, &m, &scenes[i]);
    }
    if (status == FF_OK) status = ff_picture_write_png(picture, path, error);
    ff_picture_destroy(picture);
    return status;
}
