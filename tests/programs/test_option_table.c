/* Command lines: parsed values, and messages about errors. */
#include "support/captured_stderr.h"
#include "support/test.h"

#include "option_help.h"
#include "option_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_WORDS 160

struct values {
    bool flag;
    uint32_t count;
    int32_t bias;
    double real, seconds, milliseconds;
    uint64_t bytes;
    const char *text, *first;
    int choice, tenth;
    uint32_t extent[2];
    struct option_texts repeated;
    struct option_list words;
};

static bool parse_tenth(const char *text, void *value)
{
    *(int *)value = text[0] - '0';
    return strlen(text) == 1 && text[0] >= '0' && text[0] <= '9';
}

static struct values v;

static const struct option rows[] = {
    {OPTION_WORD, .operand = "FIRST", .value = &v.first, .help = "a first word", .minimum = 1},
    {OPTION_WORDS, .operand = "OTHERS", .value = &v.words},
    {OPTION_SECTION, .help = "Numbers"},
    {OPTION_FLAG, "flag", .value = &v.flag, .help = "a flag", .letter = 'f'},
    {OPTION_UINT, "count", "N", "7", &v.count, "a count", 1, 99, .letter = 'c'},
    {OPTION_INT, "bias", "LEVELS", "-1", &v.bias, "a bias", -8, 8},
    {OPTION_REAL, "real", "P", "1/16", &v.real, "a probability", 0, 1},
    {OPTION_SECONDS, "seconds", "SECONDS", "250ms", &v.seconds, "a time", 1e-6, 3600},
    {OPTION_MILLISECONDS, "latency", "MS", "20", &v.milliseconds, "a short time", 0, 60000},
    {OPTION_BYTES, "budget", "SIZE", "1G", &v.bytes, "memory", 65536, 1099511627776.0},
    {OPTION_SECTION, .help = "Words"},
    {OPTION_TEXT, "text", "NAME", "(none)", &v.text, "a text"},
    {OPTION_CHOICE, "choice", "auto|sparse|paged", "paged", &v.choice, "one of three"},
    {OPTION_EXTENT, "size", "WxH", "640x360", v.extent, "an extent", 16, 8192},
    {OPTION_CUSTOM, "tenth", "D", "3", &v.tenth, "a digit", .parse = parse_tenth},
    {OPTION_REPEATED, "sweep", "NAME=V", "(none)", &v.repeated, "may be given several times"},
    {OPTION_RENAMED, "old", "count"},
};
static const struct option_table table = {"program", "usage: program FIRST [OTHERS...]\n",
                                          "The end.\n", rows, sizeof rows / sizeof *rows};

static const char *said; ///< captured from stderr, or a help text

static void print_help(const struct option_table *t)
{
    static char text[1 << 13];
    FILE *file = tmpfile();
    assert_non_null(file);
    option_help_print(t, file);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    said = text;
}

/* Parses a command line of words separated by spaces. `said` gets the text on stderr. */
static enum option_outcome parse_with(const struct option_table *t, const char *line)
{
    static char words[4096];
    static char program[] = "program";
    static char *argv[MOST_WORDS + 1]; /* lists of words point into it */
    int argc = 1;
    argv[0] = program;
    snprintf(words, sizeof words, "%s", line);
    for (char *word = strtok(words, " "); word && argc < MOST_WORDS; word = strtok(NULL, " "))
        argv[argc++] = word;
    argv[argc] = NULL;
    v = (struct values){0};
    captured_stderr_begin();
    enum option_outcome outcome = options_parse(t, argc, argv);
    said = captured_stderr_end();
    return outcome;
}

static void expect_run(const char *line)
{
    if (parse_with(&table, line) != OPTIONS_RUN)
        fail_msg("'%s' is refused: %s", line, said);
    assert_string_equal(said, "");
}

static void defaults_are_those_of_the_table(void **state)
{
    (void)state;
    expect_run("a");
    assert_false(v.flag);
    assert_int_equal(v.count, 7);
    assert_int_equal(v.bias, -1);
    assert_true(v.real == 0.0625 && v.seconds == 0.25 && v.milliseconds == 20.0);
    assert_int_equal(v.bytes, 1 << 30);
    assert_null(v.text);
    assert_int_equal(v.choice, 2);
    assert_true(v.extent[0] == 640 && v.extent[1] == 360 && v.tenth == 3);
    assert_int_equal(v.repeated.count, 0);
    assert_string_equal(v.first, "a");
    assert_int_equal(v.words.count, 0);
}

