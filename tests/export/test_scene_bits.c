/* Every scene that comes with the project gives the same bits on 1, 2 and 8 threads, and when it is saved, loaded and
 * continued. FF_SCENE_STEPS says for how many steps (make soak: 10,000). */
#define _GNU_SOURCE
#include "runtime/export/scene_crowd.h"
#include "tests/built_in_open.h"

#include <dirent.h>
#include <stdio.h>

#define STEPS_SHORT 160

static uint64_t steps = STEPS_SHORT;

static int set_up(void **state)
{
    const char *wanted = getenv("FF_SCENE_STEPS");
    open_pack(state);
    if (wanted) steps = strtoull(wanted, NULL, 10);
    return steps > 8 ? 0 : -1;
}

static ff_crowd *begin(const ff_scene *scene, uint32_t threads)
{
    ff_error error;
    ff_behaviour_def behaviour;
    ff_crowd *crowd;
    ff_crowd_def def = ff_scene_crowd_def(scene, &behaviour);
    def.threads = threads;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    FF_ASSERT_OK(ff_scene_populate(scene, crowd, &error), error);
    return crowd;
}

static ff_crowd *reloaded(ff_crowd *crowd, uint32_t threads)
{
    ff_error error;
    ff_crowd *loaded;
    ff_crowd_def run = ff_crowd_def_default();
    size_t size = ff_crowd_save_size(crowd);
    void *data = malloc(size);
    assert_non_null(data);
    FF_ASSERT_OK(ff_crowd_save(crowd, data, size, &error), error);
    ff_crowd_destroy(crowd);
    run.threads = threads;
    FF_ASSERT_OK(ff_crowd_load(pack, data, size, &run, &loaded, &error), error);
    free(data);
    return loaded;
}

/* Those who have arrived leave, where the scene says so. */
static void let_leave(const ff_scene *scene, ff_crowd *crowd, ff_agent *agents)
{
    ff_error error;
    uint32_t count = scene->leave ? ff_crowd_agents(crowd, agents, scene->most) : 0;
    for (uint32_t i = 0; i < count; ++i) {
        ff_agent_state state;
        FF_ASSERT_OK(ff_crowd_agent_state(crowd, agents[i], &state, &error), error);
        if (state.reached) FF_ASSERT_OK(ff_crowd_remove_agent(crowd, agents[i], &error), error);
    }
}

enum { QUARTERS = 4 };

/* The state after each quarter; save: stopped and gone on with in the midst of each. */
static void run(const ff_scene *scene, uint32_t threads, bool save, uint64_t hashes[QUARTERS])
{
    ff_agent *agents = calloc(scene->most, sizeof *agents);
    assert_non_null(agents);
    ff_crowd *crowd = begin(scene, threads);
    for (uint64_t quarter = 0; quarter < QUARTERS; ++quarter) {
        for (uint64_t k = 0; k < steps / QUARTERS; ++k) {
            if (save && k == steps / QUARTERS / 2) crowd = reloaded(crowd, threads);
            ff_crowd_step(crowd);
            let_leave(scene, crowd, agents);
        }
        hashes[quarter] = ff_crowd_state_hash(crowd);
    }
    ff_crowd_destroy(crowd);
    free(agents);
}

static void try_scene(const char *path)
{
    ff_error error;
    ff_scene_def def;
    ff_scene scene;
    FF_ASSERT_OK(ff_scene_def_load(path, &def, &error), error);
    FF_ASSERT_OK(ff_scene_create(&def, &scene, &error), error);
    uint64_t one[QUARTERS], other[QUARTERS];
    run(&scene, 1, false, one);
    assert_true(one[0] != one[1]);
    static const struct {
        uint32_t threads;
        bool save;
    } ways[] = {{2, false}, {8, false}, {1, true}, {2, true}};
    for (size_t w = 0; w < sizeof ways / sizeof ways[0]; ++w) {
        run(&scene, ways[w].threads, ways[w].save, other);
        if (memcmp(one, other, sizeof one) != 0) {
            print_error("%s is another on %u threads%s\n", path, ways[w].threads,
                        ways[w].save ? ", saved" : "");
            fail();
        }
    }
    print_message("%s: %llu steps, state %016llx on 1, 2 and 8 threads and saved on the way\n", path,
                  (unsigned long long)steps, (unsigned long long)one[QUARTERS - 1]);
    ff_scene_free(&scene);
    ff_scene_def_free(&def);
}

static void every_scene_gives_the_same_bits_on_any_threads_and_saved_on_the_way(void **state)
{
    (void)state;
    DIR *folder = opendir("runtime/scenes");
    assert_non_null(folder);
    int scenes = 0;
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        const char *end = strrchr(entry->d_name, '.');
        char path[512];
        if (!end || strcmp(end, ".json") != 0) continue;
        snprintf(path, sizeof path, "runtime/scenes/%s", entry->d_name);
        try_scene(path);
        ++scenes;
    }
    closedir(folder);
    assert_true(scenes >= 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_gives_the_same_bits_on_any_threads_and_saved_on_the_way),
    };
    return cmocka_run_group_tests(tests, set_up, close_pack);
}
