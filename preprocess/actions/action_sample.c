#include "preprocess/actions/annotate.h"

/* Rate and cylinder radii: algorithms A.9; root: footstep study, section 2. */
void ff_collider_radii(const ff_collider_settings *settings, double out[FF_COLLIDER_COUNT])
{
    out[FF_COLLIDER_HEAD] = settings->head;
    out[FF_COLLIDER_HAND_L] = out[FF_COLLIDER_HAND_R] = settings->hand;
    out[FF_COLLIDER_FOOT_L] = out[FF_COLLIDER_FOOT_R] = settings->foot;
    out[FF_COLLIDER_ROOT] = settings->root;
}

static ff_vec3 middle(const ff_vec3 *at, int p, int q)
{
    return ff_lerp3(at[p], at[q], 0.5);
}

void ff_collider_middles(const ff_vec3 at[FF_BODY_COUNT], ff_vec3 out[FF_COLLIDER_COUNT])
{
    out[FF_COLLIDER_HEAD] = middle(at, FF_ROLE_HEAD, FF_ROLE_HEAD_TOP);
    out[FF_COLLIDER_HAND_L] = middle(at, FF_ROLE_WRIST_L, FF_ROLE_HAND_L);
    out[FF_COLLIDER_HAND_R] = middle(at, FF_ROLE_WRIST_R, FF_ROLE_HAND_R);
    out[FF_COLLIDER_FOOT_L] = middle(at, FF_ROLE_ANKLE_L, FF_ROLE_TOE_L);
    out[FF_COLLIDER_FOOT_R] = middle(at, FF_ROLE_ANKLE_R, FF_ROLE_TOE_R);
    out[FF_COLLIDER_ROOT] = at[FF_ROLE_HIPS];
}

/* World places of the colliders in one frame. */
static void colliders_at(const ff_rig *rig, const ff_motion *motion, int frame,
                         ff_vec3 out[FF_COLLIDER_COUNT])
{
    ff_vec3 at[FF_BODY_COUNT];
    ff_motion_pose(rig, motion, frame, at, NULL);
    ff_collider_middles(at, out);
    out[FF_COLLIDER_ROOT] =
        ff_ground(ff_v2(motion->root[frame].x, motion->root[frame].y), motion->hips[frame].z);
}

void ff_join_read(const ff_rig *rig, const ff_motion *motion, int frame, ff_vec2 origin, double heading,
                  double level, ff_join *out)
{
    const double apart = 1.0 / 30.0; /* s, footstep study section 1 */
    ff_vec2 axis = ff_fwd2(heading);
    for (int k = 0; k < FF_JOIN_FRAMES; ++k) {
        ff_vec3 root, hips, at[FF_BODY_COUNT];
        ff_quat local[FF_ROLE_JOINT_COUNT];
        ff_motion_sample(motion, frame + (k - FF_JOIN_FRAMES / 2) * apart / motion->frame_time, &root, &hips,
                         local);
        ff_rig_pose_local(rig, root, hips, local, at);
        for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j) {
            ff_vec2 here = ff_to_frame2(axis, ff_sub2(ff_plane(at[j]), origin));
            out->at[k][j][0] = (float)here.a;
            out->at[k][j][1] = (float)here.b;
            out->at[k][j][2] = (float)(at[j].y - level);
        }
    }
}

void ff_action_sample(const ff_collider_settings *settings, const ff_rig *rig, const ff_motion *motion,
                      ff_vec2 origin, double heading, ff_action *out)
{
    double own[FF_COLLIDER_COUNT];
    ff_collider_radii(settings, own);
    int first = out->first_frame, last = out->last_frame;
    double seconds = (last - first) * motion->frame_time;
    int samples = (int)ceil(seconds * settings->rate - 1e-9) + 1;
    if (samples < 2) samples = 2;
    if (samples > FF_COLLIDER_SAMPLES_MAX) samples = FF_COLLIDER_SAMPLES_MAX;
    ff_vec2 axis = ff_fwd2(heading);
    double radius = 0.0;
    for (int k = 0; k < samples; ++k) {
        double at = first + (last - first) * (double)k / (samples - 1);
        int low = (int)at, high = low < last ? low + 1 : low;
        ff_vec3 p[FF_COLLIDER_COUNT], q[FF_COLLIDER_COUNT];
        colliders_at(rig, motion, low, p);
        colliders_at(rig, motion, high, q);
        ff_vec2 root = ff_plane(ff_lerp3(p[FF_COLLIDER_ROOT], q[FF_COLLIDER_ROOT], at - low));
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
            ff_vec3 here = ff_lerp3(p[c], q[c], at - low);
            ff_vec2 local = ff_to_frame2(axis, ff_sub2(ff_plane(here), origin));
            out->colliders[k][c] = (ff_pack_collider){(float)local.a, (float)local.b,
                                                      (float)(here.y - (double)out->record.height)};
            radius = ff_max(radius, ff_length2(ff_sub2(ff_plane(here), root)) + own[c]);
        }
    }
    out->record.collider_samples = (uint32_t)samples;
    out->record.coarse_radius = (float)radius;
}
