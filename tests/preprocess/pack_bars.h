/* pack_bars.h - how well the examples of a pack are closed and correspond, measured on the pack's own poses and not taken
 * from what it says of itself, save how far closing moved joints, which only the builder can know. */
#ifndef FF_PACK_BARS_H
#define FF_PACK_BARS_H

#include "preprocess/examples/correspond.h"
#include "preprocess/examples/example_judge.h"
#include "preprocess/report/pack_read.h"

#include <stdio.h>

typedef struct ff_pack_bars {
    double jump;     /* m, of any joint over the end of a cycle */
    double moved[2]; /* m, by closing: straight walks, others */
    double kick;     /* velocity difference at the cut as a share of that at a contact */
    double rms[2];   /* m, worst pair: both straight walks, others */
    double wait[2];  /* s, longest */
    uint32_t found[2], possible[2], pairs[2], by_keys;
    double stored;     /* m, largest difference of a stored rms from the measured one */
    uint32_t disorder; /* correspondences that do not go around once */
} ff_pack_bars;

static inline bool ff_bars_straight(const ff_pack_example *e)
{
    return e->gait == FF_GAIT_WALK && !(e->flags & FF_EXAMPLE_IDLE) && e->v_left == 0.0f &&
           e->turn_rate == 0.0f;
}

/* Joints of a pose of the pack at a phase, in the root's frame. */
static inline void ff_bars_pose(const ff_pack *pack, uint32_t index, double phase, ff_vec3 *at)
{
    const ff_pack_example *e = &pack->examples[index];
    ff_quat world[FF_ROLE_JOINT_COUNT];
    ff_vec3 hips;
    if (ff_pack_sample(pack, e->stream, phase * ff_pack_stream_seconds(pack, e->stream), 0, NULL, &hips,
                       world, NULL) != FF_OK)
        abort();
    at[0] = hips;
    for (uint32_t j = 1; j < FF_ROLE_JOINT_COUNT; ++j) {
        int32_t parent = ff_pack_joint_parent(pack, j);
        at[j] = ff_add3(at[parent], ff_quat_rotate(world[parent], ff_pack_joint_offset(pack, j)));
        world[j] = ff_quat_mul(world[parent], world[j]);
    }
}

/* Root mean square distance of the joints after the best turn and shift on the ground, written down once more: the plane
 * parts as complex numbers. */
static inline double ff_bars_rms(const ff_vec3 *p, const ff_vec3 *q)
{
    double n = FF_ROLE_JOINT_COUNT, px = 0, pz = 0, qx = 0, qz = 0, re = 0, im = 0, square = 0;
    for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j)
        px += p[j].x / n, pz += p[j].z / n, qx += q[j].x / n, qz += q[j].z / n;
    for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j) {
        double ax = p[j].x - px, az = p[j].z - pz, bx = q[j].x - qx, bz = q[j].z - qz, up = p[j].y - q[j].y;
        re += ax * bx + az * bz;
        im += ax * bz - az * bx;
        square += ax * ax + az * az + bx * bx + bz * bz + up * up;
    }
    return sqrt(ff_max(square - 2.0 * sqrt(re * re + im * im), 0.0) / n);
}

static inline void ff_bars_loops(const ff_pack *pack, ff_pack_bars *out)
{
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        ff_vec3 first[FF_ROLE_JOINT_COUNT], last[FF_ROLE_JOINT_COUNT];
        const ff_pack_loop *loop = &pack->loops[i];
        int other = !ff_bars_straight(&pack->examples[i]);
        ff_bars_pose(pack, i, 0.0, first);
        ff_bars_pose(pack, i, 1.0 - 1e-5, last);
        for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j)
            out->jump = ff_max(out->jump, ff_length3(ff_sub3(first[j], last[j])));
        out->jump = ff_max(out->jump, (double)loop->jump);
        out->moved[other] = ff_max(out->moved[other], (double)loop->moved);
        if (!(pack->examples[i].flags & FF_EXAMPLE_IDLE) && loop->cut_kick > 0.0f)
            out->kick = ff_max(out->kick, (double)loop->cut_kick / (double)loop->contact_kick);
    }
}

/* The semi-procedural clip at an example's rates, at a phase. */
static inline void ff_bars_gait_pose(const ff_pack *pack, const ff_rig *rig, uint32_t index, double phase,
                                     ff_vec3 *at)
{
    ff_example e;
    ff_vec3 body[FF_BODY_COUNT], next[FF_BODY_COUNT];
    if (ff_pack_play_gait(pack, rig, index, &e, NULL) != FF_OK) abort();
    double frame = phase * e.frame_count;
    ff_example_pose(rig, &e, (int)frame % e.frame_count, body);
    ff_example_pose(rig, &e, ((int)frame + 1) % e.frame_count, next);
    for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j)
        at[j] = ff_lerp3(body[j], next[j], frame - floor(frame));
    ff_example_free(&e);
}

