#define _POSIX_C_SOURCE 200809L
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "page.h"
#include "page_choose.h"
#include "page_frames.h"
#include "page_shots.h"
#include "page_sweep.h"
#include "refused_memory.h"

static struct page_sweep s;
static char root[400], page_path[440];

/* Makes a folder of its own for each test, below the build folder. */
static void start(const char *name)
{
    const char *build = getenv("SLUICE_BUILD_ROOT");
    snprintf(root, sizeof root, "%s/tests/tradeoff/page/test_page_files", build ? build : ".");
    mkdir(root, 0777);
    snprintf(root + strlen(root), sizeof root - strlen(root), "/%s", name);
    mkdir(root, 0777);
    snprintf(page_path, sizeof page_path, "%s/page.html", root);
    page_sweep_init(&s, root, false);
}

static bool write_page(void)
{
    return page_write(&s.sweep, s.recommendations, PAGE_SWEEP_RECOMMENDATIONS, page_path);
}

/* The caller frees the text. */
static char *read_page(size_t *size)
{
    FILE *file = fopen(page_path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, *size, file), *size);
    text[*size] = '\0';
    fclose(file);
    return text;
}

static int count_words(const char *text, const char *word)
{
    int count = 0;
    for (; (text = strstr(text, word)); text++)
        count++;
    return count;
}

static enum page_read read_frames(const char *text, struct page_frames *frames)
{
    char reason[PAGE_REASON_SIZE] = "";
    page_sweep_add_file(&s, 0, "frames.csv", text, strlen(text));
    enum page_read read = page_frames_init(frames, s.folders[0], reason);
    assert_true((read == PAGE_READ) == (reason[0] == '\0'));
    return read;
}

static void table_has_the_numbers_of_its_file(void **state)
{
    (void)state;
    struct page_frames frames;
    start("table");
    assert_int_equal(read_frames("frame,a,b\r\n3,,-1.5\r\n5,inf,2e3", &frames), PAGE_READ);
    assert_int_equal(frames.row_count, 2);
    int a = page_frames_find(&frames, "a"), b = page_frames_find(&frames, "b");
    assert_true(isnan(page_frames_get(&frames, 3, a)));
    assert_true(page_frames_get(&frames, 5, a) == INFINITY);
    assert_true(page_frames_get(&frames, 3, b) == -1.5);
    assert_true(page_frames_get(&frames, 5, b) == 2000.0);
    assert_true(isnan(page_frames_get(&frames, 4, b)));
    assert_int_equal(page_frames_find(&frames, "c"), -1);
    page_frames_finish(&frames);
}

static void damaged_table_is_left_out_whole(void **state)
{
    (void)state;
    static const char *const damaged[] = {
        "",       "frame,a",         "frame,a\n",     "frame,a\n0,1\n1",  "frame,a\n0,1,2\n",
        "a\nx\n", "frame,a\n0,1 \n", "frame,a\n0,1x", "frame,a\n0,1\n\n", "frame,a\n0;1\n"};
    start("damaged");
    for (size_t i = 0; i < sizeof damaged / sizeof *damaged; i++) {
        struct page_frames frames;
        if (read_frames(damaged[i], &frames) != PAGE_LEFT_OUT)
            assert_string_equal(damaged[i], "a line that is left out");
        assert_int_equal(frames.row_count, 0);
        assert_null(frames.cells);
    }
}

static void table_with_too_many_columns_is_left_out(void **state)
{
    (void)state;
    char text[4 * PAGE_COLUMNS_MAX] = "a";
    struct page_frames frames;
    start("columns");
    for (int i = 1; i < PAGE_COLUMNS_MAX; i++)
        strcat(text, ",a");
    strcat(text, ",a\n");
    assert_int_equal(read_frames(text, &frames), PAGE_LEFT_OUT);
}

static void frames_are_ordered_from_the_worst(void **state)
{
    (void)state;
    struct page_shots shots;
    const char *text = "frame,psnr_db\n0,30\n1,999\n2,12\n4,20\n";
    start("shots");
    page_sweep_add_file(&s, 0, "frames.csv", text, strlen(text));
    for (uint32_t frame = 0; frame < 4; frame++)
        page_sweep_add_picture(&s, 0, "frame", frame, 1, 0);
    page_sweep_add_file(&s, 0, "frame-0004.png.sluice-part", "", 0);
    page_sweep_add_file(&s, 0, "frame--001.png", "", 0);
    const uint32_t by_psnr[] = {2, 0, 1, 3}, by_flip[] = {1, 2, 0, 3};
    assert_true(page_shots_get(&shots, s.folders[0])); /* nothing is known of 3 */
    assert_int_equal(shots.count, 4);
    assert_memory_equal(shots.frames, by_psnr, sizeof by_psnr);
    text = "frame,psnr_db,flip\n0,30,0.2\n1,999,0.9\n2,12,0.5\n3,999,0\n";
    page_sweep_add_file(&s, 0, "frames.csv", text, strlen(text));
    assert_true(page_shots_get(&shots, s.folders[0]));
    assert_memory_equal(shots.frames, by_flip, sizeof by_flip);
    text = "frame,psnr_db,flip\n0,30,0.2\n1,999,0.9\n2,12,\n"; /* flip does not know all */
    page_sweep_add_file(&s, 0, "frames.csv", text, strlen(text));
    assert_true(page_shots_get(&shots, s.folders[0]));
    assert_memory_equal(shots.frames, by_psnr, sizeof by_psnr);
}

