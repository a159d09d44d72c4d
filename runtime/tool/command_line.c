#include "runtime/tool/command_line.h"

#include "runtime/tool/nearest.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_OPTIONS = 64, GO_ON = -1 };

/* -------------------------------------------------------------------------------------------- usage errors */

static void print_full_name(FILE *to, const ff_command *command)
{
    fprintf(to, "%s%s%s", command->program, command->name[0] ? " " : "", command->name);
}

int ff_command_misuse(const ff_command *command, const char *format, ...)
{
    va_list arguments;
    fprintf(stderr, "%s: ", command->program);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputs("; try '", stderr);
    print_full_name(stderr, command);
    fputs(" --help'\n", stderr);
    return FF_EXIT_USAGE;
}

static int unknown_option(const ff_command *command, const char *word, size_t length)
{
    char given[64];
    const char *known[MAX_OPTIONS + 3];
    size_t count = 0;
    snprintf(given, sizeof given, "%.*s", (int)(length < 60 ? length : 60), word);
    for (const ff_option *option = command->options; option && option->name && count < MAX_OPTIONS; ++option)
        known[count++] = option->name;
    known[count++] = "--help";
    known[count++] = "--version";
    known[count] = NULL;
    const char *near = ff_nearest(given, known);
    if (near) return ff_command_misuse(command, "unknown option '%s'; did you mean '%s'?", given, near);
    return ff_command_misuse(command, "unknown option '%s'", given);
}

/* ----------------------------------------------------------------------------------------------- --help */

static size_t option_width(const ff_option *option)
{
    size_t width = strlen(option->name) + (option->alias ? strlen(option->alias) + 2 : 0);
    return width + (option->value_name ? strlen(option->value_name) + 1 : 0);
}

static void print_option(const ff_option *option, size_t width)
{
    printf("  %s%s%s%s%s", option->alias ? option->alias : "", option->alias ? ", " : "", option->name,
           option->value_name ? " " : "", option->value_name ? option->value_name : "");
    printf("%*s  %s\n", (int)(width - option_width(option)), "", option->help);
}

static int print_help(const ff_command *command)
{
    static const ff_option common[] = {{.name = "--help", .help = "print this text"},
                                       {.name = "--version", .help = "print the version"}};
    print_full_name(stdout, command);
    printf(" - %s\n\nusage: ", command->summary);
    print_full_name(stdout, command);
    printf(" [options]%s%s\n\noptions:\n", command->arguments && command->arguments[0] ? " " : "",
           command->arguments ? command->arguments : "");
    size_t width = option_width(&common[1]);
    for (const ff_option *option = command->options; option && option->name; ++option) {
        if (option_width(option) > width) width = option_width(option);
    }
    for (const ff_option *option = command->options; option && option->name; ++option)
        print_option(option, width);
    print_option(&common[0], width);
    print_option(&common[1], width);
    if (command->details) printf("\n%s\n", command->details);
    return FF_EXIT_OK;
}

static int print_version(const char *program)
{
    printf("%s %s\n", program, FF_VERSION);
    return FF_EXIT_OK;
}

/* -------------------------------------------------------------------------------------------- options */

static int set_number(const ff_command *command, const ff_option *option, const char *value)
{
    char *end = NULL;
    double number = strtod(value, &end);
    if (end == value || *end || !isfinite(number))
        return ff_command_misuse(command, "%s needs a number, not '%.60s'", option->name, value);
    if (number < option->low || number > option->high)
        return ff_command_misuse(command, "%s is %s; expected %g to %g", option->name, value, option->low,
                                 option->high);
    *option->number = number;
    return GO_ON;
}

static int set_integer(const ff_command *command, const ff_option *option, const char *value)
{
    char *end = NULL;
    errno = 0;
    long long number = strtoll(value, &end, 10);
    if (end == value || *end)
        return ff_command_misuse(command, "%s needs a whole number, not '%.60s'", option->name, value);
    if (errno == ERANGE || (double)number < option->low || (double)number > option->high)
        return ff_command_misuse(command, "%s is %.60s; expected %.0f to %.0f", option->name, value,
                                 option->low, option->high);
    *option->integer = number;
    return GO_ON;
}

static int set_value(const ff_command *command, const ff_option *option, const char *value)
{
    if (option->number) return set_number(command, option, value);
    if (option->integer) return set_integer(command, option, value);
    if (!*value) return ff_command_misuse(command, "%s needs a value that is not empty", option->name);
    *option->text = value;
    return GO_ON;
}

