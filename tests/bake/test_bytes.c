/* Pictures in memory, or read by a function, are baked like a file of equal bytes. */
#define _XOPEN_SOURCE 700

#include "bake/baked.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 301, HEIGHT = 170, LEVELS = 9 };

struct fixture {
    struct bake_folder folder;
    char picture[256], of_file[256], of_bytes[256];
    uint8_t *bytes;
    size_t size;
    SluiceResult result; ///< result of the callback
    SluiceInput input, callback;
    int errors;
    char last[1024];
};

static SluiceResult read_some(void *user, uint64_t offset, void *bytes, size_t size)
{
    const struct fixture *f = user;
    memcpy(bytes, f->bytes + offset, size);
    return f->result;
}

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct fixture *f = user;
    f->errors += severity == SLUICE_LOG_ERROR;
    snprintf(f->last, sizeof f->last, "%s", message);
}

static void setup(struct fixture *f)
{
    memset(f, 0, sizeof *f);
    uint8_t *samples = malloc(WIDTH * HEIGHT * 3);
    for (uint32_t i = 0; i < WIDTH * HEIGHT * 3; i++)
        samples[i] = (uint8_t)(i * i >> 7);
    bake_folder_init(&f->folder);
    bake_folder_file(&f->folder, "picture.png", f->picture);
    bake_folder_file(&f->folder, "file.store", f->of_file);
    bake_folder_file(&f->folder, "bytes.store", f->of_bytes);
    write_png(f->picture, samples, WIDTH, HEIGHT, 3, false);
    bake_picture_file(f->picture, f->of_file, NULL);
    FILE *file = fopen(f->picture, "rb");
    f->bytes = malloc(1 << 20);
    f->size = fread(f->bytes, 1, 1 << 20, file);
    f->bytes = realloc(f->bytes,
                       f->size); /* exactly sized, so that sanitizers see a read beyond the end */
    fclose(file);
    unlink(f->picture);
    f->input =
        (SluiceInput){.structSize = sizeof(SluiceInput), .pBytes = f->bytes, .size = f->size};
    f->callback = (SluiceInput){
        .structSize = sizeof(SluiceInput), .size = f->size, .pUserData = f, .pfnRead = read_some};
    free(samples);
}

static void teardown(struct fixture *f)
{
    free(f->bytes);
    bake_folder_finish(&f->folder);
}

static SluiceResult bake(struct fixture *f, const SluiceInput *input,
                         const SluiceAllocationCallbacks *cb)
{
    SluiceBakerCreateInfo create = {
        .structSize = sizeof create, .threadCount = 1, .pAllocator = cb, .log = {f, on_log}};
    SluiceBakeInfo info = {.structSize = sizeof info, .pInput = input, .pOutputPath = f->of_bytes};
    SluiceBaker *baker = NULL;
    SluiceResult result = sluiceCreateBaker(&create, &baker);
    if (result == SLUICE_SUCCESS)
        result = sluiceBakeFile(baker, &info, NULL);
    sluiceDestroyBaker(baker);
    return result;
}

static void check_same(const struct fixture *f)
{
    for (uint32_t level = 0; level < LEVELS; level++) {
        size_t size, expected_size;
        void *bytes = read_bytes(f->of_bytes, level, &size);
        void *expected = read_bytes(f->of_file, level, &expected_size);
        assert_int_equal(size, expected_size);
        assert_memory_equal(bytes, expected, size);
        free(bytes);
        free(expected);
    }
}

static void bytes_and_callbacks_give_the_store_of_the_file(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    for (int calls_back = 0; calls_back < 2; calls_back++) {
        CHECK_OK(bake(&f, calls_back ? &f.callback : &f.input, NULL));
        check_same(&f);
        unlink(f.of_bytes);
    }
    teardown(&f);
}

static void bytes_that_are_cut_leave_no_store(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    for (size_t size = 1; size < f.size - 12; size += f.size / 9) { /* the last chunk is empty */
        uint8_t *cut = malloc(size);
        memcpy(cut, f.bytes, size);
        SluiceInput input = {.structSize = sizeof input, .pBytes = cut, .size = size};
        f.errors = 0;
        CHECK_RESULT(bake(&f, &input, NULL), SLUICE_ERROR_CORRUPT_DATA);
        assert_true(f.errors > 0);
        assert_non_null(strstr(f.last, "(memory)"));
        assert_int_equal(access(f.of_bytes, F_OK), -1);
        free(cut);
    }
    teardown(&f);
}

static void inputs_without_bytes_and_callbacks_that_fail_are_errors(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    f.result = SLUICE_ERROR_IO;
    CHECK_RESULT(bake(&f, &f.callback, NULL), SLUICE_ERROR_IO);
    f.result = SLUICE_NOT_READY;
    CHECK_RESULT(bake(&f, &f.callback, NULL), SLUICE_NOT_READY);
    SluiceInput input = {.structSize = sizeof input, .size = 1};
    CHECK_RESULT(bake(&f, &input, NULL), SLUICE_ERROR_NULL_POINTER);
    input.pBytes = &input;
    input.size = 0;
    CHECK_RESULT(bake(&f, &input, NULL), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(bake(&f, NULL, NULL), SLUICE_ERROR_NULL_POINTER);
    teardown(&f);
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    struct fixture f;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    setup(&f);
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        a.refuse_count = 1;
        result = bake(&f, &f.callback, &a.callbacks);
        assert_int_equal(a.live_bytes, 0);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        else
            check_same(&f);
        if (a.calls <= n)
            break;
        result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_and_callbacks_give_the_store_of_the_file),
        cmocka_unit_test(bytes_that_are_cut_leave_no_store),
        cmocka_unit_test(inputs_without_bytes_and_callbacks_that_fail_are_errors),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    return RUN_TESTS(tests);
}
