/* walker_pack.h - packs for tests whose every foot is known in closed form: walkers on a grid of rates, feet planted
 * exactly, joined by Kuhn's subdivision of the grid into tetrahedra. */
#ifndef FF_TEST_WALKER_PACK_H
#define FF_TEST_WALKER_PACK_H

#include "preprocess/pack/pose_encode.h"
#include "runtime/core/gait/leg_ik.h"
#include "runtime/core/gait/synth.h"
#include "runtime/core/pack/joints.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct ff_walker_grid {
    int count[3];
    double axis[3][8]; /* forward, left, turn; each increasing, with 0 among them */
    double rate;       /* frames per second */
} ff_walker_grid;

static const ff_walker_grid ff_walker_grid_full = {
    {5, 3, 3}, {{-0.8, 0.0, 0.6, 1.2, 1.8}, {-0.5, 0.0, 0.5}, {-1.4, 0.0, 1.4}}, 60.0};
static const ff_walker_grid ff_walker_grid_small = {
    {3, 3, 3}, {{-0.6, 0.0, 1.2}, {-0.5, 0.0, 0.5}, {-1.4, 0.0, 1.4}}, 15.0};
static const ff_walker_grid ff_walker_grid_tiny = {{2, 1, 1}, {{0.0, 1.2}, {0.0}, {0.0}}, 8.0};

#define FF_WALKER_BALL_REST 0.02
#define FF_WALKER_HIPS 0.93
#define FF_WALKER_AHEAD 0.08  /* m, of the balls before the hips when standing */
#define FF_WALKER_STANCE 0.62 /* of the cycle */

static const double ff_walker_offsets[FF_JOINT_COUNT][3] = {
    {0, FF_WALKER_HIPS, 0}, {0, 0.1, 0},      {0, 0.25, 0},      {0, 0.2, 0},      {0, 0.1, 0.02},
    {0.03, 0.15, 0},        {0.14, 0, 0},     {0.28, 0, 0},      {0.25, 0, 0},     {-0.03, 0.15, 0},
    {-0.14, 0, 0},          {-0.28, 0, 0},    {-0.25, 0, 0},     {0.09, -0.03, 0}, {0, -0.41, 0},
    {0, -0.41, 0},          {0, -0.06, 0.13}, {-0.09, -0.03, 0}, {0, -0.41, 0},    {0, -0.41, 0},
    {0, -0.06, 0.13}};
static const double ff_walker_points[FF_POINT_COUNT][4] = {
    {FF_JOINT_HEAD, 0, 0.2, 0},         {FF_JOINT_WRIST_L, 0.15, 0, 0},
    {FF_JOINT_WRIST_R, -0.15, 0, 0},    {FF_JOINT_BALL_L, 0, -0.02, 0.06},
    {FF_JOINT_BALL_R, 0, -0.02, 0.06},  {FF_JOINT_ANKLE_L, 0, -0.06, -0.05},
    {FF_JOINT_ANKLE_R, 0, -0.06, -0.05}};

static inline void *ff_walker_push(ff_array *array, size_t count, size_t size)
{
    void *at = ff_array_grow(array, count, size);
    if (!at) abort();
    memset(at, 0, count * size);
    return at;
}

static inline void ff_walker_skeleton(ff_pack_content *content)
{
    ff_pack_joint *joint = ff_walker_push(&content->joints, FF_JOINT_COUNT, sizeof *joint);
    ff_pack_point *point = ff_walker_push(&content->points, FF_POINT_COUNT, sizeof *point);
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        char name[24];
        snprintf(name, sizeof name, "joint%d", j);
        joint[j] = (ff_pack_joint){ff_joint_parents[j], ff_pack_add_string(content, name), {0}, 0.05f};
        for (int i = 0; i < 3; ++i)
            joint[j].offset[i] = (float)ff_walker_offsets[j][i];
    }
    for (int p = 0; p < FF_POINT_COUNT; ++p) {
        point[p].joint = (int32_t)ff_walker_points[p][0];
        point[p].kind = (uint32_t)p;
        for (int i = 0; i < 3; ++i)
            point[p].offset[i] = (float)ff_walker_points[p][i + 1];
    }
}

