/* BVH out. */
#include "mocap/euler.h"
#include "mocap/print.h"
#include "mocap/tree.h"
#include "mocap/write.h"

enum { DECIMALS = 6 };

typedef struct writer {
    const ff_clip *clip;
    ff_tree tree;
    ff_print text;
    double per_unit; /* file units per metre */
} writer;

static void close_to(writer *w, int depth, int target)
{
    for (; depth >= target; --depth) {
        ff_print_repeat(&w->text, "\t", depth);
        ff_print_text(&w->text, "}\n");
    }
}

static void write_joint(writer *w, int index)
{
    const ff_joint *joint = &w->clip->joints[index];
    int depth = w->tree.depth[index];
    ff_print_repeat(&w->text, "\t", depth);
    ff_print_text(&w->text, joint->end_site ? "End Site" : (depth == 0 ? "ROOT " : "JOINT "));
    if (!joint->end_site) ff_print_text(&w->text, joint->name);
    ff_print_text(&w->text, "\n");
    ff_print_repeat(&w->text, "\t", depth);
    ff_print_text(&w->text, "{\n");
    ff_print_repeat(&w->text, "\t", depth + 1);
    ff_print_text(&w->text, "OFFSET");
    ff_print_vec3(&w->text, ff_scale3(joint->offset, w->per_unit), DECIMALS);
    ff_print_text(&w->text, "\n");
    if (joint->end_site) return;
    ff_print_repeat(&w->text, "\t", depth + 1);
    ff_print_text(&w->text, joint->track >= 0
                                ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
                                : "CHANNELS 3 Zrotation Xrotation Yrotation\n");
}

static void write_hierarchy(writer *w)
{
    ff_print_text(&w->text, "HIERARCHY\n");
    int open = -1;
    for (int i = 0; i < w->clip->joint_count; ++i) {
        int joint = w->tree.order[i];
        close_to(w, open, w->tree.depth[joint]);
        write_joint(w, joint);
        open = w->tree.depth[joint];
    }
    close_to(w, open, 0);
}

static void write_frame(writer *w, int frame)
{
    const ff_clip *clip = w->clip;
    const ff_quat *rotations = clip->rotations + (size_t)frame * (size_t)clip->joint_count;
    for (int i = 0; i < clip->joint_count; ++i) {
        int joint = w->tree.order[i], track = clip->joints[joint].track;
        if (clip->joints[joint].end_site) continue;
        if (track >= 0) {
            ff_vec3 at = clip->positions[(size_t)frame * (size_t)clip->track_count + (size_t)track];
            ff_print_vec3(&w->text, ff_scale3(at, w->per_unit), DECIMALS);
        }
        ff_vec3 angles = ff_euler_zxy(rotations[joint]);
        ff_print_vec3(&w->text, ff_v3(angles.z, angles.x, angles.y), DECIMALS);
    }
    ff_print_text(&w->text, "\n");
}

ff_status ff_bvh_write(const char *path, const ff_clip *clip, ff_error *error)
{
    writer w = {.clip = clip, .per_unit = clip->unit_m > 0.0 ? 1.0 / clip->unit_m : 1.0};
    ff_status status = ff_tree_build(clip, &w.tree, error);
    if (status != FF_OK) return status;
    write_hierarchy(&w);
    ff_print_text(&w.text, "MOTION\nFrames: ");
    ff_print_integer(&w.text, clip->frame_count);
    ff_print_text(&w.text, "\nFrame Time: ");
    ff_print_number(&w.text, clip->frame_time, 9);
    ff_print_text(&w.text, "\n");
    for (int frame = 0; frame < clip->frame_count; ++frame)
        write_frame(&w, frame);
    ff_tree_free(&w.tree);
    return ff_print_to_file(&w.text, path, error);
}
