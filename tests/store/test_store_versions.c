/* Newer minor versions are read, newer major ones refused with words that help. */
#include "store/naive_store.h"
#include "store/stores.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

/* The byte `at` is `value`. */
struct change {
    size_t at;
    unsigned char value;
};

static void write_changed(const struct scratch *scratch, const struct change *changes, int count,
                          bool reseals)
{
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = scratch->path,
                                  .width = 200,
                                  .height = 140,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .colorSpace = SLUICE_STORE_COLOR_SPACE_SRGB,
                                  .addressModeV = SLUICE_STORE_ADDRESS_MODE_MIRRORED_REPEAT,
                                  .compressionLevel = 1};
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    size_t size;
    unsigned char *bytes = read_bytes(scratch->path, &size);
    for (int i = 0; i < count; i++)
        bytes[changes[i].at] = changes[i].value;
    if (reseals)
        naive_store_reseal(bytes, size);
    write_bytes(scratch->path, bytes, size);
    free(bytes);
}

static SluiceResult read_changed(size_t at, unsigned char value, bool reseals,
                                 struct messages *messages)
{
    struct scratch scratch;
    struct change change = {at, value};
    scratch_init(&scratch);
    write_changed(&scratch, &change, 1, reseals);
    SluiceResult result = read_store(scratch.path, PICTURE_MIXED, messages);
    scratch_finish(&scratch);
    return result;
}

static SluiceStoreInfo info_of(const char *path)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    SluiceStoreInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetStoreInfo(source, &info));
    sluiceDestroyImageSource(source);
    return info;
}

/* The texels stay readable, what stands for them in words is left open. */
static void choices_that_a_newer_minor_version_adds_are_what_says_least(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    const struct change changes[] = {{12, 2}, {48, 5}, {52, 77}, {56, 4}, {63, 0x80}};
    write_changed(&scratch, changes, 5, true);
    CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
    SluiceStoreInfo info = info_of(scratch.path);
    assert_int_equal(info.versionMinor, 2);
    assert_int_equal(info.colorSpace, SLUICE_STORE_COLOR_SPACE_UNDEFINED);
    assert_int_equal(info.meaning, SLUICE_STORE_MEANING_DATA);
    assert_int_equal(info.addressModeU, SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_EDGE);
    assert_int_equal(info.addressModeV, SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_EDGE);
    scratch_finish(&scratch);
}

static void choices_that_are_known_are_kept_whatever_the_minor_version(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    const struct change changes[] = {{12, 2}, {52, 5}}; /* the meaning alone is new */
    write_changed(&scratch, changes, 2, true);
    SluiceStoreInfo info = info_of(scratch.path);
    assert_int_equal(info.colorSpace, SLUICE_STORE_COLOR_SPACE_SRGB);
    assert_int_equal(info.meaning, SLUICE_STORE_MEANING_DATA);
    assert_int_equal(info.addressModeU, SLUICE_STORE_ADDRESS_MODE_REPEAT);
    assert_int_equal(info.addressModeV, SLUICE_STORE_ADDRESS_MODE_MIRRORED_REPEAT);
    scratch_finish(&scratch);
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
    CHECK_OK(read_changed(116, 1, true, &messages));  /* behind the cube flag */
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
        cmocka_unit_test(choices_that_a_newer_minor_version_adds_are_what_says_least),
        cmocka_unit_test(choices_that_are_known_are_kept_whatever_the_minor_version),
        cmocka_unit_test(a_newer_major_version_is_refused_and_the_log_says_what_to_do),
        cmocka_unit_test(a_major_version_that_never_was_is_damage),
        cmocka_unit_test(a_format_that_is_not_known_is_refused_and_the_log_says_so),
    };
    return RUN_TESTS(tests);
}
