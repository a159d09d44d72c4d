#include "runtime/core/pack/pack_check.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/pack/joints.h"

#define LIMIT_BODY 10.0f  /* m: no bone or radius is longer */
#define LIMIT_SPEED 50.0f /* m/s, rad/s */

static ff_status check_strings(const ff_pack *pack, ff_error *error)
{
    if (pack->strings[0] != 0) return FF_PACK_REFUSE("STRS", pack->strings, "the first byte must be 0");
    const char *last = pack->strings + pack->string_size - 1;
    if (*last != 0) return FF_PACK_REFUSE("STRS", last, "the last byte must be 0");
    return FF_OK;
}

static double bone_length(const ff_pack_joint *joint)
{
    return ff_length3(ff_v3((double)joint->offset[0], (double)joint->offset[1], (double)joint->offset[2]));
}

static ff_status check_joint(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_joint *joint = &pack->joints[index];
    if (joint->parent != ff_joint_parents[index])
        return FF_PACK_REFUSE("JNTS", &joint->parent, "joint %u has parent %d, expected %d", index,
                              joint->parent, ff_joint_parents[index]);
    if (joint->name >= pack->string_size)
        return FF_PACK_REFUSE("JNTS", &joint->name, "the name of joint %u lies outside STRS", index);
    const float *wild = ff_pack_wild_float(joint->offset, 3, LIMIT_BODY);
    if (wild) return FF_PACK_REFUSE("JNTS", wild, "joint %u: offset %g m", index, (double)*wild);
    if (!(joint->radius >= 0.0f && joint->radius <= LIMIT_BODY))
        return FF_PACK_REFUSE("JNTS", &joint->radius, "joint %u: radius %g m", index, (double)joint->radius);
    bool leg_bone = index == FF_JOINT_KNEE_L || index == FF_JOINT_ANKLE_L || index == FF_JOINT_KNEE_R ||
                    index == FF_JOINT_ANKLE_R;
    if (leg_bone && bone_length(joint) < 0.01)
        return FF_PACK_REFUSE("JNTS", joint->offset, "the leg bone to joint %u is %.4g m long", index,
                              bone_length(joint));
    return FF_OK;
}

static ff_status check_skeleton(const ff_pack *pack, ff_error *error)
{
    if (pack->joint_count != FF_JOINT_COUNT)
        return FF_PACK_REFUSE("JNTS", pack->joints, "%u joints, expected the %d of a person",
                              pack->joint_count, FF_JOINT_COUNT);
    for (uint32_t i = 0; i < pack->joint_count; ++i) {
        ff_status status = check_joint(pack, i, error);
        if (status != FF_OK) return status;
    }
    if (!(pack->joints[0].offset[1] > 0.1f))
        return FF_PACK_REFUSE("JNTS", &pack->joints[0].offset[1], "the hips rest %g m above the ground",
                              (double)pack->joints[0].offset[1]);
    if (pack->point_count != FF_POINT_COUNT)
        return FF_PACK_REFUSE("PNTS", pack->points, "%u points, expected %d", pack->point_count,
                              FF_POINT_COUNT);
    for (uint32_t i = 0; i < pack->point_count; ++i) {
        const ff_pack_point *point = &pack->points[i];
        if (point->joint < 0 || (uint32_t)point->joint >= pack->joint_count)
            return FF_PACK_REFUSE("PNTS", &point->joint, "point %u sits on joint %d of %u", i, point->joint,
                                  pack->joint_count);
        if (point->kind != i)
            return FF_PACK_REFUSE("PNTS", &point->kind, "point %u is of kind %u, expected %u", i, point->kind,
                                  i);
        const float *wild = ff_pack_wild_float(point->offset, 3, LIMIT_BODY);
        if (wild) return FF_PACK_REFUSE("PNTS", wild, "point %u: offset %g m", i, (double)*wild);
    }
    return FF_OK;
}

