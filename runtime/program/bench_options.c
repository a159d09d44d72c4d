#include "runtime/program/bench_options.h"

#define OPTIONS_MOST 24
#define SEEDS_MOST 1000
#define THREADS_MOST 256

typedef struct option_list {
    ff_option item[OPTIONS_MOST];
    int count;
} option_list;

/* The list stays ended by a zeroed option. */
static void add(option_list *list, ff_option option)
{
    if (list->count < OPTIONS_MOST - 1) list->item[list->count++] = option;
}

static void add_seeds(option_list *list, const char *help, ff_bench_options *options)
{
    add(list, (ff_option){.name = "--seeds",
                          .value_name = "N",
                          .help = help,
                          .integer = &options->seeds,
                          .low = 1,
                          .high = SEEDS_MOST});
    add(list, (ff_option){.name = "--first-seed",
                          .value_name = "N",
                          .help = "the first of them (default 1)",
                          .integer = &options->first_seed,
                          .low = 0,
                          .high = 1e9});
}

static void add_outputs(option_list *list, const char *files, ff_bench_options *options)
{
    if (files)
        add(list, (ff_option){.name = "--out",
                              .alias = "-o",
                              .value_name = "FOLDER",
                              .help = files,
                              .text = &options->out});
    add(list,
        (ff_option){
            .name = "--json", .value_name = "FILE", .help = "the table as JSON", .text = &options->json});
}

int ff_bench_parse(const ff_bench_command *command, int argc, char **argv, ff_bench_options *options)
{
    option_list list = {.count = 0};
    add(&list, (ff_option){.name = "--pack",
                           .alias = "-p",
                           .value_name = "FILE",
                           .help = "motion pack",
                           .text = &options->pack});
    for (const ff_option *own = command->own; own && own->name; ++own)
        add(&list, *own);
    if (command->seeds) add_seeds(&list, command->seeds, options);
    add_outputs(&list, command->files, options);
    if (command->threads)
        add(&list, (ff_option){.name = "--threads",
                               .value_name = "N",
                               .help = command->threads,
                               .integer = &options->threads,
                               .low = 1,
                               .high = THREADS_MOST});
    add(&list, (ff_option){.name = "--quiet", .alias = "-q", .help = "no progress", .flag = &options->quiet});
    const ff_command whole = {.program = FF_BENCH_PROGRAM,
                              .name = command->name,
                              .arguments = "",
                              .summary = command->summary,
                              .options = list.item};
    ff_operands operands;
    int status = ff_command_parse(&whole, argc, argv, &operands);
    if (status >= 0) return status;
    return options->pack ? -1 : ff_command_misuse(&whole, "--pack FILE is missing");
}

int ff_bench_misuse(const ff_bench_command *command, const char *option, const char *given,
                    const char *expected)
{
    const ff_command whole = {.program = FF_BENCH_PROGRAM, .name = command->name};
    return ff_command_misuse(&whole, "%s is '%.40s'; it can be %s", option, given, expected);
}
