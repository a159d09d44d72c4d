/* From the pack's records to the vertices of a blend space. */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/gait/blend.h"
#include "runtime/core/pack/pose_stream.h"
#include "runtime/core/pose/posture.h"

#define RUN_RISE 0.006     /* m */
#define LEAST_RUN_LOCK 0.3 /* u */
#define LEAST_SECTION 0.02 /* of the cycle, of a run */
#define STILL                                                                                                \
    (30.0 * FF_DEG)   /* rad/s: a joint that is never faster is not really moved in the captures ... */
#define ANY_SPEED 1e3 /* rad/s: ... which tell nothing of how fast it may be */
#define IDLE_STEP_PERIOD 1.15 /* s: of steps taken where the blend is nearly idle (96 steps per minute) */

static ff_vec3 vec3_of(const float v[3])
{
    return ff_v3((double)v[0], (double)v[1], (double)v[2]);
}

void ff_body_frame_read(const ff_pack *pack, ff_body_frame *body)
{
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        body->offset[j] = vec3_of(pack->joints[j].offset);
    for (int foot = 0; foot < 2; ++foot) {
        int leg = FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE;
        body->thigh[foot] = ff_length3(body->offset[leg + 1]);
        body->shank[foot] = ff_length3(body->offset[leg + 2]);
        body->heel[foot] = vec3_of(pack->points[FF_POINT_HEEL_L + foot].offset);
        body->toe[foot] = vec3_of(pack->points[FF_POINT_TOE_L + foot].offset);
        ff_vec3 toe = body->toe[foot];
        body->toe_length[foot] = ff_max(sqrt(toe.z * toe.z + toe.y * toe.y), 1e-6);
        body->toe_flat[foot] = ff_atan2(toe.y, toe.z);
    }
    body->ball_rest = body->offset[FF_JOINT_HIPS].y;
    for (int j = FF_JOINT_HIP_L; j <= FF_JOINT_BALL_L; ++j)
        body->ball_rest += body->offset[j].y;
}

/* Phase u of a fraction of the cycle. */
static double phase_of(const ff_blend_vertex *vertex, double fraction)
{
    int k = FF_GAIT_KEYS - 1;
    while (k > 0 && fraction < vertex->key[k])
        --k;
    return k + (fraction - vertex->key[k]) / (vertex->key[k + 1] - vertex->key[k]);
}

static double wrap_phase(double u)
{
    return u - FF_GAIT_KEYS * floor(u / FF_GAIT_KEYS);
}

/* When each ball stands still. Where an example does not tell (idle) or tells nothing a step can be made of, the
 * usual times: flat 0.07 of a cycle after contact (0.04 in a run), released 0.05 before toe-off (gait facts; study,
 * section 2). */
static void read_locks(const ff_pack_example *example, ff_blend_vertex *vertex)
{
    bool run = example->gait == FF_GAIT_RUN;
    double usual = run ? 0.75 : 2.25, least = run ? 0.2 : 0.8, most = run ? 1.2 : 3.2;
    for (int foot = 0; foot < 2; ++foot) {
        double contact = 2.0 * foot, start = contact + (run ? 0.1 : 0.5), length = usual;
        if (!vertex->idle && example->lock[foot][1] >= 0.0f) {
            double from = phase_of(vertex, ff_clamp((double)example->lock[foot][0], 0.0, 1.0));
            double to = phase_of(vertex, (double)example->lock[foot][1]);
            double found = wrap_phase(to - from);
            double off = wrap_phase(from - contact + 1.0) - 1.0; /* after contact, from -1 to 3 */
            if (found > least && found < most && off < (run ? 0.8 : 1.5)) {
                start = contact + off;
                length = found;
            }
        }
        vertex->lock_start[foot] = start;
        vertex->lock_length[foot] = length;
    }
}

/* Who runs lifts the ball well before the toe leaves: held down to the end of the pack's locks, which allow it 3 cm, the leg
 * gets too long for it. So the lock ends where the ball has risen by RUN_RISE. */
static void shorten_lock(const ff_blend_space *space, ff_blend_vertex *vertex, int foot)
{
    double lowest = 1e9;
    for (int pass = 0; pass < 2; ++pass) {
        for (uint32_t i = 0; i < vertex->frame_count; ++i) {
            const ff_pack_foot *at = &space->pack->feet[2 * (vertex->first_frame + i) + (uint32_t)foot];
            double since =
                wrap_phase(phase_of(vertex, (double)i / vertex->frame_count) - vertex->lock_start[foot]);
            if (since >= vertex->lock_length[foot]) continue;
            if (pass == 0) lowest = ff_min(lowest, (double)at->ball[2]);
            if (pass == 1 && since > LEAST_RUN_LOCK && (double)at->ball[2] > lowest + RUN_RISE)
                vertex->lock_length[foot] = since;
        }
    }
}