/* A foot of the closed-form walk, in the root frame. */
typedef struct ff_walker_foot {
    double forward, left, height, yaw, pitch;
} ff_walker_foot;

/* A ball that stands in the world, seen from a root that moves at constant rates and passed it (beside it by `aside`)
 * time seconds ago. */
static inline ff_vec2 ff_walker_standing(ff_rates rates, double aside, double time)
{
    double turn = rates.turn * time, s = fabs(turn) > 1e-9 ? sin(turn) / rates.turn : time;
    double c = fabs(turn) > 1e-9 ? (1.0 - cos(turn)) / rates.turn : 0.0;
    ff_vec2 moved = ff_v2(rates.forward * s - rates.left * c, rates.forward * c + rates.left * s);
    return ff_to_frame2(ff_fwd2(turn), ff_sub2(ff_v2(FF_WALKER_AHEAD, aside), moved));
}

static inline ff_walker_foot ff_walker_foot_at(ff_rates rates, double period, int foot, double fraction,
                                               bool idle)
{
    double aside = foot == 0 ? 0.09 : -0.09, toe_out = foot == 0 ? 0.1 : -0.1;
    if (idle) return (ff_walker_foot){FF_WALKER_AHEAD, aside, FF_WALKER_BALL_REST, toe_out, 0.0};
    double x = fraction - 0.5 * foot;
    x -= floor(x);
    double half = 0.5 * FF_WALKER_STANCE * period, pace = ff_clamp(fabs(rates.forward), 0.15, 1.3) / 1.3;
    double early = 1.0 - ff_smooth(x / 0.08), late = ff_smooth((x - 0.38) / (FF_WALKER_STANCE - 0.38));
    ff_walker_foot at;
    ff_vec2 place;
    if (x < FF_WALKER_STANCE) {
        double time = x * period - half;
        place = ff_walker_standing(rates, aside, time);
        at.yaw = toe_out - rates.turn * time;
        at.pitch = pace * (0.4 * early - 1.05 * late);
        at.height = FF_WALKER_BALL_REST + 0.18 * sin(ff_max(at.pitch, 0.0));
    } else {
        double s = (x - FF_WALKER_STANCE) / (1.0 - FF_WALKER_STANCE), h = ff_smooth(s);
        double span = (1.0 - FF_WALKER_STANCE) * period, e = 1e-4;
        ff_vec2 p = ff_walker_standing(rates, aside, half), q = ff_walker_standing(rates, aside, -half);
        ff_vec2 dp = ff_scale2(ff_sub2(p, ff_walker_standing(rates, aside, half - e)), span / e);
        ff_vec2 dq = ff_scale2(ff_sub2(ff_walker_standing(rates, aside, e - half), q), span / e);
        double h10 = s * (1.0 - s) * (1.0 - s), h11 = -s * s * (1.0 - s);
        place = ff_add2(ff_add2(ff_scale2(p, 1.0 - h), ff_scale2(q, h)),
                        ff_add2(ff_scale2(dp, h10), ff_scale2(dq, h11)));
        at.yaw = toe_out + rates.turn * half * (2.0 * h - 1.0);
        at.pitch = pace * (-1.05 * (1.0 - ff_smooth(s / 0.7)) + 0.4 * ff_smooth((s - 0.5) / 0.5));
        at.height =
            FF_WALKER_BALL_REST + 0.06 * sin(FF_PI * s) * sin(FF_PI * s) + 0.18 * sin(ff_max(at.pitch, 0.0));
    }
    at.forward = place.a;
    at.left = place.b;
    return at;
}

static inline ff_vec3 ff_walker_offset(int joint)
{
    return ff_v3(ff_walker_offsets[joint][0], ff_walker_offsets[joint][1], ff_walker_offsets[joint][2]);
}

