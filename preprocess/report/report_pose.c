#include "preprocess/report/report_parts.h"

#include <stdio.h>
#include <string.h>

void ff_report_text(ff_text *page, const char *text)
{
    char out[500];
    size_t used = 0;
    for (; *text && used < 480; ++text) {
        const char *plain = *text == '<' ? "&lt;" : (*text == '>' ? "&gt;" : (*text == '&' ? "&amp;" : NULL));
        if (*text == '"') plain = "&quot;";
        int length = plain ? snprintf(out + used, sizeof out - used, "%s", plain)
                           : snprintf(out + used, sizeof out - used, "%c", *text);
        used += (size_t)length;
    }
    out[used] = 0;
    ff_text_add(page, "%s", out);
}

const char *ff_report_mode(uint32_t mode)
{
    static const char *const names[FF_MODE_COUNT] = {"idle",  "short step", "long step", "run",   "jump",
                                                     "climb", "turn",       "crouch",    "start", "stop"};
    return mode < FF_MODE_COUNT ? names[mode] : "?";
}

const char *ff_report_colour(uint32_t mode)
{
    static const char *const colours[FF_MODE_COUNT] = {"#b8b8b8", "#8fd19e", "#4caf6d", "#f4a259", "#b07cc6",
                                                       "#8d6e63", "#f2c14e", "#7fb2d9", "#5bc0be", "#e07a7a"};
    return mode < FF_MODE_COUNT ? colours[mode] : "#000";
}

void ff_report_pose(const ff_pack *pack, uint32_t stream, double seconds, ff_vec3 *positions)
{
    ff_quat world[FF_PACK_MAX_JOINTS];
    ff_root_frame root;
    ff_pack_sample(pack, stream, seconds, 0, &root, &positions[0], world, NULL);
    ff_root_place(&root, &positions[0], &world[0]);
    for (uint32_t j = 1; j < pack->joint_count; ++j) {
        int32_t parent = pack->joints[j].parent;
        ff_vec3 offset = ff_pack_joint_offset(pack, j);
        positions[j] = ff_add3(positions[parent], ff_quat_rotate(world[parent], offset));
        world[j] = ff_quat_mul(world[parent], world[j]);
    }
    for (uint32_t p = 0; p < pack->point_count; ++p) {
        const ff_pack_point *point = &pack->points[p];
        ff_vec3 offset = ff_v3((double)point->offset[0], (double)point->offset[1], (double)point->offset[2]);
        positions[pack->joint_count + p] =
            ff_add3(positions[point->joint], ff_quat_rotate(world[point->joint], offset));
    }
}