/* Fractions at which the sections of a cycle begin. A run's order is that of its own steps: the pack's keys name the same
 * events for both gaits. False: a run whose keys are in no order to run by. */
static bool read_keys(const ff_pack_example *example, ff_blend_vertex *vertex)
{
    static const int order[FF_GAIT_COUNT][FF_GAIT_KEYS] = {{0, 1, 2, 3}, {0, 3, 2, 1}};
    bool rising = true;
    for (int k = 0; k < FF_GAIT_KEYS; ++k) {
        vertex->key[k] = (double)example->key[order[example->gait][k]];
        if (k > 0) rising = rising && vertex->key[k] - vertex->key[k - 1] > LEAST_SECTION;
    }
    vertex->key[FF_GAIT_KEYS] = 1.0;
    return example->gait == FF_GAIT_WALK ||
           (!vertex->idle && rising && vertex->key[FF_GAIT_KEYS - 1] < 1.0 - LEAST_SECTION);
}

static bool read_vertex(const ff_blend_space *space, uint32_t index, ff_blend_vertex *vertex)
{
    const ff_pack_example *example = &space->pack->examples[index];
    const ff_pack_stream *stream = &space->pack->streams[example->stream];
    *vertex = (ff_blend_vertex){.example = index};
    vertex->idle = (example->flags & FF_EXAMPLE_IDLE) != 0;
    vertex->first_frame = stream->first_frame;
    vertex->frame_count = stream->frame_count;
    vertex->rate = (double)stream->rate;
    vertex->period = vertex->idle ? IDLE_STEP_PERIOD : (double)example->period;
    if (!vertex->idle)
        vertex->rates =
            (ff_rates){(double)example->v_forward, (double)example->v_left, (double)example->turn_rate};
    bool usable = read_keys(example, vertex);
    if (usable) read_locks(example, vertex);
    for (int foot = 0; foot < 2 && usable && example->gait == FF_GAIT_RUN; ++foot)
        shorten_lock(space, vertex, foot);
    return usable;
}

static void read_tree(ff_blend_space *space)
{
    for (uint32_t j = 0; j < FF_JOINT_COUNT; ++j)
        for (uint32_t i = 0; i < 3; ++i)
            space->offsets[i * FF_POSE_LANES + j] = space->pack->joints[j].offset[i];
    space->tree = (ff_pose_tree){ff_joint_parents, space->offsets, FF_JOINT_COUNT, FF_POSE_LANES};
}

/* The examples' frames come first of all frames. */
static ff_status read_poses(ff_blend_space *space, ff_error *error)
{
    const ff_pack *pack = space->pack;
    uint32_t frames = pack->foot_count / 2;
    double mean[4 * FF_JOINT_COUNT] = {0.0};
    space->hips = ff_calloc(frames, sizeof *space->hips);
    space->poses.lanes = FF_POSE_LANES;
    space->poses.keys = ff_calloc(frames, 4 * FF_POSE_LANES * sizeof *space->poses.keys);
    if (!space->hips || !space->poses.keys)
        return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory preparing %u poses", frames);
    ff_posture walking = ff_posture_of_gait(pack, FF_GAIT_WALK),
               running = ff_posture_of_gait(pack, FF_GAIT_RUN);
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        uint32_t index = pack->examples[i].stream;
        const ff_pack_stream *stream = &pack->streams[index];
        ff_posture own = ff_posture_of_stream(pack, index);
        const ff_posture *common = pack->examples[i].gait == FF_GAIT_RUN ? &running : &walking;
        for (uint32_t k = 0; k < stream->frame_count; ++k) {
            ff_vec3 hips;
            ff_quat rotations[FF_JOINT_COUNT];
            uint32_t frame = stream->first_frame + k;
            ff_stream_pose(pack, index, (double)k / stream->frame_count, false, &hips, rotations);
            ff_posture_level(&own, common, rotations);
            space->hips[frame][0] = (float)hips.z;
            space->hips[frame][1] = (float)hips.x;
            space->hips[frame][2] = (float)hips.y;
            for (uint32_t j = 0; j < FF_JOINT_COUNT; ++j)
                ff_pose_write(&space->poses, frame, j, rotations[j]);
        }
        ff_pose_align(&space->poses, stream->first_frame, stream->frame_count, FF_JOINT_COUNT, mean);
    }
    for (uint32_t j = 0; j < FF_JOINT_HIP_L && space->idle >= 0; ++j)
        space->rest[j] = ff_pose_read(&space->poses, space->vertices[space->idle].first_frame, j);
    return FF_OK;
}

