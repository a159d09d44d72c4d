#include "runtime/export/film_crowd.h"

#include "runtime/export/obstacle_outline.h"

#include <string.h>

#define ELEVATION (32.0 * FF_DEG)
#define VIEW_ANGLE (30.0 * FF_DEG)
#define WALL_HEIGHT 0.4    /* m: one sees feet behind it */
#define LEAST_VIEW 3.0     /* m */
#define LONG 2.5           /* longer than wide */
#define GROUND_MARGIN 14.0 /* m, tiles beyond everybody's paths */
#define HEAD_ROOM 1.8

static void include(ff_vec3 *low, ff_vec3 *high, ff_vec2 p)
{
    const double reach = 0.5; /* of a stride beyond the root */
    *low = ff_v3(ff_min(low->x, p.b - reach), 0.0, ff_min(low->z, p.a - reach));
    *high = ff_v3(ff_max(high->x, p.b + reach), HEAD_ROOM, ff_max(high->z, p.a + reach));
}

static void bounds(const ff_recording *recording, ff_vec3 *low, ff_vec3 *high)
{
    *low = ff_v3(1e9, 0.0, 1e9);
    *high = ff_v3(-1e9, HEAD_ROOM, -1e9);
    for (uint32_t k = 0; k < recording->step_count; k += 5)
        for (uint32_t i = 0; i < recording->agent_count; ++i) {
            const ff_track *track = ff_recording_track(recording, k, i);
            if (track->present) include(low, high, track->position);
        }
}

/* Of those present at one step; somewhat larger than a single person. */
static void bounds_at(const ff_recording *recording, uint32_t step, ff_vec3 *low, ff_vec3 *high)
{
    *low = ff_v3(1e9, 0.0, 1e9);
    *high = ff_v3(-1e9, HEAD_ROOM, -1e9);
    for (uint32_t i = 0; i < recording->agent_count; ++i) {
        const ff_track *track = ff_recording_track(recording, step, i);
        if (track->present) include(low, high, track->position);
    }
    if (low->x > high->x) include(low, high, ff_recording_track(recording, step, 0)->position);
    double x = ff_max(0.0, LEAST_VIEW - (high->x - low->x)), z = ff_max(0.0, LEAST_VIEW - (high->z - low->z));
    low->x -= 0.5 * x, high->x += 0.5 * x;
    low->z -= 0.5 * z, high->z += 0.5 * z;
}

bool ff_film_crowd_is_long(const ff_recording *recording)
{
    ff_vec3 low, high;
    bounds(recording, &low, &high);
    double x = high.x - low.x, z = high.z - low.z;
    return ff_max(x, z) > LONG * ff_min(x, z);
}

double ff_film_crowd_tile(const ff_recording *recording)
{
    ff_vec3 low, high;
    bounds(recording, &low, &high);
    return ff_ground_tile(high.x - low.x, high.z - low.z);
}

/* Whether every corner of the box is on the picture; the box of what is seen goes to seen[4] (left, top, right,
 * bottom). */
static bool sees(const ff_camera *camera, ff_vec3 low, ff_vec3 high, int width, int height, double seen[4])
{
    seen[0] = seen[1] = 1e9;
    seen[2] = seen[3] = -1e9;
    for (unsigned c = 0; c < 8; ++c) {
        ff_vec3 corner = ff_v3(c & 1u ? high.x : low.x, c & 2u ? high.y : low.y, c & 4u ? high.z : low.z);
        double depth;
        ff_pixel p = ff_camera_project(camera, corner, &depth);
        if (depth < 1.0) return false;
        seen[0] = ff_min(seen[0], p.x);
        seen[1] = ff_min(seen[1], p.y);
        seen[2] = ff_max(seen[2], p.x);
        seen[3] = ff_max(seen[3], p.y);
    }
    return seen[2] - seen[0] < 0.94 * width && seen[3] - seen[1] < 0.94 * height;
}

ff_camera ff_film_crowd_camera(const ff_recording *recording, uint32_t pose, int width, int height)
{
    ff_vec3 low, high;
    bounds(recording, &low, &high);
    /* Pictures are wide: look along the shorter side of where people go. */
    bool along_x = high.z - low.z > high.x - low.x;
    ff_vec3 back =
        along_x ? ff_v3(-cos(ELEVATION), sin(ELEVATION), 0.0) : ff_v3(0.0, sin(ELEVATION), -cos(ELEVATION));
    bounds_at(recording, pose * recording->pose_stride, &low, &high);
    ff_vec3 middle = ff_lerp3(low, high, 0.5);
    ff_camera camera = {0};
    double distance = 4.0, seen[4] = {0};
    for (int tries = 0; tries < 300; ++tries, distance *= 1.03) { /* up to 28 km */
        camera = ff_camera_look(ff_madd3(middle, back, distance), middle, ff_v3(0.0, 1.0, 0.0), true);
        camera.scale = 0.5 * width / tan(0.5 * VIEW_ANGLE);
        if (!sees(&camera, low, high, width, height, seen)) continue;
        camera.centre_x = 0.5 * (width - seen[0] - seen[2]);
        camera.centre_y = 0.5 * (height - seen[1] - seen[3]);
        break;
    }
    return camera;
}