static ff_status check_example_phases(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_example *example = &pack->examples[index];
    if (example->key[0] != 0.0f)
        return FF_PACK_REFUSE("EXMP", example->key, "example %u: its first key is %g, expected 0", index,
                              (double)example->key[0]);
    for (int k = 0; k < 4; ++k)
        if (!(example->key[k] >= 0.0f && example->key[k] < 1.0f))
            return FF_PACK_REFUSE("EXMP", &example->key[k], "example %u: key %d is %g, expected 0 to 1",
                                  index, k, (double)example->key[k]);
    for (int k = 1; k < 4 && example->gait == FF_GAIT_WALK; ++k)
        if (!(example->key[k] >= example->key[k - 1] + 0.005f && example->key[k] <= 0.995f))
            return FF_PACK_REFUSE("EXMP", &example->key[k],
                                  "example %u: keys of a walk must increase, key %d is %g after %g", index, k,
                                  (double)example->key[k], (double)example->key[k - 1]);
    const float *wild = ff_pack_wild_float(&example->lock[0][0], 4, 1.0f);
    if (wild) return FF_PACK_REFUSE("EXMP", wild, "example %u: lock phase %g", index, (double)*wild);
    return FF_OK;
}

static ff_status check_example(const ff_pack *pack, uint32_t index, uint32_t first_frame, ff_error *error)
{
    const ff_pack_example *example = &pack->examples[index];
    if (example->name >= pack->string_size)
        return FF_PACK_REFUSE("EXMP", &example->name, "the name of example %u lies outside STRS", index);
    if (pack->clip_count > 0 && example->clip >= pack->clip_count)
        return FF_PACK_REFUSE("EXMP", &example->clip, "example %u: clip %u of %u", index, example->clip,
                              pack->clip_count);
    if (example->stream >= pack->stream_count)
        return FF_PACK_REFUSE("EXMP", &example->stream, "example %u: stream %u of %u", index, example->stream,
                              pack->stream_count);
    if (example->gait >= FF_GAIT_COUNT)
        return FF_PACK_REFUSE("EXMP", &example->gait, "example %u: gait %u", index, example->gait);
    if (example->flags &
        ~(uint32_t)(FF_EXAMPLE_IDLE | FF_EXAMPLE_MIRRORED | FF_EXAMPLE_DERIVED | FF_EXAMPLE_LOOSE))
        return FF_PACK_REFUSE("EXMP", &example->flags, "example %u: unknown flags %x", index, example->flags);
    const ff_pack_stream *stream = &pack->streams[example->stream];
    if (!(stream->flags & FF_STREAM_CYCLIC) || stream->frame_count < 4 || stream->first_frame != first_frame)
        return FF_PACK_REFUSE("EXMP", &example->stream,
                              "example %u: its stream must be cyclic, of 4 frames or more, from frame %u",
                              index, first_frame);
    if (!(example->period >= 0.2f && example->period <= 120.0f))
        return FF_PACK_REFUSE("EXMP", &example->period, "example %u: period %g s", index,
                              (double)example->period);
    double frames = (double)example->period * (double)stream->rate;
    if (!(fabs(frames - (double)stream->frame_count) <= 0.01 * (double)stream->frame_count))
        return FF_PACK_REFUSE("EXMP", &example->period, "example %u: %g s at %g Hz are not its %u frames",
                              index, (double)example->period, (double)stream->rate, stream->frame_count);
    if (!(fabs((double)stream->seconds - (double)example->period) <= 0.01 * (double)example->period))
        return FF_PACK_REFUSE("STRM", &stream->seconds, "example %u: a cycle of %g s, its stream takes %g s",
                              index, (double)example->period, (double)stream->seconds);
    const float rates[3] = {example->v_forward, example->v_left, example->turn_rate};
    if (ff_pack_wild_float(rates, 3, LIMIT_SPEED) || ff_pack_wild_float(&example->seam, 1, LIMIT_BODY))
        return FF_PACK_REFUSE("EXMP", &example->v_forward, "example %u: rates %g m/s, %g m/s, %g rad/s",
                              index, (double)rates[0], (double)rates[1], (double)rates[2]);
    return check_example_phases(pack, index, error);
}

