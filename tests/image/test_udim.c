/* UDIM patterns: which files of a folder are cells, and which names and patterns are not. */
#define _XOPEN_SOURCE 700

#include "support/few_descriptors.h"
#include "support/test.h"

#include <sluice/udim.h>

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/sluice-udim-XXXXXX";
static char last_line[1024];

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user, (void)severity;
    snprintf(last_line, sizeof last_line, "%s", message);
}
static const SluiceLogCallback to_last_line = {NULL, on_log};

static const char *pattern_of(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void make_file(const char *name)
{
    int file = open(pattern_of(name), O_CREAT | O_WRONLY, 0600);
    assert_true(file >= 0);
    close(file);
}

/* Files that a pattern could mistake for cells. Those that "a.<UDIM>.exr" matches come last. */
static const char *const others[] = {
    "a.1000.exr",   "a.2000.exr",    "a.99.exr",       "a.100.exr",
    "a.10010.exr",  "a.0001.exr",    "a.1x01.exr",     "a..exr",
    "a.exr",        "a.1005.ex",     "b.1006.exr",     "a.1007.exr.part",
    "aa.1008.exr",  "a.-100.exr",    "a. 1009.exr",    "a.1011.EXR",
    "1001",         "a.1001",        "t_u1_v1.png",    "t_u10_v1.png",
    "t_u11_v1.png", "t_u01_v2.png",  "t_u0_v1.png",    "t_u1_v0.png",
    "t_u9_v99.png", "t_u10_v99.png", "t_u10_v100.png", "t_u1_v101.png",
    "t_u2v3.png",   "t_u2_v3x.png",  "t_u_v3.png",     "t_u4_v.png",
    "t_u.png",      "t_.png",        "t_u3_v12.png",   "a.1001.exr",
    "a.1010.exr",   "a.1999.exr",    "a.1042.exr"};
enum { OTHERS = sizeof others / sizeof others[0] };

static int set_up(void)
{
    if (!mkdtemp(folder))
        return -1;
    for (uint32_t i = 0; i < OTHERS; i++)
        make_file(others[i]);
    mkdir(pattern_of("a.1100.exr"), 0700);
    return symlink("a.1042.exr", pattern_of("a.1050.exr")) ||
           symlink("nothing", pattern_of("a.1051.exr"));
}

static int tear_down(void)
{
    for (uint32_t i = 0; i < OTHERS; i++)
        unlink(pattern_of(others[i]));
    unlink(pattern_of("a.1050.exr"));
    unlink(pattern_of("a.1051.exr"));
    rmdir(pattern_of("a.1100.exr"));
    return rmdir(folder);
}

static void check_cells(const char *pattern, const uint32_t *expected, uint32_t count)
{
    uint32_t numbers[999], found = 0, room = 999;
    CHECK_OK(sluiceFindUdimFiles(pattern, NULL, &found, NULL));
    assert_int_equal(found, count);
    CHECK_OK(sluiceFindUdimFiles(pattern, NULL, &room, numbers));
    assert_int_equal(room, count);
    assert_memory_equal(numbers, expected, count * sizeof *expected);
    for (uint32_t i = 0; i < count; i++) {
        char path[256];
        CHECK_OK(sluiceWriteUdimPath(pattern, numbers[i], NULL, sizeof path, path));
        assert_int_equal(access(path, F_OK), 0);
    }
}

static void cells_with_files_are_listed_in_ascending_order(void **state)
{
    (void)state;
    static const uint32_t udim[] = {1001, 1010, 1042, 1050, 1999};
    /* u1_v1, u10_v1, u3_v12, u9_v99. u10_v99 is 1990. */
    static const uint32_t uv[] = {1001, 1010, 1113, 1989, 1990};
    static const uint32_t bare[] = {1001};
    check_cells(pattern_of("a.<UDIM>.exr"), udim, 5);
    check_cells(pattern_of("t_<UVTILE>.png"), uv, 5);
    check_cells(pattern_of("<UDIM>"), bare, 1);
    check_cells(pattern_of("a.<UDIM>"), bare, 1);
}

static void a_pattern_without_a_folder_is_in_the_working_directory(void **state)
{
    (void)state;
    char before[4096], path[32];
    uint32_t count = 0;
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(folder), 0);
    SluiceResult result = sluiceFindUdimFiles("a.<UDIM>.exr", NULL, &count, NULL);
    assert_int_equal(chdir(before), 0);
    CHECK_OK(result);
    assert_int_equal(count, 5);
    CHECK_OK(sluiceWriteUdimPath("a.<UDIM>.exr", 1001, NULL, sizeof path, path));
    assert_string_equal(path, "a.1001.exr");
    CHECK_OK(sluiceWriteUdimPath("/<UVTILE>", 1999, NULL, sizeof path, path));
    assert_string_equal(path, "/u9_v100");
}