/* A cycle's last frame is followed by its first. */
static double fastest_of(const ff_pose_store *poses, const ff_blend_vertex *vertex, uint32_t joint)
{
    double most = 0.0;
    ff_quat last = ff_pose_read(poses, vertex->first_frame + vertex->frame_count - 1, joint);
    for (uint32_t i = 0; i < vertex->frame_count; ++i) {
        ff_quat now = ff_pose_read(poses, vertex->first_frame + i, joint);
        most = ff_max(most, ff_quat_angle(ff_quat_mul(ff_quat_conj(last), now)));
        last = now;
    }
    return most * vertex->rate;
}

/* People have no faster side. */
static void even_out(double *left, double *right)
{
    *left = *right = ff_max(*left, *right);
}

/* What joints are seen to turn at; of what was derived, nobody has. */
static void read_speeds(ff_blend_space *space)
{
    for (uint32_t v = 0; v < space->vertex_count; ++v) {
        const ff_blend_vertex *vertex = &space->vertices[v];
        if (space->pack->examples[vertex->example].flags & FF_EXAMPLE_DERIVED) continue;
        for (uint32_t j = 0; j < FF_JOINT_COUNT; ++j)
            space->fastest[j] = ff_max(space->fastest[j], fastest_of(&space->poses, vertex, j));
    }
    for (int j = 0; j < FF_JOINT_CLAVICLE_R - FF_JOINT_CLAVICLE_L; ++j)
        even_out(&space->fastest[FF_JOINT_CLAVICLE_L + j], &space->fastest[FF_JOINT_CLAVICLE_R + j]);
    for (int j = 0; j < FF_JOINT_LEG_STRIDE; ++j)
        even_out(&space->fastest[FF_JOINT_HIP_L + j], &space->fastest[FF_JOINT_HIP_R + j]);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        if (space->fastest[j] < STILL) space->fastest[j] = ANY_SPEED;
}

static double speed_of(ff_rates rates)
{
    return ff_length3(ff_blend_point(rates));
}

/* Where the feet of a standing body are: the mean of the idle example, or of the slowest walk's stance. */
static void read_neutral(ff_blend_space *space)
{
    int32_t calm = space->idle >= 0 ? space->idle : 0;
    for (uint32_t v = 0; v < space->walk_count && space->idle < 0; ++v)
        if (speed_of(space->vertices[v].rates) < speed_of(space->vertices[calm].rates)) calm = (int32_t)v;
    const ff_blend_vertex *vertex = &space->vertices[calm];
    for (int foot = 0; foot < 2; ++foot) {
        double *neutral = space->neutral[foot];
        for (uint32_t i = 0; i < vertex->frame_count; ++i) {
            const ff_pack_foot *at = &space->pack->feet[2 * (vertex->first_frame + i) + (uint32_t)foot];
            neutral[0] += (double)at->ball[0] / vertex->frame_count;
            neutral[1] += (double)at->ball[1] / vertex->frame_count;
            neutral[2] += (double)at->yaw / vertex->frame_count;
        }
    }
    /* Alike on both sides: how one person stood for a moment is no rule for where feet go. */
    double *left = space->neutral[0], *right = space->neutral[1];
    left[0] = right[0] = 0.5 * (left[0] + right[0]);
    left[1] = 0.5 * (left[1] - right[1]);
    left[2] = 0.5 * (left[2] - right[2]);
    right[1] = -left[1];
    right[2] = -left[2];
}

ff_status ff_blend_read_examples(ff_blend_space *space, ff_error *error)
{
    const ff_pack *pack = space->pack;
    space->idle = -1;
    space->vertices = ff_calloc(pack->example_count, sizeof *space->vertices);
    space->points = ff_calloc(pack->example_count, sizeof *space->points);
    if (!space->vertices || !space->points)
        return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory preparing %u examples", pack->example_count);
    ff_body_frame_read(pack, &space->body);
    read_tree(space);
    uint32_t walking = 0;
    for (uint32_t gait = 0; gait < FF_GAIT_COUNT; ++gait) {
        for (uint32_t i = 0; i < pack->example_count; ++i) {
            ff_blend_vertex *vertex = &space->vertices[space->vertex_count];
            if (pack->examples[i].gait != gait || !read_vertex(space, i, vertex)) continue;
            space->points[space->vertex_count] = ff_blend_point(vertex->rates);
            if (vertex->idle && space->idle < 0) space->idle = (int32_t)space->vertex_count;
            if (gait == FF_GAIT_WALK) ++space->walk_count, walking += !vertex->idle;
            ++space->vertex_count;
        }
    }
    if (walking == 0)
        return ff_fail(
            error, FF_ERR_NO_DATA,
            "the pack has no walking example: build it from clips with at least two strides in them");
    read_neutral(space);
    ff_status status = read_poses(space, error);
    if (status == FF_OK) read_speeds(space);
    return status;
}
