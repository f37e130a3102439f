/* Pictures that are read although they are damaged are named in the log. */
#define _XOPEN_SOURCE 700

#include "bake/baked.h"

#include "support/test.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <vips/vips.h>

enum { THREADS = 4, ROUNDS = 10 };

struct lines {
    pthread_mutex_t mutex;
    int counts[THREADS]; ///< warnings that name picture i
    int others, errors;
    char last[1024];
};

struct fixture {
    struct bake_folder folder;
    struct lines lines;
    SluiceBaker *baker;
    char inputs[THREADS][256]; ///< even ones are damaged
};

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct fixture *f = user;
    int named = THREADS;
    pthread_mutex_lock(&f->lines.mutex);
    for (int i = 0; i < THREADS; i++)
        if (strncmp(message, f->inputs[i], strlen(f->inputs[i])) == 0)
            named = i;
    f->lines.errors += severity == SLUICE_LOG_ERROR;
    if (severity == SLUICE_LOG_WARNING)
        *(named < THREADS ? &f->lines.counts[named] : &f->lines.others) += 1;
    snprintf(f->lines.last, sizeof f->lines.last, "%s", message);
    pthread_mutex_unlock(&f->lines.mutex);
}

static uint8_t *read_whole(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

/* Bytes in the middle of a JPEG that end its data too early, so that the decoder goes on behind
 * them. */
static void write_jpeg(const char *path, uint8_t *bytes, size_t size, bool is_damaged)
{
    if (is_damaged)
        memset(bytes + size / 2, 0x55, 40);
    FILE *file = fopen(path, "wb");
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void make_jpeg(const char *path, bool is_damaged)
{
    enum { WIDTH = 600, HEIGHT = 400 };
    uint8_t *samples = malloc(WIDTH * HEIGHT * 3);
    uint32_t random = 4;
    for (uint32_t i = 0; i < WIDTH * HEIGHT * 3; i++) {
        random = random * 1664525u + 1013904223u;
        samples[i] = (uint8_t)(i / 3 % WIDTH / 3 + i / WIDTH / 15 + (random >> 28));
    }
    VipsImage *image = vips_image_new_from_memory(samples, WIDTH * HEIGHT * 3, WIDTH, HEIGHT, 3,
                                                  VIPS_FORMAT_UCHAR);
    size_t size;
    assert_int_equal(vips_jpegsave(image, path, NULL), 0);
    g_object_unref(image);
    free(samples);
    uint8_t *bytes = read_whole(path, &size);
    write_jpeg(path, bytes, size, is_damaged);
    free(bytes);
}

static void setup(struct fixture *f)
{
    memset(f, 0, sizeof *f);
    pthread_mutex_init(&f->lines.mutex, NULL);
    bake_folder_init(&f->folder);
    SluiceBakerCreateInfo create = {
        .structSize = sizeof create, .threadCount = THREADS, .log = {f, on_log}};
    CHECK_OK(sluiceCreateBaker(&create, &f->baker));
    for (int i = 0; i < THREADS; i++) {
        char name[32];
        snprintf(name, sizeof name, "%d.jpg", i);
        bake_folder_file(&f->folder, name, f->inputs[i]);
        make_jpeg(f->inputs[i], i % 2 == 0);
    }
}

static void teardown(struct fixture *f)
{
    sluiceDestroyBaker(f->baker);
    bake_folder_finish(&f->folder);
    pthread_mutex_destroy(&f->lines.mutex);
}

static SluiceResult bake(struct fixture *f, const char *input)
{
    char output[300];
    snprintf(output, sizeof output, "%s.store", input);
    SluiceBakeReport report = {.structSize = sizeof report};
    SluiceBakeInfo info = {
        .structSize = sizeof info, .pInputPath = input, .pOutputPath = output, .force = true};
    return sluiceBakeFile(f->baker, &info, &report);
}

static void a_damaged_picture_is_named(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    CHECK_OK(bake(&f, f.inputs[1]));
    assert_int_equal(f.lines.counts[1], 0);
    CHECK_OK(bake(&f, f.inputs[0]));
    assert_int_equal(f.lines.counts[0], 2); /* how many, and which */
    assert_non_null(strstr(f.lines.last, "libvips: VipsJpeg: Corrupt JPEG data"));
    CHECK_OK(bake(&f, f.inputs[2]));
    assert_int_equal(f.lines.counts[2], 2);
    assert_int_equal(f.lines.errors + f.lines.others, 0);
    teardown(&f);
}

/* libvips collects texts for the whole process; those of warnings are not left there. */
static void a_warning_is_not_the_reason_why_the_next_picture_fails(void **state)
{
    (void)state;
    struct fixture f;
    char path[256];
    static uint8_t samples[300 * 200 * 3];
    setup(&f);
    CHECK_OK(bake(&f, f.inputs[0]));
    write_png(bake_folder_file(&f.folder, "cut.png", path), samples, 300, 200, 3, false);
    assert_int_equal(truncate(path, 100), 0);
    CHECK_RESULT(bake(&f, path), SLUICE_ERROR_CORRUPT_DATA);
    assert_null(strstr(f.lines.last, "JPEG"));
    assert_non_null(strstr(f.lines.last, path));
    teardown(&f);
}

struct task {
    struct fixture *f;
    const char *input;
    int failures;
};

static void *bake_often(void *user)
{
    struct task *task = user;
    for (int i = 0; i < ROUNDS; i++)
        task->failures += bake(task->f, task->input) != SLUICE_SUCCESS;
    return NULL;
}

static void pictures_of_other_threads_are_not_named(void **state)
{
    (void)state;
    struct fixture f;
    struct task tasks[THREADS];
    pthread_t threads[THREADS];
    setup(&f);
    for (int i = 0; i < THREADS; i++) {
        tasks[i] = (struct task){&f, f.inputs[i], 0};
        assert_int_equal(pthread_create(&threads[i], NULL, bake_often, &tasks[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(tasks[i].failures, 0);
        assert_true(i % 2 ? f.lines.counts[i] == 0 : f.lines.counts[i] >= ROUNDS);
    }
    assert_int_equal(f.lines.others, 0);
    teardown(&f);
}

static void count_warning(const gchar *domain, GLogLevelFlags level, const gchar *message,
                          gpointer user)
{
    (void)domain, (void)level, (void)message;
    ++*(int *)user;
}

/* g_log asks handlers from the last one on; after the baker's end the application's is asked. */
static void the_handler_ends_with_the_last_baker(void **state)
{
    (void)state;
    struct fixture f, second;
    int count = 0;
    guint id = g_log_set_handler("VIPS", G_LOG_LEVEL_WARNING, count_warning, &count);
    setup(&f);
    setup(&second);
    teardown(&f);
    CHECK_OK(bake(&second, second.inputs[0]));
    assert_int_equal(second.lines.counts[0], 2);
    assert_int_equal(count, 0);
    teardown(&second);
    g_log("VIPS", G_LOG_LEVEL_WARNING, "for the application");
    assert_int_equal(count, 1);
    g_log_remove_handler("VIPS", id);
}

static void a_damaged_photograph_is_named(void **state)
{
    (void)state;
    const char *data = getenv("SLUICE_TEST_DATA"), *root = getenv("SLUICE_SOURCE_ROOT");
    char path[1024];
    size_t size;
    snprintf(path, sizeof path,
             "%s%s/gltf/FlightHelmet/FlightHelmet_Materials_GlassPlasticMat_BaseColor.jpg",
             data   ? data
             : root ? root
                    : ".",
             data ? "" : "/../shared/data");
    uint8_t *bytes = read_whole(path, &size);
    if (!bytes)
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    struct fixture f;
    setup(&f);
    write_jpeg(f.inputs[0], bytes, size, true);
    free(bytes);
    CHECK_OK(bake(&f, f.inputs[0]));
    assert_int_equal(f.lines.counts[0], 2);
    assert_int_equal(f.lines.errors + f.lines.others, 0);
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_damaged_picture_is_named),
        cmocka_unit_test(a_warning_is_not_the_reason_why_the_next_picture_fails),
        cmocka_unit_test(pictures_of_other_threads_are_not_named),
        cmocka_unit_test(the_handler_ends_with_the_last_baker),
        cmocka_unit_test(a_damaged_photograph_is_named),
    };
    return RUN_TESTS(tests);
}
