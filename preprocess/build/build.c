#define _POSIX_C_SOURCE 200809L
#include "preprocess/build/build.h"

#include "mocap/generator/generator.h"
#include "preprocess/actions/annotate.h"
#include "preprocess/actions/reach.h"
#include "preprocess/actions/successors.h"
#include "preprocess/build/build_clip.h"
#include "preprocess/build/derive_actions.h"
#include "preprocess/build/pack_fill.h"
#include "preprocess/build/select_actions.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/tasks.h"
#include "runtime/tool/progress.h"

#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

ff_build_settings ff_build_settings_default(void)
{
    return (ff_build_settings){.pack = ff_settings_default(), .threads = ff_processor_count()};
}

void ff_build_result_free(ff_build_result *result)
{
    ff_pack_content_free(&result->content);
    free(result->skipped);
    memset(result, 0, sizeof *result);
}

/* The order in which a stage takes the clips: the most work first, so that no thread ends up alone with it. */
typedef struct ordered {
    double work;
    uint32_t index;
} ordered;

typedef struct build {
    const ff_catalogue *catalogue; /* NULL = built-in clips */
    const ff_build_settings *settings;
    ff_tasks *tasks;
    ff_progress *progress;
    ff_build_clip *clips; /* the good ones first, [good, count) were left out */
    int count, good;
    ordered *order;
    atomic_int first_bad; /* with strict: clips after it need not be looked at any more */
    ff_cache cache;
    ff_rig rig;
    ff_build_shared shared;
    ff_build_result *result;
} build;

/* ---------------------------------------------------------------------------------------------------- sources */

/* Length of the folder part that all paths share, so that the rest says the same on every machine. */
static size_t shared_folder(const ff_catalogue *catalogue)
{
    if (catalogue->count == 0) return 0;
    const char *first = catalogue->entries[0].path, *slash = strrchr(first, '/');
    size_t length = slash ? (size_t)(slash - first) + 1 : 0;
    for (int i = 1; i < catalogue->count; ++i) {
        const char *path = catalogue->entries[i].path;
        size_t same = 0;
        while (same < length && path[same] == first[same])
            ++same;
        while (same > 0 && first[same - 1] != '/')
            --same;
        length = same;
    }
    return length;
}

static char *copy_text(const char *text)
{
    char *copy = malloc(strlen(text) + 1);
    if (copy) memcpy(copy, text, strlen(text) + 1);
    return copy;
}

static ff_status name_sources(build *b, ff_error *error)
{
    b->count = b->catalogue ? b->catalogue->count : ff_generator_count();
    if (b->count == 0) return ff_fail(error, FF_ERR_NO_DATA, "no clip to build from (.amc or .bvh)");
    b->clips = ff_calloc((size_t)b->count, sizeof *b->clips);
    b->order = ff_calloc((size_t)b->count, sizeof *b->order);
    if (!b->clips || !b->order)
        return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory for %d clips", b->count);
    size_t skip = b->catalogue ? shared_folder(b->catalogue) : 0;
    for (int i = 0; i < b->count; ++i) {
        char text[256];
        snprintf(text, sizeof text, "built-in/%s", b->catalogue ? "" : ff_generator_describe(i).name);
        b->clips[i].source = copy_text(b->catalogue ? b->catalogue->entries[i].path + skip : text);
        if (!b->clips[i].source)
            return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory for %d clips", b->count);
        ff_build_clip_begin(&b->clips[i], b->catalogue ? &b->catalogue->entries[i] : NULL, i);
    }
    return FF_OK;
}

/* ------------------------------------------------------------------------------------------------------ stages */

/* A rough measure for the order and the time left: bytes before anything is known of a clip, then frames. */
static double work_of(const ff_build_clip *clip)
{
    struct stat info;
    if (clip->frames > 0) return clip->frames * clip->clip.frame_time + 0.01;
    return clip->entry && stat(clip->entry->path, &info) == 0 ? 1e-6 * (double)info.st_size + 0.01 : 1.0;
}

