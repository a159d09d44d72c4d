/* walker.h - a hand-made person who swings arms and legs, for the exporters' tests: no pack, no crowd. */
#ifndef FF_TEST_WALKER_H
#define FF_TEST_WALKER_H

#include "runtime/export/recording.h"
#include "runtime/export/scene.h"
#include "tests/check.h"

static const char *const walker_names[FF_JOINT_COUNT] = {
    "hips",          "spine",       "chest",      "neck",           "head",           "left clavicle",
    "left shoulder", "left elbow",  "left wrist", "right clavicle", "right shoulder", "right elbow",
    "right wrist",   "left hip",    "left knee",  "left ankle",     "left ball",      "right hip",
    "right knee",    "right ankle", "right ball"};

static inline void walker_figure(ff_figure *figure)
{
    static const double offsets[FF_JOINT_COUNT][3] = {
        {0, 0.95, 0},      {0, 0.11, -0.01}, {0, 0.13, 0},      {0, 0.25, 0},     {0, 0.08, 0.01},
        {0.03, 0.20, 0},   {0.15, -0.02, 0}, {0.29, 0, 0},      {0.25, 0, 0},     {-0.03, 0.20, 0},
        {-0.15, -0.02, 0}, {-0.29, 0, 0},    {-0.25, 0, 0},     {0.09, -0.05, 0}, {0, -0.42, 0},
        {0, -0.40, 0},     {0, -0.05, 0.13}, {-0.09, -0.05, 0}, {0, -0.42, 0},    {0, -0.40, 0},
        {0, -0.05, 0.13}};
    ff_vec3 joints[FF_JOINT_COUNT];
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        joints[j] = ff_v3(offsets[j][0], offsets[j][1], offsets[j][2]);
    ff_error error;
    FF_ASSERT_OK(
        ff_figure_from_joints(FF_JOINT_COUNT, ff_joint_parents, joints, walker_names, figure, &error), error);
}

/* A pose at phase (turns) of a make-believe walk. */
static inline void walker_pose(double phase, double heading, ff_quat *local)
{
    double swing = ff_sin(FF_TAU * phase);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        local[j] = FF_QUAT_IDENTITY;
    local[FF_JOINT_HIPS] = ff_quat_yaw(heading);
    for (int side = 0; side < 2; ++side) {
        double s = side == 0 ? swing : -swing, down = side == 0 ? -1.35 : 1.35;
        int shoulder = side == 0 ? FF_JOINT_SHOULDER_L : FF_JOINT_SHOULDER_R;
        int hip = FF_JOINT_HIP_L + side * FF_JOINT_LEG_STRIDE;
        local[shoulder] =
            ff_quat_mul(ff_quat_axis(ff_v3(1, 0, 0), 0.4 * s), ff_quat_axis(ff_v3(0, 0, 1), down));
        local[shoulder + 1] = ff_quat_axis(ff_v3(0, 1, 0), side == 0 ? -0.35 : 0.35);
        local[hip] = ff_quat_axis(ff_v3(1, 0, 0), -0.45 * s);
        local[hip + 1] =
            ff_quat_axis(ff_v3(1, 0, 0), ff_max(0.05, 0.5 * ff_cos(FF_TAU * phase + side * FF_PI)));
    }
}

/* Everybody of a scene walks straight to the goal at their speed and then stands. */
static inline void walker_record(const ff_scene *scene, double seconds, ff_recording *recording)
{
    ff_error error;
    uint32_t agents = ff_scene_agent_count(scene), steps = (uint32_t)(seconds / scene->step + 0.5);
    FF_ASSERT_OK(ff_recording_create(agents, FF_JOINT_COUNT, scene->step, steps + 1, recording, &error),
                 error);
    for (uint32_t k = 0; k <= steps; ++k) {
        FF_ASSERT_OK(ff_recording_begin(recording, &error), error);
        for (uint32_t i = 0; i < agents; ++i) {
            const ff_scene_agent *agent = &ff_scene_agents(scene)[i];
            ff_vec2 way = ff_sub2(agent->goal, agent->position);
            double length = ff_length2(way), gone = ff_min(length, k * scene->step * agent->preferred_speed);
            double phase = gone / 1.4;
            ff_agent_state state = {.position = ff_madd2(agent->position, ff_unit2(way), gone),
                                    .scale = 1.0 + 0.05 * (i % 3),
                                    .heading = agent->heading,
                                    .reached = gone >= length};
            state.planted[0] = fmod(phase + 0.25, 1.0) < 0.6;
            state.planted[1] = fmod(phase + 0.75, 1.0) < 0.6;
            ff_quat local[FF_JOINT_COUNT];
            walker_pose(phase, agent->heading, local);
            ff_recording_set_track(recording, i, &state);
            if (ff_recording_wants_pose(recording))
                ff_recording_set_pose(recording, i, ff_ground(state.position, 0.93), local);
        }
    }
}

static inline void walker_scene(const char *text, ff_scene *scene)
{
    ff_error error;
    ff_scene_def def;
    FF_ASSERT_OK(ff_scene_def_parse(text, strlen(text), "scene.json", &def, &error), error);
    FF_ASSERT_OK(ff_scene_create(&def, scene, &error), error);
    ff_scene_def_free(&def);
}

#endif
