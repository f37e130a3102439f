/**
 * The part of cmocka's interface that tests use, for systems for which no package of cmocka can be
 * had when cross building. Prints TAP. Include it as cmocka.h, behind setjmp.h and the others.
 */
#ifndef TESTS_CROSS_CMOCKA_H
#define TESTS_CROSS_CMOCKA_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct CMUnitTest {
    const char *name;
    void (*test_func)(void **state);
    int (*setup_func)(void **state);
    int (*teardown_func)(void **state);
    void *initial_state;
};

#define cmocka_unit_test(f)                                                                        \
    {                                                                                              \
#f, f, NULL, NULL, NULL                                                                    \
    }
#define cmocka_unit_test_setup_teardown(f, setup, teardown)                                        \
    {                                                                                              \
#f, f, setup, teardown, NULL                                                               \
    }
#define cmocka_run_group_tests(tests, setup, teardown)                                             \
    small_run_tests(tests, sizeof(tests) / sizeof *(tests))
#define cmocka_run_group_tests_name(name, tests, setup, teardown)                                  \
    small_run_tests(tests, sizeof(tests) / sizeof *(tests))

/** Runs all tests. Returns how many failed. */
int small_run_tests(const struct CMUnitTest *tests, size_t count);
/** Ends the test that runs now. */
void small_fail(const char *file, int line, const char *what);
void small_skip(void);

#define fail() small_fail(__FILE__, __LINE__, "fail()")
#define skip() small_skip()
#define fail_msg(...)                                                                              \
    do {                                                                                           \
        printf("# " __VA_ARGS__);                                                                  \
        printf("\n");                                                                              \
        small_fail(__FILE__, __LINE__, "fail_msg()");                                              \
    } while (0)
#define print_message(...) printf(__VA_ARGS__)
#define print_error(...) printf(__VA_ARGS__)
#define test_calloc calloc
#define test_free free

#define SMALL_CHECK(condition, text)                                                               \
    do {                                                                                           \
        if (!(condition))                                                                          \
            small_fail(__FILE__, __LINE__, text);                                                  \
    } while (0)
#define SMALL_WORD(a) ((unsigned long long)(a))
#define assert_true(a) SMALL_CHECK(a, #a)
#define assert_false(a) SMALL_CHECK(!(a), "!" #a)
#define assert_null(a) SMALL_CHECK((a) == NULL, #a " == NULL")
#define assert_non_null(a) SMALL_CHECK((a) != NULL, #a " != NULL")
#define assert_int_equal(a, b) SMALL_CHECK(SMALL_WORD(a) == SMALL_WORD(b), #a " == " #b)
#define assert_int_not_equal(a, b) SMALL_CHECK(SMALL_WORD(a) != SMALL_WORD(b), #a " != " #b)
#define assert_ptr_equal(a, b) SMALL_CHECK((const void *)(a) == (const void *)(b), #a " == " #b)
#define assert_ptr_not_equal(a, b) SMALL_CHECK((const void *)(a) != (const void *)(b), #a " != " #b)
#define assert_string_equal(a, b) SMALL_CHECK(strcmp(a, b) == 0, #a " equals " #b)
#define assert_string_not_equal(a, b) SMALL_CHECK(strcmp(a, b) != 0, #a " differs from " #b)
#define assert_memory_equal(a, b, size) SMALL_CHECK(memcmp(a, b, size) == 0, #a " equals " #b)
#define assert_in_range(a, least, most)                                                            \
    SMALL_CHECK(SMALL_WORD(a) >= SMALL_WORD(least) && SMALL_WORD(a) <= SMALL_WORD(most),           \
                #a " lies in " #least " to " #most)

#endif /* TESTS_CROSS_CMOCKA_H */
