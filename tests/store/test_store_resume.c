/* Writers that are stopped, killed, or resumed with different settings. */
#define _XOPEN_SOURCE 700

#include "store/fault_io.h"
#include "store/naive_store.h"
#include "store/stores.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    TILES = 23
}; /* tiles of the picture below: 12 + 6 + 2 + 1 + tail for R8G8B8A8, and a spare */

static SluiceStoreCreateInfo describe(const struct scratch *scratch, uint32_t compression)
{
    return (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                   .pPath = scratch->path,
                                   .width = 500,
                                   .height = 380,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                   .pSourceName = "picture.png",
                                   .settingsHash = 1,
                                   .compressionLevel = compression,
                                   .flags = SLUICE_STORE_WRITER_RESUME};
}

static unsigned char *write_at_once(uint32_t compression, size_t *size)
{
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, compression);
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    unsigned char *bytes = read_bytes(scratch.path, size);
    scratch_finish(&scratch);
    return bytes;
}

static void expect_bytes(const char *path, const unsigned char *expected, size_t expected_size)
{
    size_t size;
    unsigned char *bytes = read_bytes(path, &size);
    assert_int_equal(size, expected_size);
    assert_memory_equal(bytes, expected, size);
    free(bytes);
}

static uint64_t written_count(SluiceStoreWriter *writer)
{
    uint64_t written, total;
    CHECK_OK(sluiceGetStoreProgress(writer, &written, &total));
    return written;
}

static void stop_after(const SluiceStoreCreateInfo *info, uint64_t tiles)
{
    SluiceStoreWriter *writer;
    CHECK_OK(sluiceCreateStoreWriter(info, &writer));
    CHECK_OK(write_tiles(writer, info, PICTURE_MIXED, tiles));
    sluiceDestroyStoreWriter(writer);
}

static void a_writer_stopped_anywhere_is_resumed_to_the_same_file(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        size_t size;
        unsigned char *expected = write_at_once(compression, &size);
        for (uint64_t n = 0; n < TILES; n++) {
            struct scratch scratch;
            struct messages messages;
            scratch_init(&scratch);
            SluiceStoreCreateInfo info = describe(&scratch, compression);
            info.log = messages_log(&messages);
            stop_after(&info, n);
            if (!exists(scratch.path)) { /* n may be all of them */
                assert_true(exists(scratch.part_path));
                SluiceStoreWriter *writer;
                CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
                assert_int_equal(written_count(writer), n);
                assert_int_equal(messages.others, 1);
                CHECK_OK(write_tiles(writer, &info, PICTURE_MIXED, UINT64_MAX));
                sluiceDestroyStoreWriter(writer);
            }
            expect_bytes(scratch.path, expected, size);
            assert_false(exists(scratch.part_path));
            assert_int_equal(messages.errors, 0);
            scratch_finish(&scratch);
        }
        free(expected);
    }
}

/* Writes in a child process that dies before its call of a number. Returns true if it survives. */
static bool write_and_die(const SluiceStoreCreateInfo *info, enum fault_call call, uint64_t kill_at)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        fault_io = (struct fault_io){.longest = 20000};
        fault_io.kill_at[call] = kill_at;
        _exit(write_store(info, PICTURE_MIXED) == SLUICE_SUCCESS ? 0 : 1);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status))
        return false;
    assert_int_equal(WEXITSTATUS(status), 0);
    return true;
}

/* Returns how often the process was killed. */
static uint32_t kill_before_every(enum fault_call call, uint32_t compression)
{
    size_t size;
    unsigned char *expected = write_at_once(compression, &size);
    bool lives = false;
    uint32_t kills = 0;
    for (uint64_t kill_at = 1; !lives; kill_at++) {
        struct scratch scratch;
        scratch_init(&scratch);
        SluiceStoreCreateInfo info = describe(&scratch, compression);
        lives = write_and_die(&info, call, kill_at);
        kills += !lives;
        /* complete or absent: the name exists once only the folder is left to be synced */
        bool is_named = lives || (call == FAULT_SYNC && kill_at == 2);
        assert_int_equal(exists(scratch.path), is_named);
        if (!is_named)
            CHECK_OK(write_store(&info, PICTURE_MIXED));
        expect_bytes(scratch.path, expected, size);
        scratch_finish(&scratch);
    }
    free(expected);
    return kills;
}

