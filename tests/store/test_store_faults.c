/* Failing system calls give an error, and leave the unchanged file or none. */
#define _XOPEN_SOURCE 700

#include "store/fault_io.h"
#include "store/stores.h"
#include "support/test.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static SluiceStoreCreateInfo describe(const struct scratch *scratch, uint32_t compression)
{
    return (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                   .pPath = scratch->path,
                                   .width = 300,
                                   .height = 260,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                   .compressionLevel = compression};
}

static void no_faults(void)
{
    fault_io = (struct fault_io){0};
}

static void interrupted_and_short_calls_make_no_difference(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        struct scratch plain, disturbed;
        scratch_init(&plain);
        scratch_init(&disturbed);
        SluiceStoreCreateInfo info = describe(&plain, compression);
        CHECK_OK(write_store(&info, PICTURE_MIXED));
        info.pPath = disturbed.path;
        fault_io = (struct fault_io){.interrupts = true, .longest = 3001};
        CHECK_OK(write_store(&info, PICTURE_MIXED));
        CHECK_OK(read_store(disturbed.path, PICTURE_MIXED, NULL));
        assert_true(fault_io.count[FAULT_READ] > 50 && fault_io.largest_read == 3001);
        no_faults();
        size_t sizes[2];
        unsigned char *bytes[] = {read_bytes(plain.path, &sizes[0]),
                                  read_bytes(disturbed.path, &sizes[1])};
        assert_int_equal(sizes[0], sizes[1]);
        assert_memory_equal(bytes[0], bytes[1], sizes[0]);
        free(bytes[0]);
        free(bytes[1]);
        scratch_finish(&plain);
        scratch_finish(&disturbed);
    }
}

static void every_read_that_fails_is_an_error_that_is_logged(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 3);
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    bool is_reached = true;
    uint64_t n = 1;
    uint32_t missed_count = 0;
    for (; is_reached; n++) {
        struct messages messages;
        fault_io = (struct fault_io){.fail_at = {[FAULT_READ] = n}, .error = EIO};
        SluiceResult result = read_store(scratch.path, PICTURE_MIXED, &messages);
        is_reached = fault_io.count[FAULT_READ] >= n;
        no_faults();
        /* Without the index no equal tiles are known, but nothing is lost. */
        bool has_failed = is_reached && result != SLUICE_SUCCESS;
        missed_count += is_reached && !has_failed;
        CHECK_RESULT(result, has_failed ? SLUICE_ERROR_IO : SLUICE_SUCCESS);
        assert_int_equal(messages.errors, has_failed);
        if (has_failed) {
            assert_non_null(strstr(messages.last, scratch.path));
            assert_non_null(strstr(messages.last, strerror(EIO)));
        }
    }
    assert_true(n > 10);
    assert_int_equal(missed_count, 1);
    scratch_finish(&scratch);
}

static void a_source_reads_on_after_an_error(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 3);
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = scratch.path};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    unsigned char *texels = malloc(65536);
    SluiceImageRegion region = {0, 0, 0, 128, 128, 0};
    for (uint64_t n = 1; n <= 2; n++) { /* the index, the tile */
        fault_io = (struct fault_io){.fail_at = {[FAULT_READ] = n}, .error = EIO};
        CHECK_RESULT(sluiceReadImageRegion(source, &region, texels, 512), SLUICE_ERROR_IO);
        no_faults();
    }
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, 512));
    assert_true(is_painted(PICTURE_MIXED, info.format, &region, texels, 512));
    free(texels);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
}

/* Fails creation, every write, sealing and publishing in turn. A failure leaves no file, and
 * writing can be resumed. */
static void fail_every_call(enum fault_call call, uint32_t compression, bool writes_half)
{
    struct scratch clean;
    scratch_init(&clean);
    SluiceStoreCreateInfo info = describe(&clean, compression);
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    bool has_failed = true;
    for (uint64_t n = 1; has_failed; n++) {
        struct scratch scratch;
        struct messages messages;
        scratch_init(&scratch);
        info.pPath = scratch.path;
        info.flags = SLUICE_STORE_WRITER_RESUME;
        info.log = messages_log(&messages);
        fault_io =
            (struct fault_io){.error = ENOSPC, .is_lasting = true, .writes_half = writes_half};
        fault_io.fail_at[call] = n;
        SluiceResult result = write_store(&info, PICTURE_MIXED);
        has_failed = fault_io.count[call] >= n;
        no_faults();
        CHECK_RESULT(result, has_failed ? SLUICE_ERROR_IO : SLUICE_SUCCESS);
        assert_true(!has_failed || messages.errors > 0);
        /* when the folder is synced, the name already exists */
        bool is_last_sync = call == FAULT_SYNC && n == 2;
        assert_int_equal(exists(scratch.path), !has_failed || is_last_sync);
        if (has_failed && !is_last_sync)
            CHECK_OK(write_store(&info, PICTURE_MIXED));
        CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
        scratch_finish(&scratch);
    }
    scratch_finish(&clean);
}

