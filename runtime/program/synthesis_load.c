#include "runtime/program/synthesis_load.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/base/random.h"
#include "runtime/core/gait/gait_hips.h"
#include "runtime/core/gait/leg_pose.h"

#include <stdlib.h>
#include <string.h>

#define STEP (1.0 / 30.0) /* s */
#define LANES_MOST 32

/* One motion of a character. */
typedef struct sample {
    uint32_t first_frame, frame_count;
    double place, pace; /* frames; per step */
    double weight;
} sample;

typedef struct character {
    sample sample[FF_LOAD_SAMPLES];
    ff_vec3 hips; /* m */
} character;

struct ff_synthesis_load {
    ff_blend_space *space;
    ff_pose_store store;
    ff_pose_tree tree;
    int32_t parents[FF_LOAD_JOINTS];
    float offsets[3 * LANES_MOST];
    uint32_t count;
    character *characters;
    ff_matrix *out; /* [count][joints] */
};

/* The joint of the pack that shows how joint turns. */
static uint32_t model_of(uint32_t joint)
{
    static const uint32_t like[10] = {FF_JOINT_WRIST_L, FF_JOINT_ELBOW_L, FF_JOINT_WRIST_L, FF_JOINT_ELBOW_L,
                                      FF_JOINT_WRIST_L, FF_JOINT_WRIST_R, FF_JOINT_ELBOW_R, FF_JOINT_WRIST_R,
                                      FF_JOINT_ELBOW_R, FF_JOINT_WRIST_R};
    return joint < FF_JOINT_COUNT ? joint : like[joint - FF_JOINT_COUNT];
}

static void make_tree(ff_synthesis_load *load, uint32_t joints, uint32_t lanes)
{
    for (uint32_t j = 0; j < joints; ++j) {
        bool finger = j >= FF_JOINT_COUNT, left = j < FF_JOINT_COUNT + 5;
        load->parents[j] = !finger ? ff_joint_parents[j] : left ? FF_JOINT_WRIST_L : FF_JOINT_WRIST_R;
        ff_vec3 offset =
            finger ? ff_v3(left ? 0.09 : -0.09, 0.0, 0.02 * (j % 5) - 0.04) : load->space->body.offset[j];
        load->offsets[j] = (float)offset.x;
        load->offsets[lanes + j] = (float)offset.y;
        load->offsets[2 * lanes + j] = (float)offset.z;
    }
    load->tree = (ff_pose_tree){load->parents, load->offsets, joints, lanes};
}

static void copy_poses(ff_synthesis_load *load, uint32_t frames)
{
    const ff_pose_store *from = &load->space->poses;
    for (uint32_t k = 0; k < frames; ++k)
        for (uint32_t j = 0; j < load->tree.joint_count; ++j)
            for (uint32_t part = 0; part < 4; ++part)
                ff_pose_frame(&load->store, k)[part * load->store.lanes + j] =
                    ff_pose_frame(from, k)[part * from->lanes + model_of(j)];
}

static void draw_character(const ff_blend_space *space, ff_random *random, character *out)
{
    double sum = 0.0;
    for (int i = 0; i < FF_LOAD_SAMPLES; ++i) {
        sample *s = &out->sample[i];
        const ff_blend_vertex *vertex =
            &space->vertices[(uint32_t)ff_random_range(random, 0.0, space->walk_count)];
        s->first_frame = vertex->first_frame;
        s->frame_count = vertex->frame_count;
        s->place = ff_random_range(random, 0.0, vertex->frame_count);
        s->pace = vertex->rate * STEP;
        s->weight = 0.1 + ff_random_unit(random);
        sum += s->weight;
    }
    for (int i = 0; i < FF_LOAD_SAMPLES; ++i)
        out->sample[i].weight /= sum;
    out->hips = ff_v3(ff_random_range(random, -50.0, 50.0), 0.0, ff_random_range(random, -50.0, 50.0));
}

static ff_status fill(ff_synthesis_load *load, const ff_pack *pack, uint32_t joints, ff_error *error)
{
    uint32_t lanes = (joints + 7) / 8 * 8, frames = pack->foot_count / 2;
    ff_random random = {31, joints, 0};
    load->store.lanes = lanes;
    load->store.keys = ff_calloc(frames, 4 * lanes * sizeof *load->store.keys);
    load->characters = ff_calloc(load->count, sizeof *load->characters);
    load->out = ff_calloc((size_t)load->count * joints, sizeof *load->out);
    if (!load->store.keys || !load->characters || !load->out)
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u characters", load->count);
    make_tree(load, joints, lanes);
    copy_poses(load, frames);
    for (uint32_t i = 0; i < load->count; ++i) {
        draw_character(load->space, &random, &load->characters[i]);
        load->characters[i].hips.y = load->space->body.offset[FF_JOINT_HIPS].y - 0.04;
    }
    return FF_OK;
}

