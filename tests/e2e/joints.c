/* joints.c - where the joints of every animation of a glTF file are, as the reader sees them: a table to compare with
 * another loader's.
 *
 *   joints FILE
 *
 * "A INDEX" begins an animation, "F SECONDS" a frame (from its first key), then a line "NAME TAB X TAB Y TAB Z" a joint, in
 * file units, before anything is scaled or moved. */
#include "mocap/gltf.h"
#include "mocap/read.h"
#include "runtime/core/base/file.h"

#include <stdio.h>
#include <string.h>

enum { FRAMES_SHOWN = 25 };

static void print_clip(const ff_clip *clip)
{
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    int stride = (clip->frame_count - 1) / FRAMES_SHOWN + 1;
    for (int k = 0; k < clip->frame_count; k += stride) {
        printf("F %.17g\n", k * clip->frame_time);
        ff_clip_pose(clip, k, at, NULL);
        for (int j = 0; j < clip->joint_count; ++j)
            if (!clip->joints[j].end_site)
                printf("%s\t%.9g\t%.9g\t%.9g\n", clip->joints[j].name, at[j].x, at[j].y, at[j].z);
    }
}

static ff_status print_file(const ff_file *file, const char *path, ff_error *error)
{
    ff_load_options options = ff_load_options_default();
    ff_gltf gltf;
    ff_status status = ff_gltf_open(file->data, file->size, path, (ff_gltf_keys){.all = true}, &gltf, error);
    int count = status == FF_OK ? gltf.animation_count : 0;
    if (status == FF_OK) ff_gltf_close(&gltf);
    for (int i = 0; i < count && status == FF_OK; ++i) {
        char index[16];
        ff_clip clip;
        snprintf(index, sizeof index, "%d", i);
        status = ff_gltf_parse(file->data, file->size, path, index, &options, &clip, error);
        if (status != FF_OK) break;
        printf("A %d\n", i);
        print_clip(&clip);
        ff_clip_free(&clip);
    }
    return status;
}

int main(int argc, char **argv)
{
    ff_error error;
    ff_file file;
    char text[1024];
    if (argc != 2) return 2;
    ff_status status = ff_file_map(argv[1], &file, &error);
    if (status == FF_OK) {
        status = print_file(&file, argv[1], &error);
        ff_file_unmap(&file);
    }
    if (status != FF_OK) fprintf(stderr, "joints: %s\n", ff_error_text(&error, text, sizeof text));
    return status == FF_OK ? 0 : 1;
}
