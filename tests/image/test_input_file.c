#define _XOPEN_SOURCE 700

#include "image/input_file.h"

#include "base/alloc.h"
#include "support/failing_allocator.h"
#include "support/few_descriptors.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FILE_SIZE = 1000 };

static uint8_t byte_at(uint64_t offset)
{
    return (uint8_t)(offset * 7 + offset / 256);
}

struct fixture {
    char path[64];
    int descriptor;
    int errors;
    char last[1024];
    struct slc_input_file file;
};

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct fixture *f = user;
    f->errors += severity == SLUICE_LOG_ERROR;
    strncpy(f->last, message, sizeof f->last - 1);
}

static void setup(struct fixture *f)
{
    uint8_t bytes[FILE_SIZE];
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    SluiceLogCallback log = {f, on_log};
    *f = (struct fixture){.path = "/tmp/sluice-input-XXXXXX"};
    for (uint32_t i = 0; i < FILE_SIZE; i++)
        bytes[i] = byte_at(i);
    f->descriptor = mkstemp(f->path);
    assert_true(f->descriptor >= 0);
    assert_int_equal(write(f->descriptor, bytes, FILE_SIZE), FILE_SIZE);
    CHECK_OK(slc_input_file_init(&f->file, f->path, &cb, &log));
}

static void teardown(struct fixture *f)
{
    slc_input_file_finish(&f->file);
    close(f->descriptor);
    unlink(f->path);
}

static void bytes_inside_the_file_are_read_and_others_are_damage(void **state)
{
    (void)state;
    static const struct {
        uint64_t offset;
        size_t size;
        SluiceResult result;
    } reads[] = {
        {0, FILE_SIZE, SLUICE_SUCCESS},
        {999, 1, SLUICE_SUCCESS},
        {FILE_SIZE, 0, SLUICE_SUCCESS},
        {999, 2, SLUICE_ERROR_CORRUPT_DATA},
        {FILE_SIZE, 1, SLUICE_ERROR_CORRUPT_DATA},
        {UINT64_MAX, 1, SLUICE_ERROR_CORRUPT_DATA},
        {UINT64_MAX - 10, 20, SLUICE_ERROR_CORRUPT_DATA},
        {1, SIZE_MAX, SLUICE_ERROR_CORRUPT_DATA},
    };
    struct fixture f;
    setup(&f);
    CHECK_OK(slc_input_file_open(&f.file));
    assert_int_equal(f.file.size, FILE_SIZE);
    for (size_t i = 0; i < sizeof reads / sizeof reads[0]; i++) {
        uint8_t bytes[FILE_SIZE + 1];
        bytes[reads[i].size <= FILE_SIZE ? reads[i].size : 0] = 0xEE;
        CHECK_RESULT(slc_input_file_read(&f.file, reads[i].offset, bytes, reads[i].size),
                     reads[i].result);
        for (size_t k = 0; reads[i].result == SLUICE_SUCCESS && k < reads[i].size; k++)
            assert_int_equal(bytes[k], byte_at(reads[i].offset + k));
        assert_int_equal(bytes[reads[i].size <= FILE_SIZE ? reads[i].size : 0], 0xEE);
    }
    assert_int_equal(f.errors, 5);
    assert_non_null(strstr(f.last, f.path));
    teardown(&f);
}

static void what_is_there_is_read_up_to_the_end(void **state)
{
    (void)state;
    struct fixture f;
    uint8_t bytes[100];
    setup(&f);
    CHECK_OK(slc_input_file_open(&f.file));
    assert_int_equal(slc_input_file_read_some(&f.file, 950, bytes, 100), 50);
    assert_int_equal(bytes[49], byte_at(999));
    assert_int_equal(slc_input_file_read_some(&f.file, 5000, bytes, 100), 0);
    assert_int_equal(ftruncate(f.descriptor, 960), 0);
    CHECK_RESULT(slc_input_file_read(&f.file, 950, bytes, 50), SLUICE_ERROR_IO);
    assert_non_null(strstr(f.last, "shorter"));
    teardown(&f);
}

static void a_file_is_opened_closed_and_opened_again(void **state)
{
    (void)state;
    struct fixture f;
    uint8_t byte;
    setup(&f);
    for (int i = 0; i < 2000; i++) { /* more often than there are descriptors */
        CHECK_OK(slc_input_file_open(&f.file));
        CHECK_OK(slc_input_file_open(&f.file));
        CHECK_OK(slc_input_file_read(&f.file, 3, &byte, 1));
        slc_input_file_close(&f.file);
        slc_input_file_close(&f.file);
    }
    unlink(f.path);
    CHECK_RESULT(slc_input_file_open(&f.file), SLUICE_ERROR_FILE_NOT_FOUND);
    assert_int_equal(f.errors, 1);
    teardown(&f);
}

