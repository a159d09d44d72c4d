#include "runtime/core/plan/plan_body.h"

static const double FASTEST = 10.0;           /* m/s, of any two limbs past each other */
static const double LEAST_STEP = 1.0 / 240.0; /* s */
static const double REACH = 2.3; /* m: two roots further apart than this are out of each other's reach */

/* ------------------------------------------------------------------------------------------------------- bodies */

/* The root of the step at a time, and the hips and joints of its clip then. */
static ff_status pose_at(const ff_action_set *set, const ff_plan *plan, double time, ff_root_frame *root,
                         ff_vec3 *hips, ff_quat *rotations, ff_error *error)
{
    const ff_pack *pack = ff_action_set_pack(set);
    const ff_plan_step *step = &plan->steps[ff_plan_step_at(plan, time)];
    const ff_pack_action *r = ff_action_set_record(set, step->action);
    const ff_pack_clip *clip = &pack->clips[r->clip];
    double share =
        step->hold
            ? 1.0
            : ff_clamp((time - step->start) * ff_action_set_pace(set, step->action) / (double)r->duration,
                       0.0, 1.0);
    double at = (double)r->t_0 - (double)clip->time_offset + share * (double)r->duration;
    uint32_t flags = r->flags & FF_ACTION_MIRRORED ? FF_SAMPLE_MIRRORED : 0;
    *root = ff_plan_root_at(set, plan, time);
    ff_vec3 at_join[FF_COLLIDER_COUNT];
    ff_plan_colliders(set, plan, time, at_join);
    root->position = ff_v2(at_join[FF_COLLIDER_ROOT].x, at_join[FF_COLLIDER_ROOT].y);
    return ff_pack_sample(pack, clip->stream, at, flags, NULL, hips, rotations, error);
}

void ff_body_capsules(const ff_pack *pack, const ff_vec3 at[FF_JOINT_COUNT],
                      const ff_quat turned[FF_JOINT_COUNT], ff_body_capsule out[FF_BODY_CAPSULES])
{
    int n = 0;
    for (int j = 1; j < FF_JOINT_COUNT; ++j) {
        int parent = pack->joints[j].parent;
        out[n++] = (ff_body_capsule){at[parent], at[j], (double)pack->joints[parent].radius};
    }
    for (uint32_t p = 0; p < pack->point_count && pack->points[p].kind <= FF_POINT_TOE_R; ++p) {
        const ff_pack_point *point = &pack->points[p];
        ff_vec3 tip = ff_v3((double)point->offset[0], (double)point->offset[1], (double)point->offset[2]);
        out[n++] = (ff_body_capsule){at[point->joint],
                                     ff_add3(at[point->joint], ff_quat_rotate(turned[point->joint], tip)),
                                     (double)pack->joints[point->joint].radius};
    }
}

ff_status ff_plan_body_at(const ff_action_set *set, const ff_plan *plan, double time,
                          ff_body_capsule out[FF_BODY_CAPSULES], ff_error *error)
{
    const ff_pack *pack = ff_action_set_pack(set);
    ff_root_frame root;
    ff_vec3 at[FF_JOINT_COUNT];
    ff_quat local[FF_JOINT_COUNT], turned[FF_JOINT_COUNT];
    ff_status status = pose_at(set, plan, time, &root, &at[0], local, error);
    if (status != FF_OK) return status;
    ff_root_place(&root, &at[0], &local[0]);
    turned[0] = local[0];
    for (int j = 1; j < FF_JOINT_COUNT; ++j) {
        int parent = pack->joints[j].parent;
        const float *offset = pack->joints[j].offset;
        ff_vec3 bone = ff_v3((double)offset[0], (double)offset[1], (double)offset[2]);
        at[j] = ff_add3(at[parent], ff_quat_rotate(turned[parent], bone));
        turned[j] = ff_quat_mul(turned[parent], local[j]);
    }
    ff_body_capsules(pack, at, turned, out);
    return FF_OK;
}

/* -------------------------------------------------------------------------------------------------------- gaps */

/* Distance of two segments (Ericson, Real-Time Collision Detection, 5.1.9). */
static double segment_distance(ff_vec3 p, ff_vec3 p_end, ff_vec3 q, ff_vec3 q_end)
{
    ff_vec3 d = ff_sub3(p_end, p), e = ff_sub3(q_end, q), r = ff_sub3(p, q);
    double a = ff_dot3(d, d), b = ff_dot3(d, e), c = ff_dot3(d, r), f = ff_dot3(e, r), g = ff_dot3(e, e);
    double s = 0.0, t = 0.0, both = a * g - b * b;
    if (a > 1e-12 && both > 1e-12) s = ff_clamp((b * f - c * g) / both, 0.0, 1.0);
    if (g > 1e-12) t = (b * s + f) / g;
    if (t < 0.0 || t > 1.0) {
        t = ff_clamp(t, 0.0, 1.0);
        s = a > 1e-12 ? ff_clamp((b * t - c) / a, 0.0, 1.0) : 0.0;
    }
    return ff_length3(ff_sub3(ff_madd3(p, d, s), ff_madd3(q, e, t)));
}

double ff_bodies_gap(const ff_body_capsule x[FF_BODY_CAPSULES], const ff_body_capsule y[FF_BODY_CAPSULES])
{
    double least = INFINITY;
    for (int i = 0; i < FF_BODY_CAPSULES; ++i)
        for (int k = 0; k < FF_BODY_CAPSULES; ++k)
            least = ff_min(least, segment_distance(x[i].from, x[i].to, y[k].from, y[k].to) - x[i].radius -
                                      y[k].radius);
    return least;
}

ff_status ff_plan_bodies_gap(const ff_action_set *set, const ff_plan *x, const ff_plan *y, double from,
                             double until, double *gap, double *when, ff_error *error)
{
    *gap = INFINITY;
    *when = from;
    for (double time = from; time <= until;) {
        ff_vec2 p = ff_plan_root_at(set, x, time).position, q = ff_plan_root_at(set, y, time).position;
        double apart = ff_length2(ff_sub2(p, q)) - REACH;
        if (apart <= 0.0) {
            ff_body_capsule mine[FF_BODY_CAPSULES], theirs[FF_BODY_CAPSULES];
            ff_status status = ff_plan_body_at(set, x, time, mine, error);
            if (status == FF_OK) status = ff_plan_body_at(set, y, time, theirs, error);
            if (status != FF_OK) return status;
            apart = ff_bodies_gap(mine, theirs);
        }
        if (apart < *gap) {
            *gap = apart;
            *when = time;
        }
        time += ff_max(LEAST_STEP, apart / FASTEST);
    }
    return FF_OK;
}
