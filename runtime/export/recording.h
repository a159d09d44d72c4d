/* recording.h - what a run leaves behind: every agent's track at every step, and its poses at up to 30 Hz.
 *
 * Poses take 8 bytes per joint (quaternions as int16, error below 0.005 degrees), so that 100 people for a minute
 * are 31 MB. Measurements that need more (foot skate) are taken while the crowd runs, from the poses as they come.
 */
#ifndef FF_RECORDING_H
#define FF_RECORDING_H

#include "runtime/core/base/memory.h"
#include "runtime/export/figure.h"

typedef struct ff_track {
    ff_vec2 position;     /* m */
    float heading, speed; /* rad, m/s */
    float scale;          /* of the body */
    uint8_t present;      /* 0: not in the scene any more */
    uint8_t reached;
    uint8_t planted[2];
} ff_track;

typedef struct ff_recording {
    uint32_t agent_count, joint_count;
    double step;          /* s between tracks */
    double start;         /* s, of the first track in the scene's time: 0, unless a saved crowd went on */
    uint32_t pose_stride; /* steps between poses; 0 = none are kept */
    uint32_t step_count;  /* tracks taken; the first is the start, time 0 */
    uint32_t pose_count;
    ff_array tracks;    /* ff_track [step][agent] */
    ff_array hips;      /* float[3] [pose][agent] */
    ff_array rotations; /* int16_t[4] [pose][agent][joint] */
} ff_recording;

/* Choose the pose rate: 30 Hz or the step's if that is lower, and less when a run of most_steps would not fit the
 * memory set aside for poses. Fails with FF_ERR_RANGE when even 5 Hz would not. */
ff_status ff_recording_create(uint32_t agents, uint32_t joints, double step, uint64_t most_steps,
                              ff_recording *out, ff_error *error);
void ff_recording_free(ff_recording *recording);

/* Open the next step, with nobody present and, where a pose is due, everybody in the last pose. */
ff_status ff_recording_begin(ff_recording *recording, ff_error *error);
void ff_recording_set_track(ff_recording *recording, uint32_t agent, const ff_agent_state *state);
bool ff_recording_wants_pose(const ff_recording *recording); /* of the step just begun */
/* Of one who has just come also for the poses before, in which it is not there. */
void ff_recording_set_pose(ff_recording *recording, uint32_t agent, ff_vec3 hips, const ff_quat *rotations);

/* The step's last call: who was there in the one before and is not now has left, and so has reached its goal. */
void ff_recording_end(ff_recording *recording);
/* Drop all rows but the first agents. */
void ff_recording_trim(ff_recording *recording, uint32_t agents);

/* The steps [first, end) in which an agent is there; {0, 0}: never. Each comes once and goes once. */
typedef struct ff_span {
    uint32_t first, end;
} ff_span;
ff_span ff_recording_span(const ff_recording *recording, uint32_t agent);

/* Whether any pose was kept of an agent. */
bool ff_recording_is_posed(const ff_recording *recording, uint32_t agent);

/* How large its body is beside the pack's. */
double ff_recording_scale(const ff_recording *recording, uint32_t agent);

const ff_track *ff_recording_track(const ff_recording *recording, uint32_t step, uint32_t agent);
void ff_recording_pose(const ff_recording *recording, uint32_t pose, uint32_t agent, ff_vec3 *hips,
                       ff_quat *rotations);
/* The stored form: int16_t[4] per joint, 32767 = 1. */
const int16_t (*ff_recording_raw_rotations(const ff_recording *recording, uint32_t pose, uint32_t agent))[4];
const float *ff_recording_raw_hips(const ff_recording *recording, uint32_t pose, uint32_t agent);

static inline double ff_recording_pose_step(const ff_recording *recording)
{
    return recording->step * recording->pose_stride;
}

#endif