/* Returns the value of an option as a number. */
static double value_of(const char *name)
{
    return strcmp(name, "count") == 0     ? v.count
           : strcmp(name, "bias") == 0    ? v.bias
           : strcmp(name, "real") == 0    ? v.real
           : strcmp(name, "seconds") == 0 ? v.seconds
           : strcmp(name, "latency") == 0 ? v.milliseconds
           : strcmp(name, "budget") == 0  ? (double)v.bytes
           : strcmp(name, "choice") == 0  ? v.choice
           : strcmp(name, "tenth") == 0   ? v.tenth
                                          : -1e9;
}

static void values_are_read_with_their_units(void **state)
{
    static const struct {
        const char *name, *text;
        double value;
    } good[] = {
        {"count", "1", 1},
        {"count", "99", 99},
        {"count", "007", 7},
        {"bias", "-8", -8},
        {"bias", "+8", 8},
        {"bias", "0", 0},
        {"real", "0.25", 0.25},
        {"real", "1/4", 0.25},
        {"real", "1e-3", 0.001},
        {"real", "0", 0},
        {"seconds", "1.5", 1.5},
        {"seconds", "2s", 2},
        {"seconds", "2min", 120},
        {"seconds", "1us", 1e-6},
        {"seconds", "500ms", 0.5},
        {"latency", "5", 5},
        {"latency", "1.5s", 1500},
        {"latency", "250us", 0.25},
        {"budget", "64K", 65536},
        {"budget", "64", 67108864},
        {"budget", "64M", 67108864},
        {"budget", "2G", 2147483648.0},
        {"budget", "1T", 1099511627776.0},
        {"choice", "auto", 0},
        {"choice", "sparse", 1},
        {"tenth", "9", 9},
    };
    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        char line[128];
        for (int form = 0; form < 2; form++) {
            snprintf(line, sizeof line, form ? "--%s=%s a" : "a --%s %s", good[i].name,
                     good[i].text);
            expect_run(line);
            double value = value_of(good[i].name);
            if (value != good[i].value)
                fail_msg("%s is %.17g", line, value);
        }
    }
    expect_run("a --size 16x8192 -c 5 -f");
    assert_true(v.extent[0] == 16 && v.extent[1] == 8192 && v.count == 5 && v.flag);
    expect_run("a --count 3 --count 4");
    assert_int_equal(v.count, 4);
}