static void every_write_that_fails_leaves_no_file_and_can_be_resumed(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        fail_every_call(FAULT_WRITE, compression, false);
        fail_every_call(FAULT_WRITE, compression, true);
    }
}

static void everything_else_that_fails_leaves_no_file_and_can_be_resumed(void **state)
{
    (void)state;
    fail_every_call(FAULT_READ, 3, false);
    fail_every_call(FAULT_SYNC, 3, false);
    fail_every_call(FAULT_RENAME, 3, false);
    fail_every_call(FAULT_CUT, 3, false);
}

static void a_tile_that_found_no_room_can_be_written_when_there_is_some(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        size_t sizes[2];
        unsigned char *bytes[2];
        for (int is_disturbed = 0; is_disturbed < 2; is_disturbed++) {
            struct scratch scratch;
            scratch_init(&scratch);
            SluiceStoreCreateInfo info = describe(&scratch, compression);
            SluiceStoreWriter *writer;
            SluiceStoreLayout layout;
            bool is_written = true;
            CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
            CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
            if (is_disturbed) {
                fault_io = (struct fault_io){
                    .fail_at = {[FAULT_WRITE] = 1}, .error = ENOSPC, .writes_half = true};
                CHECK_RESULT(write_one(writer, &layout, PICTURE_MIXED, 0, 0, 0, 0),
                             SLUICE_ERROR_IO);
                no_faults();
                CHECK_OK(sluiceIsStoreTileWritten(writer, 0, 0, 0, 0, &is_written));
                assert_false(is_written);
            }
            CHECK_OK(write_tiles(writer, &info, PICTURE_MIXED, UINT64_MAX));
            sluiceDestroyStoreWriter(writer);
            bytes[is_disturbed] = read_bytes(scratch.path, &sizes[is_disturbed]);
            scratch_finish(&scratch);
        }
        assert_int_equal(sizes[0], sizes[1]);
        assert_memory_equal(bytes[0], bytes[1], sizes[0]);
        free(bytes[0]);
        free(bytes[1]);
    }
}

/* Uses the system's own limit, not an injected fault. */
static void a_disk_that_is_full_is_an_error(void **state)
{
    (void)state;
    struct rlimit before, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    signal(SIGXFSZ, SIG_IGN);
    for (rlim_t size = 1000; size < 400000; size += 44444) {
        struct scratch scratch;
        scratch_init(&scratch);
        SluiceStoreCreateInfo info = describe(&scratch, 0);
        small.rlim_cur = size;
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
        SluiceResult result = write_store(&info, PICTURE_MIXED);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
        CHECK_RESULT(result, SLUICE_ERROR_IO);
        assert_false(exists(scratch.path));
        assert_false(exists(scratch.part_path));
        scratch_finish(&scratch);
    }
}

static void what_cannot_be_created_is_refused(void **state)
{
    (void)state;
    SluiceStoreWriter *writer = NULL;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 1);
    info.pPath = "/dev/null/a.store";
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_FILE_NOT_FOUND);
    info.pPath = "/tmp/there is no such folder/a.store";
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_FILE_NOT_FOUND);
    info = describe(&scratch, SLUICE_STORE_MAX_COMPRESSION_LEVEL + 1);
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_INVALID_ARGUMENT);
    info = describe(&scratch, 1);
    info.mipLevelCount = 3;
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_INVALID_ARGUMENT);
    info = describe(&scratch, 1);
    info.flags = 2;
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_INVALID_ARGUMENT);
    info = describe(&scratch, 1);
    info.format = SLUICE_FORMAT_UNDEFINED;
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_UNSUPPORTED);
    info.pPath = NULL;
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_NULL_POINTER);
    assert_null(writer);
    scratch_finish(&scratch); /* the folder must be empty */
}