static void draw_ground(const ff_recording *recording, const ff_camera *camera, ff_raster *raster)
{
    static const ff_colour tile[2] = {{214, 213, 207}, {222, 221, 216}};
    ff_vec3 low, high;
    bounds(recording, &low, &high);
    double side = ff_film_crowd_tile(recording);
    int x0 = (int)floor((low.x - GROUND_MARGIN) / side), x1 = (int)ceil((high.x + GROUND_MARGIN) / side);
    int z0 = (int)floor((low.z - GROUND_MARGIN) / side), z1 = (int)ceil((high.z + GROUND_MARGIN) / side);
    for (int z = z0; z < z1; ++z)
        for (int x = x0; x < x1; ++x) {
            ff_vec3 corners[4] = {ff_v3(x, 0.0, z), ff_v3(x + 1, 0.0, z), ff_v3(x + 1, 0.0, z + 1),
                                  ff_v3(x, 0.0, z + 1)};
            for (int c = 0; c < 4; ++c)
                corners[c] = ff_scale3(corners[c], side);
            ff_raster_ground(raster, camera, corners, 4, tile[(x + z) & 1]);
        }
}

/* The places of goals, on the ground. */
static void draw_goals(const ff_scene *scene, const ff_camera *camera, ff_raster *raster)
{
    static const ff_colour patch = {232, 222, 186};
    const ff_goal_def *goals = scene->behaviour.goals.data;
    for (size_t i = 0; i < scene->behaviour.goals.count; ++i) {
        ff_vec2 outline[FF_OUTLINE_MOST];
        ff_vec3 corners[FF_OUTLINE_MOST];
        uint32_t count = ff_region_outline(&goals[i].place, outline);
        for (uint32_t c = 0; c < count; ++c)
            corners[c] = ff_ground(outline[c], 0.0);
        ff_raster_ground(raster, camera, corners, (int)count, patch);
    }
}

/* A wall is a standing sheet, seen from both sides. */
static void draw_walls(const ff_scene *scene, const ff_camera *camera, ff_raster *raster)
{
    static const uint32_t faces[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
    for (uint32_t i = 0; i < ff_scene_wall_count(scene); ++i) {
        const ff_scene_wall *wall = &ff_scene_walls(scene)[i];
        ff_vec3 feet[2] = {ff_ground(wall->p, 0.0), ff_ground(wall->q, 0.0)};
        ff_shaded_vertex sheet[4];
        for (int c = 0; c < 4; ++c) {
            ff_vec3 at = feet[c == 1 || c == 2];
            at.y = c >= 2 ? WALL_HEIGHT : 0.0;
            sheet[c] = (ff_shaded_vertex){at, ff_scale3(camera->forward, -1.0), {176, 172, 164}};
        }
        ff_raster_mesh(raster, camera, sheet, faces, 4);
    }
}

/* Sides and top of each obstacle, where it is at the time. */
static void draw_obstacles(const ff_scene *scene, double time, const ff_camera *camera, ff_raster *raster)
{
    enum { N = FF_OBSTACLE_CORNERS };
    static const ff_colour colour = {168, 140, 108};
    const ff_obstacle_def *obstacles = scene->obstacles.data;
    for (size_t i = 0; i < scene->obstacles.count; ++i) {
        ff_vec2 outline[N];
        ff_obstacle_outline(&obstacles[i], time, outline);
        ff_shaded_vertex vertices[5 * N];
        uint32_t faces[3 * N - 2][3], face = 0;
        double low = ff_max(obstacles[i].low, 0.0), high = obstacles[i].high;
        for (uint32_t c = 0; c < N; ++c) {
            ff_vec2 p = outline[c], q = outline[(c + 1) % N];
            ff_vec3 out = ff_ground(ff_scale2(ff_left2(ff_unit2(ff_sub2(q, p))), -1.0), 0.0);
            ff_shaded_vertex *v = &vertices[4 * c];
            v[0] = (ff_shaded_vertex){ff_ground(p, low), out, colour};
            v[1] = (ff_shaded_vertex){ff_ground(q, low), out, colour};
            v[2] = (ff_shaded_vertex){ff_ground(q, high), out, colour};
            v[3] = (ff_shaded_vertex){ff_ground(p, high), out, colour};
            vertices[4 * N + c] = (ff_shaded_vertex){ff_ground(p, high), ff_v3(0.0, 1.0, 0.0), colour};
            const uint32_t a = 4 * c;
            const uint32_t sides[2][3] = {{a, a + 1, a + 2}, {a, a + 2, a + 3}};
            memcpy(faces[face], sides, sizeof sides);
            face += 2;
        }
        for (uint32_t c = 1; c + 1 < N; ++c, ++face)
            memcpy(faces[face], (const uint32_t[3]){4 * N, 4 * N + c, 4 * N + c + 1}, sizeof faces[face]);
        ff_raster_mesh(raster, camera, vertices, (const uint32_t(*)[3])faces, face);
    }
}

void ff_film_crowd_draw(ff_stage *stage, const ff_scene *scene, const ff_recording *recording, uint32_t pose,
                        const ff_camera *camera, ff_raster *raster)
{
    ff_raster_clear(raster, (ff_colour){228, 232, 236}, (ff_colour){206, 205, 199});
    draw_ground(recording, camera, raster);
    draw_goals(scene, camera, raster);
    uint32_t step = pose * recording->pose_stride;
    for (int pass = 0; pass < 2; ++pass) { /* all shadows first: nobody's shadow falls on a body */
        for (uint32_t i = 0; i < recording->agent_count; ++i) {
            if (!ff_recording_track(recording, step, i)->present) continue;
            ff_stage_pose(stage, recording, pose, i, NULL);
            if (pass == 0) {
                ff_stage_shadow(stage, raster, camera);
                continue;
            }
            ff_look look = ff_look_of(scene, i);
            ff_stage_dress(stage, &look);
            ff_stage_draw(stage, raster, camera);
        }
        if (pass == 0) ff_raster_darken(raster);
    }
    draw_walls(scene, camera, raster);
    draw_obstacles(scene, recording->start + step * recording->step, camera, raster);
}
