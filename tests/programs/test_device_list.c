/* The value of --devices. */
#include "device_list.h"

#include "support/test.h"

#include <string.h>

static void words_and_counts_name_no_device(void **state)
{
    (void)state;
    struct device_list list;
    assert_true(device_list_parse("all", &list));
    assert_int_equal(list.wanted, DEVICE_LIST_ALL);
    assert_int_equal(list.count, 0);
    assert_true(device_list_parse("2", &list));
    assert_int_equal(list.wanted, 2);
    assert_int_equal(list.count, 0);
}

static void a_comma_makes_numbers_indices(void **state)
{
    (void)state;
    struct device_list list;
    assert_true(device_list_parse("3,0,3", &list));
    assert_int_equal(list.wanted, 0);
    assert_int_equal(list.count, 3);
    assert_int_equal(list.indices[0], 3);
    assert_int_equal(list.indices[1], 0);
    assert_int_equal(list.indices[2], 3);
    assert_true(device_list_parse("1,", &list));
    assert_int_equal(list.count, 1);
    assert_int_equal(list.indices[0], 1);
}

static void a_later_list_replaces_an_earlier_one(void **state)
{
    (void)state;
    struct device_list list;
    assert_true(device_list_parse("all", &list));
    assert_true(device_list_parse("0,1", &list));
    assert_int_equal(list.wanted, 0);
    assert_true(device_list_parse("1", &list));
    assert_int_equal(list.count, 0);
}

static void other_texts_are_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {"",    "0",    "-1",  "+1",  "65", "99999999999",
                                        "two", "ALL",  "1 ",  ",",   ",1", "1,,",
                                        "1,a", "0,-1", "1.5", "0;1", " 1", "1, 2"};
    struct device_list list;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (device_list_parse(texts[i], &list))
            fail_msg("\"%s\" was taken for a list", texts[i]);
}

static void lists_are_bounded(void **state)
{
    (void)state;
    char text[2 * DEVICE_LIST_MOST + 4] = "";
    struct device_list list;
    for (uint32_t i = 0; i < DEVICE_LIST_MOST; i++)
        strcat(text, "0,");
    assert_true(device_list_parse(text, &list));
    assert_int_equal(list.count, DEVICE_LIST_MOST);
    strcat(text, "0");
    assert_false(device_list_parse(text, &list));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_and_counts_name_no_device),
        cmocka_unit_test(a_comma_makes_numbers_indices),
        cmocka_unit_test(a_later_list_replaces_an_earlier_one),
        cmocka_unit_test(other_texts_are_refused),
        cmocka_unit_test(lists_are_bounded),
    };
    return RUN_TESTS(tests);
}
