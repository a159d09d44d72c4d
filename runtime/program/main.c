/* footfall-crowd - runs crowds of people on motion packs. */
#include "runtime/program/run.h"
#include "runtime/tool/command_line.h"

#include <stdio.h>
#include <string.h>

static const char usage[] = "footfall-crowd " FF_VERSION " - run crowds of people on motion packs\n"
                            "\n"
                            "usage: footfall-crowd run SCENE.json --pack FILE.ffpack --out FOLDER [options]\n"
                            "       footfall-crowd run --help\n"
                            "       footfall-crowd --version\n";

int main(int argc, char **argv)
{
    if (argc >= 2 && strcmp(argv[1], "run") == 0) return ff_run_main(argc - 2, argv + 2);
    if (argc == 2 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
        fputs(usage, stdout);
        return FF_EXIT_OK;
    }
    if (argc == 2 && strcmp(argv[1], "--version") == 0) {
        puts("footfall-crowd " FF_VERSION);
        return FF_EXIT_OK;
    }
    if (argc < 2)
        fputs("footfall-crowd: no command; try 'footfall-crowd --help'\n", stderr);
    else
        fprintf(stderr, "footfall-crowd: unknown command '%s'; 'run' is known; try 'footfall-crowd --help'\n",
                argv[1]);
    return FF_EXIT_USAGE;
}
