/* Text of other sources in the output of the tools. */
#define _XOPEN_SOURCE 700

#include "text.h"

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

struct case_of_text {
    const char *text, *written, *json;
};

static void check(const struct case_of_text *c, bool json)
{
    char *got = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&got, &size);
    if (json)
        text_write_json(out, c->text);
    else
        text_write(out, c->text);
    fclose(out);
    assert_string_equal(got, json ? c->json : c->written);
    free(got);
}

static void check_all(const struct case_of_text *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        check(&cases[i], false);
        check(&cases[i], true);
    }
}

static void letters_of_all_alphabets_stay_as_they_are(void **state)
{
    (void)state;
    static const struct case_of_text cases[] = {
        {"", "", "\"\""},
        {"a b~.png", "a b~.png", "\"a b~.png\""},
        {"f\xC3\xBCr \xE6\x9C\xA8\xF0\x9F\x8C\xB2", "f\xC3\xBCr \xE6\x9C\xA8\xF0\x9F\x8C\xB2",
         "\"f\xC3\xBCr \xE6\x9C\xA8\xF0\x9F\x8C\xB2\""},
        {"\xC2\xA0\xF4\x8F\xBF\xBF", "\xC2\xA0\xF4\x8F\xBF\xBF", "\"\xC2\xA0\xF4\x8F\xBF\xBF\""},
        {"a\\b\"c", "a\\b\"c", "\"a\\\\b\\\"c\""},
    };
    check_all(cases, sizeof cases / sizeof cases[0]);
}

static void what_a_terminal_acts_on_is_spelled_out(void **state)
{
    (void)state;
    static const struct case_of_text cases[] = {
        {"\x1B[31m\a", "\\x1b[31m\\x07", "\"\\u001b[31m\\u0007\""},
        {"a\nb\tc\r", "a\\nb\\tc\\x0d", "\"a\\u000ab\\u0009c\\u000d\""},
        {"\x7F\x01", "\\x7f\\x01", "\"\\u007f\\u0001\""},
        {"\xC2\x9B"
         "1m",
         "\\u009b1m", "\"\\u009b1m\""},                            /* CSI in one character */
        {"\xE2\x80\xAEgnp.a", "\\u202egnp.a", "\"\\u202egnp.a\""}, /* a.png backwards */
        {"\xE2\x81\xA9\xE2\x80\xA8", "\\u2069\\u2028", "\"\\u2069\\u2028\""},
    };
    check_all(cases, sizeof cases / sizeof cases[0]);
}

static void bytes_that_are_no_utf8_are_told_from_letters(void **state)
{
    (void)state;
    static const struct case_of_text cases[] = {
        {"\xFFx", "\\xffx", "\"\\ufffdx\""},
        {"\x80", "\\x80", "\"\\ufffd\""},
        {"\xC3", "\\xc3", "\"\\ufffd\""}, /* truncated */
        {"\xF0\x9F\x8C", "\\xf0\\x9f\\x8c", "\"\\ufffd\\ufffd\\ufffd\""},
        {"\xC0\xAF", "\\xc0\\xaf", "\"\\ufffd\\ufffd\""},                 /* overlong */
        {"\xED\xA0\x80", "\\xed\\xa0\\x80", "\"\\ufffd\\ufffd\\ufffd\""}, /* a surrogate */
        {"\xF4\x90\x80\x80", "\\xf4\\x90\\x80\\x80", "\"\\ufffd\\ufffd\\ufffd\\ufffd\""},
    };
    check_all(cases, sizeof cases / sizeof cases[0]);
}

static void keep_line(void *user_data, const char *line)
{
    strncat(user_data, line, 100);
}

static void a_listener_gets_the_lines_that_are_said(void **state)
{
    char lines[256] = "";
    (void)state;
    text_say("%s", "before");
    text_set_listener(keep_line, lines);
    text_say("one %d;", 1);
    text_say("a\nb");
    text_set_listener(NULL, NULL);
    text_say("behind");
    assert_string_equal(lines, "one 1;a\nb");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(letters_of_all_alphabets_stay_as_they_are),
        cmocka_unit_test(what_a_terminal_acts_on_is_spelled_out),
        cmocka_unit_test(bytes_that_are_no_utf8_are_told_from_letters),
        cmocka_unit_test(a_listener_gets_the_lines_that_are_said),
    };
    return RUN_TESTS(tests);
}