static int by_work(const void *left, const void *right)
{
    const ordered *a = left, *b = right;
    if (a->work != b->work) return a->work < b->work ? 1 : -1;
    return (a->index > b->index) - (a->index < b->index);
}

typedef struct stage {
    build *b;
    void (*run)(ff_build_clip *, const ff_build_shared *);
} stage;

static void run_one(void *context, uint32_t turn)
{
    const stage *s = context;
    build *b = s->b;
    int index = (int)b->order[turn].index;
    ff_build_clip *clip = &b->clips[index];
    if (b->settings->strict && index > atomic_load(&b->first_bad)) return;
    s->run(clip, &b->shared);
    int bad = atomic_load(&b->first_bad);
    while (clip->status != FF_OK && index < bad && !atomic_compare_exchange_weak(&b->first_bad, &bad, index))
        continue;
    ff_progress_step_by(b->progress, clip->source, b->order[turn].work);
}

/* Move clips that failed behind the good ones, both in order. With strict the first one ends the build, and so does an
 * only clip: what is wrong with it is then all there is to say. */
static ff_status set_bad_aside(build *b, ff_error *error)
{
    bool first_ends = b->settings->strict || b->count == 1;
    int kept = 0;
    for (int i = 0; i < b->good; ++i) {
        if (b->clips[i].status == FF_OK) {
            ++kept;
            continue;
        }
        if (!first_ends) continue;
        if (error) *error = b->clips[i].error;
        return b->clips[i].status;
    }
    ff_build_clip *sorted = ff_calloc((size_t)b->good, sizeof *sorted);
    if (!sorted) return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory for %d clips", b->good);
    int front = 0, back = kept;
    for (int i = 0; i < b->good; ++i)
        sorted[b->clips[i].status == FF_OK ? front++ : back++] = b->clips[i];
    memcpy(b->clips, sorted, (size_t)b->good * sizeof *sorted);
    free(sorted);
    b->good = kept;
    if (kept > 0) return FF_OK;
    return ff_fail(error, b->clips[0].status,
                   "none of the %d clips can be used: nothing to build a pack from", b->count);
}

static ff_status run_stage(build *b, const char *what, void (*run)(ff_build_clip *, const ff_build_shared *),
                           ff_error *error)
{
    double work = 0.0;
    for (int i = 0; i < b->good; ++i) {
        b->order[i] = (ordered){work_of(&b->clips[i]), (uint32_t)i};
        work += b->order[i].work;
    }
    qsort(b->order, (size_t)b->good, sizeof *b->order, by_work);
    atomic_store(&b->first_bad, INT_MAX);
    b->progress = ff_progress_start(what, (uint64_t)b->good, b->settings->quiet);
    ff_progress_weigh(b->progress, work);
    ff_tasks_for(b->tasks, (uint32_t)b->good, 1, run_one, &(stage){b, run});
    ff_progress_end(b->progress);
    b->progress = NULL;
    return set_bad_aside(b, error);
}

/* The skeleton that was asked for. */
static ff_status load_rig(build *b, const char *path, ff_error *error)
{
    ff_load_options options = ff_load_options_default();
    options.strict = b->settings->strict;
    ff_clip clip;
    ff_status status = ff_skeleton_load(path, &options, &clip, error);
    if (status != FF_OK) return status;
    const ff_clip *only = &clip;
    status = ff_rig_from_clips(&only, 1, &b->rig, error);
    if (status != FF_OK) ff_error_in_file(error, path);
    ff_clip_free(&clip);
    return status;
}

/* What is a short and what a long step is known once all clips are cut. */
static ff_status split_walks(ff_build_clip *clips, int count, ff_error *error)
{
    ff_actions **sets = ff_calloc((size_t)count, sizeof *sets);
    if (!sets) return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory for %d clips", count);
    for (int i = 0; i < count; ++i)
        sets[i] = &clips[i].actions;
    ff_status status = ff_actions_split_walks(sets, count, error);
    free(sets);
    return status;
}