static void every_point_that_is_done_is_chosen_once_the_base_first(void **state)
{
    (void)state;
    struct page_choice choices[PAGE_SWEEP_POINTS];
    uint32_t prominent, seen[PAGE_SWEEP_POINTS] = {0};
    start("choose");
    uint32_t count =
        page_choose(&s.sweep, s.recommendations, PAGE_SWEEP_RECOMMENDATIONS, choices, &prominent);
    assert_int_equal(count, PAGE_SWEEP_DONE);
    for (uint32_t i = 0; i < count; i++)
        seen[choices[i].point]++;
    for (uint32_t i = 0; i < PAGE_SWEEP_POINTS; i++)
        assert_int_equal(seen[i], i < PAGE_SWEEP_DONE);
    assert_int_equal(choices[0].point, PAGE_SWEEP_BASE);
    assert_int_equal(choices[1].point, 0);
    assert_int_equal(choices[2].point, 8);
    assert_true(prominent > 3 && prominent < count);
}

static void pictures_that_runs_share_are_on_the_page_once(void **state)
{
    (void)state;
    size_t size;
    start("shared");
    page_sweep_add_picture(&s, PAGE_SWEEP_BASE, "frame", 0, 'b', 30);
    page_sweep_add_picture(&s, PAGE_SWEEP_BASE, "truth", 0, 't', 30);
    page_sweep_add_picture(&s, 0, "frame", 0, 'c', 30);
    page_sweep_add_picture(&s, 0, "truth", 0, 't', 30);
    assert_true(write_page());
    char *text = read_page(&size);
    /* 81 bytes and ten times "ttt", which is "dHR0" each: four of them in a row occur seven times
     */
    assert_int_equal(count_words(text, "dHR0dHR0dHR0dHR0"), 7);
    assert_int_equal(count_words(text, "Y2NjY2NjY2NjY2Nj"), 7);
    assert_int_equal(count_words(text, "\"streamed\":"), 2);
    assert_int_equal(count_words(text, "\"png\":\""), 3);
    free(text);
}

static void pictures_beyond_the_size_of_the_page_are_named(void **state)
{
    (void)state;
    size_t size;
    start("size");
    for (uint32_t i = 0; i < PAGE_SWEEP_DONE; i++)
        for (uint32_t frame = 0; frame < 2; frame++)
            page_sweep_add_picture(&s, i, "frame", frame, (uint8_t)(i + 1), 1000000 + frame);
    page_sweep_add_file(&s, 4, "frame-0000.png", "not at all", 10);
    assert_true(write_page());
    char *text = read_page(&size);
    assert_true(size <= PAGE_SIZE_MAX);
    assert_true(size > PAGE_SIZE_MAX - 2000000);
    assert_int_equal(count_words(text, "\"png\":\""), 4); /* 1.33 MB each */
    assert_true(count_words(text, "the page has no room for it") > 0);
    assert_int_equal(count_words(text, "\"estimates\":"), PAGE_SWEEP_POINTS);
    free(text);
}

static void page_that_cannot_be_written_is_an_error(void **state)
{
    (void)state;
    start("nowhere");
    snprintf(page_path, sizeof page_path, "%s/no/such/folder/page.html", root);
    assert_false(write_page());
}

static void without_memory_the_page_stays_as_it_was(void **state)
{
    (void)state;
    size_t size;
    start("memory");
    page_sweep_add_frames(&s, 0, 5);
    page_sweep_add_picture(&s, 0, "frame", 0, 1, 1);
    page_sweep_add_picture(&s, 0, "truth", 0, 2, 1);
    uint64_t refused = 0;
    for (bool written = false; !written; refused++) {
        FILE *file = fopen(page_path, "wb");
        fputs("former", file);
        fclose(file);
        refuse_memory_after(refused);
        written = write_page();
        uint64_t calls = refuse_memory_after(UINT64_MAX);
        char *text = read_page(&size);
        assert_int_equal(strcmp(text, "former") != 0, written);
        assert_int_equal(written, calls <= refused);
        free(text);
    }
    assert_true(refused > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_has_the_numbers_of_its_file),
        cmocka_unit_test(damaged_table_is_left_out_whole),
        cmocka_unit_test(table_with_too_many_columns_is_left_out),
        cmocka_unit_test(frames_are_ordered_from_the_worst),
        cmocka_unit_test(every_point_that_is_done_is_chosen_once_the_base_first),
        cmocka_unit_test(pictures_that_runs_share_are_on_the_page_once),
        cmocka_unit_test(pictures_beyond_the_size_of_the_page_are_named),
        cmocka_unit_test(page_that_cannot_be_written_is_an_error),
        cmocka_unit_test(without_memory_the_page_stays_as_it_was),
    };
    return RUN_TESTS(tests);
}
