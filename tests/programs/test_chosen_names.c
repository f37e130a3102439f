/* Lists of names on the command line. */
#include "chosen_names.h"

#include "support/captured_stderr.h"
#include "support/test.h"

#include <string.h>

static void a_list_has_its_names_and_no_parts_of_them(void **state)
{
    (void)state;
    assert_true(names_have("fill", "fill"));
    assert_true(names_have("fill,budget", "fill"));
    assert_true(names_have("fill,budget", "budget"));
    assert_false(names_have("fill,budget", "sampling"));
    assert_false(names_have("fill,budget", "bud"));
    assert_false(names_have("fill", "filling"));
    assert_false(names_have("fill,", ""));
    assert_true(names_have(NULL, "anything"));
}

static void names_that_nothing_has_are_said(void **state)
{
    (void)state;
    assert_true(names_are_known(NULL, "fill,budget"));
    assert_true(names_are_known("budget", "fill,budget"));
    assert_true(names_are_known("budget,fill", "fill,budget"));
    static const char *const unknown[][2] = {{"bud", "\"bud\""},
                                             {"fill,trips", "\"trips\""},
                                             {"fill,", "\"\""},
                                             {",fill", "\"\""},
                                             {"", "\"\""}};
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++) {
        captured_stderr_begin();
        bool known = names_are_known(unknown[i][0], "fill,budget");
        const char *text = captured_stderr_end();
        assert_false(known);
        assert_non_null(strstr(text, unknown[i][1]));
        assert_non_null(strstr(text, "fill,budget"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_list_has_its_names_and_no_parts_of_them),
        cmocka_unit_test(names_that_nothing_has_are_said),
    };
    return RUN_TESTS(tests);
}
