/* check.h - cmocka with assertions that fail on NaN. */
#ifndef FF_CHECK_H
#define FF_CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "runtime/core/base/maths.h"

/* cmocka 1.1.5 passes assert_float_equal when one side is NaN: this is written so that NaN fails. */
#define FF_ASSERT_NEAR(got, want, tolerance)                                                                 \
    ff_assert_near((got), (want), (tolerance), #got, __FILE__, __LINE__)
static inline void ff_assert_near(double got, double want, double tolerance, const char *what,
                                  const char *file, int line)
{
    if (!(fabs(got - want) <= tolerance)) {
        print_error("%s = %.9g, want %.9g within %.3g\n", what, got, want, tolerance);
        _fail(file, line);
    }
}

#define FF_ASSERT_BELOW(got, limit) ff_assert_below((got), (limit), #got, __FILE__, __LINE__)
static inline void ff_assert_below(double got, double limit, const char *what, const char *file, int line)
{
    if (!(got <= limit)) {
        print_error("%s = %.9g, want at most %.9g\n", what, got, limit);
        _fail(file, line);
    }
}

/* A call that must succeed; prints its error when it does not. error is an ff_error variable. */
#define FF_ASSERT_OK(call, error) ff_assert_ok((call), &(error), __FILE__, __LINE__)
static inline void ff_assert_ok(ff_status status, const ff_error *error, const char *file, int line)
{
    if (status != FF_OK) {
        char text[1024];
        print_error("%s\n", ff_error_text(error, text, sizeof text));
        _fail(file, line);
    }
}

/* Folder of the outside data, "../shared" beside the project, or NULL (the test must then say that it skipped). */
static inline const char *ff_shared_folder(void)
{
    const char *set = getenv("FF_SHARED");
    return set && *set ? set : NULL;
}

#endif
