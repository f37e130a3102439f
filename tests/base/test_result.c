#include "support/test.h"

#include <string.h>

static void every_result_has_its_own_name(void **state)
{
    (void)state;
    const char *names[64];
    int count = 0;
    for (int value = -40; value < 10; value++) {
        const char *name = sluiceGetResultName((SluiceResult)value);
        if (strcmp(name, "SLUICE_RESULT_UNKNOWN") == 0)
            continue;
        for (int i = 0; i < count; i++)
            assert_string_not_equal(name, names[i]);
        names[count++] = name;
    }
    assert_int_equal(count, 4 + 24);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_result_has_its_own_name)};
    return RUN_TESTS(tests);
}
