#define _POSIX_C_SOURCE 200809L
#include "preprocess/commands/extract_command.h"

#include "preprocess/report/extract.h"
#include "runtime/core/base/fail.h"
#include "runtime/export/bvh.h"
#include "runtime/export/glb.h"
#include "runtime/tool/command_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char *const PROGRAM = "footfall-pack";

static bool ends_in(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

/* The exporter of glTF wants a scene: one person and the ground. */
static ff_status write_glb(const char *path, const ff_figure *figure, const ff_recording *recording,
                           ff_error *error)
{
    static const char text[] =
        "{\"kind\": \"custom\", \"agents\": [{\"position\": [0, 0], \"goal\": [0, 1]}]}";
    ff_scene_def def;
    ff_scene scene;
    ff_status status = ff_scene_def_parse(text, sizeof text - 1, "scene", &def, error);
    if (status != FF_OK) return status;
    status = ff_scene_create(&def, &scene, error);
    ff_scene_def_free(&def);
    if (status != FF_OK) return status;
    status = ff_glb_write(path, figure, &scene, recording, error);
    ff_scene_free(&scene);
    return status;
}

static ff_status extract(const char *const *operands, const char *path, double rate, int cycles,
                         ff_error *error)
{
    ff_pack *pack;
    ff_part part;
    ff_figure figure;
    ff_recording recording;
    ff_status status = ff_pack_open(operands[0], &pack, error);
    if (status != FF_OK) return status;
    status = ff_part_find(pack, operands[1], &part, error);
    if (status != FF_OK) ff_error_in_file(error, operands[0]);
    if (status == FF_OK) status = ff_figure_from_pack(pack, &figure, error);
    if (status == FF_OK) status = ff_part_record(pack, part, rate, cycles, &recording, error);
    if (status == FF_OK) {
        status = ends_in(path, ".bvh") ? ff_recording_write_bvh(path, &figure, &recording, 0, error)
                                       : write_glb(path, &figure, &recording, error);
        if (status == FF_OK) {
            char what[256];
            ff_part_say(pack, part, what, sizeof what);
            printf("%s: %u poses in %.2f s\n%s\n", what, recording.pose_count,
                   (recording.pose_count - 1) * ff_recording_pose_step(&recording), path);
        }
        ff_recording_free(&recording);
    }
    ff_pack_close(pack);
    return status;
}

int ff_extract_command(int argc, char **argv)
{
    const char *path = NULL;
    double rate = 60.0;
    int64_t cycles = 1;
    ff_option options[] = {{.name = "--out",
                            .alias = "-o",
                            .value_name = "FILE",
                            .help = "what to write, .bvh or .glb (needed)",
                            .text = &path},
                           {.name = "--rate",
                            .value_name = "HZ",
                            .help = "poses per second, near it: the last pose is the last moment",
                            .number = &rate,
                            .low = 1,
                            .high = 1000},
                           {.name = "--cycles",
                            .value_name = "N",
                            .help = "rounds of an example",
                            .integer = &cycles,
                            .low = 1,
                            .high = 1000},
                           {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "extract",
        .arguments = "PACK ACTION|EXAMPLE|CLIP",
        .summary = "write an action, example or clip of a pack as BVH or glTF",
        .details =
            "Named by a number (an action's), by action:NUMBER, example:NUMBER or clip:NUMBER, or by the "
            "name "
            "of an\nexample or clip that 'footfall-pack inspect' lists. The motion starts over the origin "
            "facing +Z;\nmirrored actions are mirrored.",
        .options = options,
        .min_operands = 2,
        .max_operands = 2,
    };
    ff_operands operands;
    ff_error error;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result >= 0) return result;
    if (!path) return ff_command_misuse(&command, "--out FILE (-o) is missing");
    if (!ends_in(path, ".bvh") && !ends_in(path, ".glb"))
        return ff_command_misuse(&command, "--out %.80s ends in neither .bvh nor .glb", path);
    return extract(operands.items, path, rate, (int)cycles, &error) == FF_OK
               ? FF_EXIT_OK
               : ff_command_fail(PROGRAM, &error);
}
