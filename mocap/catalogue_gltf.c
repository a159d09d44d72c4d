/* The animations of a glTF file, each an entry of its own: FILE#NAME. */
#include "mocap/catalogue_build.h"
#include "mocap/gltf.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* Does it hold motion of nodes? One key is a pose. */
static bool moves(const ff_gltf *gltf, int animation)
{
    const ff_gltf_animation *a = &gltf->animations[animation];
    for (int c = 0; c < a->channel_count; ++c) {
        const ff_gltf_channel *channel = &gltf->channels[a->first_channel + c];
        if (channel->node >= 0 && channel->path != FF_GLTF_OTHER && gltf->accessors[channel->input].count > 1)
            return true;
    }
    return false;
}

/* A name can stand behind the '#' when it is the only one so called and is no path or control character. */
static bool is_usable_name(const ff_gltf *gltf, int animation)
{
    const char *name = gltf->animations[animation].name;
    for (const char *c = name; *c; ++c)
        if ((unsigned char)*c < ' ' || *c == '/' || *c == '#') return false;
    for (int i = 0; i < gltf->animation_count; ++i)
        if (i != animation && strcmp(gltf->animations[i].name, name) == 0) return false;
    return *name != '\0' && strlen(name) < sizeof gltf->animations[0].name - 1;
}

static ff_status add_animations(ff_catalogue_builder *builder, ff_catalogue_entry entry, const ff_gltf *gltf,
                                ff_error *error)
{
    char *file = entry.path;
    int added = 0;
    for (int i = 0; i < gltf->animation_count; ++i) {
        char index[16];
        if (!moves(gltf, i)) continue;
        ++added;
        snprintf(index, sizeof index, "%d", i);
        if (gltf->animation_count > 1 || gltf->animations[i].name[0])
            entry.path = ff_catalogue_keep_joined(builder, file, "#",
                                                  is_usable_name(gltf, i) ? gltf->animations[i].name : index);
        if (!ff_catalogue_add(builder, entry))
            return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the animations of %s", file);
    }
    /* A file without any is an entry all the same: reading it says what is the matter. */
    if (added > 0 || ff_catalogue_add(builder, entry)) return FF_OK;
    return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %s", file);
}

ff_status ff_catalogue_add_clips(ff_catalogue_builder *builder, ff_catalogue_entry entry, ff_error *error)
{
    const char *ending = entry.path ? strrchr(entry.path, '.') : NULL;
    ff_file file;
    ff_gltf gltf;
    bool several = ending && (strcasecmp(ending, ".gltf") == 0 || strcasecmp(ending, ".glb") == 0);
    /* A file that cannot be read is left to the build, which names it and goes on with the others. */
    if (several && ff_file_map(entry.path, &file, NULL) == FF_OK) {
        ff_status status =
            ff_gltf_open(file.data, file.size, entry.path, (ff_gltf_keys){.all = true}, &gltf, NULL);
        ff_file_unmap(&file);
        if (status == FF_OK) {
            status = add_animations(builder, entry, &gltf, error);
            ff_gltf_close(&gltf);
            return status;
        }
    }
    if (ff_catalogue_add(builder, entry)) return FF_OK;
    return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the catalogue");
}
