/* Parts of a kept truth: averaged pictures, files of frames, and the text that identifies them. */
#define _XOPEN_SOURCE 700
#include "frame_file.h"
#include "reference_key.h"
#include "supersample.h"

#include "support/test.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct supersample tables;

static void average_of_a_plain_square_is_its_color(void **state)
{
    (void)state;
    for (uint32_t factor = 1; factor <= 4; factor++)
        for (int value = 0; value < 256; value++) {
            uint8_t large[4 * 4 * 4], pixel[4];
            memset(large, value, sizeof large);
            supersample_average(&tables, large, factor, 1, 1, pixel);
            for (int i = 0; i < 4; i++)
                assert_int_equal(pixel[i], value);
        }
}

static void averages_are_of_light_and_alpha_of_itself(void **state)
{
    (void)state;
    /* two rows of two pixels: half of the light is 188 in sRGB, a quarter 137 */
    const uint8_t large[16] = {255, 255, 0, 255, 0, 0, 0, 0, 255, 0, 0, 255, 0, 0, 0, 0};
    uint8_t pixel[4];
    supersample_average(&tables, large, 2, 1, 1, pixel);
    assert_int_equal(pixel[0], lround(255 * (1.055 * pow(0.5, 1 / 2.4) - 0.055)));
    assert_int_equal(pixel[1], lround(255 * (1.055 * pow(0.25, 1 / 2.4) - 0.055)));
    assert_int_equal(pixel[2], 0);
    assert_int_equal(pixel[3], 128);
}

static void each_pixel_has_its_own_square(void **state)
{
    (void)state;
    enum { WIDTH = 5, HEIGHT = 3, FACTOR = 4 };
    static uint8_t large[4 * WIDTH * HEIGHT * FACTOR * FACTOR], small[4 * WIDTH * HEIGHT];
    for (int y = 0; y < HEIGHT * FACTOR; y++)
        for (int x = 0; x < WIDTH * FACTOR; x++)
            memset(large + 4 * (y * WIDTH * FACTOR + x), x / FACTOR * 40 + y / FACTOR, 4);
    supersample_average(&tables, large, FACTOR, WIDTH, HEIGHT, small);
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        assert_int_equal(small[i], i / 4 % WIDTH * 40 + i / 4 / WIDTH);
}

/** A folder that is empty at the beginning of each test. */
struct folder {
    char path[64], file[96], key[96];
};

static int set_up(void **state)
{
    static struct folder folder;
    strcpy(folder.path, "/tmp/test_reference-XXXXXX");
    if (!mkdtemp(folder.path))
        return -1;
    snprintf(folder.file, sizeof folder.file, "%s/a picture", folder.path);
    snprintf(folder.key, sizeof folder.key, "%s/key", folder.path);
    *state = &folder;
    return 0;
}

static int tear_down(void **state)
{
    struct folder *folder = *state;
    remove(folder->file);
    remove(folder->key);
    return remove(folder->path); /* the folder must be empty */
}

static void frames_come_back_in_any_order(void **state)
{
    const struct folder *folder = *state;
    struct frame_file file;
    uint8_t pixels[64];
    assert_true(frame_file_create(folder->file, sizeof pixels, &file));
    for (int i = 4; i >= 0; i -= 2) {
        memset(pixels, i + 1, sizeof pixels);
        assert_true(frame_file_write(&file, (uint32_t)i, pixels));
    }
    assert_int_not_equal(access(folder->file, F_OK), 0); /* absent until complete */
    assert_true(frame_file_keep(&file));
    assert_true(frame_file_open(folder->file, sizeof pixels, 5, &file));
    for (uint32_t i = 0; i < 5; i++) {
        assert_true(frame_file_read(&file, i, pixels));
        for (size_t k = 0; k < sizeof pixels; k++)
            assert_int_equal(pixels[k], i % 2 ? 0 : i + 1);
    }
    assert_false(frame_file_read(&file, 5, pixels));
    frame_file_close(&file);
    frame_file_close(&file);
}

