/* Command lines: what is accepted, what is refused and how it is said. */
#include "tests/check.h"

#include "runtime/tool/command_line.h"
#include "runtime/tool/nearest.h"
#include "tests/tool/capture.h"

/* The options of an imagined command, at their defaults. */
typedef struct sample {
    bool quiet;
    const char *out;
    double seconds;
    int64_t threads;
    ff_operands operands;
    ff_option options[5];
    ff_command command;
} sample;

static void sample_init(sample *s)
{
    memset(s, 0, sizeof *s);
    s->seconds = 60.0, s->threads = 1;
    s->options[0] = (ff_option){
        .name = "--out", .alias = "-o", .value_name = "FILE", .help = "where to write", .text = &s->out};
    s->options[1] = (ff_option){.name = "--seconds",
                                .value_name = "S",
                                .help = "how long to run",
                                .number = &s->seconds,
                                .low = 0.0,
                                .high = 3600.0};
    s->options[2] = (ff_option){.name = "--threads",
                                .value_name = "N",
                                .help = "threads",
                                .integer = &s->threads,
                                .low = 1,
                                .high = 256};
    s->options[3] = (ff_option){.name = "--quiet", .help = "say nothing", .flag = &s->quiet};
    s->command = (ff_command){.program = "footfall-crowd",
                              .name = "run",
                              .arguments = "SCENE",
                              .summary = "run a scene",
                              .details = "More about it.",
                              .options = s->options,
                              .min_operands = 1,
                              .max_operands = 2};
}

enum { MOST_WORDS = 12 };

/* Parse words given as one string with spaces. */
static int parse(sample *s, const char *line)
{
    static char text[256], *argv[MOST_WORDS];
    int argc = 0;
    snprintf(text, sizeof text, "%s", line);
    for (char *word = strtok(text, " "); word && argc < MOST_WORDS; word = strtok(NULL, " "))
        argv[argc++] = word;
    return ff_command_parse(&s->command, argc, argv, &s->operands);
}

static void options_and_operands_may_stand_in_any_order(void **state)
{
    (void)state;
    sample s;
    sample_init(&s);
    assert_int_equal(parse(&s, "-o a.glb circle.json --seconds=12.5 --quiet --threads 4 --out=b.glb"), -1);
    assert_string_equal(s.out, "b.glb");
    FF_ASSERT_NEAR(s.seconds, 12.5, 0.0);
    assert_int_equal(s.threads, 4);
    assert_true(s.quiet);
    assert_int_equal(s.operands.count, 1);
    assert_string_equal(s.operands.items[0], "circle.json");
}

static void two_dashes_end_the_options_and_one_dash_is_an_operand(void **state)
{
    (void)state;
    sample s;
    sample_init(&s);
    assert_int_equal(parse(&s, "- -- --quiet"), -1);
    assert_int_equal(s.operands.count, 2);
    assert_string_equal(s.operands.items[0], "-");
    assert_string_equal(s.operands.items[1], "--quiet");
    assert_false(s.quiet);
}

