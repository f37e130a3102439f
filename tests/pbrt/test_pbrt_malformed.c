/* The scenes of tests/pbrt/data/malformed behave as their table says. */
#include "pbrt/pbrt_files.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct expectation {
    char file[64], line[8], kind[16], shapes[16], what[256];
};

/* Only a reader of pictures can see what is wrong with these. */
static bool is_about_pictures(const char *file)
{
    return strcmp(file, "png-cut.pbrt") == 0 || strcmp(file, "tga-size.pbrt") == 0 ||
           strcmp(file, "exr-cut.pbrt") == 0;
}

/* Whether a message names the file and the line. */
static bool names_line(const struct pbrt_files *files, const char *path, const char *line)
{
    char place[1200];
    snprintf(place, sizeof place, "%s:%s:", path, line);
    return strstr(files->log, place) != NULL;
}

static void check_scene(struct pbrt_files *files, const char *folder,
                        const struct expectation *expected)
{
    char path[1100];
    snprintf(path, sizeof path, "%s/%s", folder, expected->file);
    SluiceResult result = pbrt_open(files, path);
    bool is_fatal = strcmp(expected->kind, "fatal") == 0;
    if (is_fatal)
        CHECK_RESULT(result, SLUICE_ERROR_CORRUPT_DATA);
    else if (!strstr(expected->kind, "or"))
        CHECK_OK(result);
    if (result == SLUICE_SUCCESS) {
        uint32_t good = pbrt_read_all(files);
        if (strcmp(expected->shapes, "1 or 2") == 0)
            assert_true(good == 1 || good == 2);
        else if (strcmp(expected->shapes, "any") != 0 && good != (uint32_t)atoi(expected->shapes))
            fail_msg("%s has %u shapes, not %s: %s", expected->file, good, expected->shapes,
                     files->log);
        if (is_about_pictures(expected->file))
            return;
        if (strcmp(expected->kind, "skip") == 0 && files->errors == 0)
            fail_msg("%s: no error", expected->file);
    }
    if (files->warnings + files->errors == 0)
        fail_msg("%s: no message", expected->file);
    if (expected->line[0] != '-' && !names_line(files, path, expected->line))
        fail_msg("%s: no message names line %s but: %s", expected->file, expected->line,
                 files->log);
}

static void scenes_with_a_mistake_behave_as_the_table_says(void **state)
{
    (void)state;
    static struct pbrt_files files;
    char folder[1000], table[1100], line[1024];
    int count = 0;
    snprintf(folder, sizeof folder, "%s/tests/pbrt/data/malformed", getenv("SLUICE_SOURCE_ROOT"));
    snprintf(table, sizeof table, "%s/EXPECTED.tsv", folder);
    FILE *file = fopen(table, "r");
    assert_non_null(file);
    pbrt_files_init(&files);
    while (fgets(line, sizeof line, file)) {
        struct expectation expected;
        if (sscanf(line, "%63[^\t]\t%7[^\t]\t%15[^\t]\t%15[^\t]\t%255[^\n]", expected.file,
                   expected.line, expected.kind, expected.shapes, expected.what) == 5 &&
            strcmp(expected.file, "file") != 0) {
            check_scene(&files, folder, &expected);
            count++;
        }
    }
    fclose(file);
    pbrt_files_finish(&files);
    assert_int_equal(count, 58);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_with_a_mistake_behave_as_the_table_says),
    };
    return RUN_TESTS(tests);
}