static inline void ff_walker_leg(ff_vec3 hips, ff_walker_foot at, int foot, ff_quat *rotations)
{
    int j = FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE;
    ff_quat turn = ff_quat_mul(ff_quat_yaw(at.yaw), ff_quat_axis(ff_v3(1, 0, 0), -at.pitch));
    ff_vec3 ankle =
        ff_sub3(ff_v3(at.left, at.height, at.forward), ff_quat_rotate(turn, ff_walker_offset(j + 3)));
    ff_leg leg;
    leg.thigh = ff_quat_axis(ff_v3(1, 0, 0), -0.3);
    leg.shank = ff_quat_axis(ff_v3(1, 0, 0), 0.3);
    leg.hip = ff_add3(hips, ff_walker_offset(j));
    leg.knee = ff_add3(leg.hip, ff_quat_rotate(leg.thigh, ff_walker_offset(j + 1)));
    leg.ankle = ff_add3(leg.knee, ff_quat_rotate(leg.shank, ff_walker_offset(j + 2)));
    ff_leg_solve(&leg, leg.hip, ankle);
    rotations[j] = leg.thigh;
    rotations[j + 1] = ff_quat_mul(ff_quat_conj(leg.thigh), leg.shank);
    rotations[j + 2] = ff_quat_mul(ff_quat_conj(leg.shank), turn);
}

#define FF_WALKER_MOST_FRAMES 256

/* The poses of one example. */
typedef struct ff_walker_poses {
    ff_vec3 hips[FF_WALKER_MOST_FRAMES];
    ff_quat rotations[FF_WALKER_MOST_FRAMES][FF_JOINT_COUNT];
} ff_walker_poses;

static inline uint32_t ff_walker_stream(ff_pack_content *content, const ff_pose_motion *motion)
{
    ff_pose_coded coded;
    uint32_t index;
    if (ff_pose_encode(content->joints.data, content->points.data, motion, &coded, NULL) != FF_OK ||
        ff_pack_add_stream(content, &coded, motion->frame_count, 1.0 / motion->frame_time, &index, NULL) !=
            FF_OK)
        abort();
    ff_pose_coded_free(&coded);
    return index;
}

static inline void ff_walker_frame(ff_pack_content *content, ff_rates rates, double period, double fraction,
                                   bool idle, ff_vec3 *hips_out, ff_quat *rotations)
{
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        rotations[j] = FF_QUAT_IDENTITY;
    double pace = idle ? 0.0 : ff_min(fabs(rates.forward), 1.5);
    double bob = -0.012 * pace * cos(2.0 * FF_TAU * (fraction - 0.02)), sway = 0.02 * sin(FF_TAU * fraction);
    ff_vec3 hips = ff_v3(idle ? 0.2 * sway : sway, FF_WALKER_HIPS - 0.02 - 0.025 * pace + bob, 0.0);
    for (int foot = 0; foot < 2; ++foot) {
        ff_walker_foot at = ff_walker_foot_at(rates, period, foot, fraction, idle);
        ff_pack_foot *out = ff_walker_push(&content->feet, 1, sizeof *out);
        *out = (ff_pack_foot){
            {(float)at.forward, (float)at.left, (float)at.height}, (float)at.yaw, (float)at.pitch};
        ff_walker_leg(hips, at, foot, rotations);
        double side = foot == 0 ? 1.0 : -1.0, swing = side * 0.35 * pace * cos(FF_TAU * fraction);
        int shoulder = foot == 0 ? FF_JOINT_SHOULDER_L : FF_JOINT_SHOULDER_R;
        rotations[shoulder] =
            ff_quat_mul(ff_quat_axis(ff_v3(1, 0, 0), swing), ff_quat_axis(ff_v3(0, 0, 1), -side * 1.45));
    }
    *hips_out = ff_v3(hips.z, hips.x, hips.y);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        rotations[j] = ff_quat_unit(rotations[j]);
}