static void a_writer_killed_before_any_call_is_resumed_to_the_same_file(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        assert_in_range(kill_before_every(FAULT_WRITE, compression), 2 * 21, 1000);
        assert_in_range(kill_before_every(FAULT_READ, compression), 21, 1000);
        assert_int_equal(kill_before_every(FAULT_CUT, compression), 2);
        assert_int_equal(kill_before_every(FAULT_SYNC, compression), 2);
        assert_int_equal(kill_before_every(FAULT_RENAME, compression), 1);
    }
}

static void a_writer_killed_again_and_again_gets_there(void **state)
{
    (void)state;
    size_t size;
    unsigned char *expected = write_at_once(3, &size);
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 3);
    uint32_t runs = 1;
    while (!write_and_die(&info, FAULT_WRITE, 6))
        assert_true(runs++ < 100);
    assert_true(runs > 5);
    expect_bytes(scratch.path, expected, size);
    free(expected);
    scratch_finish(&scratch);
}

static void a_tile_that_is_damaged_meanwhile_is_written_again(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        struct scratch scratch;
        scratch_init(&scratch);
        SluiceStoreCreateInfo info = describe(&scratch, compression);
        stop_after(&info, 9);
        size_t size;
        unsigned char *bytes = read_bytes(scratch.part_path, &size);
        bytes[8192 + 100] ^= 1;                    /* byte of the first tile */
        memset(bytes + 4096 + 2 * 20, 0xFF, 20);   /* the third tile's entry */
        bytes[4096 + 5 * 20 + 9] ^= 4;             /* the sixth tile's checksum */
        memset(bytes + 4096 + 150 * 20, 0x11, 20); /* no such tile */
        write_bytes(scratch.part_path, bytes, size);
        free(bytes);
        SluiceStoreWriter *writer;
        CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
        assert_int_equal(written_count(writer), 6);
        bool is_written;
        for (uint32_t x = 0; x < 4; x++) {
            CHECK_OK(sluiceIsStoreTileWritten(writer, 0, 0, x, 0, &is_written));
            assert_int_equal(is_written, x != 0 && x != 2);
        }
        CHECK_OK(write_tiles(writer, &info, PICTURE_MIXED, UINT64_MAX));
        sluiceDestroyStoreWriter(writer);
        CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
        struct naive_store store;
        assert_null(naive_store_load(&store, scratch.path));
        naive_store_finish(&store);
        scratch_finish(&scratch);
    }
}

static void other_settings_begin_anew(void **state)
{
    (void)state;
    for (int change = 0; change < 12; change++) {
        struct scratch scratch;
        scratch_init(&scratch);
        SluiceStoreCreateInfo info = describe(&scratch, 3);
        stop_after(&info, 7);
        switch (change) {
        case 0: info.width++; break;
        case 1: info.height++; break;
        case 2: info.format = SLUICE_FORMAT_R8G8B8A8_SRGB; break;
        case 3: info.arrayLayerCount = 2; break;
        case 4: info.compressionLevel = 4; break;
        case 5: info.pSourceName = "picture.pn"; break;
        case 6: info.sourceSize = 1; break;
        case 7: info.sourceModifiedTimeNs = 1; break;
        case 8: info.settingsHash = 2; break;
        case 9: info.meaning = SLUICE_STORE_MEANING_DATA; break;
        case 10: info.addressModeV = SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_EDGE; break;
        default: info.flags = 0; break;
        }
        SluiceStoreWriter *writer;
        CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
        assert_int_equal(written_count(writer), 0);
        CHECK_OK(write_tiles(writer, &info, PICTURE_SMOOTH, UINT64_MAX));
        sluiceDestroyStoreWriter(writer);
        CHECK_OK(read_store(scratch.path, PICTURE_SMOOTH, NULL));
        scratch_finish(&scratch);
    }
}

static void what_was_there_stays_until_the_new_file_is_finished(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 3);
    CHECK_OK(write_store(&info, PICTURE_NOISE));
    stop_after(&info, 5);
    CHECK_OK(read_store(scratch.path, PICTURE_NOISE, NULL));
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
    scratch_finish(&scratch);
}