static void what_is_no_tile_is_not_written(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 1);
    struct messages messages = {0};
    const char *line = messages.last;
    info.log = messages_log(&messages);
    SluiceStoreWriter *writer;
    SluiceStoreLayout layout;
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    static const char *const lines[] = {"arrayLayer is 1; it must be from 0 to 0", "tile 3, 0 of",
                                        "tile 0, 3 of level 0: the level has", "mipLevel is 9",
                                        "are the tail"};
    static const char texels[65536];
    const uint32_t bad[][4] = {
        {1, 0, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 3}, {0, 9, 0, 0}, {0, layout.tailFirstLevel, 0, 0}};
    bool is_written;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        CHECK_RESULT(
            sluiceWriteStoreTile(writer, bad[i][0], bad[i][1], bad[i][2], bad[i][3], texels, 512),
            SLUICE_ERROR_INVALID_ARGUMENT);
        assert_non_null(strstr(line, lines[i]));
    }
    CHECK_RESULT(sluiceWriteStoreTile(writer, 0, 0, 0, 0, texels, 511),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_string_equal(line, "rowPitch is 511; it must be at least 512");
    CHECK_RESULT(sluiceWriteStoreTile(writer, 0, 0, 0, 0, NULL, 512), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceIsStoreTileWritten(writer, 0, 9, 0, 0, &is_written),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    const void *levels[SLUICE_STORE_MAX_MIP_LEVELS] = {texels};
    CHECK_RESULT(sluiceWriteStoreTail(writer, 0, levels, NULL), SLUICE_ERROR_NULL_POINTER);
    for (int i = 0; i < SLUICE_STORE_MAX_MIP_LEVELS; i++)
        levels[i] = texels;
    const size_t pitches[SLUICE_STORE_MAX_MIP_LEVELS] = {512, 3};
    CHECK_RESULT(sluiceWriteStoreTail(writer, 0, levels, pitches), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(line, "pRowPitches[1] is 3; it must be at least"));
    CHECK_RESULT(sluiceWriteStoreTail(writer, 1, levels, NULL), SLUICE_ERROR_INVALID_ARGUMENT);
    uint64_t written, total;
    CHECK_OK(sluiceGetStoreProgress(writer, &written, &total));
    assert_int_equal(written, 0);
    sluiceDestroyStoreWriter(writer);
    sluiceDestroyStoreWriter(NULL);
    scratch_finish(&scratch);
}

/* Writes tiles of level 0 in the order of their positions. */
static SluiceResult write_turn(SluiceStoreWriter *writer, uint64_t turn)
{
    static unsigned char texels[65536];
    SluiceStoreLayout layout;
    SluiceImageRegion region;
    uint32_t x = (uint32_t)turn % 3, y = (uint32_t)turn / 3;
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    CHECK_OK(sluiceGetStoreTileRegion(&layout, 0, x, y, &region));
    paint(PICTURE_MIXED, layout.format, &region, texels, 512);
    return sluiceWriteStoreTileInTurn(writer, turn, 0, 0, x, y, texels, 512);
}

/* A tile takes two writes: a chunk and an entry. */
static void a_disk_that_refuses_a_tile_that_waited_is_told_later(void **state)
{
    (void)state;
    for (uint64_t number = 1; number <= 6; number++) {
        struct scratch scratch;
        SluiceStoreWriter *writer;
        scratch_init(&scratch);
        SluiceStoreCreateInfo info = describe(&scratch, 3);
        info.flags = SLUICE_STORE_WRITER_RESUME;
        CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
        CHECK_OK(write_turn(writer, 1));
        CHECK_OK(write_turn(writer, 2));
        fault_io = (struct fault_io){.fail_at[FAULT_WRITE] = number, .error = ENOSPC};
        CHECK_RESULT(write_turn(writer, 0), SLUICE_ERROR_IO);
        no_faults();
        CHECK_RESULT(write_turn(writer, 3), SLUICE_ERROR_IO);
        CHECK_RESULT(sluiceFinishStore(writer), SLUICE_ERROR_IO);
        sluiceDestroyStoreWriter(writer);
        CHECK_OK(write_store(&info, PICTURE_MIXED));
        CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
        scratch_finish(&scratch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(interrupted_and_short_calls_make_no_difference),
        cmocka_unit_test(every_read_that_fails_is_an_error_that_is_logged),
        cmocka_unit_test(a_source_reads_on_after_an_error),
        cmocka_unit_test(every_write_that_fails_leaves_no_file_and_can_be_resumed),
        cmocka_unit_test(everything_else_that_fails_leaves_no_file_and_can_be_resumed),
        cmocka_unit_test(a_tile_that_found_no_room_can_be_written_when_there_is_some),
        cmocka_unit_test(a_disk_that_is_full_is_an_error),
        cmocka_unit_test(what_cannot_be_created_is_refused),
        cmocka_unit_test(what_is_no_tile_is_not_written),
        cmocka_unit_test(a_disk_that_refuses_a_tile_that_waited_is_told_later),
    };
    return RUN_TESTS(tests);
}