static inline void ff_walker_example(ff_pack_content *content, const ff_walker_grid *grid, ff_rates rates,
                                     bool idle)
{
    double wanted = idle ? 2.0
                         : 1.25 - 0.15 * ff_min(fabs(rates.forward), 1.8) -
                               0.2 * (fabs(rates.left) + 0.5 * fabs(rates.turn));
    uint32_t frames = (uint32_t)(wanted * grid->rate + 0.5);
    double period = frames / grid->rate;
    static ff_walker_poses poses;
    for (uint32_t i = 0; i < frames; ++i)
        ff_walker_frame(content, rates, period, (double)i / frames, idle, &poses.hips[i], poses.rotations[i]);
    ff_pose_motion motion = {.frame_count = (int)frames,
                             .frame_time = 1.0 / grid->rate,
                             .cyclic = true,
                             .hips = poses.hips,
                             .rotations = poses.rotations[0]};
    ff_pack_example *example = ff_walker_push(&content->examples, 1, sizeof *example);
    example->name = ff_pack_add_string(content, idle ? "idle" : "walk");
    example->stream = ff_walker_stream(content, &motion);
    example->gait = FF_GAIT_WALK;
    example->flags = idle ? FF_EXAMPLE_IDLE : FF_EXAMPLE_DERIVED;
    example->period = (float)period;
    example->v_forward = (float)rates.forward;
    example->v_left = (float)rates.left;
    example->turn_rate = (float)rates.turn;
    static const float keys[2][4] = {{0.0f, 0.12f, 0.5f, 0.62f}, {0.0f, 0.1f, 0.5f, 0.6f}};
    memcpy(example->key, keys[idle], sizeof example->key);
    static const float locks[2][2][2] = {{{0.08f, 0.57f}, {0.58f, 0.07f}}, {{0.0f, -1.0f}, {0.0f, -1.0f}}};
    memcpy(example->lock, locks[idle], sizeof example->lock);
}

static inline int32_t ff_walker_index(const ff_walker_grid *grid, const int at[3])
{
    return (at[0] * grid->count[1] + at[1]) * grid->count[2] + at[2];
}

/* Kuhn: along each of the 6 orders of the axes from one corner of the cell to the other. A flat axis is skipped, which
 * leaves triangles or segments. */
static inline void ff_walker_cell(ff_pack_content *content, const ff_walker_grid *grid, const int corner[3])
{
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int o = 0; o < 6; ++o) {
        int at[3] = {corner[0], corner[1], corner[2]}, count = 0;
        ff_pack_simplex simplex = {{-1, -1, -1, -1}, FF_GAIT_WALK};
        simplex.vertex[count++] = ff_walker_index(grid, at);
        for (int i = 0; i < 3; ++i) {
            if (grid->count[orders[o][i]] == 1) continue;
            ++at[orders[o][i]];
            simplex.vertex[count++] = ff_walker_index(grid, at);
        }
        ff_pack_simplex *out = ff_walker_push(&content->simplices, 1, sizeof *out);
        *out = simplex;
    }
}

/* A clip of two frames with a plant and an action, so that no section is empty. */
static inline void ff_walker_clip(ff_pack_content *content)
{
    uint32_t name = ff_pack_add_string(content, "clip");
    const ff_vec3 root[2] = {{0.0, 0.0, 0.0}, {0.02, 0.0, 0.01}},
                  hips[2] = {{0.0, 0.0, 0.9}, {0.0, 0.0, 0.9}};
    ff_quat rotations[2 * FF_JOINT_COUNT];
    for (int j = 0; j < 2 * FF_JOINT_COUNT; ++j)
        rotations[j] = FF_QUAT_IDENTITY;
    ff_pose_motion motion = {
        .frame_count = 2, .frame_time = 1.0 / 60.0, .root = root, .hips = hips, .rotations = rotations};
    ff_pack_clip *clip = ff_walker_push(&content->clips, 1, sizeof *clip);
    *clip = (ff_pack_clip){.name = name,
                           .stream = ff_walker_stream(content, &motion),
                           .plant_count = 1,
                           .action_count = 1,
                           .source_rate = 120.0f};
    ff_pack_plant *plant = ff_walker_push(&content->plants, 1, sizeof *plant);
    *plant = (ff_pack_plant){.end = 0.5f, .flat_start = 0.1f, .flat_end = 0.4f, .confidence = 1.0f};
    ff_pack_action *action = ff_walker_push(&content->actions, 1, sizeof *action);
    *action = (ff_pack_action){
        .swing = 1, .t_end = 0.5f, .duration = 0.5f, .collider_samples = 1, .swing_plant = UINT32_MAX};
    ff_walker_push(&content->reach, 1, sizeof(ff_pack_reach));
    ff_walker_push(&content->colliders, FF_COLLIDER_COUNT, sizeof(ff_pack_collider));
    float *radius = ff_walker_push(&content->collider_radii, FF_COLLIDER_COUNT, sizeof *radius);
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c)
        radius[c] = 0.1f;
}

