#include "runtime/program/bench.h"

#include "runtime/core/base/file.h"
#include "runtime/tool/command_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const ff_subcommand benches[] = {
    {"table1", "collisions and smoothness of MCN, ORCA and SF in three crossing crowds (FbCrowd, Table 1)",
     ff_bench_table1_main},
    {"fig6", "what a whole person costs on one core, in crowds of 40 to 20,000 (FbCrowd, Figure 6)",
     ff_bench_fig6_main},
    {"fig7", "everyone to the other side of a circle, by MCN, ORCA, SF and Detour (FbCrowd, Figure 7)",
     ff_bench_fig7_main},
    {"synthesis", "what a pose costs: four motions blended, matrices of all joints, both legs' IK",
     ff_bench_synthesis_main},
    {"walk", "how people walk: planted feet, knees, joints, on courses of every kind", ff_bench_walk_main},
    {"hybrid", "an obstacle course by blending, semi-procedurally and by both (FbCrowd, section 7.1)",
     ff_bench_hybrid_main},
    {"fig9", "frames per second of crowds on footsteps (footstep planning, Figure 9)", ff_bench_fig9_main},
    {"fig10", "how bodies get past each other on footsteps (footstep planning, Figures 1 and 10)",
     ff_bench_fig10_main},
    {"mixed", "crowds of which one half is on footsteps and the other goes by velocity", ff_bench_mixed_main},
    {"astar", "the search for footsteps: its cost and its plans, the footstep paper's beside ours",
     ff_bench_astar_main},
    {"facts", "straight walks beside what people do: steps, events, angles", ff_bench_facts_main},
    {0},
};

int ff_bench_main(int argc, char **argv)
{
    /* The words before the name of the bench are the program's. */
    return ff_command_dispatch("footfall-crowd bench", "measure, and compare with others and with the paper",
                               benches, argc + 1, argv - 1);
}

ff_status ff_bench_write_json(const ff_bench_options *options, const char *name, json_t *value,
                              ff_error *error)
{
    char *text = value ? json_dumps(value, JSON_INDENT(2) | JSON_REAL_PRECISION(8)) : NULL;
    json_decref(value);
    if (!text) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the table of %s", name);
    ff_status status = FF_OK;
    if (options->json) status = ff_file_write_atomic(options->json, text, strlen(text), error);
    if (status == FF_OK && options->out) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s.json", options->out, name);
        status = ff_folder_create(options->out, error);
        if (status == FF_OK) status = ff_file_write_atomic(path, text, strlen(text), error);
    }
    free(text);
    return status;
}
