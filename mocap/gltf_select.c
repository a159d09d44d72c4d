/* A document without the keys of the animations that are not asked for: files of games hold a hundred of them in
 * thousands of accessors, and parsing these for each clip is most of the work. */
#include "mocap/gltf_guard.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

int ff_gltf_find_animation(const char *const *names, int count, const char *wanted)
{
    if (!wanted) return count > 0 ? 0 : -1;
    for (int i = 0; i < count; ++i)
        if (names[i] && strcmp(names[i], wanted) == 0) return i;
    char *end = NULL;
    long index = strtol(wanted, &end, 10);
    return *wanted && *end == '\0' && index >= 0 && index < count ? (int)index : -1;
}

static int find_in(const json_t *animations, const char *wanted)
{
    int count = (int)json_array_size(animations);
    const char **names = ff_calloc((size_t)count, sizeof *names);
    for (int i = 0; names && i < count; ++i)
        names[i] = json_string_value(json_object_get(json_array_get(animations, (size_t)i), "name"));
    int found = names ? ff_gltf_find_animation(names, count, wanted) : -1;
    free(names);
    return found;
}

/* ----------------------------------------------------------------------------------------------- what is used */

static void mark(ff_gltf_numbers *numbers, const json_t *index)
{
    json_int_t i = json_is_integer(index) ? json_integer_value(index) : -1;
    if (i >= 0 && (size_t)i < numbers->count) numbers->to[i] = 0;
}

static void mark_animation(ff_gltf_numbers *accessors, const json_t *animation)
{
    size_t i;
    json_t *sampler;
    json_array_foreach(json_object_get(animation, "samplers"), i, sampler)
    {
        mark(accessors, json_object_get(sampler, "input"));
        mark(accessors, json_object_get(sampler, "output"));
    }
}

static void mark_skins(ff_gltf_numbers *accessors, const json_t *root)
{
    size_t i, k;
    json_t *skin, *mesh, *primitive, *attribute;
    const char *key;
    json_array_foreach(json_object_get(root, "skins"), i, skin)
        mark(accessors, json_object_get(skin, "inverseBindMatrices"));
    json_array_foreach(json_object_get(root, "meshes"), i, mesh)
    {
        json_array_foreach(json_object_get(mesh, "primitives"), k, primitive)
        {
            mark(accessors, json_object_get(primitive, "indices"));
            json_object_foreach(json_object_get(primitive, "attributes"), key, attribute)
                mark(accessors, attribute);
        }
    }
}

static void mark_views(ff_gltf_numbers *views, const json_t *root, const ff_gltf_numbers *accessors)
{
    for (size_t i = 0; i < accessors->count; ++i) {
        if (accessors->to[i] == UINT32_MAX) continue;
        const json_t *accessor = json_array_get(json_object_get(root, "accessors"), i);
        const json_t *sparse = json_object_get(accessor, "sparse");
        mark(views, json_object_get(accessor, "bufferView"));
        mark(views, json_object_get(json_object_get(sparse, "indices"), "bufferView"));
        mark(views, json_object_get(json_object_get(sparse, "values"), "bufferView"));
    }
}

static bool start_numbers(ff_gltf_numbers *numbers, const json_t *list)
{
    numbers->count = json_array_size(list);
    numbers->to = ff_calloc(numbers->count, sizeof *numbers->to);
    for (size_t i = 0; numbers->to && i < numbers->count; ++i)
        numbers->to[i] = UINT32_MAX;
    return numbers->to != NULL;
}

/* ------------------------------------------------------------------------------------------------ the selection */

/* The same elements, without those that are not used; their new numbers. */
static bool replace_list(json_t *root, const char *key, ff_gltf_numbers *numbers)
{
    json_t *list = json_object_get(root, key), *shorter = json_array();
    if (!list || !json_is_array(list)) {
        json_decref(shorter);
        return true;
    }
    uint32_t next = 0;
    bool done = shorter != NULL;
    for (size_t i = 0; done && i < numbers->count; ++i) {
        if (numbers->to[i] == UINT32_MAX) continue;
        numbers->to[i] = next++;
        done = json_array_append(shorter, json_array_get(list, i)) == 0;
    }
    return json_object_set_new(root, key, shorter) == 0 && done;
}

