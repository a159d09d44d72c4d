/* bench_options.h - the options that the benches share: pack, runs, outputs. */
#ifndef FF_BENCH_OPTIONS_H
#define FF_BENCH_OPTIONS_H

#include "runtime/tool/command_line.h"

#define FF_BENCH_PROGRAM "footfall-crowd"

/* What was given. Texts are the caller's argv; out and json NULL when not asked for. */
typedef struct ff_bench_options {
    const char *pack, *out, *json;
    int64_t seeds, first_seed, threads;
    bool quiet;
} ff_bench_options;

typedef struct ff_bench_command {
    const char *name, *summary; /* "bench fig7" */
    const char *files;          /* help of --out; NULL: a bench without it */
    const char *seeds;          /* help of --seeds; NULL: a bench without --seeds and --first-seed */
    const char *threads;        /* help of --threads; NULL: a bench without it */
    const ff_option *own;       /* the bench's own options, ended by a zeroed one; NULL: none */
} ff_bench_command;

/* Fill options, which hold the defaults, and the targets of own ones. Returns -1 to go on, else the status to leave with. */
int ff_bench_parse(const ff_bench_command *command, int argc, char **argv, ff_bench_options *options);

/* A usage error that parsing cannot see; returns FF_EXIT_USAGE. */
int ff_bench_misuse(const ff_bench_command *command, const char *option, const char *given,
                    const char *expected);

#endif
