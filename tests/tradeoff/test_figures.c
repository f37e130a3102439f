/* Figures that programs print, by figure and by frame. */
#define _POSIX_C_SOURCE 200809L
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "figures.h"
#include "frames.h"

/* Returns a path. The caller removes the file and frees the path. */
static char *write_file(const char *text)
{
    char *path = strdup("/tmp/sluice-figures-XXXXXX");
    int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), strlen(text));
    close(file);
    return path;
}

static void drop_file(char *path)
{
    unlink(path);
    free(path);
}

static void expect(const char *line, const char *name, double value, const char *unit)
{
    struct figure figure;
    if (!figure_parse(line, &figure))
        fail_msg("not a figure: %s", line);
    assert_string_equal(figure.name, name);
    assert_string_equal(figure.unit, unit);
    if (figure.value != value && !(isnan(figure.value) && isnan(value)))
        fail_msg("%s is %g", line, figure.value);
    figure_finish(&figure);
}

static void lines_are_read_whatever_the_order_of_their_members(void **state)
{
    (void)state;
    expect("{\"name\": \"a_ms\", \"value\": 1.5, \"unit\": \"ms\"}", "a_ms", 1.5, "ms");
    expect("  {\"unit\":\"\",\"value\":-2e3,\"name\":\"b\"}  \r", "b", -2000.0, "");
    expect("{\"name\": \"c\", \"more\": \"x\", \"value\": 0, \"n\": 7}", "c", 0.0, "");
    expect("{\"name\": \"d\", \"value\": null, \"unit\": \"dB\"}", "d", NAN, "dB");
    expect("{\"name\": \"e\", \"value\": 1e999, \"unit\": \"dB\"}", "e", INFINITY, "dB");
    expect("{\"name\": \"f\", \"value\": true}", "f", 1.0, "");
}

static void strings_are_what_their_escapes_mean(void **state)
{
    struct figure figure;
    (void)state;
    assert_true(figure_parse(
        "{\"name\": \"device\", \"value\": \"a \\\"b\\\" \\\\ \\u00e9\\u20AC\"}", &figure));
    assert_string_equal(figure.text, "a \"b\" \\ \xc3\xa9\xe2\x82\xac");
    assert_true(isnan(figure.value));
    figure_finish(&figure);
    assert_true(figure_parse("{\"name\": \"x\", \"value\": \"\\ud83d\\u0000\"}", &figure));
    assert_string_equal(figure.text, "\xef\xbf\xbd\xef\xbf\xbd");
    figure_finish(&figure);
}

static void what_is_no_figure_is_refused(void **state)
{
    static const char *const lines[] = {
        "",
        "{",
        "{}",
        "walking: 60 frames",
        "{\"name\": \"a\"}",
        "{\"value\": 1}",
        "{\"name\": \"a\", \"value\": }",
        "{\"name\": \"a\", \"value\": 1",
        "{\"name\": \"a\", \"value\": 1} x",
        "{\"name\": \"a\", \"value\": 0x10}",
        "{\"name\": \"a\", \"value\": nan}",
        "{\"name\": \"a\", \"value\": inf}",
        "{\"name\": \"a\", \"value\": +1}",
        "{\"name\": \"a\", \"value\": 1.2.3}",
        "{\"name\": \"a, \"value\": 1}",
        "{\"name\": \"a\\q\", \"value\": 1}",
        "{\"name\": \"a\\u12\", \"value\": 1}",
        "{\"name\": \"a\\",
        "{\"name\" \"a\", \"value\": 1}",
        "{\"name\": 5, \"value\": 1}",
        "[\"name\", \"a\"]",
    };
    (void)state;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        struct figure figure;
        if (figure_parse(lines[i], &figure))
            fail_msg("taken for a figure: %s", lines[i]);
        assert_null(figure.name);
    }
}

