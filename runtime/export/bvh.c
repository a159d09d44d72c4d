#include "runtime/export/bvh.h"

#include "runtime/export/text.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* BVH names are words. */
static void word(const char *name, char *out, size_t size)
{
    snprintf(out, size, "%s", name);
    for (char *c = out; *c; ++c)
        if (!isalnum((unsigned char)*c) && *c != '-' && *c != '.') *c = '_';
}

static bool is_leaf(const ff_figure *figure, uint32_t joint)
{
    for (uint32_t j = joint + 1; j < figure->joint_count; ++j)
        if (figure->parent[j] == (int32_t)joint) return false;
    return true;
}

static void write_offset(ff_text *text, int depth, ff_vec3 offset)
{
    ff_text_add(text, "%*sOFFSET %.6f %.6f %.6f\n", 2 * depth, "", offset.x, offset.y, offset.z);
}

/* Recursion is as deep as the skeleton, at most FF_FIGURE_MAX_JOINTS. */
static void write_joint(ff_text *text, const ff_figure *figure, double scale, uint32_t joint, int depth,
                        uint32_t *order, uint32_t *count)
{
    char name[sizeof figure->name[0]];
    word(figure->name[joint], name, sizeof name);
    order[(*count)++] = joint;
    ff_text_add(text, "%*s%s %s\n%*s{\n", 2 * depth, "", depth ? "JOINT" : "ROOT", name, 2 * depth, "");
    write_offset(text, depth + 1, depth ? ff_scale3(figure->offset[joint], scale) : ff_v3(0.0, 0.0, 0.0));
    ff_text_add(text, "%*sCHANNELS %sZrotation Xrotation Yrotation\n", 2 * depth + 2, "",
                depth ? "3 " : "6 Xposition Yposition Zposition ");
    for (uint32_t j = joint + 1; j < figure->joint_count; ++j)
        if (figure->parent[j] == (int32_t)joint) write_joint(text, figure, scale, j, depth + 1, order, count);
    if (is_leaf(figure, joint)) {
        ff_text_add(text, "%*sEnd Site\n%*s{\n", 2 * depth + 2, "", 2 * depth + 2, "");
        write_offset(text, depth + 2, ff_scale3(ff_figure_tip(figure, joint), scale));
        ff_text_add(text, "%*s}\n", 2 * depth + 2, "");
    }
    ff_text_add(text, "%*s}\n", 2 * depth, "");
}

/* Angles z, x, y with q = Rz * Rx * Ry. */
static void angles_zxy(ff_quat q, double out[3])
{
    double m01 = 2.0 * (q.x * q.y - q.z * q.w), m11 = 1.0 - 2.0 * (q.x * q.x + q.z * q.z);
    double m20 = 2.0 * (q.x * q.z - q.y * q.w), m22 = 1.0 - 2.0 * (q.x * q.x + q.y * q.y);
    double m21 = 2.0 * (q.y * q.z + q.x * q.w);
    out[1] = asin(ff_clamp(m21, -1.0, 1.0));
    if (fabs(m21) < 0.9999999) {
        out[0] = atan2(-m01, m11);
        out[2] = atan2(-m20, m22);
    } else { /* z and y turn about one axis: z takes all of it */
        out[0] = atan2(2.0 * (q.x * q.y + q.z * q.w), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
        out[2] = 0.0;
    }
}

/* Whole turns are added so that a curve editor shows no jumps. */
static void write_rotation(ff_text *text, ff_quat q, double last[3])
{
    double angles[3];
    angles_zxy(q, angles);
    for (int k = 0; k < 3; ++k) {
        double degrees = angles[k] / FF_DEG;
        degrees += 360.0 * floor((last[k] - degrees) / 360.0 + 0.5);
        last[k] = degrees;
        ff_text_add(text, " %.5f", degrees);
    }
}

ff_status ff_recording_write_bvh(const char *path, const ff_figure *figure, const ff_recording *recording,
                                 uint32_t agent, ff_error *error)
{
    uint32_t order[FF_FIGURE_MAX_JOINTS], count = 0;
    ff_text text = {0};
    ff_text_add(&text, "HIERARCHY\n");
    write_joint(&text, figure, ff_recording_scale(recording, agent), 0, 0, order, &count);
    ff_text_add(&text, "MOTION\nFrames: %u\nFrame Time: %.8f\n", recording->pose_count,
                ff_recording_pose_step(recording));
    double last[FF_FIGURE_MAX_JOINTS][3];
    memset(last, 0, sizeof last);
    for (uint32_t k = 0; k < recording->pose_count; ++k) {
        ff_vec3 hips;
        ff_quat rotations[FF_FIGURE_MAX_JOINTS];
        ff_recording_pose(recording, k, agent, &hips, rotations);
        ff_text_add(&text, "%.6f %.6f %.6f", hips.x, hips.y, hips.z);
        for (uint32_t i = 0; i < count; ++i)
            write_rotation(&text, rotations[order[i]], last[i]);
        ff_text_add(&text, "\n");
    }
    return ff_text_write(&text, path, error);
}