ff_status ff_synthesis_load_create(const ff_pack *pack, uint32_t joints, uint32_t characters,
                                   ff_synthesis_load **out, ff_error *error)
{
    *out = NULL;
    if (joints < FF_JOINT_COUNT || joints > FF_LOAD_JOINTS)
        return ff_fail(error, FF_ERR_ARGUMENT, "%u joints; expected %d to %d", joints, FF_JOINT_COUNT,
                       FF_LOAD_JOINTS);
    ff_synthesis_load *load = ff_calloc(1, sizeof *load);
    if (!load) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u characters", characters);
    load->count = characters;
    ff_status status = ff_blend_space_create(pack, &load->space, error);
    if (status == FF_OK) status = fill(load, pack, joints, error);
    if (status != FF_OK) {
        ff_synthesis_load_destroy(load);
        return status;
    }
    *out = load;
    return FF_OK;
}

void ff_synthesis_load_destroy(ff_synthesis_load *load)
{
    if (!load) return;
    ff_blend_space_destroy(load->space);
    free(load->store.keys);
    free(load->characters);
    free(load->out);
    free(load);
}

/* Where the four motions are now, and on to the next step. */
static void sample_motions(character *c, ff_pose_mix *mix)
{
    mix->count = 0;
    for (int i = 0; i < FF_LOAD_SAMPLES; ++i) {
        sample *s = &c->sample[i];
        uint32_t frame = (uint32_t)s->place, next = frame + 1 < s->frame_count ? frame + 1 : 0;
        double on = s->weight * (s->place - frame);
        ff_pose_mix_add(mix, s->first_frame + frame, s->first_frame + next, s->weight - on, on);
        s->place += s->pace;
        if (s->place >= s->frame_count) s->place -= s->frame_count;
    }
}

/* Both feet flat, a little off where the blend has them: the left one stands, the right one swings. */
static void bring_legs(const ff_blend_space *space, ff_vec3 hips, uint32_t lane_count, float *lanes)
{
    ff_quat rotations[FF_JOINT_COUNT];
    ff_pose_rotations(lanes, lane_count, FF_JOINT_HIPS, 1, rotations);
    ff_pose_rotations(lanes, lane_count, FF_JOINT_HIP_L, 2 * FF_JOINT_LEG_STRIDE, rotations + FF_JOINT_HIP_L);
    ff_legs legs;
    ff_leg_target target[2];
    ff_legs_of_clip(&space->body, hips, rotations, &legs);
    for (int foot = 0; foot < 2; ++foot) {
        ff_vec3 ankle = ff_pair3_half(legs.ankle, foot);
        ff_vec3 to_ball = space->body.offset[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
        ff_foothold ball = {ankle.z + to_ball.z + 0.02, ankle.x + to_ball.x,
                            space->body.ball_rest + 0.05 * foot, 0.1};
        target[foot] = (ff_leg_target){.ball = ball,
                                       .turn = ff_gait_foot_rotation(0.1, 0.0),
                                       .most_raise = 1.0,
                                       .grip = 1.0 - foot,
                                       .swing = 0.5 * foot};
    }
    ff_legs_pose(&space->body, target, &legs, rotations);
    float *x = lanes, *y = x + lane_count, *z = y + lane_count, *w = z + lane_count;
    for (int j = FF_JOINT_HIP_L; j < FF_JOINT_COUNT; ++j) {
        x[j] = (float)rotations[j].x;
        y[j] = (float)rotations[j].y;
        z[j] = (float)rotations[j].z;
        w[j] = (float)rotations[j].w;
    }
}

void ff_synthesis_load_run(ff_synthesis_load *load, bool simd, bool legs)
{
    float lanes[4 * LANES_MOST];
    ff_pose_mix mix;
    for (uint32_t i = 0; i < load->count; ++i) {
        character *c = &load->characters[i];
        ff_matrix *out = load->out + (size_t)i * load->tree.joint_count;
        const ff_pose_root root = {{(float)c->hips.x, (float)c->hips.y, (float)c->hips.z}, 1.0f};
        sample_motions(c, &mix);
        if (simd)
            ff_pose_blend(&load->store, &mix, lanes);
        else
            ff_pose_blend_plain(&load->store, &mix, lanes);
        if (legs) bring_legs(load->space, c->hips, load->store.lanes, lanes);
        if (simd)
            ff_pose_matrices(&load->tree, lanes, &root, out);
        else
            ff_pose_matrices_plain(&load->tree, lanes, &root, out);
    }
}

double ff_synthesis_load_sum(const ff_synthesis_load *load)
{
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)load->count * load->tree.joint_count; ++i)
        for (int k = 0; k < 12; ++k)
            sum += (double)load->out[i].row[k / 4][k % 4];
    return sum;
}
