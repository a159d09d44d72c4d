/* catalogue_build.h - what the parts of catalogue reading share: a catalogue that grows. */
#ifndef FF_CATALOGUE_BUILD_H
#define FF_CATALOGUE_BUILD_H

#include "mocap/catalogue.h"
#include "runtime/core/base/memory.h"

/* Strings and override lists are kept in chained blocks until ff_catalogue_free. */
typedef struct ff_catalogue_builder {
    ff_array entries; /* ff_catalogue_entry */
    void *memory;
    char *skin; /* of the last catalogue that names one */
    ff_load_options skin_options;
} ff_catalogue_builder;

/* size zeroed bytes that live as long as the catalogue; NULL when memory is short. */
void *ff_catalogue_keep(ff_catalogue_builder *builder, size_t size);
char *ff_catalogue_keep_text(ff_catalogue_builder *builder, const char *text);
char *ff_catalogue_keep_joined(ff_catalogue_builder *builder, const char *a, const char *b, const char *c);
/* folder/name, or name alone when it is absolute or folder is "". */
char *ff_catalogue_keep_path(ff_catalogue_builder *builder, const char *folder, const char *name);

/* An entry as it is when nothing is said about it; its path is "". */
ff_catalogue_entry ff_catalogue_default(void);

/* False when memory is short, also for a path that is NULL because it was. */
bool ff_catalogue_add(ff_catalogue_builder *builder, ff_catalogue_entry entry);

bool ff_is_clip_path(const char *path); /* ends in .amc, .bvh, .gltf or .glb */

/* Add an entry, or, for a glTF file (whose name no #ANIMATION follows), one for each of its animations that moves. */
ff_status ff_catalogue_add_clips(ff_catalogue_builder *builder, ff_catalogue_entry entry, ff_error *error);

/* Add what the text of a catalogue file lists; path: of the file. */
ff_status ff_catalogue_add_text(ff_catalogue_builder *builder, const char *text, size_t size,
                                const char *path, const char *folder, ff_error *error);

/* Add what a catalogue file lists; its files are below folder when that is not NULL. */
ff_status ff_catalogue_add_json(ff_catalogue_builder *builder, const char *path, const char *folder,
                                ff_error *error);

/* Add every clip below a folder; of a clip that is there as AMC and as BVH, the AMC. */
ff_status ff_catalogue_add_folder(ff_catalogue_builder *builder, const char *path, ff_error *error);

#endif
