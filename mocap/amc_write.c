/* ASF and AMC out. All axes are those of the world (C = identity), so a bone's angles are its joint's local rotation.
 *
 * An ASF bone ends in one place and all its children start there. A joint whose children start in several places
 * becomes a bone of no length with a rigid bone to each, as CMU's own skeletons have at the root (lhipjoint). */
#include "mocap/euler.h"
#include "mocap/print.h"
#include "mocap/tree.h"
#include "mocap/write.h"
#include "runtime/core/base/fail.h"

#include <stdio.h>
#include <string.h>

enum { DECIMALS = 6 };

typedef struct writer {
    const ff_clip *clip;
    ff_tree tree;
    ff_print text;
    double per_unit; /* file units per metre */
} writer;

/* Names as ASF can have them: one word, the root is "root". */
static void bone_name(const writer *w, int joint, char name[80])
{
    snprintf(name, 80, "%s", joint == 0 ? "root" : w->clip->joints[joint].name);
    for (char *p = name; *p; ++p)
        if ((unsigned char)*p <= ' ' || *p == '{' || *p == '}') *p = '_';
}

static void link_name(const writer *w, int child, char name[80])
{
    char of[80];
    bone_name(w, child, of);
    if (w->clip->joints[child].end_site) /* end sites often share a name */
        snprintf(name, 80, "tip_%d", child);
    else
        snprintf(name, 80, "to_%.60s", of);
}

/* The one place where all children of a joint start, or false. Bones of a joint without children have no length. */
static bool single_end(const writer *w, int joint, ff_vec3 *end)
{
    *end = ff_v3(0.0, 0.0, 0.0);
    int first = w->tree.first_child[joint];
    if (first < 0) return true;
    ff_vec3 at = w->clip->joints[first].offset;
    for (int c = first; c >= 0; c = w->tree.next_sibling[c])
        if (ff_length3(ff_sub3(w->clip->joints[c].offset, at)) > 1e-9) return false;
    if (joint == 0 && ff_length3(at) > 0.0) return false; /* the root has no length of its own */
    *end = at;
    return true;
}

static void write_bone(writer *w, int id, const char *name, ff_vec3 end, bool moves)
{
    double length = ff_length3(end);
    ff_print_text(&w->text, "  begin\n    id ");
    ff_print_integer(&w->text, id);
    ff_print_text(&w->text, "\n    name ");
    ff_print_text(&w->text, name);
    ff_print_text(&w->text, "\n    direction");
    ff_print_vec3(&w->text, length > 0.0 ? ff_scale3(end, 1.0 / length) : ff_v3(0.0, 1.0, 0.0), 9);
    ff_print_text(&w->text, "\n    length ");
    ff_print_number(&w->text, length * w->per_unit, DECIMALS);
    ff_print_text(&w->text, "\n    axis 0 0 0 XYZ\n");
    if (moves) ff_print_text(&w->text, "    dof rx ry rz\n");
    ff_print_text(&w->text, "  end\n");
}

static void write_bones(writer *w)
{
    const ff_clip *clip = w->clip;
    char name[80];
    ff_vec3 end;
    int id = 0;
    ff_print_text(&w->text, ":bonedata\n");
    for (int i = 0; i < clip->joint_count; ++i) {
        int joint = w->tree.order[i];
        if (clip->joints[joint].end_site) continue;
        bone_name(w, joint, name);
        bool single = single_end(w, joint, &end);
        if (joint > 0) write_bone(w, ++id, name, end, true);
        for (int c = w->tree.first_child[joint]; c >= 0 && !single; c = w->tree.next_sibling[c]) {
            link_name(w, c, name);
            write_bone(w, ++id, name, clip->joints[c].offset, false);
        }
    }
}

static void write_children(writer *w, int joint, bool single)
{
    char name[80];
    bone_name(w, joint, name);
    ff_print_text(&w->text, "    ");
    ff_print_text(&w->text, name);
    for (int c = w->tree.first_child[joint]; c >= 0; c = w->tree.next_sibling[c]) {
        if (single && w->clip->joints[c].end_site) continue;
        ff_print_text(&w->text, " ");
        single ? bone_name(w, c, name) : link_name(w, c, name);
        ff_print_text(&w->text, name);
    }
    ff_print_text(&w->text, "\n");
}