/* Three actions instead of the one: a step with either foot and a stand, which follow each other, with events. After
 * ff_walker_content. */
static inline void ff_walker_steps(ff_pack_content *content)
{
    enum { ACTIONS = 3, SAMPLES = 3, EVENTS = 2 };
    content->actions.count = content->colliders.count = 0;
    ((ff_pack_clip *)content->clips.data)->action_count = ACTIONS;
    ff_pack_action *action = ff_walker_push(&content->actions, ACTIONS, sizeof *action);
    ff_pack_collider *collider =
        ff_walker_push(&content->colliders, ACTIONS * SAMPLES * FF_COLLIDER_COUNT, sizeof *collider);
    ff_pack_event *event = ff_walker_push(&content->events, ACTIONS * EVENTS, sizeof *event);
    ff_pack_successor *next = ff_walker_push(&content->successors, 2 * ACTIONS, sizeof *next);
    for (uint32_t i = 0; i < ACTIONS; ++i) {
        bool stand = i == 2;
        uint32_t support = i & 1u;
        float length = stand ? 0.0f : 0.6f, aside = support ? 0.18f : -0.18f;
        action[i] = (ff_pack_action){
            .mode = stand ? FF_MODE_IDLE : FF_MODE_WALK_LONG,
            .support = support,
            .swing = 1u - support,
            .flags = stand ? FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING : 0,
            .t_end = 0.5f,
            .duration = 0.5f,
            .root_displacement = {length, 0.0f},
            .speed = 2.0f * length,
            .swing_displacement = {2.0f * length, 0.0f},
            .step_length = length,
            .step_width = 0.18f,
            .root_start = {0.0f, 0.5f * aside, 0.0f},
            .root_end = {length, 0.5f * aside, 0.0f},
            .land = {length, aside, 0.0f},
            .energy = 1.5f,
            .flight = {-1.0f, -1.0f},
            .coarse_radius = 0.5f,
            .first_collider = i * SAMPLES * FF_COLLIDER_COUNT,
            .collider_samples = SAMPLES,
            .swing_plant = UINT32_MAX,
            .first_event = i * EVENTS,
            .event_count = EVENTS,
            .first_successor = 2 * i,
            .successor_count = 2,
        };
        for (uint32_t k = 0; k < SAMPLES * FF_COLLIDER_COUNT; ++k)
            collider[action[i].first_collider + k] =
                (ff_pack_collider){length * (float)(k / FF_COLLIDER_COUNT) / (SAMPLES - 1), 0.5f * aside,
                                   0.3f * (float)(k % FF_COLLIDER_COUNT)};
        event[i * EVENTS] = (ff_pack_event){0.1f, 1u - support, FF_EVENT_TOE_OFF, 0};
        event[i * EVENTS + 1] = (ff_pack_event){0.4f, 1u - support, FF_EVENT_CONTACT, 0};
        /* Who stands on the left foot lands on the right one: the action that stands on that, and the stand where it may. */
        uint32_t then = support ? 0u : 1u;
        next[2 * i] = (ff_pack_successor){then, 0.01f, 0.2f};
        next[2 * i + 1] = (ff_pack_successor){support || stand ? 2u : 1u, 0.02f, 0.4f};
    }
}

