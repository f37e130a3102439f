/* Reports on opened files. */
#define _XOPEN_SOURCE 700

#include "support/test.h"

#include "browser.h"
#include "file_facts.h"
#include "messages.h"
#include "recent.h"

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

/* Names of the list, "a b/" for folders, with '|' between. */
static const char *names_of(const struct browser *b)
{
    static char text[1024];
    text[0] = '\0';
    for (uint32_t i = 0; i < b->shown_count; i++) {
        const struct browser_entry *entry = &b->entries[b->shown[i]];
        strcat(text, i > 0 ? "|" : "");
        strcat(text, entry->name);
        strcat(text, entry->is_folder ? "/" : "");
    }
    return text;
}

static void make_files(void)
{
    assert_int_equal(mkdir(path_of("files"), 0777), 0);
    assert_int_equal(mkdir(path_of("files/with space"), 0777), 0);
    assert_int_equal(mkdir(path_of("files/\xC3\x9C"
                                   "ber"),
                           0777),
                     0);
    assert_int_equal(mkdir(path_of("files/.hidden"), 0777), 0);
    write_file("files/with space/a b.gltf", "{}");
    write_file("files/gr\xC3\xB6\xC3\x9F"
               "e.JPG",
               "12345");
    write_file("files/notes.txt", "");
    write_file("files/b.pbrt", "");
    write_file("files/list.trace", "");
    assert_int_equal(symlink("nowhere", path_of("files/gone.png")), 0);
}

static void a_folder_shows_folders_and_what_the_viewer_reads(void **state)
{
    struct browser b = {.folder = ""};
    char path[4096];
    (void)state;
    make_files();
    browser_enter(&b, path_of("files"));
    assert_string_equal(b.problem, "");
    assert_string_equal(names_of(&b), "with space/|\xC3\x9C"
                                      "ber/|b.pbrt|gr\xC3\xB6\xC3\x9F"
                                      "e.JPG|list.trace");
    assert_int_equal(b.entries[b.shown[3]].size, 5);
    browser_set_filter(&b, "GR jpg");
    assert_string_equal(names_of(&b), "gr\xC3\xB6\xC3\x9F"
                                      "e.JPG");
    browser_set_filter(&b, "nothing");
    assert_int_equal(b.shown_count, 0);
    browser_activate(&b);
    assert_false(browser_take(&b, path, sizeof path));
    browser_finish(&b);
}

static void the_folder_of_a_scene_may_begin_like_a_url(void **state)
{
    struct browser b = {.scene = "https-pictures/a.png"};
    char before[4096];
    (void)state;
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(mkdir(path_of("https-pictures"), 0777), 0);
    assert_int_equal(chdir(path_of(".")), 0);
    browser_begin(&b);
    assert_int_equal(chdir(before), 0);
    assert_string_equal(strrchr(b.folder, '/'), "/https-pictures");
    browser_finish(&b);
}

static void keys_walk_through_folders_and_choose_a_file(void **state)
{
    struct browser b = {.folder = ""};
    char path[4096];
    (void)state;
    browser_enter(&b, path_of("files"));
    browser_move(&b, -1);
    assert_int_equal(b.selected[BROWSER_FILES], 0);
    browser_move(&b, 1000000);
    assert_int_equal(b.selected[BROWSER_FILES], 4);
    browser_move(&b, INT32_MIN);
    browser_activate(&b);
    assert_string_equal(b.folder, path_of("files/with space"));
    browser_up(&b);
    assert_string_equal(b.folder, path_of("files"));
    assert_string_equal(browser_selected(&b, path, sizeof path), path_of("files/with space"));
    browser_activate(&b);
    browser_activate(&b);
    assert_true(browser_take(&b, path, sizeof path));
    assert_string_equal(path, path_of("files/with space/a b.gltf"));
    assert_false(browser_take(&b, path, sizeof path));
    browser_choose_folder(&b);
    assert_true(browser_take(&b, path, sizeof path));
    assert_string_equal(path, path_of("files/with space"));
    browser_finish(&b);
}

static void typed_paths_are_entered_and_opened(void **state)
{
    struct browser b = {.folder = ""};
    char path[4096];
    (void)state;
    browser_enter(&b, "/");
    browser_set_filter(&b, path_of("files/with space"));
    browser_activate(&b);
    assert_string_equal(b.folder, path_of("files/with space"));
    assert_string_equal(b.filter, "");
    browser_set_filter(&b, "../notes.txt");
    browser_activate(&b);
    assert_true(browser_take(&b, path, sizeof path));
    assert_string_equal(path, path_of("files/with space/../notes.txt"));
    browser_set_filter(&b, "https://files.example/a.store");
    browser_activate(&b);
    assert_true(browser_take(&b, path, sizeof path));
    assert_string_equal(path, "https://files.example/a.store");
    browser_finish(&b);
}

static void folders_that_cannot_be_read_are_named_and_can_be_left(void **state)
{
    struct browser b = {.folder = ""};
    (void)state;
    browser_enter(&b, path_of("files/none"));
    assert_non_null(strstr(b.problem, "files/none: No such file or directory"));
    assert_int_equal(b.shown_count, 0);
    browser_up(&b);
    assert_string_equal(b.folder, path_of("files"));
    assert_string_equal(b.problem, "");
    browser_enter(&b, path_of("files/b.pbrt"));
    assert_non_null(strstr(b.problem, "Not a directory"));
    assert_int_equal(chmod(path_of("files/with space"), 0), 0);
    browser_enter(&b, path_of("files/with space"));
    if (geteuid() != 0)
        assert_non_null(strstr(b.problem, "Permission denied"));
    assert_int_equal(chmod(path_of("files/with space"), 0777), 0);
    browser_finish(&b);
}

