#include "preprocess/examples/example.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The ball is held while it is slower than this (m/s) and lower than this over its rest height (m): holding it until
 * toe-off made skate and knee jumps worse (synthesis study, section 2). */
#define HOLD_SPEED_WALK 0.5
#define HOLD_SPEED_RUN 0.9
#define HOLD_RISE 0.03

ff_status ff_example_alloc(ff_example *example, int frames, ff_error *error)
{
    memset(example, 0, sizeof *example);
    size_t n = (size_t)frames;
    example->clip = -1;
    example->frame_count = frames;
    example->hips = ff_calloc(n, sizeof *example->hips);
    example->rotations = ff_calloc(n, FF_ROLE_JOINT_COUNT * sizeof *example->rotations);
    example->feet = ff_calloc(n, 2 * sizeof *example->feet);
    if (example->hips && example->rotations && example->feet) return FF_OK;
    ff_example_free(example);
    return ff_fail(error, FF_ERR_NO_MEMORY, "a gait cycle of %d frames", frames);
}

void ff_example_free(ff_example *example)
{
    free(example->hips);
    free(example->rotations);
    free(example->feet);
    memset(example, 0, sizeof *example);
}

ff_vec2 ff_root_arc(ff_vec2 v, double turn_rate, double t)
{
    double angle = turn_rate * t, sine, cosine;
    if (fabs(angle) < 1e-6) return ff_scale2(ff_madd2(v, ff_left2(v), 0.5 * angle), t);
    ff_sincos(angle, &sine, &cosine);
    double s = sine / turn_rate, c = (1.0 - cosine) / turn_rate;
    return ff_v2(s * v.a - c * v.b, c * v.a + s * v.b);
}

void ff_example_pose(const ff_rig *rig, const ff_example *example, int frame, ff_vec3 *positions)
{
    const ff_quat *local = example->rotations + (size_t)frame * FF_ROLE_JOINT_COUNT;
    ff_quat world[FF_ROLE_JOINT_COUNT];
    ff_vec3 hips = example->hips[frame];
    world[0] = local[0];
    for (int r = 1; r < FF_ROLE_JOINT_COUNT; ++r)
        world[r] = ff_quat_mul(world[ff_role_parent((ff_role)r)], local[r]);
    ff_rig_pose(rig, ff_v3(hips.y, hips.z, hips.x), world, positions);
}

/* ---------------------------------------------------------------------------------------------------- feet */

static ff_pack_foot foot_of_pose(const ff_vec3 *at, int foot)
{
    ff_vec3 heel = at[foot ? FF_BODY_HEEL_R : FF_BODY_HEEL_L],
            ball = at[foot ? FF_ROLE_BALL_R : FF_ROLE_BALL_L];
    ff_vec3 along = ff_sub3(ball, heel);
    ff_pack_foot out = {{(float)ball.z, (float)ball.x, (float)ball.y},
                        (float)ff_atan2(along.x, along.z),
                        (float)ff_atan2(along.y, ff_length2(ff_plane(along)))};
    return out;
}

/* Speed of the ball over the ground at a frame, the root moving at the example's rates. */
static double ball_speed(const ff_example *example, int frame, int foot)
{
    int n = example->frame_count;
    const ff_pack_foot *before = &example->feet[2 * ((frame + n - 1) % n) + foot];
    const ff_pack_foot *now = &example->feet[2 * frame + foot],
                       *after = &example->feet[2 * ((frame + 1) % n) + foot];
    double rate = n / (double)example->record.period, turn = (double)example->record.turn_rate;
    ff_vec2 own = ff_scale2(ff_v2((double)after->ball[0] - (double)before->ball[0],
                                  (double)after->ball[1] - (double)before->ball[1]),
                            0.5 * rate);
    ff_vec2 root = ff_v2((double)example->record.v_forward, (double)example->record.v_left);
    ff_vec2 swing = ff_scale2(ff_left2(ff_v2((double)now->ball[0], (double)now->ball[1])), turn);
    return ff_length2(ff_add2(own, ff_add2(root, swing)));
}

/* Contact and toe-off of a foot in frames, off later than contact. */
static void contact_frames(const ff_example *example, int foot, double *contact, double *off)
{
    double n = example->frame_count;
    *contact = n * (double)example->record.key[foot ? 2 : 0];
    *off = n * (double)example->record.key[foot ? 1 : 3];
    if (*off < *contact) *off += n;
}

/* The longest stretch of the stance in which the ball is still and down: from about foot-flat to shortly before
 * toe-off. */
static double find_lock(const ff_rig *rig, ff_example *example, int foot)
{
    ff_vec3 rest[FF_BODY_COUNT];
    ff_rig_rest_pose(rig, rest);
    double limit = example->record.gait == FF_GAIT_RUN ? HOLD_SPEED_RUN : HOLD_SPEED_WALK;
    double contact, off, n = example->frame_count;
    contact_frames(example, foot, &contact, &off);
    int first = (int)(0.5 * (contact + off)), last = first, start = -1;
    for (int k = (int)ceil(contact); k < off; ++k) {
        int frame = k % example->frame_count;
        double rise = (double)example->feet[2 * frame + foot].ball[2] - rest[FF_ROLE_BALL_L].y;
        bool still = ball_speed(example, frame, foot) < limit && rise < HOLD_RISE;
        if (!still) start = -1;
        if (still && start < 0) start = k;
        if (still && k - start > last - first) first = start, last = k;
    }
    float *lock = example->record.lock[foot];
    lock[0] = (float)fmod(first / n, 1.0);
    lock[1] = (float)fmod(last / n, 1.0);
    return (last - first) / n;
}

