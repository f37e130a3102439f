/* Files that are changed, truncated or replaced while they are open. */
#define _XOPEN_SOURCE 700

#include "store/stores.h"
#include "store/victim.h"
#include "support/few_descriptors.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static SluiceResult read_first_tile(SluiceImageSource *source)
{
    unsigned char texels[65536];
    SluiceImageRegion region = {0, 0, 0, 128, 128, 0};
    SluiceResult result = sluiceReadImageRegion(source, &region, texels, 512);
    if (result == SLUICE_SUCCESS)
        assert_true(is_painted(PICTURE_SMOOTH, SLUICE_FORMAT_R8G8B8A8_UNORM, &region, texels, 512));
    return result;
}

static void a_file_that_is_cut_while_it_is_open_gives_an_error(void **state)
{
    (void)state;
    for (int is_known = 0; is_known < 2; is_known++) { /* whether the index has been read before */
        struct victim victim;
        victim_init(&victim, 3);
        struct messages messages;
        SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                                   .pPath = victim.scratch.path,
                                                   .log = messages_log(&messages)};
        SluiceImageSource *source;
        CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
        if (is_known)
            CHECK_OK(read_first_tile(source));
        assert_int_equal(truncate(victim.scratch.path, is_known ? 8200 : 5000), 0);
        CHECK_RESULT(read_first_tile(source), SLUICE_ERROR_IO);
        assert_int_equal(messages.errors, 1);
        write_bytes(victim.scratch.path, victim.bytes, victim.size); /* and is whole again */
        CHECK_OK(read_first_tile(source));
        sluiceDestroyImageSource(source);
        victim_finish(&victim);
    }
}

static void a_file_that_is_replaced_stays_what_it_was_for_who_has_it_open(void **state)
{
    (void)state;
    struct victim victim;
    victim_init(&victim, 3);
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = victim.scratch.path};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = victim.scratch.path,
                                  .width = 500,
                                  .height = 500,
                                  .format = SLUICE_FORMAT_R8_UNORM};
    CHECK_OK(write_store(&info, PICTURE_NOISE));
    CHECK_OK(read_first_tile(source));
    sluiceDestroyImageSource(source);
    CHECK_OK(read_store(victim.scratch.path, PICTURE_NOISE, NULL));
    victim_finish(&victim);
}

static void a_file_that_is_written_over_while_it_is_open_gives_an_error(void **state)
{
    (void)state;
    struct victim victim, other;
    victim_init(&victim, 3);
    victim_init(&other, 0);
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = victim.scratch.path};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    write_bytes(victim.scratch.path, other.bytes, other.size);
    CHECK_RESULT(read_first_tile(source), SLUICE_ERROR_CORRUPT_DATA);
    sluiceDestroyImageSource(source);
    victim_finish(&victim);
    victim_finish(&other);
}

/* Overwrites one byte of the first tile's texels. */
static void change_tile(const struct victim *victim, unsigned char value)
{
    FILE *file = fopen(victim->scratch.path, "r+b");
    fseek(file, 8192 + 100, SEEK_SET);
    fputc(value, file);
    fclose(file);
}

static void raw_tiles_are_checked_once_or_each_time(void **state)
{
    (void)state;
    for (int always = 0; always < 2; always++) {
        struct victim victim;
        victim_init(&victim, 0);
        SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                                   .pPath = victim.scratch.path,
                                                   .alwaysCheckRawTiles = always};
        SluiceImageSource *source;
        static unsigned char texels[65536];
        SluiceImageRegion region = {0, 0, 0, 128, 128, 0};
        unsigned char right = victim.bytes[8192 + 100];
        CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
        change_tile(&victim, right ^ 1);
        CHECK_RESULT(read_first_tile(source), SLUICE_ERROR_CORRUPT_DATA);
        CHECK_RESULT(read_first_tile(source), SLUICE_ERROR_CORRUPT_DATA);
        change_tile(&victim, right);
        CHECK_OK(read_first_tile(source));
        change_tile(&victim, right ^ 1);
        CHECK_RESULT(sluiceReadImageRegion(source, &region, texels, 512),
                     always ? SLUICE_ERROR_CORRUPT_DATA : SLUICE_SUCCESS);
        assert_int_equal(texels[100], right ^ 1);
        region.x = 128; /* this tile has not been verified yet */
        CHECK_OK(sluiceReadImageRegion(source, &region, texels, 512));
        sluiceDestroyImageSource(source);
        victim_finish(&victim);
    }
}