static void a_short_array_gets_the_first_cells(void **state)
{
    (void)state;
    uint32_t numbers[2] = {0}, room = 2;
    CHECK_RESULT(sluiceFindUdimFiles(pattern_of("a.<UDIM>.exr"), NULL, &room, numbers),
                 SLUICE_INCOMPLETE);
    assert_int_equal(room, 2);
    assert_int_equal(numbers[0], 1001);
    assert_int_equal(numbers[1], 1010);
    room = 0;
    CHECK_RESULT(sluiceFindUdimFiles(pattern_of("a.<UDIM>.exr"), NULL, &room, numbers),
                 SLUICE_INCOMPLETE);
    assert_int_equal(room, 0);
}

static void patterns_that_name_no_cells_are_refused(void **state)
{
    (void)state;
    static char longest[4097];
    static const struct {
        const char *pattern, *said;
    } wrong[] = {
        {"", "has neither <UDIM> nor <UVTILE>"}, {"a.1001.exr", "has neither"},
        {"a.<udim>.exr", "has neither"},         {"a.<UDIM.exr", "has neither"},
        {"a.%(UDIM)d.exr", "has neither"},       {"<UDIM>.<UDIM>", "more than one"},
        {"<UDIM><UVTILE>", "more than one"},     {"<UVTILE>.<UVTILE>", "more than one"},
        {"<UVTILE>/<UDIM>", "more than one"},    {"<UDIM>/a.exr", "name of a folder"},
        {"a.<UDIM>/", "name of a folder"},       {longest, "longer than 4095 bytes"},
    };
    memset(longest, 'a', 4096);
    memcpy(longest + 4000, "<UDIM>", 6);
    for (uint32_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        uint32_t count = 7;
        char path[16];
        last_line[0] = 0;
        CHECK_RESULT(sluiceFindUdimFiles(wrong[i].pattern, &to_last_line, &count, NULL),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        assert_int_equal(count, 7);
        assert_non_null(strstr(last_line, wrong[i].said));
        CHECK_RESULT(sluiceWriteUdimPath(wrong[i].pattern, 1001, NULL, sizeof path, path),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    }
    longest[4095] = 0; /* a name that no file can have */
    uint32_t count;
    CHECK_RESULT(sluiceFindUdimFiles(longest, NULL, &count, NULL), SLUICE_ERROR_FILE_NOT_FOUND);
}

static void missing_files_and_folders_are_not_found(void **state)
{
    (void)state;
    static const char *const missing[] = {"c.<UDIM>.exr", "nowhere/a.<UDIM>.exr",
                                          "a.1001.exr/a.<UDIM>.exr", "a.<UVTILE>.exr"};
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t count = 7;
        last_line[0] = 0;
        CHECK_RESULT(sluiceFindUdimFiles(pattern_of(missing[i]), &to_last_line, &count, NULL),
                     SLUICE_ERROR_FILE_NOT_FOUND);
        assert_int_equal(count, 7);
        assert_non_null(strstr(last_line, folder));
    }
}

static void numbers_and_buffers_out_of_range_are_refused(void **state)
{
    (void)state;
    static const uint32_t numbers[] = {0, 1, 1000, 2000, 10010, UINT32_MAX};
    char path[16];
    for (uint32_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        CHECK_RESULT(sluiceWriteUdimPath("a.<UDIM>", numbers[i], NULL, sizeof path, path),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    memset(path, '#', sizeof path);
    CHECK_RESULT(sluiceWriteUdimPath("a.<UDIM>", 1001, &to_last_line, 6, path),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_string_equal(last_line, "pathSize 6 is below the path's 7 bytes");
    assert_int_equal(path[0], '#');
    CHECK_OK(sluiceWriteUdimPath("a.<UDIM>", 1001, NULL, 7, path));
    assert_string_equal(path, "a.1001");
    assert_int_equal(path[7], '#');
}

static void without_file_descriptors_the_answer_is_later(void **state)
{
    (void)state;
    struct few_descriptors few;
    uint32_t count;
    few_descriptors_begin(&few, 0);
    SluiceResult result = sluiceFindUdimFiles(pattern_of("a.<UDIM>.exr"), NULL, &count, NULL);
    few_descriptors_end(&few);
    CHECK_RESULT(result, SLUICE_NOT_READY);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_with_files_are_listed_in_ascending_order),
        cmocka_unit_test(a_pattern_without_a_folder_is_in_the_working_directory),
        cmocka_unit_test(a_short_array_gets_the_first_cells),
        cmocka_unit_test(patterns_that_name_no_cells_are_refused),
        cmocka_unit_test(missing_files_and_folders_are_not_found),
        cmocka_unit_test(numbers_and_buffers_out_of_range_are_refused),
        cmocka_unit_test(without_file_descriptors_the_answer_is_later),
    };
    if (set_up())
        return 1;
    int failed = RUN_TESTS(tests);
    return tear_down() ? 1 : failed;
}
