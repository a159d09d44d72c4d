/* play.c - the queue: entries, joins, standing. What an entry looks like is in play_pose.c. */
#include "runtime/core/play/play.h"

#include <string.h>

/* Standing is where the action before has left the root, which the plan relies on: somebody who was captured with the weight on
 * one foot stands so. */
static ff_play_step stand_at(const ff_root_frame *root, const ff_play_foot feet[2], double start,
                             uint32_t last)
{
    ff_play_step step = {.start = start,
                         .end = FF_PLAY_FOREVER,
                         .entered = start,
                         .pace = 1.0,
                         .a = root->position.a,
                         .b = root->position.b,
                         .heading = root->heading,
                         .foot = {feet[0], feet[1]},
                         .action = FF_PLAY_STAND,
                         .last = last};
    step.foot[0].planted = step.foot[1].planted = 1;
    return step;
}

/* The root as an entry ends, without what fades out. */
static ff_root_frame root_after(const ff_play_set *set, const ff_play_step *step)
{
    ff_root_frame root = {{step->a, step->b}, step->heading};
    if (step->action == FF_PLAY_STAND) return root;
    ff_root_frame local = ff_play_root_at(set, step->action, set->actions[step->action].duration);
    ff_vec2 moved = ff_from_frame2(ff_fwd2(step->heading), local.position);
    return (ff_root_frame){ff_add2(root.position, moved),
                           step->heading + (double)set->pack->actions[step->action].theta};
}

static ff_play_step action_at(const ff_play_set *set, const ff_play_order *order, const ff_play_foot feet[2])
{
    return (ff_play_step){.start = order->start,
                          .end = order->start + set->actions[order->action].duration / order->pace,
                          .entered = order->start,
                          .pace = order->pace,
                          .a = order->anchor.a,
                          .b = order->anchor.b,
                          .heading = order->heading,
                          .foot = {feet[0], feet[1]},
                          .action = order->action};
}

/* A foot that is put down where it is. */
static ff_play_foot foot_of(const ff_play_targets *at, int foot)
{
    return (ff_play_foot){at->ball[foot].z, at->ball[foot].x, ff_play_foot_yaw(at->foot[foot]), 1, 0};
}

static void stand_next(const ff_play_set *set, ff_play *play)
{
    const ff_play_step *now = &play->step[0];
    ff_play_foot feet[2];
    ff_play_feet_after(set, now, feet);
    ff_root_frame root = root_after(set, now);
    if (!feet[0].planted ||
        !feet[1].planted) { /* a captured stop may end on a foot that still slides: there it stays */
        ff_play_targets at;
        ff_play_targets_at(set, play, now->end, &at);
        for (int foot = 0; foot < 2; ++foot)
            if (!feet[foot].planted) feet[foot] = foot_of(&at, foot);
    }
    play->step[1] = stand_at(&root, feet, now->end, now->action == FF_PLAY_STAND ? now->last : now->action);
}

void ff_play_init(const ff_play_set *set, ff_play *play, const ff_play_order *last, double time,
                  double idle_time)
{
    memset(play, 0, sizeof *play);
    play->idle_time = idle_time - time;
    const ff_play_foot nowhere[2] = {{.planted = 0}, {.planted = 0}};
    play->step[0] = action_at(set, last, nowhere);
    stand_next(set, play);
    play->step[0] = play->step[1];
    play->step[0].start = play->step[0].entered = time;
    memset(&play->step[1], 0, sizeof play->step[1]);
}

void ff_play_next(const ff_play_set *set, ff_play *play, const ff_play_order *order)
{
    ff_play_step *now = &play->step[0];
    bool stands = now->action == FF_PLAY_STAND;
    if (order)
        now->end = order->start; /* its own end but for rounding */
    else if (stands)
        now->end = FF_PLAY_FOREVER;
    memset(&play->step[1], 0, sizeof play->step[1]);
    /* An action that does nothing but stand is played as standing, whose motion goes on however many of them follow. */
    if (order && order->action != FF_PLAY_STAND && !set->actions[order->action].idle) {
        ff_play_foot feet[2];
        ff_play_feet_after(set, now, feet);
        play->step[1] = action_at(set, order, feet);
    } else if (order || !stands) {
        stand_next(set, play);
    }
}

/* ------------------------------------------------------------------------------------------------- joins */

#define LATER (1.0 / 240.0)       /* s, over which speeds are taken */
#define MOST_RUSH (20.0 * FF_DEG) /* that their speed at a join carries toes on */

/* Seen from the root of another motion at the same moment, as pose offsets are. Feet are turned by the joint of the ankle,
 * taken from the root's heading. */
static void seen_from(const ff_play_targets *at, const ff_play_targets *root, ff_pose_targets *out)
{
    ff_vec2 ahead = ff_fwd2(root->heading);
    ff_quat back = ff_quat_yaw(-root->heading);
    ff_vec2 hips = ff_to_frame2(ahead, ff_sub2(ff_plane(at->hips), root->root));
    out->hips = ff_v3(hips.a, hips.b, at->hips.y);
    memcpy(out->turn, at->rotations, sizeof out->turn);
    out->turn[FF_JOINT_HIPS] = ff_quat_mul(back, at->rotations[FF_JOINT_HIPS]);
    for (int foot = 0; foot < 2; ++foot) {
        ff_vec2 ball = ff_to_frame2(ahead, ff_sub2(ff_plane(at->ball[foot]), root->root));
        out->foot[foot] = (ff_pose_foot){ball.a, ball.b, at->ball[foot].y, 0.0, 0.0};
        out->turn[FF_JOINT_ANKLE_L + foot * FF_JOINT_LEG_STRIDE] = ff_quat_mul(back, at->foot[foot]);
    }
}