static void files_of_another_size_are_not_opened(void **state)
{
    const struct folder *folder = *state;
    struct frame_file file;
    const uint8_t pixels[64] = {0};
    assert_false(frame_file_open(folder->file, sizeof pixels, 1, &file));
    assert_true(frame_file_create(folder->file, sizeof pixels, &file));
    assert_true(frame_file_write(&file, 2, pixels));
    assert_true(frame_file_keep(&file));
    assert_false(frame_file_open(folder->file, sizeof pixels, 2, &file));
    assert_false(frame_file_open(folder->file, sizeof pixels, 4, &file));
    assert_false(frame_file_open(folder->path, sizeof pixels, 3, &file));
    assert_false(file.is_open);
    assert_true(frame_file_open(folder->file, sizeof pixels, 3, &file));
    frame_file_close(&file);
}

static void frames_that_are_not_kept_leave_what_was_there(void **state)
{
    const struct folder *folder = *state; /* tear_down checks for leftover files */
    struct frame_file file;
    const uint8_t pixels[64] = {7};
    FILE *older = fopen(folder->file, "w");
    fputs("older", older);
    fclose(older);
    assert_true(frame_file_create(folder->file, sizeof pixels, &file));
    assert_true(frame_file_write(&file, 0, pixels));
    frame_file_close(&file);
    assert_false(file.is_open);
    struct stat status;
    assert_int_equal(stat(folder->file, &status), 0);
    assert_int_equal(status.st_size, 5);
}

static void scratch_files_leave_nothing(void **state)
{
    const struct folder *folder = *state; /* tear_down checks for leftover files */
    struct frame_file file;
    uint8_t pixels[64] = {7};
    assert_true(frame_file_create_scratch(folder->path, sizeof pixels, &file));
    assert_true(frame_file_write(&file, 9, pixels));
    memset(pixels, 0, sizeof pixels);
    assert_true(frame_file_read(&file, 9, pixels));
    assert_int_equal(pixels[0], 7);
    frame_file_close(&file);
    assert_false(frame_file_create_scratch(folder->file, sizeof pixels, &file));
}

/** Inputs of a drawing with one picture. */
struct scene {
    struct settings settings;
    struct gpu gpu;
    struct picture picture;
    struct picture_list pictures;
};

static void init_scene(struct scene *scene, const struct folder *folder)
{
    FILE *file = fopen(folder->file, "w");
    assert_non_null(file);
    fclose(file);
    *scene = (struct scene){.picture = {.path = (char *)folder->file}, .pictures = {.count = 1}};
    scene->pictures.pictures = &scene->picture;
    scene->settings = (struct settings){.size = {64, 32},
                                        .frames = 9,
                                        .generate_scale = 1,
                                        .reference_samples = 1,
                                        .reference_supersample = 1,
                                        .reference_anisotropy = 1};
    scene->gpu.modes[1] = SLUICE_RESIDENCY_MODE_DENSE;
    strcpy(scene->gpu.properties.deviceName, "a device");
}

static enum reference_match compare(const struct scene *scene, const char *path)
{
    struct reference_content content = {0};
    char *key = reference_key_create(&scene->settings, &scene->gpu, &scene->pictures);
    assert_non_null(key);
    enum reference_match match = reference_key_compare(path, key, &content);
    free(key);
    if (match == REFERENCE_MATCHES) {
        assert_int_equal(content.checksum, 0x0badcafe);
        assert_true(content.device_memory == 5000000000u);
    }
    return match;
}

static void write_key(const struct scene *scene, const char *path)
{
    const struct reference_content content = {0x0badcafe, 5000000000u};
    char *key = reference_key_create(&scene->settings, &scene->gpu, &scene->pictures);
    assert_non_null(key);
    assert_true(reference_key_write(path, key, &content));
    free(key);
}

static void the_same_settings_match(void **state)
{
    const struct folder *folder = *state;
    struct scene scene;
    init_scene(&scene, folder);
    assert_int_equal(compare(&scene, folder->key), REFERENCE_MISSING);
    write_key(&scene, folder->key);
    assert_int_equal(compare(&scene, folder->key), REFERENCE_MATCHES);
    scene.settings.anisotropy = 16; /* settings of the run, not of the truth */
    scene.settings.lod_bias = 1;
    assert_int_equal(compare(&scene, folder->key), REFERENCE_MATCHES);
}

#define CHECK_DIFFERS(field, value)                                                                \
    do {                                                                                           \
        struct scene other = scene;                                                                \
        other.pictures.pictures = &other.picture;                                                  \
        other.field = value;                                                                       \
        assert_int_equal(compare(&other, folder->key), REFERENCE_DIFFERS);                         \
    } while (0)