static ff_status check_examples(const ff_pack *pack, ff_error *error)
{
    uint64_t first_frame = 0;
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        ff_status status = check_example(pack, i, (uint32_t)first_frame, error);
        if (status != FF_OK) return status;
        first_frame += pack->streams[pack->examples[i].stream].frame_count;
    }
    if (pack->foot_count != 2 * first_frame)
        return FF_PACK_REFUSE("FEET", pack->data, "%u feet for %llu example frames", pack->foot_count,
                              (unsigned long long)first_frame);
    for (uint32_t i = 0; i < pack->foot_count; ++i) {
        const ff_pack_foot *foot = &pack->feet[i];
        const float *wild = ff_pack_wild_float(foot->ball, 3, LIMIT_BODY);
        if (!wild) wild = ff_pack_wild_float(&foot->yaw, 2, LIMIT_BODY);
        if (wild) return FF_PACK_REFUSE("FEET", wild, "foot %u: %g", i, (double)*wild);
    }
    return FF_OK;
}

static ff_status check_simplices(const ff_pack *pack, ff_error *error)
{
    for (uint32_t i = 0; i < pack->simplex_count; ++i) {
        const ff_pack_simplex *simplex = &pack->simplices[i];
        if (simplex->gait >= FF_GAIT_COUNT)
            return FF_PACK_REFUSE("SMPX", &simplex->gait, "simplex %u: gait %u", i, simplex->gait);
        for (int v = 0; v < 4; ++v) {
            int32_t vertex = simplex->vertex[v];
            bool unused = vertex == -1 && v > 0;
            bool known = vertex >= 0 && (uint32_t)vertex < pack->example_count &&
                         (v == 0 || simplex->vertex[v - 1] >= 0) &&
                         pack->examples[vertex].gait == simplex->gait;
            for (int u = 0; u < v && known; ++u)
                known = simplex->vertex[u] != vertex;
            if (!unused && !known)
                return FF_PACK_REFUSE("SMPX", &simplex->vertex[v],
                                      "simplex %u: vertex %d is example %d of %u (of its gait, no gap, none "
                                      "twice)",
                                      i, v, vertex, pack->example_count);
        }
    }
    return FF_OK;
}

static ff_status check_hull(const ff_pack *pack, ff_error *error)
{
    for (uint32_t i = 0; i < pack->hull_count; ++i) {
        const float *wild = ff_pack_wild_float(&pack->hull[i].f, 2, LIMIT_SPEED);
        if (wild) return FF_PACK_REFUSE("HULL", wild, "point %u: %g m/s", i, (double)*wild);
    }
    for (uint32_t i = 0; i < pack->hull_count && pack->hull_count >= 3; ++i) {
        const ff_pack_point2 *p = &pack->hull[i];
        const ff_pack_point2 *q = &pack->hull[(i + 1) % pack->hull_count];
        const ff_pack_point2 *r = &pack->hull[(i + 2) % pack->hull_count];
        ff_vec2 u = ff_v2((double)q->f - (double)p->f, (double)q->l - (double)p->l);
        ff_vec2 v = ff_v2((double)r->f - (double)q->f, (double)r->l - (double)q->l);
        if (!(ff_det2(u, v) >= -1e-6))
            return FF_PACK_REFUSE("HULL", q, "the outline is not convex and counter-clockwise at point %u",
                                  (i + 1) % pack->hull_count);
    }
    return FF_OK;
}

ff_status ff_pack_check(const ff_pack *pack, ff_error *error)
{
    static ff_status (*const checks[])(const ff_pack *, ff_error *) = {
        check_strings, check_skeleton,      ff_pack_check_streams, check_examples,    check_simplices,
        check_hull,    ff_pack_check_clips, ff_pack_check_gait,    ff_pack_check_skin};
    for (size_t i = 0; i < sizeof checks / sizeof checks[0]; ++i) {
        ff_status status = checks[i](pack, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}
