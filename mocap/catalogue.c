#include "mocap/catalogue.h"

#include "mocap/catalogue_build.h"
#include "runtime/core/base/fail.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

typedef struct block {
    struct block *next;
    max_align_t data[];
} block;

void *ff_catalogue_keep(ff_catalogue_builder *builder, size_t size)
{
    block *kept = calloc(1, sizeof *kept + size);
    if (!kept) return NULL;
    kept->next = builder->memory;
    builder->memory = kept;
    return kept->data;
}

char *ff_catalogue_keep_text(ff_catalogue_builder *builder, const char *text)
{
    size_t size = strlen(text) + 1;
    char *kept = ff_catalogue_keep(builder, size);
    return kept ? memcpy(kept, text, size) : NULL;
}

char *ff_catalogue_keep_joined(ff_catalogue_builder *builder, const char *a, const char *b, const char *c)
{
    size_t size = strlen(a) + strlen(b) + strlen(c) + 1;
    char *kept = ff_catalogue_keep(builder, size);
    if (kept) snprintf(kept, size, "%s%s%s", a, b, c);
    return kept;
}

char *ff_catalogue_keep_path(ff_catalogue_builder *builder, const char *folder, const char *name)
{
    size_t front = *name == '/' ? 0 : strlen(folder), size = strlen(name) + 1;
    bool slash = front > 0 && folder[front - 1] != '/';
    char *kept = ff_catalogue_keep(builder, front + slash + size);
    if (!kept) return NULL;
    memcpy(kept, folder, front);
    if (slash) kept[front] = '/';
    memcpy(kept + front + slash, name, size);
    return kept;
}

ff_catalogue_entry ff_catalogue_default(void)
{
    static char nothing[1] = "";
    return (ff_catalogue_entry){.path = nothing,
                                .options = ff_load_options_default(),
                                .tags = nothing,
                                .mode = nothing,
                                .trim_last = -1,
                                .mirror = true,
                                .licence = nothing,
                                .citation = nothing};
}

bool ff_catalogue_add(ff_catalogue_builder *builder, ff_catalogue_entry entry)
{
    ff_catalogue_entry *added = entry.path ? ff_array_grow(&builder->entries, 1, sizeof *added) : NULL;
    if (added) *added = entry;
    return added != NULL;
}

static bool ends_in(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

bool ff_is_clip_path(const char *path)
{
    return ends_in(path, ".amc") || ends_in(path, ".bvh") || ends_in(path, ".gltf") || ends_in(path, ".glb");
}

static ff_status fail_memory(ff_error *error)
{
    return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the catalogue");
}

/* CATALOGUE.json:FOLDER says where the catalogue's files are. */
static ff_status add_placed_catalogue(ff_catalogue_builder *builder, const char *input, const char *colon,
                                      ff_error *error)
{
    char *path = ff_catalogue_keep_text(builder, input);
    if (!path) return fail_memory(error);
    path[colon - input] = '\0';
    /* NOLINTNEXTLINE(clang-analyzer-unix.Malloc): the builder keeps path in its list of blocks */
    return ff_catalogue_add_json(builder, path, colon + 1, error);
}

static ff_status add_input(ff_catalogue_builder *builder, const char *input, ff_error *error)
{
    struct stat info;
    if (stat(input, &info) == 0 && S_ISDIR(info.st_mode))
        return ff_catalogue_add_folder(builder, input, error);
    if (ends_in(input, ".json")) return ff_catalogue_add_json(builder, input, NULL, error);
    const char *placed = strstr(input, ".json:");
    if (placed) return add_placed_catalogue(builder, input, placed + 5, error);
    if (ff_is_clip_path(input) || input[ff_clip_file_length(input)] == '#') {
        ff_catalogue_entry entry = ff_catalogue_default();
        entry.path = ff_catalogue_keep_text(builder, input);
        return ff_catalogue_add_clips(builder, entry, error);
    }
    ff_fail(error, FF_ERR_ARGUMENT,
            "neither a catalogue (.json), a folder nor a clip (.amc, .bvh, .gltf, .glb)");
    ff_error_in_file(error, input);
    return FF_ERR_ARGUMENT;
}

static int by_path(const void *left, const void *right)
{
    const ff_catalogue_entry *a = left, *b = right;
    int order = strcmp(a->path, b->path);
    if (order != 0) return order;
    if (a->trim_first != b->trim_first) return a->trim_first < b->trim_first ? -1 : 1;
    return (a->trim_last > b->trim_last) - (a->trim_last < b->trim_last);
}

/* The same stretch of the same file may come from a folder and from a list: it is taken once. */
static void drop_repeated(ff_catalogue *catalogue)
{
    int kept = 0;
    for (int i = 0; i < catalogue->count; ++i)
        if (kept == 0 || by_path(&catalogue->entries[kept - 1], &catalogue->entries[i]) != 0)
            catalogue->entries[kept++] = catalogue->entries[i];
    catalogue->count = kept;
}

ff_status ff_catalogue_read(const char *const *inputs, int input_count, ff_catalogue *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    ff_catalogue_builder builder = {.memory = NULL};
    ff_status status = FF_OK;
    for (int i = 0; i < input_count && status == FF_OK; ++i)
        status = add_input(&builder, inputs[i], error);
    out->entries = builder.entries.data;
    out->count = (int)builder.entries.count;
    out->memory = builder.memory;
    out->skin = builder.skin;
    out->skin_options = builder.skin_options;
    if (status == FF_OK && out->count == 0)
        status =
            ff_fail(error, FF_ERR_NO_DATA, "no clip to read: no .amc, .bvh, .gltf or .glb in what was given");
    if (status != FF_OK) {
        ff_catalogue_free(out);
        return status;
    }
    qsort(out->entries, (size_t)out->count, sizeof *out->entries, by_path);
    drop_repeated(out);
    return FF_OK;
}

void ff_catalogue_free(ff_catalogue *catalogue)
{
    free(catalogue->entries);
    for (block *kept = catalogue->memory; kept;) {
        block *next = kept->next;
        free(kept);
        kept = next;
    }
    memset(catalogue, 0, sizeof *catalogue);
}