/* Every prefix of a valid line, so that reads behind the end show. */
static void cut_lines_are_refused(void **state)
{
    static const char line[] = "{\"name\": \"a\\u00e9\", \"value\": \"x\", \"unit\": \"\"}";
    (void)state;
    for (size_t length = 0; length + 1 < sizeof line; length++) {
        struct figure figure;
        char *cut = strndup(line, length);
        assert_false(figure_parse(cut, &figure));
        free(cut);
    }
}

static void rubbish_between_figures_is_counted(void **state)
{
    struct figures figures = {0};
    char *path = write_file("{\"name\": \"a\", \"value\": 1, \"unit\": \"ms\"}\nrubbish\n\n \n"
                            "{\"name\": \"a\", \"value\": 2, \"unit\": \"ms\"}\n"
                            "{\"name\": \"p\", \"value\": 1e999, \"unit\": \"dB\"}\nmore");
    (void)state;
    assert_true(figures_read(path, &figures));
    assert_int_equal(figures.count, 3);
    assert_int_equal(figures.rubbish_count, 2);
    assert_true(figures_value(&figures, "a") == 2.0); /* the last one */
    assert_true(figures_value(&figures, "p") == 999.0);
    assert_true(isnan(figures_value(&figures, "b")));
    figures_finish(&figures);
    drop_file(path);
    assert_false(figures_read(path = strdup("/nonexistent/figures"), &figures));
    free(path);
}

static void frames_give_figures_that_the_program_did_not_print(void **state)
{
    struct frames frames;
    struct figures figures = {0};
    /* Squared errors 1e-2, 1e-3 and none; 10, 0 and 5 % missing; one cell empty, one rubbish. */
    char *path = write_file("frame,psnr_db,flip,missing_pixels,sampled_pixels,ssim\r\n"
                            "0,20,0.5,10,100,x\r\n1,30,,0,100,0.5\r\n2,999,0.25,5,100,1\r\n");
    (void)state;
    assert_true(frames_read(path, &frames));
    drop_file(path);
    assert_int_equal(frames.row_count, 3);
    assert_int_equal(frames_column(&frames, "flip"), 2);
    assert_int_equal(frames_column(&frames, "ssim"), 5);
    assert_int_equal(frames_column(&frames, "other"), -1);
    figures_add(&figures, "ssim_mean", 0.125, "");
    frames_derive(&frames, &figures);
    assert_true(fabs(figures_value(&figures, "psnr_mean_db") + 10.0 * log10(0.011 / 3.0)) < 1e-9);
    assert_true(fabs(figures_value(&figures, "flip_mean") - 0.375) < 1e-12);
    assert_true(fabs(figures_value(&figures, "missing_pixels_percent") - 5.0) < 1e-12);
    assert_true(figures_value(&figures, "ssim_mean") == 0.125); /* the program's own stays */
    frames_finish(&frames);
    figures_finish(&figures);
}

static void damaged_tables_give_nothing(void **state)
{
    static const char *const texts[] = {
        "",    "\n\n",          "frame\n", "frame,psnr_db\n1\n2,\n3,x,7,8\n",
        "\0x", ",,,\n,,,,,,\n", "psnr_db"};
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct frames frames;
        struct figures figures = {0};
        char *path = write_file(texts[i]);
        assert_true(frames_read(path, &frames));
        frames_derive(&frames, &figures);
        assert_int_equal(figures.count, 0);
        frames_finish(&frames);
        drop_file(path);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_are_read_whatever_the_order_of_their_members),
        cmocka_unit_test(strings_are_what_their_escapes_mean),
        cmocka_unit_test(what_is_no_figure_is_refused),
        cmocka_unit_test(cut_lines_are_refused),
        cmocka_unit_test(rubbish_between_figures_is_counted),
        cmocka_unit_test(frames_give_figures_that_the_program_did_not_print),
        cmocka_unit_test(damaged_tables_give_nothing),
    };
    return RUN_TESTS(tests);
}