static ff_status add_skin(build *b, ff_error *error)
{
    const ff_catalogue *catalogue = b->catalogue;
    ff_load_options options = ff_load_options_default();
    const char *path = b->settings->skin;
    if (!path && catalogue && catalogue->skin) path = catalogue->skin, options = catalogue->skin_options;
    return path ? ff_pack_add_skin(&b->result->content, &b->settings->pack.skin, &b->rig, path, &options,
                                   error)
                : FF_OK;
}

/* Every clip of the pack: the good ones, then what was derived from them. They are shallow copies, which share what the
 * originals own. */
typedef struct gathered {
    ff_build_clip *clips, *derived;
    int count, derived_count;
} gathered;

static void gathered_free(gathered *g)
{
    for (int i = 0; i < g->derived_count; ++i)
        ff_build_clip_free(&g->derived[i]);
    free(g->derived);
    free(g->clips);
}

static ff_status gather(build *b, const ff_example_set *set, gathered *g, ff_error *error)
{
    ff_status status = FF_OK;
    if (b->settings->pack.actions.derive)
        status = ff_derive_actions(&b->shared, set, b->clips, b->good, &g->derived, &g->derived_count, error);
    if (status != FF_OK) return status;
    g->count = b->good + g->derived_count;
    g->clips = ff_calloc((size_t)g->count, sizeof *g->clips);
    if (!g->clips) return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory for %d clips", g->count);
    memcpy(g->clips, b->clips, (size_t)b->good * sizeof *g->clips);
    if (g->derived_count) memcpy(g->clips + b->good, g->derived, (size_t)g->derived_count * sizeof *g->clips);
    return split_walks(g->clips, g->count, error);
}

/* Leave out clips that neither an action nor an example is left of. */
static void drop_unused(gathered *g, ff_example_set *set)
{
    int kept = 0;
    for (int i = 0; i < g->count; ++i) {
        bool used = g->clips[i].actions.count > 0;
        for (int k = 0; k < set->count; ++k)
            used = used || set->items[k].clip == i;
        if (!used) continue;
        for (int k = 0; k < set->count; ++k)
            if (set->items[k].clip == i) set->items[k].clip = kept;
        g->clips[kept++] = g->clips[i];
    }
    g->count = kept;
}

/* Tell when the pack walks with less than a whole cycle that closes well. */
static void warn_of_level(build *b, const ff_example_set *set)
{
    const ff_example *e = &set->items[set->gait.gait.example];
    if (set->level == FF_LEVEL_FIRM) return;
    snprintf(b->result->warning, sizeof b->result->warning,
             "no clip has a whole straight walking cycle that closes well; the pack walks with %.90s, of "
             "which closing "
             "moves a joint by %.1f cm: add longer walks straight ahead",
             e->name, 100.0 * (double)e->loop.moved);
}

static ff_status add_all(build *b, gathered *g, ff_example_set *set, ff_error *error)
{
    ff_pack_content *content = &b->result->content;
    int wanted = (int)b->settings->pack.actions.count;
    ff_status status = gather(b, set, g, error);
    if (status == FF_OK && wanted > 0) {
        status =
            ff_actions_select(&b->settings->pack.successors, g->clips, g->count, wanted, b->tasks, error);
        if (status == FF_OK) drop_unused(g, set);
    }
    if (status == FF_OK) warn_of_level(b, set);
    if (status == FF_OK) status = ff_pack_add_examples(content, set, error);
    if (status == FF_OK)
        status = ff_pack_add_gait(content, &b->settings->pack.correspondences, &b->rig, set, b->tasks, error);
    if (status == FF_OK)
        status = ff_pack_add_clips(content, g->clips, g->count, b->settings->pack.poses.rate, error);
    if (status == FF_OK)
        status = ff_pack_add_successors(content, &b->settings->pack.successors, b->tasks, error);
    if (status == FF_OK) status = ff_pack_add_reach(content, error);
    double radii[FF_COLLIDER_COUNT];
    ff_collider_radii(&b->settings->pack.cut.colliders, radii);
    if (status == FF_OK) status = ff_pack_set_collider_radii(content, radii, error);
    if (status == FF_OK) status = add_skin(b, error);
    if (status == FF_OK)
        status = ff_pack_add_meta(content, b->settings, g->clips, g->count, b->clips + b->good,
                                  b->count - b->good, set, error);
    return status;
}

