/* Leading frames that are a rest pose and not motion. */
#include "mocap/read.h"

/* How far the joints turn (rad) from one frame to the next: on average over those that turn, and the roots. */
typedef struct turn {
    double mean, root;
} turn;

static turn measure_turn(const ff_clip *clip, int frame)
{
    const ff_quat *a = clip->rotations + (size_t)frame * (size_t)clip->joint_count,
                  *b = a + clip->joint_count;
    double sum = 0.0, root = 0.0;
    int turning = 0;
    for (int j = 0; j < clip->joint_count; ++j) {
        double angle = ff_quat_angle(ff_quat_mul(ff_quat_conj(a[j]), b[j]));
        sum += angle;
        turning += angle > 0.0;
        if (clip->joints[j].parent < 0) root = ff_max(root, angle);
    }
    return (turn){turning > 0 ? sum / turning : 0.0, root};
}

static bool unturned(ff_quat q)
{
    return ff_quat_angle(q) < 1e-9;
}

/* No root is turned, nor is a third of the joints that are turned a frame later. */
static bool looks_like_rest(const ff_clip *clip, int frame)
{
    const ff_quat *q = clip->rotations + (size_t)frame * (size_t)clip->joint_count,
                  *later = q + clip->joint_count;
    int at_rest = 0, turning = 0;
    for (int j = 0; j < clip->joint_count; ++j) {
        if (clip->joints[j].parent < 0 && !unturned(q[j])) return false;
        if (unturned(later[j])) continue;
        ++turning;
        at_rest += unturned(q[j]);
    }
    return turning > 0 && at_rest * 3 >= turning;
}

enum { MOST_REST_FRAMES = 8, FRAMES_COMPARED = 10 };

/* A rest pose that was put before the motion (the conversions of CMU to BVH do): joints without rotation, then a jump
 * that no body makes from one frame to the next. */
int ff_clip_count_rest_frames(const ff_clip *clip)
{
    int rest = 1;
    while (rest < MOST_REST_FRAMES && rest + 1 < clip->frame_count &&
           measure_turn(clip, rest - 1).mean <= 0.0)
        ++rest;
    if (rest + 2 >= clip->frame_count || !looks_like_rest(clip, rest - 1)) return 0;
    turn jump = measure_turn(clip, rest - 1), usual = {0.0, 0.0};
    for (int i = rest; i < rest + FRAMES_COMPARED && i + 1 < clip->frame_count; ++i) {
        turn next = measure_turn(clip, i);
        usual.mean = ff_max(usual.mean, next.mean);
        usual.root = ff_max(usual.root, next.root);
    }
    bool all = jump.mean > 2.0 * FF_DEG && jump.mean > 4.0 * usual.mean;
    bool root = jump.root > 5.0 * FF_DEG && jump.root > 4.0 * usual.root;
    return all || root ? rest : 0;
}
