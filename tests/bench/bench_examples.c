/* Are the examples of a pack closed and do they correspond as well as they should? Measured on the poses in the pack.
 * Usage: bench_examples [PACK...]; without one, the built-in clips and, where FF_SHARED names them, captured ones. */
#include "preprocess/build/build.h"
#include "tests/check.h"
#include "tests/preprocess/pack_bars.h"

static int measure(const ff_pack *pack, const char *name)
{
    ff_pack_bars bars = ff_bars_measure(pack);
    printf("%s: %u examples\n", name, pack->example_count);
    ff_bars_print(&bars);
    printf("  %s\n", ff_bars_met(&bars) ? "all within the limits" : "OVER A LIMIT");
    return ff_bars_met(&bars) ? 0 : 1;
}

static int give_up(const ff_error *error)
{
    char text[1024];
    fprintf(stderr, "bench_examples: %s\n", ff_error_text(error, text, sizeof text));
    return 1;
}

static int measure_file(const char *path)
{
    ff_pack *pack;
    ff_error error;
    if (ff_pack_open(path, &pack, &error) != FF_OK) return give_up(&error);
    int result = measure(pack, path);
    ff_pack_close(pack);
    return result;
}

static int build_and_measure(const ff_catalogue *catalogue, const char *name)
{
    ff_build_settings settings = ff_build_settings_default();
    ff_build_result built = {0};
    ff_error error;
    void *data = NULL;
    size_t size;
    ff_pack *pack = NULL;
    settings.quiet = true;
    ff_status status = ff_build(catalogue, &settings, &built, &error);
    if (status == FF_OK) status = ff_pack_image(&built.content, &data, &size, &error);
    ff_build_result_free(&built);
    if (status == FF_OK) status = ff_pack_open_memory(data, size, &pack, &error);
    int result = status == FF_OK ? measure(pack, name) : give_up(&error);
    ff_pack_close(pack);
    free(data);
    return result;
}

int main(int argc, char **argv)
{
    int result = 0;
    for (int i = 1; i < argc; ++i)
        result |= measure_file(argv[i]);
    if (argc > 1) return result;
    result = build_and_measure(NULL, "built-in clips");
    if (!ff_shared_folder()) {
        printf("SKIPPED captured clips: FF_SHARED is not set\n");
        return result;
    }
    char path[1024];
    ff_catalogue catalogue;
    ff_error error;
    snprintf(path, sizeof path, "%s/data/cmu", ff_shared_folder());
    const char *paths[] = {path};
    if (ff_catalogue_read(paths, 1, &catalogue, &error) != FF_OK) return give_up(&error);
    result |= build_and_measure(&catalogue, "captured clips");
    ff_catalogue_free(&catalogue);
    return result;
}