static ff_status fill(build *b, ff_error *error)
{
    ff_example_set set;
    int *subject = ff_calloc((size_t)b->good, sizeof *subject);
    ff_cycles *cycles = ff_calloc((size_t)b->good, sizeof *cycles);
    ff_status status = FF_OK;
    if (!subject || !cycles) status = ff_fail(error, FF_ERR_NO_MEMORY, "out of memory for %d clips", b->good);
    for (int i = 0; status == FF_OK && i < b->good; ++i) {
        subject[i] = b->clips[i].subject;
        cycles[i] = b->clips[i].cycles; /* shares the examples with the clip, which stays their owner */
        for (int k = 0; k < cycles[i].count; ++k)
            cycles[i].items[k].clip = i;
    }
    if (status == FF_OK)
        status = ff_examples_select(&b->settings->pack.cut.examples, &b->rig, cycles, subject, b->good, &set,
                                    error);
    free(subject);
    free(cycles);
    if (status != FF_OK) return status;
    gathered g = {0};
    status = add_all(b, &g, &set, error);
    gathered_free(&g);
    ff_example_set_free(&set);
    return status;
}

static void keep_skipped(build *b)
{
    int count = b->count - b->good;
    b->result->skipped = ff_calloc((size_t)count, sizeof *b->result->skipped);
    for (int i = 0; b->result->skipped && i < count; ++i)
        b->result->skipped[b->result->skipped_count++] = b->clips[b->good + i].error;
}

static int by_key(const void *left, const void *right)
{
    const uint64_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

static void prune(const build *b)
{
    size_t count = 2 * (size_t)b->count;
    uint64_t *keys = ff_calloc(count, sizeof *keys);
    if (!keys) return;
    for (int i = 0; i < b->count; ++i) {
        keys[2 * i] = b->clips[i].find_key;
        keys[2 * i + 1] = b->clips[i].cut_key;
    }
    qsort(keys, count, sizeof *keys, by_key);
    ff_cache_prune(&b->cache, keys, count);
    free(keys);
}

static ff_status run(build *b, ff_error *error)
{
    const char *given = b->settings->pack.rig.skeleton;
    ff_status status = name_sources(b, error);
    b->good = b->count;
    if (status == FF_OK && *given) status = load_rig(b, given, error);
    if (status == FF_OK) status = run_stage(b, "reading", ff_build_clip_find, error);
    if (status == FF_OK && *given) ff_build_find_subjects(b->clips, b->good);
    if (status == FF_OK && !*given) status = ff_build_median_rig(b->clips, b->good, &b->rig, error);
    if (status == FF_OK) status = ff_pack_add_rig(&b->result->content, &b->rig, error);
    b->shared.joints = b->result->content.joints.data;
    b->shared.points = b->result->content.points.data;
    if (status == FF_OK) status = run_stage(b, "cutting", ff_build_clip_cut, error);
    if (status == FF_OK) status = fill(b, error);
    return status;
}

ff_status ff_build(const ff_catalogue *catalogue, const ff_build_settings *settings, ff_build_result *out,
                   ff_error *error)
{
    memset(out, 0, sizeof *out);
    build b = {.catalogue = catalogue, .settings = settings, .result = out};
    ff_cache_open(&b.cache, settings->cache);
    b.shared = (ff_build_shared){.settings = &settings->pack, .cache = &b.cache, .rig = &b.rig};
    ff_status status = ff_tasks_create(settings->threads, &b.tasks, error);
    if (status == FF_OK) status = run(&b, error);
    if (status == FF_OK && settings->prune) prune(&b);
    out->reused = atomic_load(&b.cache.found);
    out->computed = atomic_load(&b.cache.missed);
    out->unkept = atomic_load(&b.cache.unwritten);
    ff_cache_close(&b.cache);
    if (b.clips) keep_skipped(&b);
    for (int i = 0; b.clips && i < b.count; ++i)
        ff_build_clip_free(&b.clips[i]);
    free(b.clips);
    free(b.order);
    ff_tasks_destroy(b.tasks);
    return status;
}