/* Loops, one correspondence of two pairs and one with the semi-procedural clip, whose numbers are plausible. */
static inline void ff_walker_gait(ff_pack_content *content)
{
    ff_walker_push(&content->loops, content->examples.count, sizeof(ff_pack_loop));
    ff_pack_pair *pair = ff_walker_push(&content->pairs, 3, sizeof *pair);
    pair[0].phase[0] = 0.1f, pair[0].phase[1] = 0.9f;
    pair[1].phase[0] = 0.6f, pair[1].phase[1] = 0.4f;
    pair[2].phase[0] = 0.5f, pair[2].phase[1] = 0.5f;
    ff_pack_correspondence *c = ff_walker_push(&content->correspondences, 2, sizeof *c);
    c[0] = (ff_pack_correspondence){.from = 0, .to = 1, .pair_count = 2, .wait = {0.5f, 0.5f}};
    c[1] = (ff_pack_correspondence){
        .from = 0, .to = FF_CORRESPOND_GAIT, .first_pair = 2, .pair_count = 1, .wait = {1.0f, 1.0f}};
    ff_pack_gait *gait = ff_walker_push(&content->gait, 1, sizeof *gait);
    *gait = (ff_pack_gait){.example = 1, .speed = 1.2f, .period = 1.1f, .stance = 0.62f, .ball_rest = 0.02f};
    ff_walker_push(&content->gait_path, FF_GAIT_SAMPLES, sizeof(ff_pack_gait_path));
    ff_pack_sharp *sharp = ff_walker_push(&content->sharp, 2, sizeof *sharp);
    sharp[0] = (ff_pack_sharp){{0.0f, 0.3f}, {-1.0f, 0.0f}, 1};
    sharp[1] = (ff_pack_sharp){{0.0f, -0.3f}, {1.0f, 0.0f}, -1};
}

/* Two levels of a surface: two triangles, then one. */
static inline void ff_walker_skin(ff_pack_content *content)
{
    ff_pack_skin *skin = ff_walker_push(&content->skins, 2, sizeof *skin);
    skin[0] = (ff_pack_skin){0, 4, 0, 2};
    skin[1] = (ff_pack_skin){4, 3, 2, 1};
    ff_pack_vertex *v = ff_walker_push(&content->vertices, 7, sizeof *v);
    for (int i = 0; i < 7; ++i)
        v[i] = (ff_pack_vertex){.position = {0.1f * (float)(i & 1), 0.1f * (float)(i & 2), 0.0f},
                                .normal = {0.0f, 0.0f, 1.0f},
                                .joints = {FF_JOINT_CHEST, FF_JOINT_SPINE},
                                .weights = {200, 55}};
    ff_pack_triangle *t = ff_walker_push(&content->triangles, 3, sizeof *t);
    t[0] = (ff_pack_triangle){{0, 1, 2}};
    t[1] = (ff_pack_triangle){{1, 3, 2}};
    t[2] = (ff_pack_triangle){{0, 1, 2}};
}

static inline void ff_walker_content(ff_pack_content *content, const ff_walker_grid *grid)
{
    memset(content, 0, sizeof *content);
    ff_walker_skeleton(content);
    for (int i = 0; i < grid->count[0]; ++i)
        for (int j = 0; j < grid->count[1]; ++j)
            for (int k = 0; k < grid->count[2]; ++k)
                ff_walker_example(content, grid,
                                  (ff_rates){grid->axis[0][i], grid->axis[1][j], grid->axis[2][k]}, false);
    ff_walker_example(content, grid, (ff_rates){0.0, 0.0, 0.0}, true);
    ff_walker_clip(content);
    for (int i = 0; i < (grid->count[0] > 1 ? grid->count[0] - 1 : 1); ++i)
        for (int j = 0; j < (grid->count[1] > 1 ? grid->count[1] - 1 : 1); ++j)
            for (int k = 0; k < (grid->count[2] > 1 ? grid->count[2] - 1 : 1); ++k)
                ff_walker_cell(content, grid, (const int[3]){i, j, k});
    static const ff_pack_point2 hull[4] = {{-0.8f, -0.5f}, {1.8f, -0.5f}, {1.8f, 0.5f}, {-0.8f, 0.5f}};
    memcpy(ff_walker_push(&content->hull, 4, sizeof *hull), hull, sizeof hull);
    ff_walker_push(&content->tracks, 2 * 2, sizeof(ff_pack_track));
    ff_walker_gait(content);
    ff_walker_skin(content);
    if (ff_pack_set_meta(content, "{}", NULL) != FF_OK) abort();
}

/* The pack as bytes (free() them) of a 64-byte aligned block. */
static inline void *ff_walker_image(const ff_walker_grid *grid, size_t *size)
{
    ff_pack_content content;
    void *data;
    ff_walker_content(&content, grid);
    if (ff_pack_image(&content, &data, size, NULL) != FF_OK) abort();
    ff_pack_content_free(&content);
    return data;
}

#endif
