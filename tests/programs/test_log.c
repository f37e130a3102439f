/* Messages that the programs' log suppresses. */
#include "support/captured_stderr.h"
#include "support/test.h"

#include "log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *text; ///< captured text

static uint32_t count_lines(const char *part)
{
    uint32_t count = 0;
    for (const char *line = text; *line; line += strcspn(line, "\n") + 1) {
        const char *found = strstr(line, part);
        count += found && found < line + strcspn(line, "\n");
    }
    return count;
}

static void say_tile(const char *file, uint32_t tile)
{
    char message[128];
    snprintf(message, sizeof message, "%s: tile %u cannot be read", file, tile);
    log_say(NULL, SLUICE_LOG_ERROR, message);
}

static void a_message_is_said_once_then_counted(void **state)
{
    (void)state;
    captured_stderr_begin();
    for (int i = 0; i < 100; i++)
        say_tile("a.store", 1);
    say_tile("a.store", 2);
    log_finish();
    text = captured_stderr_end();
    assert_int_equal(count_lines("tile 1 "), 1);
    assert_int_equal(count_lines("tile 2 "), 1);
    assert_int_equal(count_lines("a.store: 99 more messages"), 1);
    assert_int_equal(count_lines(""), 3);
}

static void a_file_with_many_damaged_tiles_takes_few_lines(void **state)
{
    (void)state;
    captured_stderr_begin();
    for (int round = 0; round < 3; round++)
        for (uint32_t tile = 0; tile < 182; tile++)
            say_tile("a.store", tile);
    say_tile("b.store", 7);
    log_finish();
    text = captured_stderr_end();
    assert_int_equal(count_lines("a.store: tile"), LOG_LINES_PER_FILE);
    assert_int_equal(count_lines("b.store: tile 7 "), 1);
    assert_int_equal(count_lines("a.store: 514 more messages"), 1);
    assert_int_equal(count_lines(""), LOG_LINES_PER_FILE + 2);
}

/* The output is bounded. Every suppressed message is counted. */
static void more_files_than_there_is_room_for_are_counted(void **state)
{
    char name[32];
    (void)state;
    captured_stderr_begin();
    for (uint32_t file = 0; file < 1000; file++) {
        snprintf(name, sizeof name, "%u.store", file);
        say_tile(name, 0);
        say_tile(name, 0);
    }
    log_finish();
    text = captured_stderr_end();
    assert_int_equal(count_lines("tile 0 "), 255 + LOG_LINES_PER_FILE);
    assert_int_equal(count_lines("0.store: 1 more message\n"), 26);
    assert_int_equal(count_lines("other files: 1458 more messages"), 1);
}

static void infos_are_left_out_and_escapes_are_shown(void **state)
{
    (void)state;
    captured_stderr_begin();
    log_say(NULL, SLUICE_LOG_INFO, "nothing to see");
    static char speaker[] = "program: ";
    log_say(speaker, SLUICE_LOG_WARNING, "\x1b[31mred: bad");
    log_finish();
    text = captured_stderr_end();
    assert_string_equal(text, "program: \\x1b[31mred: bad\n");
}

static void after_the_end_it_begins_anew(void **state)
{
    (void)state;
    captured_stderr_begin();
    say_tile("a.store", 1);
    log_finish();
    say_tile("a.store", 1);
    log_finish();
    text = captured_stderr_end();
    assert_int_equal(count_lines("tile 1 "), 2);
    assert_int_equal(count_lines(""), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_message_is_said_once_then_counted),
        cmocka_unit_test(a_file_with_many_damaged_tiles_takes_few_lines),
        cmocka_unit_test(more_files_than_there_is_room_for_are_counted),
        cmocka_unit_test(infos_are_left_out_and_escapes_are_shown),
        cmocka_unit_test(after_the_end_it_begins_anew),
    };
    return RUN_TESTS(tests);
}
