/* What agents look like: their joints' rotations and matrices, made from the state when asked for; no part of it. */
#include "runtime/core/base/fail.h"
#include "runtime/core/crowd/crowd_state.h"

/* The joints of whoever is in the slot. */
static void pose_of(const ff_crowd *crowd, uint32_t slot, ff_vec3 *hips, ff_quat *rotations)
{
    const ff_body *body = &crowd->bodies[slot];
    if (ff_is_stepper(crowd, slot))
        ff_play_pose(crowd->footsteps->play, &crowd->steppers[slot].play, ff_crowd_time(crowd), hips,
                     rotations);
    else
        ff_gait_pose(crowd->space, &crowd->gaits[slot], body->position, body->heading, hips, rotations);
}

static void matrices_of(const ff_crowd *crowd, uint32_t slot, ff_vec2 origin, ff_matrix *out)
{
    ff_vec3 hips;
    ff_quat rotations[FF_JOINT_COUNT];
    float lanes[4 * FF_POSE_LANES];
    pose_of(crowd, slot, &hips, rotations);
    const ff_pose_root root = {{(float)(hips.x - origin.b), (float)hips.y, (float)(hips.z - origin.a)},
                               (float)crowd->gaits[slot].style.scale};
    ff_pose_lanes(rotations, FF_JOINT_COUNT, FF_POSE_LANES, lanes);
    ff_pose_matrices(&crowd->space->tree, lanes, &root, out);
}

ff_status ff_crowd_agent_pose(const ff_crowd *crowd, ff_agent agent, ff_vec3 *hips, ff_quat *rotations,
                              ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status != FF_OK) return status;
    if (!hips || !rotations) return ff_fail(error, FF_ERR_ARGUMENT, "nowhere to put the pose");
    pose_of(crowd, agent.slot, hips, rotations);
    return FF_OK;
}

ff_status ff_crowd_agent_matrices(const ff_crowd *crowd, ff_agent agent, ff_vec2 origin, ff_matrix *out,
                                  ff_error *error)
{
    ff_status status = ff_crowd_check_agent(crowd, agent, error);
    if (status == FF_OK && !out) status = ff_fail(error, FF_ERR_ARGUMENT, "nowhere to put the matrices");
    if (status == FF_OK) status = ff_crowd_check_place(origin, "origin", error);
    if (status == FF_OK) matrices_of(crowd, agent.slot, origin, out);
    return status;
}

typedef struct matrix_loop {
    const ff_crowd *crowd;
    ff_vec2 origin;
    ff_matrix *out;
} matrix_loop;

static void fill_chunk(void *context, uint32_t chunk)
{
    const matrix_loop *loop = context;
    const ff_crowd *crowd = loop->crowd;
    uint32_t end = (chunk + 1) * FF_CROWD_CHUNK;
    if (end > crowd->agent_count) end = crowd->agent_count;
    for (uint32_t i = chunk * FF_CROWD_CHUNK; i < end; ++i)
        matrices_of(crowd, crowd->live[i], loop->origin, loop->out + (size_t)i * FF_JOINT_COUNT);
}

ff_status ff_crowd_matrices(ff_crowd *crowd, ff_vec2 origin, ff_matrix *out, uint32_t capacity,
                            ff_error *error)
{
    if (!crowd || !out) return ff_fail(error, FF_ERR_ARGUMENT, "nowhere to put the matrices");
    if (capacity < crowd->agent_count)
        return ff_fail(error, FF_ERR_RANGE, "room for the matrices of %u agents, but there are %u", capacity,
                       crowd->agent_count);
    ff_status status = ff_crowd_check_place(origin, "origin", error);
    if (status != FF_OK) return status;
    double start = ff_crowd_clock(crowd);
    uint32_t count = 0;
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot)
        if (crowd->alive[slot]) crowd->live[count++] = slot;
    matrix_loop loop = {crowd, origin, out};
    ff_crowd_for_chunks(crowd, count, fill_chunk, &loop);
    crowd->timings.matrices += ff_crowd_clock(crowd) - start;
    return FF_OK;
}
