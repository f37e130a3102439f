#include "self_test_checks.h"

#include "checks/cmocka.h"
#include "../common/clock.h"

#include <setjmp.h>
#include <stdarg.h>

enum outcome { PASSED, FAILED, SKIPPED };

/* State of the running test. */
static struct {
    FILE *out;
    jmp_buf end;
    enum outcome outcome;
    char reason[1024], message[256]; ///< last printed message
} now;

void tap_filter_stdout(void);
/* Called by the tests. There is no TAP to filter here. */
void tap_filter_stdout(void) {}

void self_test_report_to(FILE *out)
{
    now.out = out;
}

/* Removes tabs and line ends, which a report line must not contain. */
static void flatten(char *text)
{
    for (; *text; text++)
        if (*text == '\t' || *text == '\n')
            *text = ' ';
}

void print_message(const char *format, ...)
{
    va_list arguments;
    char text[sizeof now.message];
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fputs(text, stdout);
    if (strcmp(text, "\n") != 0)
        memcpy(now.message, text, sizeof text);
}

void skip(void)
{
    static const char prefix[] = "# skipped: "; /* prefix that SKIP_TEST prints */
    size_t length = strncmp(now.message, prefix, sizeof prefix - 1) == 0 ? sizeof prefix - 1 : 0;
    now.outcome = SKIPPED;
    snprintf(now.reason, sizeof now.reason, "%s", now.message + length);
    longjmp(now.end, 1);
}

void self_test_fail(const char *file, int line, const char *format, ...)
{
    const char *name = strrchr(file, '/');
    va_list arguments;
    now.outcome = FAILED;
    int length = snprintf(now.reason, sizeof now.reason, "%s:%d: ", name ? name + 1 : file, line);
    va_start(arguments, format);
    vsnprintf(now.reason + length, sizeof now.reason - (size_t)length, format, arguments);
    va_end(arguments);
    longjmp(now.end, 1);
}

static void run(const struct CMUnitTest *test)
{
    void *state = test->initial_state;
    now.outcome = PASSED;
    now.reason[0] = now.message[0] = '\0';
    if (setjmp(now.end) == 0)
        test->test_func(&state);
}

int self_test_run(const struct CMUnitTest *tests, size_t count)
{
    static const char *const outcomes[] = {"pass", "fail", "skip"};
    int failed = 0;
    for (size_t i = 0; i < count; i++) {
        double start = clock_seconds();
        fprintf(now.out, "begin\t%s\n", tests[i].name);
        fflush(now.out);
        run(&tests[i]);
        failed += now.outcome == FAILED;
        flatten(now.reason);
        fprintf(now.out, "end\t%s\t%s\t%.3f\t%s\n", tests[i].name, outcomes[now.outcome],
                clock_seconds() - start, now.reason);
        fflush(now.out);
    }
    return failed;
}
