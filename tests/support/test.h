/** cmocka with the headers that it needs before it. A test's name is the fact it shows. */
#ifndef TESTS_SUPPORT_TEST_H
#define TESTS_SUPPORT_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <sluice/base.h>

#include "support/tap.h"

/** Prints both results by name when they differ. */
#define CHECK_RESULT(expression, expected)                                                         \
    do {                                                                                           \
        SluiceResult check_result_ = (expression);                                                 \
        SluiceResult check_expected_ = (expected);                                                 \
        if (check_result_ != check_expected_)                                                      \
            fail_msg("%s is %s, not %s", #expression, sluiceGetResultName(check_result_),          \
                     sluiceGetResultName(check_expected_));                                        \
    } while (0)

#define CHECK_OK(expression) CHECK_RESULT(expression, SLUICE_SUCCESS)

/** Leaves the test, which counts as skipped, and says why: a string literal, printf arguments. */
#define SKIP_TEST(...)                                                                             \
    do {                                                                                           \
        print_message("# skipped: " __VA_ARGS__);                                                  \
        print_message("\n");                                                                       \
        skip();                                                                                    \
    } while (0)

/** An array of cmocka unit tests, named as the functions are. */
#define RUN_TESTS(tests)                                                                           \
    (tap_filter_stdout(), cmocka_run_group_tests_name(__FILE__, tests, NULL, NULL))

#endif /* TESTS_SUPPORT_TEST_H */
