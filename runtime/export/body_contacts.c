#include "runtime/export/body_contacts.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define NEAR 2.5 /* m between two people who might touch */

/* Radius, and from where to where from the joint's height. */
static const struct {
    double radius, below, above;
} shape[FF_CYLINDER_COUNT] = {
    {0.12, 0.15, 0.12}, {0.08, 0.10, 0.10}, {0.08, 0.10, 0.10}, {0.11, 0.10, 0.10}, {0.11, 0.10, 0.10}};

ff_status ff_contacts_create(uint32_t agents, ff_contacts *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->agent_count = agents;
    out->bodies = ff_calloc(agents, sizeof *out->bodies);
    out->seen = ff_calloc((size_t)agents * agents / 8 + 1, 1);
    if (out->bodies && out->seen) return FF_OK;
    ff_contacts_free(out);
    return ff_fail(error, FF_ERR_NO_MEMORY, "no memory to watch the bodies of %u agents", agents);
}

void ff_contacts_free(ff_contacts *contacts)
{
    free(contacts->bodies);
    free(contacts->seen);
    memset(contacts, 0, sizeof *contacts);
}

ff_cylinders ff_cylinders_of(const ff_vec3 *joints)
{
    static const int joint[FF_CYLINDER_COUNT] = {FF_JOINT_HEAD, FF_JOINT_WRIST_L, FF_JOINT_WRIST_R,
                                                 FF_JOINT_BALL_L, FF_JOINT_BALL_R};
    ff_cylinders out = {.present = true};
    for (int i = 0; i < FF_CYLINDER_COUNT; ++i)
        out.at[i] = joints[joint[i]];
    return out;
}

ff_cylinders ff_cylinders_of_colliders(const ff_pack *pack, const ff_vec3 *joints, const ff_quat *rotations)
{
    static const int joint[FF_CYLINDER_COUNT] = {FF_JOINT_HEAD, FF_JOINT_WRIST_L, FF_JOINT_WRIST_R,
                                                 FF_JOINT_ANKLE_L, FF_JOINT_ANKLE_R};
    static const uint32_t end[FF_CYLINDER_COUNT] = {FF_POINT_HEAD_TOP, FF_POINT_HAND_L, FF_POINT_HAND_R,
                                                    FF_POINT_TOE_L, FF_POINT_TOE_R};
    ff_cylinders out = {.present = true};
    for (int i = 0; i < FF_CYLINDER_COUNT; ++i) {
        ff_vec3 tip = joints[joint[i]];
        for (uint32_t p = 0; p < pack->point_count; ++p) {
            const ff_pack_point *point = &pack->points[p];
            if (point->kind != end[i]) continue;
            ff_vec3 offset =
                ff_v3((double)point->offset[0], (double)point->offset[1], (double)point->offset[2]);
            tip = ff_add3(joints[point->joint], ff_quat_rotate(rotations[point->joint], offset));
        }
        out.at[i] = ff_lerp3(joints[joint[i]], tip, 0.5);
    }
    return out;
}

double ff_cylinders_overlap(const ff_cylinders *p, const ff_cylinders *q)
{
    double deepest = 0.0;
    for (int i = 0; i < FF_CYLINDER_COUNT; ++i) {
        for (int j = 0; j < FF_CYLINDER_COUNT; ++j) {
            double rise = q->at[j].y - p->at[i].y;
            if (rise - shape[j].below > shape[i].above || rise + shape[j].above < -shape[i].below) continue;
            double apart = ff_length2(ff_sub2(ff_plane(q->at[j]), ff_plane(p->at[i])));
            deepest = ff_max(deepest, shape[i].radius + shape[j].radius - apart);
        }
    }
    return deepest;
}

double ff_cylinders_in_wall(const ff_cylinders *body, ff_vec2 p, ff_vec2 q)
{
    ff_vec2 along = ff_sub2(q, p);
    double length = ff_dot2(along, along), deepest = 0.0;
    for (int i = 0; i < FF_CYLINDER_COUNT; ++i) {
        ff_vec2 from = ff_sub2(ff_plane(body->at[i]), p);
        double t = length > 0.0 ? ff_clamp(ff_dot2(from, along) / length, 0.0, 1.0) : 0.0;
        deepest = ff_max(deepest, shape[i].radius - ff_length2(ff_madd2(from, along, -t)));
    }
    return deepest;
}

void ff_contacts_count(ff_contacts *contacts)
{
    ff_cylinders *bodies = contacts->bodies;
    for (uint32_t i = 0; i < contacts->agent_count; ++i) {
        if (!bodies[i].present) continue;
        ff_vec2 here = ff_plane(bodies[i].at[FF_CYLINDER_HEAD]);
        for (uint32_t j = i + 1; j < contacts->agent_count; ++j) {
            if (!bodies[j].present) continue;
            ff_vec2 apart = ff_sub2(ff_plane(bodies[j].at[FF_CYLINDER_HEAD]), here);
            if (ff_dot2(apart, apart) > NEAR * NEAR) continue;
            double depth = ff_cylinders_overlap(&bodies[i], &bodies[j]);
            if (depth <= 0.0) continue;
            contacts->deepest = ff_max(contacts->deepest, depth);
            size_t bit = (size_t)i * contacts->agent_count + j;
            uint8_t mask = (uint8_t)(1u << (bit & 7u));
            contacts->pairs += (contacts->seen[bit >> 3] & mask) == 0;
            contacts->seen[bit >> 3] |= mask;
        }
    }
    for (uint32_t i = 0; i < contacts->agent_count; ++i)
        bodies[i].present = false;
}