static void what_is_no_file_is_not_opened(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    CHECK_RESULT(read_store(scratch.path, PICTURE_SMOOTH, NULL), SLUICE_ERROR_FILE_NOT_FOUND);
    CHECK_RESULT(read_store(scratch.folder, PICTURE_SMOOTH, NULL), SLUICE_ERROR_IO);
    CHECK_RESULT(read_store("/dev/null", PICTURE_SMOOTH, NULL), SLUICE_ERROR_IO);
    CHECK_RESULT(read_store("/dev/null/a.store", PICTURE_SMOOTH, NULL),
                 SLUICE_ERROR_FILE_NOT_FOUND);
    scratch_finish(&scratch);
}

static void a_store_that_found_no_descriptor_opens_later(void **state)
{
    (void)state;
    struct victim victim;
    victim_init(&victim, 3);
    struct messages messages;
    SluiceStoreImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = victim.scratch.path, .log = messages_log(&messages)};
    SluiceImageSource *source = NULL;
    struct few_descriptors few;
    few_descriptors_begin(&few, 2); /* two descriptors are kept for outputs */
    SluiceResult result = sluiceCreateStoreImageSource(&create, &source);
    few_descriptors_end(&few);
    CHECK_RESULT(result, SLUICE_NOT_READY);
    assert_null(source);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last, "Too many open files"));
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(read_first_tile(source));
    sluiceDestroyImageSource(source);
    victim_finish(&victim);
}

/* Loaders retry failing reads again and again. */
static void faults_of_a_file_are_logged_once_each_and_not_all_of_hundreds(void **state)
{
    (void)state;
    struct scratch scratch;
    struct messages messages;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = scratch.path,
                                  .width = 2560,
                                  .height = 1280,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM};
    CHECK_OK(write_store(&info, PICTURE_NOISE)); /* 200 tiles of level 0 */
    SluiceStoreImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = scratch.path, .log = messages_log(&messages)};
    SluiceImageSource *source;
    SluiceStoreInfo store = {.structSize = sizeof store};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetStoreInfo(source, &store));
    size_t size;
    unsigned char *bytes = read_bytes(scratch.path, &size);
    for (size_t at = size / 4; at < size; at += 1000)
        bytes[at] ^= 1;
    write_bytes(scratch.path, bytes, size);
    uint32_t failed = 0;
    for (uint32_t again = 0; again < 4; again++)
        for (uint32_t i = 0; i < 200; i++) {
            static unsigned char texels[65536];
            SluiceImageRegion region = {0, i % 20 * 128, i / 20 * 128, 128, 128, 0};
            failed += sluiceReadImageRegion(source, &region, texels, 512) < 0;
        }
    assert_true(failed > 4 * 100);
    assert_in_range(messages.errors, 2, 16);
    assert_non_null(strstr(messages.last, "counted, not logged"));
    sluiceDestroyImageSource(source);
    free(bytes);
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_that_is_cut_while_it_is_open_gives_an_error),
        cmocka_unit_test(a_file_that_is_replaced_stays_what_it_was_for_who_has_it_open),
        cmocka_unit_test(a_file_that_is_written_over_while_it_is_open_gives_an_error),
        cmocka_unit_test(raw_tiles_are_checked_once_or_each_time),
        cmocka_unit_test(what_is_no_file_is_not_opened),
        cmocka_unit_test(a_store_that_found_no_descriptor_opens_later),
        cmocka_unit_test(faults_of_a_file_are_logged_once_each_and_not_all_of_hundreds),
    };
    return RUN_TESTS(tests);
}