static void whatever_changes_the_frames_differs(void **state)
{
    const struct folder *folder = *state;
    struct scene scene;
    init_scene(&scene, folder);
    write_key(&scene, folder->key);
    CHECK_DIFFERS(settings.size[1], 33);
    CHECK_DIFFERS(settings.frames, 10);
    CHECK_DIFFERS(settings.rest_frames, 1);
    CHECK_DIFFERS(settings.generate_scale, 2);
    CHECK_DIFFERS(settings.format, PIXEL_FORMAT_RGBA8);
    CHECK_DIFFERS(settings.reference_samples, 4);
    CHECK_DIFFERS(settings.reference_supersample, 2);
    CHECK_DIFFERS(settings.reference_anisotropy, 16);
    CHECK_DIFFERS(settings.reference_lod_bias, -0.001);
    CHECK_DIFFERS(gpu.modes[1], SLUICE_RESIDENCY_MODE_SPARSE);
    CHECK_DIFFERS(gpu.properties.deviceName[0], 'A');
    CHECK_DIFFERS(gpu.properties.driverVersion, 1);
    CHECK_DIFFERS(picture.path, (char *)folder->path);
    CHECK_DIFFERS(pictures.count, 0);
    assert_int_equal(compare(&scene, folder->key), REFERENCE_MATCHES);
}

static void pictures_that_were_written_again_differ(void **state)
{
    const struct folder *folder = *state;
    const struct timespec times[2] = {{1000, 0}, {1000, 1}};
    struct scene scene;
    init_scene(&scene, folder);
    write_key(&scene, folder->key);
    assert_int_equal(utimensat(AT_FDCWD, folder->file, times, 0), 0);
    assert_int_equal(compare(&scene, folder->key), REFERENCE_DIFFERS);
    write_key(&scene, folder->key);
    assert_int_equal(compare(&scene, folder->key), REFERENCE_MATCHES);
    assert_int_equal(truncate(folder->file, 1), 0);
    assert_int_equal(utimensat(AT_FDCWD, folder->file, times, 0), 0);
    assert_int_equal(compare(&scene, folder->key), REFERENCE_DIFFERS);
}

static void text_that_is_cut_off_anywhere_does_not_match(void **state)
{
    const struct folder *folder = *state;
    struct scene scene;
    struct stat whole;
    init_scene(&scene, folder);
    write_key(&scene, folder->key);
    assert_int_equal(stat(folder->key, &whole), 0);
    for (off_t size = whole.st_size - 11; size >= 0; size -= 7) {
        assert_int_equal(truncate(folder->key, size), 0);
        assert_int_equal(compare(&scene, folder->key), REFERENCE_DIFFERS);
    }
}

static void text_of_somebody_else_is_told_apart(void **state)
{
    const struct folder *folder = *state;
    struct scene scene;
    init_scene(&scene, folder);
    FILE *file = fopen(folder->key, "w");
    fputs("shopping list\n", file);
    fclose(file);
    assert_int_equal(compare(&scene, folder->key), REFERENCE_FOREIGN);
    assert_int_equal(remove(folder->key), 0);
    assert_int_equal(mkdir(folder->key, 0777), 0);
    assert_int_equal(compare(&scene, folder->key), REFERENCE_FOREIGN);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(average_of_a_plain_square_is_its_color),
        cmocka_unit_test(averages_are_of_light_and_alpha_of_itself),
        cmocka_unit_test(each_pixel_has_its_own_square),
        cmocka_unit_test_setup_teardown(frames_come_back_in_any_order, set_up, tear_down),
        cmocka_unit_test_setup_teardown(files_of_another_size_are_not_opened, set_up, tear_down),
        cmocka_unit_test_setup_teardown(frames_that_are_not_kept_leave_what_was_there, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(scratch_files_leave_nothing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_same_settings_match, set_up, tear_down),
        cmocka_unit_test_setup_teardown(whatever_changes_the_frames_differs, set_up, tear_down),
        cmocka_unit_test_setup_teardown(pictures_that_were_written_again_differ, set_up, tear_down),
        cmocka_unit_test_setup_teardown(text_that_is_cut_off_anywhere_does_not_match, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(text_of_somebody_else_is_told_apart, set_up, tear_down),
    };
    supersample_init(&tables);
    return RUN_TESTS(tests);
}
