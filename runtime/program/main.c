/* footfall-crowd - runs crowds of people on motion packs. */
#include "runtime/program/bench.h"
#include "runtime/program/run.h"
#include "runtime/tool/command_line.h"

static const ff_subcommand commands[] = {
    {"run", "run a scene on a motion pack and write what happened to files", ff_run_main},
    {"bench", "measure, and compare with others and with the paper", ff_bench_main},
    {0},
};

int main(int argc, char **argv)
{
    return ff_command_dispatch("footfall-crowd", "run crowds of people on motion packs", commands, argc,
                               argv);
}
