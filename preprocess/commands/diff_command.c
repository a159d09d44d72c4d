#include "preprocess/commands/diff_command.h"

#include "preprocess/report/diff.h"
#include "runtime/tool/command_line.h"

static const char *const PROGRAM = "footfall-pack";

int ff_diff_command(int argc, char **argv)
{
    bool exit_code = false;
    ff_option options[] = {
        {.name = "--exit-code", .help = "leave with status 1 when the packs differ", .flag = &exit_code},
        {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "diff",
        .arguments = "OLD-PACK NEW-PACK",
        .summary = "say what changed from one pack to another",
        .details =
            "Settings, skeleton, clips (matched by source and name), actions, examples and velocity hull.",
        .options = options,
        .min_operands = 2,
        .max_operands = 2,
    };
    ff_operands operands;
    ff_error error;
    ff_pack *packs[2];
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result >= 0) return result;
    if (ff_pack_open(operands.items[0], &packs[0], &error) != FF_OK) return ff_command_fail(PROGRAM, &error);
    if (ff_pack_open(operands.items[1], &packs[1], &error) == FF_OK) {
        bool differs = ff_packs_diff(packs[0], packs[1]);
        result = differs && exit_code ? FF_EXIT_FAILURE : FF_EXIT_OK;
        ff_pack_close(packs[1]);
    } else {
        result = ff_command_fail(PROGRAM, &error);
    }
    ff_pack_close(packs[0]);
    return result;
}