static void thousands_of_files_are_listed(void **state)
{
    struct browser b = {.folder = ""};
    char name[64], path[4096];
    (void)state;
    assert_int_equal(mkdir(path_of("many"), 0777), 0);
    for (int i = 0; i < 5000; i++) {
        snprintf(name, sizeof name, "many/%04d.png", i);
        write_file(name, "");
    }
    browser_enter(&b, path_of("many"));
    assert_int_equal(b.shown_count, 5000);
    browser_move(&b, 4321);
    assert_string_equal(browser_selected(&b, path, sizeof path), path_of("many/4321.png"));
    browser_set_filter(&b, "99");
    assert_int_equal(b.shown_count, 95); /* expected count computed by Python */
    browser_finish(&b);
}

/* The index of a place; the count if it is not there. */
static uint32_t find_place(const struct browser *b, enum browser_place_kind kind, const char *path)
{
    uint32_t i = 0;
    while (i < b->place_count &&
           (b->places[i].kind != kind || strcmp(b->places[i].path, path) != 0))
        i++;
    return i;
}

static void places_are_recent_files_and_scenes_that_ship_or_lie_beside(void **state)
{
    struct browser b = {.folder = ""};
    char path[4096];
    (void)state;
    assert_int_equal(mkdir(path_of("files/second"), 0777), 0);
    write_file("files/second/c.obj", "");
    assert_true(files_add(path_of("files/b.pbrt"), &b.recent));
    assert_true(files_add(path_of("files/gone.pbrt"), &b.recent));
    strcpy(b.scene, path_of("files/with space/a b.gltf"));
    browser_begin(&b);
    assert_string_equal(b.folder, path_of("files/with space"));
    assert_int_equal(find_place(&b, PLACE_RECENT, path_of("files/b.pbrt")), 0);
    assert_int_equal(find_place(&b, PLACE_RECENT, path_of("files/gone.pbrt")), 1);
    assert_true(!b.places[0].is_missing && b.places[1].is_missing);
    const uint32_t room = find_place(&b, PLACE_SHIPPED, "");
    assert_true(room < b.place_count);
    assert_true(find_place(&b, PLACE_BESIDE, path_of("files/b.pbrt")) < b.place_count);
    assert_true(find_place(&b, PLACE_BESIDE, path_of("files/second/c.obj")) < b.place_count);
    assert_true(find_place(&b, PLACE_BESIDE, path_of("files/with space/a b.gltf")) < b.place_count);
    b.side = BROWSER_PLACES;
    browser_move(&b, room);
    browser_activate(&b);
    assert_true(browser_take(&b, path, sizeof path));
    assert_string_equal(path, "");
    browser_finish(&b);
}

static void recent_files_are_kept_newest_first_and_once(void **state)
{
    struct file_list list = {.count = 0};
    char name[64], kept[4096];
    (void)state;
    strcpy(kept, path_of("config/sluice/recent"));
    recent_read(kept, &list);
    assert_int_equal(list.count, 0);
    assert_true(recent_add("https://files.example/a.store?token=secret", &list));
    assert_true(recent_add("no such file", &list));
    assert_int_equal(list.count, 0);
    for (int i = 0; i < 20; i++) {
        snprintf(name, sizeof name, "recent %d\n.png", i);
        write_file(name, "");
        assert_true(recent_add(path_of(name), &list));
    }
    assert_int_equal(list.count, RECENT_MOST);
    assert_true(recent_add(path_of("recent 12\n.png"), &list));
    assert_int_equal(list.count, RECENT_MOST);
    assert_true(recent_write(kept, &list));
    files_finish(&list);
    recent_read(kept, &list);
    assert_int_equal(list.count, RECENT_MOST);
    assert_string_equal(list.paths[0], path_of("recent 12\n.png"));
    assert_string_equal(list.paths[1], path_of("recent 19\n.png"));
    assert_string_equal(list.paths[RECENT_MOST - 1], path_of("recent 8\n.png"));
    files_finish(&list);
}

static void a_damaged_list_of_recent_files_is_set_aside(void **state)
{
    static const char *const texts[] = {
        "", "sluice-view recent 2\n/a\n", "sluice-view recent 1\nrelative\n",
        "sluice-view recent 1\n/a\\x\n", "sluice-view recent 1\nhttp://h/b?c\n"};
    struct file_list list = {.count = 0};
    char line[4400], expected[4400];
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        write_file("recent.list", texts[i]);
        messages_begin();
        recent_read(path_of("recent.list"), &list);
        messages_end();
        assert_int_equal(list.count, 0);
        snprintf(expected, sizeof expected, "%s is damaged: it is ", path_of("recent.list"));
        assert_true(messages_get(0, line, sizeof line));
        assert_non_null(strstr(line, expected));
        assert_int_not_equal(access(path_of("recent.list"), F_OK), 0);
        assert_int_equal(access(path_of("recent.list.damaged"), F_OK), 0);
    }
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
        cmocka_unit_test(a_folder_shows_folders_and_what_the_viewer_reads),
        cmocka_unit_test(the_folder_of_a_scene_may_begin_like_a_url),
        cmocka_unit_test(keys_walk_through_folders_and_choose_a_file),
        cmocka_unit_test(typed_paths_are_entered_and_opened),
        cmocka_unit_test(folders_that_cannot_be_read_are_named_and_can_be_left),
        cmocka_unit_test(thousands_of_files_are_listed),
        cmocka_unit_test(places_are_recent_files_and_scenes_that_ship_or_lie_beside),
        cmocka_unit_test(recent_files_are_kept_newest_first_and_once),
        cmocka_unit_test(a_damaged_list_of_recent_files_is_set_aside),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
