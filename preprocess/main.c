/* footfall-pack - makes motion packs from clips, and shows what is in clips and packs. */
#define _POSIX_C_SOURCE 200809L
#include "mocap/generator/generator.h"
#include "preprocess/build/build.h"
#include "preprocess/build/settings.h"
#include "preprocess/commands/clean_command.h"
#include "preprocess/commands/diff_command.h"
#include "preprocess/commands/extract_command.h"
#include "preprocess/commands/import_command.h"
#include "preprocess/commands/plants_command.h"
#include "preprocess/commands/steps_command.h"
#include "preprocess/commands/validate_command.h"
#include "preprocess/report/report.h"
#include "runtime/tool/command_line.h"

#include <signal.h>

static const ff_subcommand commands[] = {
    {"build", "make a motion pack from clips", ff_build_command},
    {"config", "print every setting of build", ff_config_command},
    {"import", "bring clips into one form and say what they are", ff_import_command},
    {"extract", "write an action, example or clip of a pack as BVH or glTF", ff_extract_command},
    {"inspect", "say what is in a motion pack", ff_inspect_command},
    {"diff", "say what changed from one pack to another", ff_diff_command},
    {"validate", "check a pack against itself and against its clips", ff_validate_command},
    {"plants", "list the foot plants of clips", ff_plants_command},
    {"steps", "how clips are walked, in numbers", ff_steps_command},
    {"clean", "measure what cleaning up the feet does to clips", ff_clean_command},
    {"generate", "write the built-in clips", ff_generate_command},
    {"report", "show a motion pack as one HTML page", ff_report_command},
    {0},
};

int main(int argc, char **argv)
{
    /* A file that may not grow any more is an error like a full disk, which is told and cleaned up after. */
    signal(SIGXFSZ, SIG_IGN);
    return ff_command_dispatch("footfall-pack", "make motion packs from motion capture", commands, argc,
                               argv);
}