static inline void ff_bars_correspondence(const ff_pack *pack, const ff_rig *rig,
                                          const ff_pack_correspondence *c, ff_pack_bars *out)
{
    bool gait = c->to == FF_CORRESPOND_GAIT, straight = ff_bars_straight(&pack->examples[c->from]);
    if (!gait) straight = straight && ff_bars_straight(&pack->examples[c->to]);
    int kind = !straight;
    double around[2] = {0.0, 0.0};
    for (uint32_t k = 0; k < c->pair_count; ++k) {
        const ff_pack_pair *pair = &pack->pairs[c->first_pair + k];
        const ff_pack_pair *next = &pack->pairs[c->first_pair + (k + 1) % c->pair_count];
        ff_vec3 p[FF_ROLE_JOINT_COUNT], q[FF_ROLE_JOINT_COUNT];
        ff_bars_pose(pack, c->from, (double)pair->phase[0], p);
        if (gait) {
            ff_bars_gait_pose(pack, rig, c->from, (double)pair->phase[1], q);
        } else {
            ff_bars_pose(pack, c->to, (double)pair->phase[1], q);
        }
        double rms = ff_bars_rms(p, q);
        out->rms[kind] = ff_max(out->rms[kind], rms);
        out->stored = ff_max(out->stored, rms - (double)pair->rms);
        for (int side = 0; side < 2; ++side) {
            double step = (double)next->phase[side] - (double)pair->phase[side];
            around[side] += step - floor(step);
        }
    }
    if (c->pair_count > 1 && (fabs(around[0] - 1.0) > 1e-6 || fabs(around[1] - 1.0) > 1e-6)) ++out->disorder;
    ++out->found[kind];
    out->pairs[kind] += c->pair_count;
    out->by_keys += c->flags & FF_CORRESPOND_KEYS;
    /* Who stands may go at any time: his loop has no moment of its own. */
    if (!(pack->examples[c->from].flags & FF_EXAMPLE_IDLE))
        out->wait[kind] = ff_max(out->wait[kind], ff_max((double)c->wait[0], (double)c->wait[1]));
}

static inline ff_pack_bars ff_bars_measure(const ff_pack *pack)
{
    ff_pack_bars out = {.jump = 0.0};
    ff_rig rig;
    ff_pack_read_rig(pack, &rig);
    ff_bars_loops(pack, &out);
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        bool straight = ff_bars_straight(&pack->examples[i]);
        for (uint32_t k = i + 1; k < pack->example_count; ++k)
            ++out.possible[!(straight && ff_bars_straight(&pack->examples[k]))];
        if (pack->examples[i].gait == FF_GAIT_WALK) ++out.possible[!straight];
    }
    for (uint32_t i = 0; i < pack->correspondence_count; ++i)
        ff_bars_correspondence(pack, &rig, &pack->correspondences[i], &out);
    return out;
}

static inline void ff_bars_print(const ff_pack_bars *b)
{
    static const char *const names[2] = {"straight walks", "everything else"};
    printf("  loops: jump %.3f mm (limit 1); closing moved %.1f cm in straight walks (2), %.1f elsewhere "
           "(5); velocities at "
           "the cut %.2f of a contact's (1)\n",
           1000.0 * b->jump, 100.0 * b->moved[0], 100.0 * b->moved[1], b->kick);
    for (int kind = 0; kind < 2; ++kind)
        printf("  correspondences, %s: %u of %u, %.1f pairs each, worst rms %.1f cm (limit %.0f), longest "
               "wait %.2f s\n",
               names[kind], b->found[kind], b->possible[kind],
               b->pairs[kind] / (double)(b->found[kind] ? b->found[kind] : 1), 100.0 * b->rms[kind],
               kind ? 10.0 : 8.0, b->wait[kind]);
    printf("  %u by keys; %u out of order\n", b->by_keys, b->disorder);
}

/* Poses in the pack are quantised by up to 2 mm, which a pair just within a limit may show. */
#define FF_BARS_SLACK 0.002

static inline bool ff_bars_met(const ff_pack_bars *b)
{
    return b->jump <= FF_LOOP_JUMP && b->moved[0] <= FF_LOOP_MOVED_STRAIGHT && b->moved[1] <= FF_LOOP_MOVED &&
           b->kick <= 1.0 && b->rms[0] <= FF_PAIR_LIMIT_STRAIGHT + FF_BARS_SLACK &&
           b->rms[1] <= FF_PAIR_LIMIT + FF_BARS_SLACK && b->disorder == 0;
}

#endif
