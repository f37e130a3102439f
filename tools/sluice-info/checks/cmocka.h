/**
 * The part of cmocka that the device tests use, for sluice-info --self-test, which does without
 * cmocka. A failed check ends its test; later tests still run.
 */
#ifndef TOOLS_SLUICE_INFO_CHECKS_CMOCKA_H
#define TOOLS_SLUICE_INFO_CHECKS_CMOCKA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

struct CMUnitTest {
    const char *name;
    void (*test_func)(void **state);
    void *initial_state;
};

/** Runs tests and reports each (self_test_checks.h). Returns the number of failed tests. */
int self_test_run(const struct CMUnitTest *tests, size_t count);
/** Fails and ends the test. Takes printf arguments. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4), noreturn))
#endif
void
self_test_fail(const char *file, int line, const char *format, ...);
/** Skips and ends the test. The last message says why. */
#if defined(__GNUC__)
__attribute__((noreturn))
#endif
void
skip(void);
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
void
print_message(const char *format, ...);

#define cmocka_unit_test(function)                                                                 \
    {                                                                                              \
#function, function, NULL                                                                  \
    }
#define cmocka_run_group_tests_name(name, tests, setup, teardown)                                  \
    self_test_run(tests, sizeof(tests) / sizeof(tests)[0])
#define fail_msg(...) self_test_fail(__FILE__, __LINE__, __VA_ARGS__)
#define assert_true(condition)                                                                     \
    ((condition) ? (void)0 : self_test_fail(__FILE__, __LINE__, "%s does not hold", #condition))
#define assert_non_null(pointer) assert_true((pointer) != NULL)
#define assert_int_equal(a, b)                                                                     \
    ((intmax_t)(a) == (intmax_t)(b) ? (void)0                                                      \
                                    : self_test_fail(__FILE__, __LINE__, "%s is %jd, not %jd", #a, \
                                                     (intmax_t)(a), (intmax_t)(b)))
#define assert_int_not_equal(a, b) assert_true((intmax_t)(a) != (intmax_t)(b))
#define assert_in_range(value, low, high)                                                          \
    ((uintmax_t)(value) >= (uintmax_t)(low) && (uintmax_t)(value) <= (uintmax_t)(high)             \
         ? (void)0                                                                                 \
         : self_test_fail(__FILE__, __LINE__, "%s is %ju, not in %ju to %ju", #value,              \
                          (uintmax_t)(value), (uintmax_t)(low), (uintmax_t)(high)))
#define assert_memory_equal(a, b, size)                                                            \
    (memcmp(a, b, size) == 0 ? (void)0                                                             \
                             : self_test_fail(__FILE__, __LINE__, "%s and %s differ", #a, #b))

#endif /* TOOLS_SLUICE_INFO_CHECKS_CMOCKA_H */