static void a_writer_that_may_not_be_resumed_leaves_nothing(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 3);
    info.flags = 0;
    stop_after(&info, 5);
    assert_false(exists(scratch.path));
    assert_false(exists(scratch.part_path));
    scratch_finish(&scratch);
}

static void an_unfinished_file_is_not_read(void **state)
{
    (void)state;
    struct scratch scratch;
    struct messages messages;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 3);
    stop_after(&info, 5);
    CHECK_RESULT(read_store(scratch.part_path, PICTURE_MIXED, &messages),
                 SLUICE_ERROR_CORRUPT_DATA);
    assert_non_null(strstr(messages.last, "never finished"));
    scratch_finish(&scratch);
}

static void a_second_writer_is_refused_until_the_first_is_gone(void **state)
{
    (void)state;
    struct scratch scratch;
    struct messages messages;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 3);
    SluiceStoreWriter *first, *second = NULL;
    CHECK_OK(sluiceCreateStoreWriter(&info, &first));
    CHECK_OK(write_tiles(first, &info, PICTURE_MIXED, 4));
    SluiceStoreCreateInfo other = info;
    other.flags = 0;
    other.log = messages_log(&messages);
    CHECK_RESULT(sluiceCreateStoreWriter(&other, &second), SLUICE_ERROR_BUSY);
    assert_non_null(strstr(messages.last, "another writer"));
    assert_null(second);
    CHECK_OK(write_tiles(first, &info, PICTURE_MIXED, UINT64_MAX)); /* nothing happened to it */
    CHECK_OK(sluiceCreateStoreWriter(
        &other, &second)); /* the finished file has no .sluice-part file any more */
    sluiceDestroyStoreWriter(first);
    sluiceDestroyStoreWriter(second);
    CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
    scratch_finish(&scratch);
}

static void a_tile_cannot_be_written_twice_and_a_file_not_finished_twice(void **state)
{
    (void)state;
    struct scratch scratch;
    struct messages messages;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 3);
    info.log = messages_log(&messages);
    SluiceStoreWriter *writer;
    SluiceStoreLayout layout;
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    CHECK_OK(write_one(writer, &layout, PICTURE_MIXED, 0, 0, 1, 0));
    CHECK_RESULT(write_one(writer, &layout, PICTURE_NOISE, 0, 0, 1, 0),
                 SLUICE_ERROR_INVALID_TILE_STATE);
    uint32_t tail = layout.tailFirstLevel;
    CHECK_OK(write_one(writer, &layout, PICTURE_MIXED, 0, tail, 0, 0));
    CHECK_RESULT(write_one(writer, &layout, PICTURE_MIXED, 0, tail, 0, 0),
                 SLUICE_ERROR_INVALID_TILE_STATE);
    CHECK_RESULT(sluiceFinishStore(writer), SLUICE_ERROR_INVALID_TILE_STATE);
    assert_non_null(strstr(messages.last, "layer 0, level 0, x 0, y 0"));
    CHECK_OK(write_tiles(writer, &info, PICTURE_MIXED, UINT64_MAX));
    CHECK_RESULT(sluiceFinishStore(writer), SLUICE_ERROR_INVALID_TILE_STATE);
    CHECK_RESULT(write_one(writer, &layout, PICTURE_NOISE, 0, 0, 1, 0),
                 SLUICE_ERROR_INVALID_TILE_STATE);
    sluiceDestroyStoreWriter(writer);
    CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_writer_stopped_anywhere_is_resumed_to_the_same_file),
        cmocka_unit_test(a_writer_killed_before_any_call_is_resumed_to_the_same_file),
        cmocka_unit_test(a_writer_killed_again_and_again_gets_there),
        cmocka_unit_test(a_tile_that_is_damaged_meanwhile_is_written_again),
        cmocka_unit_test(other_settings_begin_anew),
        cmocka_unit_test(what_was_there_stays_until_the_new_file_is_finished),
        cmocka_unit_test(a_writer_that_may_not_be_resumed_leaves_nothing),
        cmocka_unit_test(an_unfinished_file_is_not_read),
        cmocka_unit_test(a_second_writer_is_refused_until_the_first_is_gone),
        cmocka_unit_test(a_tile_cannot_be_written_twice_and_a_file_not_finished_twice),
    };
    return RUN_TESTS(tests);
}