static void usage_errors_exit_2_and_say_what_is_wrong(void **state)
{
    (void)state;
    static const struct {
        const char *line, *says;
    } bad[] = {
        {"s.json --secnds 3", "unknown option '--secnds'; did you mean '--seconds'?"},
        {"s.json --helpp", "did you mean '--help'?"},
        {"s.json --colourful=3", "unknown option '--colourful'; try"},
        {"s.json -x", "unknown option '-x'"},
        {"s.json --seconds", "--seconds needs a value (S)"},
        {"s.json --seconds ten", "--seconds needs a number, not 'ten'"},
        {"s.json --seconds nan", "--seconds needs a number, not 'nan'"},
        {"s.json --seconds 1e9", "--seconds is 1e9; expected 0 to 3600"},
        {"s.json --threads 2.5", "--threads needs a whole number, not '2.5'"},
        {"s.json --threads 0", "--threads is 0; expected 1 to 256"},
        {"s.json --threads 99999999999999999999", "expected 1 to 256"},
        {"s.json --quiet=no", "--quiet takes no value"},
        {"s.json --out=", "--out needs a value that is not empty"},
        {"--quiet", "expected SCENE"},
        {"a b c", "unexpected argument 'c'"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        sample s;
        sample_init(&s);
        ff_capture capture;
        ff_capture_start(&capture, stderr);
        int status = parse(&s, bad[i].line);
        const char *said = ff_capture_end(&capture);
        assert_int_equal(status, FF_EXIT_USAGE);
        assert_ptr_equal(strstr(said, "footfall-crowd: "), said);
        if (!strstr(said, bad[i].says)) fail_msg("'%s' says: %s", bad[i].line, said);
        assert_non_null(strstr(said, "try 'footfall-crowd run --help'\n"));
    }
}

static void help_prints_program_usage_and_aligned_options(void **state)
{
    (void)state;
    sample s;
    sample_init(&s);
    ff_capture capture;
    ff_capture_start(&capture, stdout);
    int status = parse(&s, "--help");
    assert_string_equal(ff_capture_end(&capture), "footfall-crowd run - run a scene\n"
                                                  "\n"
                                                  "usage: footfall-crowd run [options] SCENE\n"
                                                  "\n"
                                                  "options:\n"
                                                  "  -o, --out FILE  where to write\n"
                                                  "  --seconds S     how long to run\n"
                                                  "  --threads N     threads\n"
                                                  "  --quiet         say nothing\n"
                                                  "  --help          print this text\n"
                                                  "  --version       print the version\n"
                                                  "\n"
                                                  "More about it.\n");
    assert_int_equal(status, FF_EXIT_OK);
}

static int run_with_count(int argc, char **argv)
{
    (void)argv;
    return 40 + argc;
}

static void a_program_runs_the_command_it_was_given_or_names_the_nearest(void **state)
{
    (void)state;
    static const ff_subcommand commands[] = {
        {"build", "make a pack", run_with_count}, {"inspect", "look", run_with_count}, {0}};
    static const struct {
        const char *word;
        int status;
        const char *out, *err;
    } calls[] = {
        {"build", 41, "", ""},
        {"--version", 0, "footfall-pack " FF_VERSION "\n", ""},
        {"--help", 0, "  build    make a pack\n  inspect  look\n", ""},
        {"biuld", 2, "", "unknown command 'biuld'; try"},
        {"buid", 2, "", "unknown command 'buid'; did you mean 'build'?"},
        {NULL, 2, "", "usage: footfall-pack COMMAND"},
    };
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; ++i) {
        char program[] = "footfall-pack", word[32] = "", extra[] = "x";
        if (calls[i].word) snprintf(word, sizeof word, "%s", calls[i].word);
        char *argv[] = {program, word, extra};
        ff_capture out, err;
        ff_capture_start(&out, stdout);
        ff_capture_start(&err, stderr);
        int status = ff_command_dispatch(program, "clips to packs", commands, calls[i].word ? 3 : 1, argv);
        const char *said_err = ff_capture_end(&err), *said_out = ff_capture_end(&out);
        assert_int_equal(status, calls[i].status);
        assert_non_null(strstr(said_out, calls[i].out));
        assert_non_null(strstr(said_err, calls[i].err));
    }
}

static void nearest_takes_the_closest_word_and_none_that_is_far(void **state)
{
    (void)state;
    static const char *const words[] = {"agents", "seconds", "seed", NULL};
    assert_string_equal(ff_nearest("sead", words), "seed");
    assert_string_equal(ff_nearest("second", words), "seconds");
    assert_string_equal(ff_nearest("seed", words), "seed");
    assert_null(ff_nearest("walls", words));
    assert_null(ff_nearest("", words));
    assert_null(ff_nearest("aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa", words));
}

static void an_error_is_printed_after_the_programs_name(void **state)
{
    (void)state;
    ff_error error = {.status = FF_ERR_PARSE, .file = "a.bvh", .line = 3, .column = 7, .message = "no"};
    ff_capture capture;
    ff_capture_start(&capture, stderr);
    int status = ff_command_fail("footfall-pack", &error);
    assert_string_equal(ff_capture_end(&capture), "footfall-pack: a.bvh:3:7: no\n");
    assert_int_equal(status, FF_EXIT_FAILURE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_and_operands_may_stand_in_any_order),
        cmocka_unit_test(two_dashes_end_the_options_and_one_dash_is_an_operand),
        cmocka_unit_test(usage_errors_exit_2_and_say_what_is_wrong),
        cmocka_unit_test(help_prints_program_usage_and_aligned_options),
        cmocka_unit_test(a_program_runs_the_command_it_was_given_or_names_the_nearest),
        cmocka_unit_test(nearest_takes_the_closest_word_and_none_that_is_far),
        cmocka_unit_test(an_error_is_printed_after_the_programs_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
