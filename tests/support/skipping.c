/* Helper of test_tap.sh, which checks its output. Not a test itself. */
#include "support/test.h"

static void passes(void **state)
{
    (void)state;
    print_message("no TAP\n");
}

static void is_skipped(void **state)
{
    (void)state;
    SKIP_TEST("no device %d", 7);
}

static void is_skipped_silently(void **state)
{
    (void)state;
    skip();
}

static void fails(void **state)
{
    (void)state;
    CHECK_RESULT(SLUICE_NOT_READY, SLUICE_SUCCESS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes),
        cmocka_unit_test(is_skipped),
        cmocka_unit_test(is_skipped_silently),
        cmocka_unit_test(fails),
    };
    return RUN_TESTS(tests);
}
