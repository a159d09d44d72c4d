#include "runtime/core/play/play_set.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/gait/leg_pose.h"

#include <stdlib.h>

#define TIPTOE 0.04 /* m: so high a heel is not meant to lie down */

double ff_play_foot_yaw(ff_quat rotation)
{
    ff_vec3 side = ff_quat_rotate(rotation, ff_v3(1.0, 0.0, 0.0));
    return ff_atan2(-side.z, side.x);
}

ff_play_over ff_play_over_ground(const ff_body_frame *body, int foot, double ball_height, ff_quat rotation)
{
    ff_vec3 ball = body->offset[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
    ff_vec3 to_heel = ff_sub3(body->heel[foot], ball);
    double up = ball_height - body->ball_rest;
    ff_play_over out = {.heel = up + ff_quat_rotate(rotation, to_heel).y - to_heel.y};
    double heel = ff_max(0.0, out.heel);
    out.toes = ff_max(0.0, up - heel);
    out.sole = ff_max(0.0, ff_min(up, heel)) * (1.0 - ff_smooth(heel / TIPTOE));
    return out;
}

/* Seen from a place and heading of the stream's world. */
void ff_play_action_sample(const ff_pack *pack, const ff_body_frame *body, const ff_play_action *action,
                           double time, ff_play_sample *out)
{
    ff_root_frame root;
    uint32_t how = action->mirrored ? (uint32_t)FF_SAMPLE_MIRRORED : 0u;
    ff_pack_sample(pack, action->stream, action->start + time, how, &root, &out->hips, out->rotations, NULL);
    out->root = ff_to_frame2(ff_fwd2(action->heading), ff_sub2(root.position, action->origin));
    out->heading = root.heading - action->heading;
    ff_root_frame here = {out->root, out->heading};
    ff_root_place(&here, &out->hips, &out->rotations[FF_JOINT_HIPS]);
    out->hips.y -= action->level;
    ff_legs_of_pose(body, out->hips, out->rotations, out->ball, out->foot);
}

void ff_play_sample_at(const ff_play_set *set, uint32_t action, double time, ff_play_sample *out)
{
    ff_play_action_sample(set->pack, &set->space->body, &set->actions[action], time, out);
}

ff_root_frame ff_play_root_at(const ff_play_set *set, uint32_t index, double time)
{
    const ff_play_action *action = &set->actions[index];
    ff_root_frame root;
    ff_pack_sample(set->pack, action->stream, action->start + time,
                   action->mirrored ? (uint32_t)FF_SAMPLE_MIRRORED : 0u, &root, NULL, NULL, NULL);
    return (ff_root_frame){ff_to_frame2(ff_fwd2(action->heading), ff_sub2(root.position, action->origin)),
                           root.heading - action->heading};
}

void ff_play_action_make(const ff_pack *pack, const ff_body_frame *body, uint32_t index,
                         ff_play_action *action)
{
    const ff_pack_action *record = &pack->actions[index];
    const ff_pack_clip *clip = &pack->clips[record->clip];
    *action = (ff_play_action){.start = (double)record->t_0 - (double)clip->time_offset,
                               .duration = (double)record->duration,
                               .level = (double)record->height,
                               .stream = clip->stream,
                               .mirrored = (record->flags & FF_ACTION_MIRRORED) != 0,
                               .support = record->support,
                               .idle = record->mode == FF_MODE_IDLE};
    ff_play_sample at;
    ff_play_action_sample(pack, body, action, 0.0, &at);
    action->origin = ff_plane(at.ball[record->support]);
    action->heading = at.heading;
    ff_play_find_stances(pack, body, record, action);
}

ff_status ff_play_set_create(const ff_pack *pack, const ff_blend_space *space, ff_play_set **out,
                             ff_error *error)
{
    *out = NULL;
    ff_play_set *set = ff_calloc(1, sizeof *set);
    if (set) set->actions = ff_calloc(pack->action_count, sizeof *set->actions);
    if (!set || !set->actions) {
        ff_play_set_destroy(set);
        return ff_fail(error, FF_ERR_NO_MEMORY, "%u actions to play", pack->action_count);
    }
    set->pack = pack;
    set->space = space;
    for (uint32_t i = 0; i < pack->action_count; ++i)
        ff_play_action_make(pack, &space->body, i, &set->actions[i]);
    *out = set;
    return FF_OK;
}

void ff_play_set_destroy(ff_play_set *set)
{
    if (!set) return;
    free(set->actions);
    free(set);
}