static void write_tree(writer *w)
{
    const ff_clip *clip = w->clip;
    char name[80];
    ff_vec3 end;
    ff_print_text(&w->text, ":hierarchy\n  begin\n");
    for (int i = 0; i < clip->joint_count; ++i) {
        int joint = w->tree.order[i];
        if (clip->joints[joint].end_site) continue;
        bool single = single_end(w, joint, &end);
        write_children(w, joint, single);
        for (int c = w->tree.first_child[joint]; c >= 0 && !single; c = w->tree.next_sibling[c]) {
            if (clip->joints[c].end_site) continue;
            link_name(w, c, name);
            ff_print_text(&w->text, "    ");
            ff_print_text(&w->text, name);
            ff_print_text(&w->text, " ");
            bone_name(w, c, name);
            ff_print_text(&w->text, name);
            ff_print_text(&w->text, "\n");
        }
    }
    ff_print_text(&w->text, "  end\n");
}

static ff_status write_asf(writer *w, const char *path, ff_error *error)
{
    ff_print_text(&w->text, ":version 1.10\n:name footfall\n:units\n  mass 1.0\n  length ");
    ff_print_number(&w->text, 0.0254 * w->per_unit, 9);
    ff_print_text(&w->text, "\n  angle deg\n:root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n  position 0 0 0\n"
                            "  orientation 0 0 0\n");
    write_bones(w);
    write_tree(w);
    return ff_print_to_file(&w->text, path, error);
}

static void write_frame(writer *w, int frame)
{
    const ff_clip *clip = w->clip;
    const ff_quat *rotations = clip->rotations + (size_t)frame * (size_t)clip->joint_count;
    ff_vec3 at = clip->track_count > 0 ? clip->positions[frame] : clip->joints[0].offset;
    ff_print_text(&w->text, "root");
    ff_print_vec3(&w->text, ff_scale3(at, w->per_unit), DECIMALS);
    for (int i = 0; i < clip->joint_count; ++i) {
        int joint = w->tree.order[i];
        char name[80];
        if (clip->joints[joint].end_site) continue;
        bone_name(w, joint, name);
        if (joint > 0) ff_print_text(&w->text, name);
        ff_print_vec3(&w->text, ff_euler_zyx(rotations[joint]), DECIMALS);
        ff_print_text(&w->text, "\n");
    }
}

static ff_status write_amc(writer *w, const char *path, ff_error *error)
{
    const ff_clip *clip = w->clip;
    ff_print_text(&w->text, ":FULLY-SPECIFIED\n:DEGREES\n");
    if (fabs(clip->frame_time * 120.0 - 1.0) >
        1e-6) { /* the format has no rate and 120 is taken for granted */
        ff_print_text(&w->text, ":SAMPLES-PER-SECOND ");
        ff_print_number(&w->text, 1.0 / clip->frame_time, 6);
        ff_print_text(&w->text, "\n");
    }
    int first = clip->first_frame > 0 ? clip->first_frame : 1;
    for (int frame = 0; frame < clip->frame_count; ++frame) {
        ff_print_integer(&w->text, (long long)first + frame);
        ff_print_text(&w->text, "\n");
        write_frame(w, frame);
    }
    return ff_print_to_file(&w->text, path, error);
}

static ff_status check_skeleton(const writer *w, ff_error *error)
{
    const ff_clip *clip = w->clip;
    char a[80], b[80];
    if (clip->joints[0].parent >= 0 || clip->joints[0].end_site)
        return ff_fail(error, FF_ERR_ARGUMENT, "the first joint is no root");
    for (int j = 1; j < clip->joint_count; ++j) {
        if (clip->joints[j].parent < 0 || clip->joints[j].track >= 0)
            return ff_fail(error, FF_ERR_UNSUPPORTED,
                           "ASF can have one root and only the root can move: joint '%s'",
                           clip->joints[j].name);
        bone_name(w, j, a);
        for (int i = 0; i < j && !clip->joints[j].end_site; ++i) {
            bone_name(w, i, b);
            if (!clip->joints[i].end_site && strcmp(a, b) == 0)
                return ff_fail(error, FF_ERR_UNSUPPORTED, "two joints would be named '%s' in the ASF", a);
        }
    }
    return FF_OK;
}

ff_status ff_asf_amc_write(const char *asf_path, const char *amc_path, const ff_clip *clip, ff_error *error)
{
    writer w = {.clip = clip, .per_unit = clip->unit_m > 0.0 ? 1.0 / clip->unit_m : 1.0};
    ff_status status = ff_tree_build(clip, &w.tree, error);
    if (status != FF_OK) return status;
    status = check_skeleton(&w, error);
    if (status == FF_OK) status = write_asf(&w, asf_path, error);
    if (status == FF_OK) status = write_amc(&w, amc_path, error);
    ff_tree_free(&w.tree);
    return status;
}
