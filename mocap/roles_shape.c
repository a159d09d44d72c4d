/* Roles by shape, for joints with unknown names. In a typical pose the legs are the two chains of equal length from one
 * joint (the hips) whose tips are lowest; the arms the two longest equal chains elsewhere; along a limb the two
 * longest bones in a row are thigh and shank, upper arm and forearm. Feet point forward, which tells left from right. */
#include "mocap/roles_find.h"

#include "runtime/core/base/memory.h"

#include <stdlib.h>

typedef struct shape {
    ff_clip *clip;
    ff_vec3 *at;   /* world positions in a typical frame */
    double *reach; /* length of the longest chain below a joint, with the bone that leads to it */
    int *next;     /* first joint of that chain, -1 for a tip */
    ff_vec3 left;
} shape;

static void measure(shape *s)
{
    const ff_clip *clip = s->clip;
    ff_clip_pose(clip, ff_clip_typical_frame(clip), s->at, NULL);
    for (int j = 0; j < clip->joint_count; ++j)
        s->next[j] = -1;
    for (int j = clip->joint_count - 1; j >= 0; --j) {
        int parent = clip->joints[j].parent;
        if (parent < 0) continue;
        s->reach[j] += ff_length3(ff_sub3(s->at[j], s->at[parent]));
        if (s->next[parent] < 0 || s->reach[j] > s->reach[parent]) {
            s->reach[parent] = s->reach[j];
            s->next[parent] = j;
        }
    }
}

static int tip_of(const shape *s, int joint)
{
    while (s->next[joint] >= 0)
        joint = s->next[joint];
    return joint;
}

static bool alike(const shape *s, int a, int b)
{
    double longer = ff_max(s->reach[a], s->reach[b]);
    return longer > 0.0 && fabs(s->reach[a] - s->reach[b]) < 0.15 * longer;
}

static bool is_below(const ff_clip *clip, int joint, int ancestor)
{
    while (joint > ancestor)
        joint = clip->joints[joint].parent;
    return joint == ancestor;
}

/* The three joints of a limb on the chain that begins with joint: ends of its two longest bones in a row. */
static bool limb_joints(const shape *s, int joint, int limb[3])
{
    double longest = 0.0;
    for (int a = joint; a >= 0; a = s->next[a]) {
        int b = s->next[a], c = b >= 0 ? s->next[b] : -1;
        if (c < 0) break;
        double length = s->reach[b] - (s->next[c] >= 0 ? s->reach[s->next[c]] : 0.0);
        if (length <= longest) continue;
        longest = length;
        limb[0] = a, limb[1] = b, limb[2] = c;
    }
    return longest > 0.0;
}

typedef struct pair {
    int parent, a, b;
} pair;

/* The best pair of equal chains below one joint. Legs: lowest tips. Arms (above is the hips): longest, and neither
 * below nor containing a leg. */
static bool find_pair(const shape *s, const pair *legs, pair *out)
{
    const ff_clip *clip = s->clip;
    double best = 0.0;
    bool found = false;
    for (int a = 1; a < clip->joint_count; ++a) {
        int limb[3];
        if (clip->joints[a].parent < 0 || !limb_joints(s, a, limb)) continue;
        for (int b = a + 1; b < clip->joint_count; ++b) {
            if (clip->joints[b].parent != clip->joints[a].parent || !alike(s, a, b) ||
                !limb_joints(s, b, limb))
                continue;
            if (legs &&
                (!is_below(clip, a, legs->parent) || is_below(clip, a, legs->a) ||
                 is_below(clip, a, legs->b) || is_below(clip, b, legs->a) || is_below(clip, b, legs->b)))
                continue;
            double score =
                legs ? s->reach[a] + s->reach[b] : -ff_max(s->at[tip_of(s, a)].y, s->at[tip_of(s, b)].y);
            if (found && score <= best) continue;
            found = true, best = score;
            *out = (pair){clip->joints[a].parent, a, b};
        }
    }
    return found;
}

static void give(ff_clip *clip, int joint, ff_role role)
{
    if (joint >= 0 && clip->joints[joint].role == FF_ROLE_NONE && ff_clip_find(clip, role) < 0)
        clip->joints[joint].role = role;
}

static void give_limbs(const shape *s, const pair *p, const ff_role left_roles[3])
{
    int limb[2][3];
    if (!limb_joints(s, p->a, limb[0]) || !limb_joints(s, p->b, limb[1])) return;
    ff_vec3 across = ff_sub3(s->at[limb[0][0]], s->at[limb[1][0]]);
    int left = ff_dot3(across, s->left) >= 0.0 ? 0 : 1;
    for (int i = 0; i < 3; ++i) {
        give(s->clip, limb[left][i], left_roles[i]);
        give(s->clip, limb[1 - left][i], ff_role_mirror(left_roles[i]));
    }
}

static bool find_left(shape *s, const pair *legs)
{
    int a[3], b[3];
    if (!limb_joints(s, legs->a, a) || !limb_joints(s, legs->b, b)) return false;
    ff_vec3 forward =
        ff_add3(ff_sub3(s->at[tip_of(s, a[2])], s->at[a[2]]), ff_sub3(s->at[tip_of(s, b[2])], s->at[b[2]]));
    s->left = ff_v3(forward.z, 0.0, -forward.x);
    return ff_length3(s->left) > 0.0;
}

static void find_limbs(shape *s)
{
    static const ff_role leg_roles[3] = {FF_ROLE_HIP_L, FF_ROLE_KNEE_L, FF_ROLE_ANKLE_L};
    static const ff_role arm_roles[3] = {FF_ROLE_SHOULDER_L, FF_ROLE_ELBOW_L, FF_ROLE_WRIST_L};
    pair legs, arms;
    measure(s);
    if (!find_pair(s, NULL, &legs) || !find_left(s, &legs)) return;
    give(s->clip, legs.parent, FF_ROLE_HIPS);
    give_limbs(s, &legs, leg_roles);
    if (!find_pair(s, &legs, &arms)) return;
    give_limbs(s, &arms, arm_roles);
    /* The head is the last joint that turns on the longest other chain from the chest. */
    int head = -1;
    for (int j = arms.parent + 1; j < s->clip->joint_count; ++j)
        if (s->clip->joints[j].parent == arms.parent && j != arms.a && j != arms.b &&
            (head < 0 || s->reach[j] > s->reach[head]))
            head = j;
    while (head >= 0 && s->next[head] >= 0 && s->next[s->next[head]] >= 0)
        head = s->next[head];
    give(s->clip, head, FF_ROLE_HEAD);
}

void ff_roles_by_shape(ff_clip *clip)
{
    size_t count = (size_t)clip->joint_count;
    shape s = {.clip = clip};
    s.at = ff_calloc(count, sizeof *s.at);
    s.reach = ff_calloc(count, sizeof *s.reach);
    s.next = ff_calloc(count, sizeof *s.next);
    if (s.at && s.reach && s.next)
        find_limbs(&s); /* short of memory: no roles, and the caller is told which miss */
    free(s.at);
    free(s.reach);
    free(s.next);
}