/* The pipe has no writer. A loader thread that waits for one would wait forever. */
static void pipes_and_devices_are_refused_without_waiting(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    unlink(f.path);
    assert_int_equal(mkfifo(f.path, 0600), 0);
    CHECK_RESULT(slc_input_file_open(&f.file), SLUICE_ERROR_IO);
    assert_non_null(strstr(f.last, "is not a regular file"));
    unlink(f.path);
    assert_int_equal(symlink("/dev/zero", f.path), 0);
    CHECK_RESULT(slc_input_file_open(&f.file), SLUICE_ERROR_IO);
    assert_non_null(strstr(f.last, "is not a regular file"));
    assert_int_equal(f.file.descriptor, -1);
    assert_false(f.file.is_open);
    teardown(&f);
}

static void nothing_is_left_of_what_was_never_begun(void **state)
{
    (void)state;
    struct slc_input_file file = {0};
    struct failing_allocator a;
    SluiceLogCallback log = {0};
    slc_input_file_finish(&file);
    failing_allocator_init(&a, 0);
    CHECK_RESULT(slc_input_file_init(&file, "x", &a.callbacks, &log),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    slc_input_file_finish(&file);
    assert_int_equal(a.live_bytes, 0);
}

static void words_of_a_file_become_printable(void **state)
{
    (void)state;
    char text[6];
    slc_printable("a\n\x80z", text, sizeof text);
    assert_string_equal(text, "a??z");
    slc_printable("much too long", text, sizeof text);
    assert_string_equal(text, "much ");
    slc_printable("x", text, 1);
    assert_string_equal(text, "");
}

static void a_file_that_found_no_descriptor_opens_later(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    struct few_descriptors few;
    few_descriptors_begin(&few, 2);
    SluiceResult result = slc_input_file_open(&f.file);
    few_descriptors_end(&few);
    CHECK_RESULT(result, SLUICE_NOT_READY);
    CHECK_OK(slc_input_file_open(&f.file));
    uint8_t byte = 0;
    CHECK_OK(slc_input_file_read(&f.file, 7, &byte, 1));
    assert_int_equal(byte, byte_at(7));
    teardown(&f);
}

struct bytes {
    const uint8_t *bytes;
    SluiceResult result; ///< result of the next call; reads only if it is SUCCESS
    uint32_t calls;
    uint64_t furthest;
};

static SluiceResult read_bytes(void *user, uint64_t offset, void *bytes, size_t size)
{
    struct bytes *from = user;
    from->calls++;
    if (offset + size > from->furthest)
        from->furthest = offset + size;
    if (from->result == SLUICE_SUCCESS)
        memcpy(bytes, from->bytes + offset, size);
    return from->result;
}

static void bytes_in_memory_and_of_a_callback_are_read_like_a_file(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct fixture f = {0};
    SluiceLogCallback log = {&f, on_log};
    uint8_t bytes[FILE_SIZE];
    for (uint32_t i = 0; i < FILE_SIZE; i++)
        bytes[i] = byte_at(i);
    struct bytes from = {.bytes = bytes};
    for (int calls_back = 0; calls_back < 2; calls_back++) {
        SluiceInput input = {.structSize = sizeof input,
                             .pBytes = calls_back ? NULL : bytes,
                             .size = FILE_SIZE,
                             .pUserData = &from,
                             .pfnRead = read_bytes};
        struct slc_input_choice choice = {calls_back ? NULL : "a name", &input, NULL};
        uint8_t read[FILE_SIZE];
        CHECK_OK(slc_input_file_init_choice(&f.file, &choice, &cb, &log));
        CHECK_OK(slc_input_file_open(&f.file));
        assert_int_equal(f.file.size, FILE_SIZE);
        CHECK_OK(slc_input_file_read(&f.file, 0, read, FILE_SIZE));
        assert_memory_equal(read, bytes, FILE_SIZE);
        CHECK_OK(slc_input_file_read(&f.file, FILE_SIZE - 3, read, 3));
        assert_memory_equal(read, bytes + FILE_SIZE - 3, 3);
        CHECK_OK(slc_input_file_read(&f.file, FILE_SIZE, read, 0));
        CHECK_RESULT(slc_input_file_read(&f.file, FILE_SIZE - 3, read, 4),
                     SLUICE_ERROR_CORRUPT_DATA);
        assert_non_null(strstr(f.last, calls_back ? "(memory)" : "a name"));
        assert_int_equal(slc_input_file_read_some(&f.file, 950, read, 100), 50);
        assert_int_equal(slc_input_file_read_some(&f.file, UINT64_MAX, read, 100), 0);
        struct slc_file_stamp none = {0}, stamp = slc_input_file_stamp(&f.file);
        assert_memory_equal(&stamp, &none, sizeof none);
        slc_input_file_finish(&f.file);
    }
    assert_int_equal(from.calls, 3);
    assert_int_equal(from.furthest, FILE_SIZE);
}

static void results_of_a_callback_are_passed_on_or_count_as_io(void **state)
{
    (void)state;
    static const SluiceResult results[][2] = {
        {SLUICE_NOT_READY, SLUICE_NOT_READY},
        {SLUICE_ERROR_OUT_OF_HOST_MEMORY, SLUICE_ERROR_OUT_OF_HOST_MEMORY},
        {SLUICE_ERROR_IO, SLUICE_ERROR_IO},
        {SLUICE_ERROR_CANCELED, SLUICE_ERROR_IO},
        {SLUICE_INCOMPLETE, SLUICE_ERROR_IO},
    };
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    SluiceLogCallback log = {0};
    struct slc_input_file file;
    struct bytes from = {0};
    SluiceInput input = {
        .structSize = sizeof input, .size = 10, .pUserData = &from, .pfnRead = read_bytes};
    struct slc_input_choice choice = {"x", &input, NULL};
    CHECK_OK(slc_input_file_init_choice(&file, &choice, &cb, &log));
    CHECK_OK(slc_input_file_open(&file));
    for (size_t i = 0; i < sizeof results / sizeof results[0]; i++) {
        uint8_t byte;
        from.result = results[i][0];
        CHECK_RESULT(slc_input_file_read(&file, 0, &byte, 1), results[i][1]);
    }
    slc_input_file_finish(&file);
}

static void inputs_without_bytes_are_refused(void **state)
{
    (void)state;
    static const uint8_t byte;
    static const struct {
        SluiceInput input;
        SluiceResult result;
    } inputs[] = {
        {{.structSize = sizeof(SluiceInput), .size = 1}, SLUICE_ERROR_NULL_POINTER},
        {{.structSize = sizeof(SluiceInput), .pBytes = &byte}, SLUICE_ERROR_INVALID_ARGUMENT},
        {{.structSize = sizeof(SluiceInput), .pBytes = &byte, .size = (uint64_t)1 << 63},
         SLUICE_ERROR_INVALID_ARGUMENT},
        {{.pBytes = &byte, .size = 1}, SLUICE_ERROR_INVALID_ARGUMENT},
    };
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    for (size_t i = 0; i < sizeof inputs / sizeof inputs[0]; i++) {
        struct fixture f = {0};
        SluiceLogCallback log = {&f, on_log};
        struct slc_input_choice choice = {"x", &inputs[i].input, NULL};
        CHECK_RESULT(slc_input_file_init_choice(&f.file, &choice, &cb, &log), inputs[i].result);
        assert_int_equal(f.errors, 1);
        slc_input_file_finish(&f.file);
    }
    struct slc_input_file file;
    struct slc_input_choice nothing = {0};
    SluiceLogCallback log = {0};
    CHECK_RESULT(slc_input_file_init_choice(&file, &nothing, &cb, &log), SLUICE_ERROR_NULL_POINTER);
    slc_input_file_finish(&file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_inside_the_file_are_read_and_others_are_damage),
        cmocka_unit_test(what_is_there_is_read_up_to_the_end),
        cmocka_unit_test(a_file_is_opened_closed_and_opened_again),
        cmocka_unit_test(pipes_and_devices_are_refused_without_waiting),
        cmocka_unit_test(nothing_is_left_of_what_was_never_begun),
        cmocka_unit_test(words_of_a_file_become_printable),
        cmocka_unit_test(a_file_that_found_no_descriptor_opens_later),
        cmocka_unit_test(bytes_in_memory_and_of_a_callback_are_read_like_a_file),
        cmocka_unit_test(results_of_a_callback_are_passed_on_or_count_as_io),
        cmocka_unit_test(inputs_without_bytes_are_refused),
    };
    return RUN_TESTS(tests);
}