/* Others keep their names, by which the right one is found, and nothing else. */
static bool replace_animations(json_t *root, int kept)
{
    const json_t *list = json_object_get(root, "animations");
    json_t *shorter = json_array();
    bool done = shorter != NULL;
    for (size_t i = 0; done && i < json_array_size(list); ++i) {
        json_t *animation = json_array_get(list, i), *name = json_object_get(animation, "name");
        if ((int)i == kept) {
            done = json_array_append(shorter, animation) == 0;
            continue;
        }
        json_t *empty = json_pack("{s:[], s:[]}", "channels", "samplers");
        if (empty && json_is_string(name)) json_object_set(empty, "name", name);
        done = json_array_append_new(shorter, empty) == 0;
    }
    return json_object_set_new(root, "animations", shorter) == 0 && done;
}

ff_status ff_gltf_select(const ff_json *json, const char *animation, ff_gltf_selection *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    const json_t *animations = json_object_get(json->root, "animations");
    out->root = json_copy(json->root);
    bool done = out->root && start_numbers(&out->accessors, json_object_get(out->root, "accessors")) &&
                start_numbers(&out->views, json_object_get(out->root, "bufferViews"));
    if (done) {
        int kept = find_in(animations, animation);
        if (kept >= 0) mark_animation(&out->accessors, json_array_get(animations, (size_t)kept));
        mark_skins(&out->accessors, out->root);
        mark_views(&out->views, out->root, &out->accessors);
        done = (!json_is_array(animations) || replace_animations(out->root, kept)) &&
               replace_list(out->root, "accessors", &out->accessors) &&
               replace_list(out->root, "bufferViews", &out->views);
    }
    if (done) return FF_OK;
    ff_gltf_selection_free(out);
    return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the document");
}

void ff_gltf_selection_free(ff_gltf_selection *selection)
{
    json_decref(selection->root);
    free(selection->accessors.to);
    free(selection->views.to);
    memset(selection, 0, sizeof *selection);
}

/* ------------------------------------------------------------------------------------------------- new numbers */

/* What names nothing in the file still names nothing. */
static bool renumber(json_t *holder, const char *key, const ff_gltf_numbers *numbers)
{
    const json_t *index = json_object_get(holder, key);
    if (!index) return true;
    size_t i = (size_t)json_integer_value(index);
    return i >= numbers->count || json_object_set_new(holder, key, json_integer(numbers->to[i])) == 0;
}

static bool renumber_places(json_t *accessor, const ff_gltf_numbers *views)
{
    json_t *sparse = json_object_get(accessor, "sparse");
    bool done = renumber(accessor, "bufferView", views);
    if (!sparse) return done;
    return renumber(json_object_get(sparse, "indices"), "bufferView", views) &&
           renumber(json_object_get(sparse, "values"), "bufferView", views) && done;
}

static bool renumber_users(const json_t *document, const ff_gltf_numbers *accessors)
{
    size_t i, k;
    json_t *item, *part, *index;
    const char *key;
    void *next;
    bool done = true;
    json_array_foreach(json_object_get(document, "animations"), i, item)
    {
        json_array_foreach(json_object_get(item, "samplers"), k, part) done =
            renumber(part, "input", accessors) && renumber(part, "output", accessors) && done;
    }
    json_array_foreach(json_object_get(document, "skins"), i, item) done =
        renumber(item, "inverseBindMatrices", accessors) && done;
    json_array_foreach(json_object_get(document, "meshes"), i, item)
    {
        json_array_foreach(json_object_get(item, "primitives"), k, part)
        {
            json_t *attributes = json_object_get(part, "attributes");
            done = renumber(part, "indices", accessors) && done;
            json_object_foreach_safe(attributes, next, key, index) done =
                renumber(attributes, key, accessors) && done;
        }
    }
    return done;
}

/* tinygltf carries names along: there the numbers of the file travel, for messages. */
static bool keep_numbers(const json_t *document, const char *key, const ff_gltf_numbers *numbers)
{
    const json_t *list = json_object_get(document, key);
    bool done = true;
    for (size_t i = 0; list && i < numbers->count; ++i)
        if (numbers->to[i] != UINT32_MAX)
            done = json_object_set_new(json_array_get(list, numbers->to[i]), "name",
                                       json_sprintf("%zu", i)) == 0 &&
                   done;
    return done;
}

ff_status ff_gltf_renumber(const ff_gltf_selection *selection, json_t *document, ff_error *error)
{
    size_t i;
    json_t *accessor;
    bool done = renumber_users(document, &selection->accessors);
    json_array_foreach(json_object_get(document, "accessors"), i, accessor) done =
        renumber_places(accessor, &selection->views) && done;
    done = keep_numbers(document, "accessors", &selection->accessors) && done;
    done = keep_numbers(document, "bufferViews", &selection->views) && done;
    return done ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the document");
}
