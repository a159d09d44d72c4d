/* The glTF reader on any bytes: clip and skin. */
#include "mocap/gltf_skin.h"
#include "tests/fuzz/clip_check.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_skin(const char *data, size_t size)
{
    ff_gltf gltf;
    ff_gltf_skeleton skeleton;
    ff_skin skin;
    if (ff_gltf_open(data, size, "/none/fuzz.gltf", (ff_gltf_keys){.all = size % 2}, &gltf, NULL) != FF_OK)
        return;
    if (ff_gltf_skeleton_find(&gltf, -1, &skeleton, NULL) == FF_OK &&
        ff_gltf_skin_read(&gltf, &skeleton, &skin, NULL) == FF_OK) {
        for (int i = 0; i < skin.vertex_count; ++i)
            for (int b = 0; b < FF_SKIN_BONES; ++b)
                must(skin.vertices[i].joint[b] >= 0 && skin.vertices[i].joint[b] < skeleton.count);
        for (int i = 0; i < 3 * skin.triangle_count; ++i)
            must(skin.triangles[i / 3][i % 3] < (uint32_t)skin.vertex_count);
        ff_skin_free(&skin);
    }
    ff_gltf_skeleton_free(&skeleton);
    ff_gltf_close(&gltf);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    const char *text = (const char *)data;
    if (ff_gltf_parse(text, size, "/none/fuzz.gltf", size % 3 ? NULL : "1", &options, &clip, &error) ==
        FF_OK) {
        if (size % 2) must(ff_clip_restore_travel(&clip, false, &error) == FF_OK || error.message[0]);
        check_clip(&clip, size % 2 ? 'y' : 'z');
    } else {
        must(error.status != FF_OK && error.message[0] && error.file[0]);
    }
    check_skin(text, size);
    return 0;
}
