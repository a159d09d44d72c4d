/* Progress: silent when asked or when there is nothing to say yet; never a control character off a terminal. */
#include "tests/check.h"

#include "runtime/tool/progress.h"
#include "tests/tool/capture.h"

#include <time.h>

static void quiet_and_short_work_print_nothing(void **state)
{
    (void)state;
    ff_capture capture;
    ff_capture_start(&capture, stderr);
    ff_progress *progress = ff_progress_start("reading", 3, true);
    assert_null(progress);
    ff_progress_step(progress, "a.bvh");
    ff_progress_end(progress);
    progress = ff_progress_start("reading", 3, false);
    ff_progress_step(progress, "a.bvh");
    ff_progress_end(progress);
    assert_string_equal(ff_capture_end(&capture), "");
}

static void off_a_terminal_long_work_prints_plain_lines(void **state)
{
    (void)state;
    ff_capture capture;
    ff_capture_start(&capture, stderr);
    ff_progress *progress = ff_progress_start("reading", 3, false);
    ff_progress_step(progress, "a.bvh");
    nanosleep(&(struct timespec){1, 20000000}, NULL);
    ff_progress_step(progress, "b.bvh");
    ff_progress_step(progress, NULL); /* within the same second */
    ff_progress_end(progress);
    assert_string_equal(ff_capture_end(&capture), "reading 2/3 b.bvh\n");
}

static void long_work_tells_the_time_left_by_weight(void **state)
{
    (void)state;
    ff_capture capture;
    ff_capture_start(&capture, stderr);
    ff_progress *progress = ff_progress_start("cutting", 3, false);
    ff_progress_weigh(progress, 91.0);
    nanosleep(&(struct timespec){2, 20000000}, NULL);
    ff_progress_step_by(progress, "a.bvh", 1.0); /* a ninetieth of the work: too little to tell from */
    nanosleep(&(struct timespec){1, 20000000}, NULL);
    ff_progress_step_by(progress, "b.bvh", 9.0);
    ff_progress_end(progress);
    assert_string_equal(ff_capture_end(&capture), "cutting 1/3 a.bvh\ncutting 2/3, 0:25 left b.bvh\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quiet_and_short_work_print_nothing),
        cmocka_unit_test(off_a_terminal_long_work_prints_plain_lines),
        cmocka_unit_test(long_work_tells_the_time_left_by_weight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
