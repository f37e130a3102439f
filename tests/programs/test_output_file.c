/* Names that one run may give to its outputs. */
#define _XOPEN_SOURCE 700
#include "support/test.h"

#include "output_file.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/sluice_outputs_XXXXXX";

static bool write_text(const char *path)
{
    return output_file_print(path, "text\n");
}

static int enter_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) && chdir(folder) == 0 && mkdir("below", 0700) == 0 &&
                   symlink("below", "link") == 0
               ? 0
               : -1;
}

static int remove_folder(void **state)
{
    static const char *const names[] = {"a",       "b",    "c",     "below/a", "below/d",
                                        "below/e", "link", "input", "output"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        unlink(names[i]);
    return rmdir("below") == 0 && chdir("/") == 0 && rmdir(folder) == 0 ? 0 : -1;
}

static void a_name_belongs_to_one_output_however_it_is_spelled(void **state)
{
    char whole[128];
    (void)state;
    snprintf(whole, sizeof whole, "%s/a", folder);
    assert_true(output_can_write("a"));
    assert_false(output_can_write("a"));
    assert_false(output_can_write("./a"));
    assert_false(output_can_write("below/../a"));
    assert_false(output_can_write(whole));
    assert_false(output_claim("a"));
    assert_true(output_can_write("below/a"));
    assert_false(output_can_write("link/a"));
}

static void a_program_may_write_its_own_file_again(void **state)
{
    (void)state;
    assert_true(output_can_write("b"));
    assert_true(write_text("b") && write_text("b"));
    assert_true(write_text("c") && write_text("c"));
}

static void a_claimed_name_is_not_written_by_the_program(void **state)
{
    (void)state;
    assert_true(output_claim("below/d"));
    assert_false(output_can_write("link/d"));
    assert_false(write_text("below/d"));
    assert_int_equal(access("below/d", F_OK), -1);
}

static void several_outputs_may_go_to_one_device(void **state)
{
    (void)state;
    assert_true(output_can_write("/dev/null") && output_can_write("/dev/null"));
    assert_true(write_text("/dev/null") && write_text("/dev/null"));
    assert_true(output_claim("/dev/null"));
}

static void many_names_are_told_apart(void **state)
{
    char path[64];
    (void)state;
    for (int i = 0; i < 500; i++) {
        snprintf(path, sizeof path, "below/frame-%04d", i);
        assert_true(output_claim(path));
    }
    assert_false(output_claim("below/frame-0000"));
    assert_false(output_claim("below/frame-0499"));
    assert_true(output_claim("frame-0499"));
}

#define ADDED 5000

/* Adds `input` many times, so that the list of inputs moves in memory. */
static void *add_inputs(void *user_data)
{
    bool *added = user_data;
    for (int i = 0; i < ADDED && *added; i++)
        *added = output_add_input("input");
    return NULL;
}

/* The thread sanitizer reports reads of the list without a lock. */
static void inputs_are_added_while_outputs_are_checked(void **state)
{
    pthread_t thread;
    bool added = true, spares = true;
    (void)state;
    assert_true(write_text("input") && write_text("output"));
    assert_int_equal(pthread_create(&thread, NULL, add_inputs, &added), 0);
    for (int i = 0; i < ADDED; i++)
        spares = output_spares_inputs("output") && spares;
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_true(added && spares);
    assert_false(output_spares_inputs("input"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_name_belongs_to_one_output_however_it_is_spelled),
        cmocka_unit_test(a_program_may_write_its_own_file_again),
        cmocka_unit_test(a_claimed_name_is_not_written_by_the_program),
        cmocka_unit_test(several_outputs_may_go_to_one_device),
        cmocka_unit_test(many_names_are_told_apart),
        cmocka_unit_test(inputs_are_added_while_outputs_are_checked),
    };
    return (tap_filter_stdout(),
            cmocka_run_group_tests_name(__FILE__, tests, enter_folder, remove_folder));
}