static const ff_option *find_option(const ff_command *command, const char *word, size_t length)
{
    for (const ff_option *option = command->options; option && option->name; ++option) {
        if (strlen(option->name) == length && memcmp(option->name, word, length) == 0) return option;
        if (option->alias && strlen(option->alias) == length && memcmp(option->alias, word, length) == 0)
            return option;
    }
    return NULL;
}

/* One word that starts with '-': "--name", "--name=value" or "-n", with the value in the next word if need be. */
static int take_option(const ff_command *command, int argc, char **argv, int *at)
{
    const char *word = argv[*at];
    const char *equals = word[1] == '-' ? strchr(word, '=') : NULL;
    size_t length = equals ? (size_t)(equals - word) : strlen(word);
    const ff_option *option = find_option(command, word, length);
    if (!option) {
        if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) return print_help(command);
        if (strcmp(word, "--version") == 0) return print_version(command->program);
        return unknown_option(command, word, length);
    }
    if (option->flag) {
        if (equals) return ff_command_misuse(command, "%s takes no value", option->name);
        *option->flag = true;
        return GO_ON;
    }
    if (equals) return set_value(command, option, equals + 1);
    if (*at + 1 >= argc)
        return ff_command_misuse(command, "%s needs a value (%s)", option->name,
                                 option->value_name ? option->value_name : "VALUE");
    return set_value(command, option, argv[++*at]);
}

int ff_command_parse(const ff_command *command, int argc, char **argv, ff_operands *operands)
{
    bool options_end = false;
    *operands = (ff_operands){(const char *const *)argv, 0};
    for (int at = 0; at < argc; ++at) {
        if (!options_end && strcmp(argv[at], "--") == 0) {
            options_end = true;
        } else if (!options_end && argv[at][0] == '-' && argv[at][1]) {
            int status = take_option(command, argc, argv, &at);
            if (status != GO_ON) return status;
        } else {
            argv[operands->count++] = argv[at]; /* never ahead of what is still to be read */
        }
    }
    if (operands->count < command->min_operands)
        return ff_command_misuse(command, "expected %s", command->arguments);
    if (command->max_operands >= 0 && operands->count > command->max_operands)
        return ff_command_misuse(command, "unexpected argument '%.80s'",
                                 operands->items[command->max_operands]);
    return GO_ON;
}

/* ------------------------------------------------------------------------------------------- commands */

static void print_commands(FILE *to, const char *program, const char *summary, const ff_subcommand *commands)
{
    int width = 0;
    for (const ff_subcommand *command = commands; command->name; ++command) {
        if ((int)strlen(command->name) > width) width = (int)strlen(command->name);
    }
    fprintf(to, "%s - %s\n\nusage: %s COMMAND [options] ...\n\ncommands:\n", program, summary, program);
    for (const ff_subcommand *command = commands; command->name; ++command)
        fprintf(to, "  %-*s  %s\n", width, command->name, command->summary);
    fprintf(to, "\n'%s COMMAND --help' tells more; --version prints the version.\n", program);
}

int ff_command_dispatch(const char *program, const char *summary, const ff_subcommand *commands, int argc,
                        char **argv)
{
    if (argc < 2) {
        print_commands(stderr, program, summary, commands);
        return FF_EXIT_USAGE;
    }
    const char *name = argv[1];
    if (strcmp(name, "--version") == 0) return print_version(program);
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) {
        print_commands(stdout, program, summary, commands);
        return FF_EXIT_OK;
    }
    const char *known[MAX_OPTIONS + 1];
    size_t count = 0;
    for (const ff_subcommand *command = commands; command->name && count < MAX_OPTIONS; ++command) {
        if (strcmp(command->name, name) == 0) return command->run(argc - 2, argv + 2);
        known[count++] = command->name;
    }
    known[count] = NULL;
    ff_command nobody = {.program = program, .name = ""};
    const char *near = ff_nearest(name, known);
    if (near) return ff_command_misuse(&nobody, "unknown command '%.60s'; did you mean '%s'?", name, near);
    return ff_command_misuse(&nobody, "unknown command '%.60s'", name);
}

int ff_command_fail(const char *program, const ff_error *error)
{
    char text[1024];
    fprintf(stderr, "%s: %s\n", program, ff_error_text(error, text, sizeof text));
    return FF_EXIT_FAILURE;
}
