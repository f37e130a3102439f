/* Newer minor versions are read, newer major ones refused with words that help. */
#include "store/naive_store.h"
#include "store/stores.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static SluiceResult read_changed(size_t at, unsigned char value, bool reseals,
                                 struct messages *messages)
{
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = {.pPath = scratch.path,
                                  .width = 200,
                                  .height = 140,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .compressionLevel = 1};
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    size_t size;
    unsigned char *bytes = read_bytes(scratch.path, &size);
    bytes[at] = value;
    if (reseals)
        naive_store_reseal(bytes, size);
    write_bytes(scratch.path, bytes, size);
    SluiceResult result = read_store(scratch.path, PICTURE_MIXED, messages);
    free(bytes);
    scratch_finish(&scratch);
    return result;
}

static void a_newer_minor_version_is_read(void **state)
{
    (void)state;
    struct messages messages;
    CHECK_OK(read_changed(12, 9, true, &messages));
    assert_int_equal(messages.errors + messages.others, 0);
}

static void what_a_newer_minor_version_adds_is_passed_over(void **state)
{
    (void)state;
    struct messages messages;
    CHECK_OK(read_changed(112, 1, true, &messages));  /* behind the data offset */
    CHECK_OK(read_changed(4063, 1, true, &messages)); /* behind the longest name */
}

static void a_newer_major_version_is_refused_and_the_log_says_what_to_do(void **state)
{
    (void)state;
    for (int reseals = 0; reseals < 2; reseals++) { /* where its checksums are is not known */
        struct messages messages;
        CHECK_RESULT(read_changed(8, 2, reseals, &messages), SLUICE_ERROR_UNSUPPORTED);
        assert_int_equal(messages.errors, 1);
        assert_non_null(strstr(messages.last, "newer major version"));
        assert_non_null(strstr(messages.last, "update Sluice"));
    }
}

static void a_major_version_that_never_was_is_damage(void **state)
{
    (void)state;
    struct messages messages;
    CHECK_RESULT(read_changed(8, 0, true, &messages), SLUICE_ERROR_CORRUPT_DATA);
}

static void a_format_that_is_not_known_is_refused_and_the_log_says_so(void **state)
{
    (void)state;
    struct messages messages;
    CHECK_RESULT(read_changed(32, 200, true, &messages), SLUICE_ERROR_UNSUPPORTED);
    assert_non_null(strstr(messages.last, "format"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_newer_minor_version_is_read),
        cmocka_unit_test(what_a_newer_minor_version_adds_is_passed_over),
        cmocka_unit_test(a_newer_major_version_is_refused_and_the_log_says_what_to_do),
        cmocka_unit_test(a_major_version_that_never_was_is_damage),
        cmocka_unit_test(a_format_that_is_not_known_is_refused_and_the_log_says_so),
    };
    return RUN_TESTS(tests);
}
