#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static jmp_buf out;
enum { FAILED = 1, SKIPPED = 2 };

void small_fail(const char *file, int line, const char *what)
{
    printf("# %s:%d: not so: %s\n", file, line, what);
    longjmp(out, FAILED);
}

void small_skip(void)
{
    longjmp(out, SKIPPED);
}

static int run(const struct CMUnitTest *test)
{
    void *state = test->initial_state;
    if (test->setup_func && test->setup_func(&state) != 0)
        return FAILED;
    int result = setjmp(out);
    if (result == 0)
        test->test_func(&state);
    if (test->teardown_func)
        test->teardown_func(&state);
    return result;
}

int small_run_tests(const struct CMUnitTest *tests, size_t count)
{
    volatile int failed = 0;
    printf("1..%d\n", (int)count);
    for (volatile size_t i = 0; i < count; i++) {
        int result = run(&tests[i]);
        failed += result == FAILED;
        printf("%s %d - %s%s\n", result == FAILED ? "not ok" : "ok", (int)i + 1, tests[i].name,
               result == SKIPPED ? " # SKIP" : "");
        fflush(stdout);
    }
    return failed;
}