static void wrong_command_lines_are_refused_with_value_and_range(void **state)
{
    static const struct {
        const char *line, *message;
    } wrong[] = {
        {"a --count 0", "--count 0: wants a whole number from 1 to 99"},
        {"a --count 100", "--count 100: wants a whole number from 1 to 99"},
        {"a --count -1", "--count -1: wants a whole number from 1 to 99"},
        {"a --count 1x", "--count 1x: wants a whole number from 1 to 99"},
        {"a --count 4294967297", "--count 4294967297: wants a whole number from 1 to 99"},
        {"a --count 99999999999999999999",
         "--count 99999999999999999999: wants a whole number from 1 to 99"},
        {"a --count", "--count: wants a whole number from 1 to 99"},
        {"a --count=", "--count: wants a whole number from 1 to 99"},
        {"a --bias 9", "--bias 9: wants a whole number from -8 to 8"},
        {"a --bias -", "--bias -: wants a whole number from -8 to 8"},
        {"a --bias 1.5", "--bias 1.5: wants a whole number from -8 to 8"},
        {"a --real 2", "--real 2: wants a number from 0 to 1"},
        {"a --real 1/0", "--real 1/0: wants a number from 0 to 1"},
        {"a --real nan", "--real nan: wants a number from 0 to 1"},
        {"a --real -inf", "--real -inf: wants a number from 0 to 1"},
        {"a --seconds 0", "--seconds 0: wants seconds, or a time like 250ms, from 1us to 3600s"},
        {"a --seconds 2h", "--seconds 2h: wants seconds, or a time like 250ms, from 1us to 3600s"},
        {"a --seconds 61min",
         "--seconds 61min: wants seconds, or a time like 250ms, from 1us to 3600s"},
        {"a --latency 61s",
         "--latency 61s: wants milliseconds, or a time like 1.5s, from 0 to 60s"},
        {"a --budget 63K", "--budget 63K: wants a size like 512M or 2G, from 64K to 1T"},
        {"a --budget 2T", "--budget 2T: wants a size like 512M or 2G, from 64K to 1T"},
        {"a --budget 1.5G", "--budget 1.5G: wants a size like 512M or 2G, from 64K to 1T"},
        {"a --budget 17592186044416T",
         "--budget 17592186044416T: wants a size like 512M or 2G, from 64K to 1T"},
        {"a --choice spars", "--choice spars: wants auto|sparse|paged; did you mean sparse?"},
        {"a --choice dense", "--choice dense: wants auto|sparse|paged"},
        {"a --size 640", "--size 640: wants WxH, each from 16 to 8192"},
        {"a --size 640x", "--size 640x: wants WxH, each from 16 to 8192"},
        {"a --size 640x8193", "--size 640x8193: wants WxH, each from 16 to 8192"},
        {"a --size 640x360x3", "--size 640x360x3: wants WxH, each from 16 to 8192"},
        {"a --tenth x", "--tenth x: wants D"},
        {"a --text=", "--text: wants NAME"},
        {"a --flag=1", "--flag 1: wants no value"},
        {"a --old 3", "--old is called --count"},
        {"a --cuont 3", "there is no option --cuont; did you mean --count? --help lists all"},
        {"a --frame-count=3",
         "there is no option --frame-count=3; did you mean --count? --help lists all"},
        {"a --bugdet 3", "there is no option --bugdet; did you mean --budget? --help lists all"},
        {"a --quite-another", "there is no option --quite-another; --help lists all"},
        {"a -x", "there is no option -x; --help lists all"},
        {"a -cf", "there is no option -cf; --help lists all"},
        {"", "a first word is needed; --help says more"},
        {"--flag", "a first word is needed; --help says more"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char expected[512];
        if (parse_with(&table, wrong[i].line) != OPTIONS_ERROR)
            fail_msg("'%s' is taken", wrong[i].line);
        snprintf(expected, sizeof expected, "program: %s\n", wrong[i].message);
        assert_string_equal(said, expected);
    }
}

static void words_may_stand_anywhere_and_follow_two_dashes(void **state)
{
    (void)state;
    expect_run("a --count 3 b - --flag c -- --flag d --");
    assert_string_equal(v.first, "a");
    assert_int_equal(v.words.count, 6);
    static const char *const words[] = {"b", "-", "c", "--flag", "d", "--"};
    for (size_t i = 0; i < 6; i++)
        assert_string_equal(v.words.items[i], words[i]);
    assert_true(v.count == 3 && v.flag);
}

static void an_option_may_be_repeated_up_to_a_limit(void **state)
{
    char line[1024] = "a";
    (void)state;
    expect_run("--sweep x=1 a --sweep y=2");
    assert_int_equal(v.repeated.count, 2);
    assert_string_equal(v.repeated.items[0], "x=1");
    assert_string_equal(v.repeated.items[1], "y=2");
    for (size_t i = 0; i < OPTION_MOST_REPEATS; i++)
        strcat(line, " --sweep z");
    expect_run(line);
    assert_int_equal(v.repeated.count, OPTION_MOST_REPEATS);
    strcat(line, " --sweep z");
    assert_int_equal(parse_with(&table, line), OPTIONS_ERROR);
    assert_string_equal(said, "program: --sweep z: wants NAME=V, at most 64 times\n");
}

/* Tables without words: with a list, with operands after "--", and with neither. */
static void lists_and_the_rest_are_taken_as_they_are(void **state)
{
    struct option_list list = {0}, rest = {0};
    bool flag = false;
    const struct option with_list[] = {
        {OPTION_LIST, "images", "FILE ...", "(none)", &list, "files"},
        {OPTION_FLAG, "flag", .value = &flag, .help = "a flag"}};
    const struct option with_rest[] = {{OPTION_REST, .value = &rest}};
    const struct option_table lists = {"program", "", NULL, with_list, 2};
    const struct option_table rests = {"program", "", NULL, with_rest, 1};
    (void)state;
    assert_int_equal(parse_with(&lists, "--images a -b c --flag"), OPTIONS_RUN);
    assert_true(list.count == 3 && flag);
    assert_string_equal(list.items[1], "-b");
    list = (struct option_list){0};
    assert_int_equal(parse_with(&lists, "--flag --images -- --a --flag"), OPTIONS_RUN);
    assert_int_equal(list.count, 2);
    list = (struct option_list){0};
    assert_int_equal(parse_with(&lists, "--images --flag"), OPTIONS_ERROR);
    assert_string_equal(said, "program: --images: wants FILE ...\n");
    list = (struct option_list){0};
    assert_int_equal(parse_with(&lists, "--images a --images b"), OPTIONS_ERROR);
    assert_string_equal(said, "program: --images: give it once, with all of FILE ... behind it\n");
    list = (struct option_list){0};
    assert_int_equal(parse_with(&lists, "--flag --"), OPTIONS_RUN);
    assert_int_equal(parse_with(&lists, "-- a"), OPTIONS_ERROR);
    assert_string_equal(said, "program: 'a' is one word too many; --help says more\n");
    assert_int_equal(parse_with(&rests, "-- --help -- a"), OPTIONS_RUN);
    assert_int_equal(rest.count, 3);
    assert_string_equal(rest.items[1], "--");
}

static void help_lists_each_option_with_its_default(void **state)
{
    static const char expected[] =
        "usage: program FIRST [OTHERS...]\n"
        "\n"
        "Numbers\n"
        "  -f, --flag                  a flag\n"
        "  -c, --count N               a count [7]\n"
        "  --bias LEVELS               a bias [-1]\n"
        "  --real P                    a probability [1/16]\n"
        "  --seconds SECONDS           a time [250ms]\n"
        "  --latency MS                a short time [20]\n"
        "  --budget SIZE               memory [1G]\n"
        "\n"
        "Words\n"
        "  --text NAME                 a text (none)\n"
        "  --choice auto|sparse|paged  one of three [paged]\n"
        "  --size WxH                  an extent [640x360]\n"
        "  --tenth D                   a digit [3]\n"
        "  --sweep NAME=V              may be given several times (none)\n"
        "  --help                      this text\n"
        "\n"
        "Defaults are in brackets. SIZE: like 512K, 64M or 2G; a number alone is in MiB.\n"
        "SECONDS: like 0.5, 250ms or 2min.\n"
        "\n"
        "The end.\n";
    (void)state;
    print_help(&table);
    assert_string_equal(said, expected);
    assert_int_equal(parse_with(&table, "--wrong -h"), OPTIONS_HELP);
    assert_int_equal(parse_with(&table, "a -- --help"), OPTIONS_RUN);
}

static void long_help_is_wrapped_and_long_choices_follow_it(void **state)
{
    static const struct option row = {
        OPTION_CHOICE,
        "format",
        "auto|one-of-many-formats|another-of-many|third",
        "auto",
        &v.choice,
        "words that fill a line up to its end and then go on in the next line."};
    const struct option_table wide = {"program", "usage", NULL, &row, 1};
    (void)state;
    print_help(&wide);
    assert_non_null(strstr(said, "  --format NAME               words that fill"));
    assert_non_null(strstr(said, "One of auto, one-of-many-formats,"));
    for (const char *line = said; *line; line += strcspn(line, "\n") + 1)
        assert_true(strcspn(line, "\n") <= 96);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_those_of_the_table),
        cmocka_unit_test(values_are_read_with_their_units),
        cmocka_unit_test(wrong_command_lines_are_refused_with_value_and_range),
        cmocka_unit_test(words_may_stand_anywhere_and_follow_two_dashes),
        cmocka_unit_test(an_option_may_be_repeated_up_to_a_limit),
        cmocka_unit_test(lists_and_the_rest_are_taken_as_they_are),
        cmocka_unit_test(help_lists_each_option_with_its_default),
        cmocka_unit_test(long_help_is_wrapped_and_long_choices_follow_it),
    };
    return RUN_TESTS(tests);
}
