/* command_line.h - options and exit codes, the same for both programs. */
#ifndef FF_COMMAND_LINE_H
#define FF_COMMAND_LINE_H

#include "runtime/core/base/fail.h"

#include <stdbool.h>

enum { FF_EXIT_OK = 0, FF_EXIT_FAILURE = 1, FF_EXIT_USAGE = 2 };

/* One option of a command. Exactly one of the targets is set. */
typedef struct ff_option {
    const char *name;       /* "--out" */
    const char *alias;      /* "-o" or NULL */
    const char *value_name; /* "FILE"; NULL for a flag */
    const char *help;
    bool *flag;
    const char **text;
    double *number;
    int64_t *integer;
    double low, high; /* accepted range of number and integer */
} ff_option;

typedef struct ff_command {
    const char *program;            /* "footfall-pack" */
    const char *name;               /* "build"; "" for the program itself */
    const char *arguments;          /* "CATALOGUE|FOLDER|FILES..." */
    const char *summary;            /* one line */
    const char *details;            /* more for --help, or NULL */
    ff_option *options;             /* ends with a zeroed element */
    int min_operands, max_operands; /* max < 0: any number */
} ff_command;

/* What parsing left that is no option: the front of argv, into which parsing moves it. */
typedef struct ff_operands {
    const char *const *items;
    int count;
} ff_operands;

/* Parse argv[0..argc) (after the command's own name). --help and --version are answered here. Returns -1 to go on,
 * else the exit status to leave with (a usage error was printed to stderr, with the nearest known option). */
int ff_command_parse(const ff_command *command, int argc, char **argv, ff_operands *operands);

/* A usage error that parsing cannot see (an option is missing, two exclude each other): prints "footfall-pack: ...; try
 * 'footfall-pack build --help'" to stderr and returns FF_EXIT_USAGE. */
int ff_command_misuse(const ff_command *command, const char *format, ...) FF_PRINTF(2, 3);

/* A program of several commands. run receives what follows the command's name and returns the exit status. */
typedef struct ff_subcommand {
    const char *name;    /* NULL ends the list */
    const char *summary; /* one line for the program's --help */
    int (*run)(int argc, char **argv);
} ff_subcommand;

/* Run the command argv[1] names and return its exit status. Answers --help and --version of the program itself; no
 * or an unknown command is a usage error that names the nearest known one. */
int ff_command_dispatch(const char *program, const char *summary, const ff_subcommand *commands, int argc,
                        char **argv);

/* Print "footfall-pack: <error>" to stderr; returns FF_EXIT_FAILURE. */
int ff_command_fail(const char *program, const ff_error *error);

#endif