double ff_example_find_feet(const ff_rig *rig, ff_example *example)
{
    ff_vec3 at[FF_BODY_COUNT];
    for (int k = 0; k < example->frame_count; ++k) {
        ff_example_pose(rig, example, k, at);
        example->feet[2 * k] = foot_of_pose(at, FF_LEFT);
        example->feet[2 * k + 1] = foot_of_pose(at, FF_RIGHT);
    }
    if (example->record.flags & FF_EXAMPLE_IDLE) {
        for (int foot = 0; foot < 2; ++foot)
            example->record.lock[foot][0] = 0.0f, example->record.lock[foot][1] = -1.0f;
        return 1.0;
    }
    return ff_min(find_lock(rig, example, FF_LEFT), find_lock(rig, example, FF_RIGHT));
}

/* ------------------------------------------------------------------------------------------- mirrored, reversed */

static double phase_after(double phase, double start)
{
    double p = phase - start;
    return p < 0.0 ? p + 1.0 : p;
}

void ff_example_sample(const ff_example *example, double phase, ff_vec3 *hips, ff_quat *rotations)
{
    int n = example->frame_count;
    double frame = (phase - floor(phase)) * n;
    int low = (int)frame % n, high = (low + 1) % n;
    double t = frame - floor(frame);
    const ff_quat *from = example->rotations + (size_t)low * FF_ROLE_JOINT_COUNT;
    const ff_quat *to = example->rotations + (size_t)high * FF_ROLE_JOINT_COUNT;
    *hips = ff_lerp3(example->hips[low], example->hips[high], t);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        rotations[r] = ff_quat_nlerp(from[r], to[r], t);
}

static ff_status copy_head(const ff_example *example, ff_example *out, const char *suffix, ff_error *error)
{
    ff_status status = ff_example_alloc(out, example->frame_count, error);
    if (status != FF_OK) return status;
    out->record = example->record;
    out->loop = example->loop;
    out->clip = example->clip;
    out->first_frame = example->first_frame;
    out->wander = example->wander;
    snprintf(out->name, sizeof out->name, "%.80s%s", example->name, suffix);
    return FF_OK;
}

ff_status ff_example_mirror(const ff_rig *rig, const ff_example *example, ff_example *out, ff_error *error)
{
    ff_status status = copy_head(example, out, " mirrored", error);
    if (status != FF_OK) return status;
    const float *key = example->record.key;
    double start = (double)key[2]; /* the right contact becomes the left one */
    out->record.flags ^= FF_EXAMPLE_MIRRORED;
    out->record.v_left = 0.0f - example->record.v_left; /* no negative zero */
    out->record.turn_rate = 0.0f - example->record.turn_rate;
    out->record.key[1] = (float)phase_after((double)key[3], start);
    out->record.key[2] = (float)phase_after((double)key[0], start);
    out->record.key[3] = (float)phase_after((double)key[1], start);
    out->loop.cut = (float)phase_after((double)example->loop.cut, start);
    for (int k = 0; k < out->frame_count; ++k) {
        ff_quat from[FF_ROLE_JOINT_COUNT], *to = out->rotations + (size_t)k * FF_ROLE_JOINT_COUNT;
        ff_vec3 hips;
        ff_example_sample(example, start + k / (double)out->frame_count, &hips, from);
        ff_pose_mirror(&hips, from, &out->hips[k], to);
    }
    ff_example_find_feet(rig, out);
    return FF_OK;
}

ff_status ff_example_reverse(const ff_rig *rig, const ff_example *example, ff_example *out, ff_error *error)
{
    ff_status status = copy_head(example, out, " reversed", error);
    if (status != FF_OK) return status;
    const float *key = example->record.key;
    double start = (double)key[3]; /* where the left foot lifted it now lands */
    out->record.flags |= FF_EXAMPLE_DERIVED;
    out->loop.cut = (float)phase_after(start, (double)example->loop.cut);
    out->record.v_forward = 0.0f - example->record.v_forward;
    out->record.v_left = 0.0f - example->record.v_left;
    out->record.turn_rate = 0.0f - example->record.turn_rate;
    out->record.key[1] = (float)phase_after(start, (double)key[2]);
    out->record.key[2] = (float)phase_after(start, (double)key[1]);
    out->record.key[3] = (float)phase_after(start, (double)key[0]);
    for (int k = 0; k < out->frame_count; ++k)
        ff_example_sample(example, start - k / (double)out->frame_count, &out->hips[k],
                          out->rotations + (size_t)k * FF_ROLE_JOINT_COUNT);
    ff_example_find_feet(rig, out);
    return FF_OK;
}
