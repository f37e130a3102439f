/* Files that are changed, cut or replaced while they are open. */
#define _XOPEN_SOURCE 700

#include "store/stores.h"
#include "store/victim.h"
#include "support/test.h"

#include <stdlib.h>
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
        SluiceStoreImageSourceCreateInfo create = {.pPath = victim.scratch.path,
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
    SluiceStoreImageSourceCreateInfo create = {.pPath = victim.scratch.path};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    SluiceStoreCreateInfo info = {.pPath = victim.scratch.path,
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
    SluiceStoreImageSourceCreateInfo create = {.pPath = victim.scratch.path};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    write_bytes(victim.scratch.path, other.bytes, other.size);
    CHECK_RESULT(read_first_tile(source), SLUICE_ERROR_CORRUPT_DATA);
    sluiceDestroyImageSource(source);
    victim_finish(&victim);
    victim_finish(&other);
}

/* Writes one byte of the first tile's texels. */
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
        SluiceStoreImageSourceCreateInfo create = {.pPath = victim.scratch.path,
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
        region.x = 128; /* that is not known to be right yet */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_that_is_cut_while_it_is_open_gives_an_error),
        cmocka_unit_test(a_file_that_is_replaced_stays_what_it_was_for_who_has_it_open),
        cmocka_unit_test(a_file_that_is_written_over_while_it_is_open_gives_an_error),
        cmocka_unit_test(raw_tiles_are_checked_once_or_each_time),
        cmocka_unit_test(what_is_no_file_is_not_opened),
    };
    return RUN_TESTS(tests);
}
