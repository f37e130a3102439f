/* Files that are opened: what is said of them. */
#define _XOPEN_SOURCE 700

#include "support/test.h"

#include "file_facts.h"
#include "messages.h"

#include "../../tools/common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/view-files-XXXXXX";

static const char *path_of(const char *name)
{
    static char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static const char *data_of(const char *name)
{
    static char path[4096];
    const char *root = getenv("SLUICE_SOURCE_ROOT");
    snprintf(path, sizeof path, "%s/tests/%s", root ? root : ".", name);
    return path;
}

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(path_of(name), "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void the_last_lines_that_were_said_are_kept_without_the_programs_name(void **state)
{
    char text[64];
    (void)state;
    messages_begin();
    text_say("sluice-view: a.png: one");
    text_say("a.png: two");
    assert_int_equal(messages_count(), 2);
    assert_true(messages_get(0, text, sizeof text));
    assert_string_equal(text, "a.png: one");
    assert_true(messages_get(1, text, sizeof text));
    assert_string_equal(text, "a.png: two");
    assert_false(messages_get(2, text, sizeof text));
    for (uint32_t i = 2; i < MESSAGES_KEPT + 1; i++)
        text_say("line %u", i);
    assert_false(messages_get(0, text, sizeof text));
    assert_true(messages_get(1, text, sizeof text));
    assert_string_equal(text, "a.png: two");
    assert_true(messages_get(MESSAGES_KEPT, text, sizeof text));
    assert_string_equal(text, "line 256");
    messages_end();
    text_say("behind");
    assert_int_equal(messages_count(), MESSAGES_KEPT + 1);
}

static void messages_say_what_to_do(void **state)
{
    static const struct {
        const char *message, *words;
    } rows[] = {
        {"a.gltf: cannot be opened: No such file or directory", "Check the name"},
        {"a.gltf: cannot be opened: Permission denied", "readable"},
        {"a.gltf: requires KHR_draco_mesh_compression, which is not supported", "compression"},
        {"a.gltf: textures[0]: KHR_texture_basisu is not supported", "PNG, JPEG or WebP"},
        {"a.gltf: uses KHR_materials_clearcoat, which is not supported", "without it"},
        {"a.gltf: accessors[0] ends at byte 76 of bufferViews[0], which has 68", "damaged"},
        {"a.gltf: is no glTF of version 2", "glTF 2.0"},
        {"a.dds: the source's mipLevelCount ends before a level fits into a tile; write the file "
         "again with all levels",
         "sluice-bake"},
        {"a.ktx2: cannot be shown: SLUICE_ERROR_CORRUPT_DATA", "damaged"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *advice = messages_advice(rows[i].message);
        if (!advice || !strstr(advice, rows[i].words))
            fail_msg("%s: %s", rows[i].message, advice ? advice : "no advice");
    }
    assert_null(messages_advice("the window is open"));
}

static void a_dropped_file_has_its_report_and_one_that_failed_its_messages(void **state)
{
    struct file_facts facts = {.report = NULL};
    char text[128];
    (void)state;
    messages_begin();
    const char *paths[] = {data_of("container/data/nvtt_bc1.dds"), "b.png"};
    file_facts_begin(&facts);
    assert_true(file_facts_note(&facts, paths, 1, true));
    assert_string_equal(facts.failed, "");
    assert_string_equal(facts.path, paths[0]);
    assert_non_null(facts.report);
    assert_non_null(strstr(facts.report, "44 x 20 texels, 6 levels, 1 layer\n"));
    assert_non_null(strstr(facts.report, "BC1_RGBA_UNORM_BLOCK\n"));
    assert_false(file_facts_note(&facts, paths, 2, true)); /* several: the inspector has them */
    assert_null(facts.report);
    file_facts_begin(&facts);
    text_say("sluice-view: none.gltf: cannot be opened");
    const char *none[] = {"none.gltf"};
    assert_true(file_facts_note(&facts, none, 1, false));
    assert_string_equal(facts.failed, "none.gltf");
    assert_true(messages_get(facts.first_message, text, sizeof text));
    assert_string_equal(text, "none.gltf: cannot be opened");
    assert_int_equal(messages_count(), facts.first_message + 1);
    file_facts_finish(&facts);
    messages_end();
}

static void a_picture_inside_of_a_file_has_the_report_of_the_file(void **state)
{
    struct file_facts facts = {.report = NULL};
    char path[4200];
    (void)state;
    snprintf(path, sizeof path, "%s#Normal", data_of("fuzz/corpus/neural/schema3.ntc"));
    file_facts_look(&facts, path);
    assert_non_null(facts.report);
    assert_non_null(strstr(facts.report, "neural textures, schema 3"));
    write_file("a#b.png", "P6 1 1 255\nabc");
    file_facts_look(&facts, path_of("a#b.png"));
    assert_string_equal(facts.path, path_of("a#b.png"));
    assert_null(facts.report);
    file_facts_finish(&facts);
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char command[128];
    (void)state;
    snprintf(command, sizeof command, "chmod -R u+rwx '%s' && rm -rf '%s'", folder, folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_lines_that_were_said_are_kept_without_the_programs_name),
        cmocka_unit_test(messages_say_what_to_do),
        cmocka_unit_test(a_dropped_file_has_its_report_and_one_that_failed_its_messages),
        cmocka_unit_test(a_picture_inside_of_a_file_has_the_report_of_the_file),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