/* s from time until a foot that is in the air lands. */
static double until_landing(const ff_play_set *set, const ff_play_step *step, int foot, double time)
{
    if (step->action == FF_PLAY_STAND) return FF_POSE_OFFSET_TIME;
    const ff_play_action *action = &set->actions[step->action];
    double local = (time - step->start) * step->pace;
    for (uint32_t i = 0; i < action->stance_count[foot]; ++i)
        if (action->stance[foot][i].from > local) return (action->stance[foot][i].from - local) / step->pace;
    return FF_POSE_OFFSET_TIME;
}

/* Toes turn by up to 2,000 degrees/s as a foot pushes off; where the next action's do not, the difference would carry them on by 90
 * degrees before it fades. */
static void limit_rush(ff_pose_offset *offset)
{
    const double most = MOST_RUSH / (FF_POSE_OFFSET_TIME * 4.0 / 27.0); /* rad/s; the cubic's own peak */
    for (int foot = 0; foot < 2; ++foot) {
        float *speed = offset->turn[1][FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
        double is = ff_length3(ff_v3((double)speed[0], (double)speed[1], (double)speed[2]));
        for (int k = 0; k < 3 && is > most; ++k)
            speed[k] = (float)((double)speed[k] * most / is);
    }
}

void ff_play_join(const ff_play_set *set, ff_play *play, const ff_play_targets shown[2], double later,
                  double time)
{
    const ff_play_step *step = &play->step[0];
    ff_play_targets raw[2];
    ff_pose_targets old[2], new[2];
    memset(&play->offset, 0, sizeof play->offset);
    for (int i = 0; i < 2; ++i) {
        ff_play_targets_at(set, play, time + i * later, &raw[i]);
        seen_from(&shown[i], &raw[i], &old[i]);
        seen_from(&raw[i], &raw[i], &new[i]);
    }
    ff_pose_switch change = {&old[0], &old[1], &new[0], &new[1], .later = later};
    for (int foot = 0; foot < 2; ++foot) {
        change.until[foot] = until_landing(set, step, foot, time);
        change.stands[foot] = shown[0].planted[foot] && raw[0].planted[foot];
    }
    ff_pose_offset_begin(&play->offset, &change);
    limit_rush(&play->offset);
    play->joined = time;
}

/* Standing that goes on is one motion. */
static bool same_stand(const ff_play_step *p, const ff_play_step *q)
{
    return p->action == FF_PLAY_STAND && q->action == FF_PLAY_STAND && p->a == q->a && p->b == q->b &&
           p->heading == q->heading && p->last == q->last;
}

static void next_entry(const ff_play_set *set, ff_play *play)
{
    double time = play->step[0].end;
    bool same = same_stand(&play->step[0], &play->step[1]);
    ff_play_targets shown[2];
    for (int i = 0; i < 2 && !same; ++i)
        ff_play_targets_at(set, play, time + i * LATER, &shown[i]);
    double entered = play->step[0].entered;
    play->step[0] = play->step[1];
    if (same) play->step[0].entered = entered;
    ff_play_next(set, play, NULL);
    if (!same) ff_play_join(set, play, shown, LATER, time);
}

void ff_play_advance(const ff_play_set *set, ff_play *play, double time)
{
    while (play->step[0].end <= time)
        next_entry(set, play);
}

/* Feet where they are, the one in the air put down under it. */
static ff_play_step freeze(const ff_play_targets *shown, double time)
{
    ff_root_frame root = {shown->root, shown->heading};
    ff_play_foot feet[2];
    for (int foot = 0; foot < 2; ++foot)
        feet[foot] = foot_of(shown, foot);
    return stand_at(&root, feet, time, FF_PLAY_STAND);
}

void ff_play_cut(const ff_play_set *set, ff_play *play, const ff_play_order *order, double time)
{
    ff_play_targets shown[2];
    for (int i = 0; i < 2; ++i)
        ff_play_targets_at(set, play, time + i * LATER, &shown[i]);
    play->step[0] =
        order->action == FF_PLAY_STAND ? freeze(&shown[0], time) : action_at(set, order, play->step[0].foot);
    play->step[0].entered = time;
    ff_play_next(set, play, NULL);
    ff_play_join(set, play, shown, LATER, time);
}

void ff_play_enter(const ff_play_set *set, ff_play *play, const ff_play_order *order,
                   const ff_play_foot feet[2], const ff_play_targets shown[2], double later, double time,
                   double idle_time)
{
    ff_root_frame root = {shown[0].root, shown[0].heading};
    memset(play, 0, sizeof *play);
    play->idle_time = idle_time - time;
    bool stands = order->action == FF_PLAY_STAND || set->actions[order->action].idle;
    play->step[0] = stands ? stand_at(&root, feet, time, FF_PLAY_STAND) : action_at(set, order, feet);
    play->step[0].entered = time;
    ff_play_next(set, play, NULL);
    ff_play_join(set, play, shown, later, time);
}
