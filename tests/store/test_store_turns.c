/* Threads that write tiles in turn write the file of one thread. */
#define _POSIX_C_SOURCE 200809L

#include "store/stores.h"
#include "support/test.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 8 * 128, HEIGHT = 6 * 128, KINDS = 9, THREADS = 5, TILE = 65536 };

static SluiceStoreCreateInfo describe(const struct scratch *scratch, uint32_t flags)
{
    return (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                   .pPath = scratch->path,
                                   .width = WIDTH,
                                   .height = HEIGHT,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                   .compressionLevel = 3,
                                   .flags = flags};
}

/* Few kinds of tiles, so that many have equal bytes; every third kind does not shrink. */
static void fill(uint64_t turn, unsigned char texels[TILE])
{
    uint32_t kind = (uint32_t)(turn * turn % KINDS), random = kind;
    for (uint32_t i = 0; i < TILE; i++) {
        random = random * 1664525u + 1013904223u;
        texels[i] = kind % 3 ? (unsigned char)(i * kind >> 9) : (unsigned char)(random >> 24);
    }
}

struct tile {
    uint32_t level, x, y;
};

/* Tiles by turn. Returns how many there are. */
static uint64_t find_tile(const SluiceStoreLayout *layout, uint64_t turn, struct tile *tile)
{
    uint64_t number = 0;
    for (uint32_t l = 0; l < layout->tailFirstLevel; l++)
        for (uint32_t y = 0; y < layout->levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < layout->levelWidthInTiles[l]; x++)
                if (number++ == turn)
                    *tile = (struct tile){l, x, y};
    return number;
}

static SluiceResult write_turn(SluiceStoreWriter *writer, uint64_t turn, bool skips_what_is_there)
{
    SluiceStoreLayout layout;
    struct tile tile = {0};
    bool found = false;
    unsigned char *texels = malloc(TILE);
    assert_non_null(texels);
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    assert_true(turn < find_tile(&layout, turn, &tile));
    if (skips_what_is_there)
        CHECK_OK(sluiceIsStoreTileWritten(writer, 0, tile.level, tile.x, tile.y, &found));
    fill(turn, texels);
    SluiceResult result = sluiceWriteStoreTileInTurn(writer, turn, 0, tile.level, tile.x, tile.y,
                                                     found ? NULL : texels, 512);
    free(texels);
    return result;
}

static void finish(SluiceStoreWriter *writer)
{
    static const unsigned char tail[TILE];
    const void *levels[16];
    for (uint32_t i = 0; i < 16; i++)
        levels[i] = tail;
    CHECK_OK(sluiceWriteStoreTail(writer, 0, levels, NULL));
    CHECK_OK(sluiceFinishStore(writer));
    sluiceDestroyStoreWriter(writer);
}

struct work {
    SluiceStoreWriter *writer;
    uint64_t count;
    bool skips;
    atomic_uint_least64_t next;
    atomic_uint failures;
};

/* The delays make early turns end late. */
static void *write_some(void *argument)
{
    struct work *work = argument;
    for (uint64_t turn; (turn = atomic_fetch_add(&work->next, 1)) < work->count;) {
        struct timespec delay = {0, turn % 4 == 0 ? 2000000 : 0};
        nanosleep(&delay, NULL);
        if (write_turn(work->writer, turn, work->skips) != SLUICE_SUCCESS)
            atomic_fetch_add(&work->failures, 1);
    }
    return NULL;
}

/* Turns 0 to `count`, then ends the store if `ends`. */
static void write_by_threads(const struct scratch *scratch, uint32_t flags, uint32_t threads,
                             uint64_t count, bool ends)
{
    SluiceStoreCreateInfo info = describe(scratch, flags);
    struct work work = {.count = count, .skips = flags != 0};
    pthread_t running[THREADS];
    CHECK_OK(sluiceCreateStoreWriter(&info, &work.writer));
    for (uint32_t i = 0; i < threads; i++)
        assert_int_equal(pthread_create(&running[i], NULL, write_some, &work), 0);
    for (uint32_t i = 0; i < threads; i++)
        pthread_join(running[i], NULL);
    assert_int_equal(work.failures, 0);
    if (ends)
        finish(work.writer);
    else
        sluiceDestroyStoreWriter(work.writer);
}

static uint64_t count_tiles(void)
{
    SluiceStoreLayout layout;
    struct tile tile = {0};
    CHECK_OK(sluiceGetStoreLayout(WIDTH, HEIGHT, SLUICE_FORMAT_R8G8B8A8_UNORM, &layout));
    return find_tile(&layout, UINT64_MAX, &tile);
}

static void assert_same_files(const struct scratch *a, const struct scratch *b)
{
    size_t sizes[2];
    unsigned char *bytes[] = {read_bytes(a->path, &sizes[0]), read_bytes(b->path, &sizes[1])};
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    free(bytes[0]);
    free(bytes[1]);
}

static void any_number_of_threads_writes_the_same_bytes(void **state)
{
    (void)state;
    struct scratch plain;
    scratch_init(&plain);
    write_by_threads(&plain, 0, 1, count_tiles(), true);
    for (uint32_t threads = 2; threads <= THREADS; threads++) {
        struct scratch scratch;
        scratch_init(&scratch);
        write_by_threads(&scratch, 0, threads, count_tiles(), true);
        assert_same_files(&plain, &scratch);
        scratch_finish(&scratch);
    }
    scratch_finish(&plain);
}

/* Equal tiles lie on both sides of every interruption. */
static void interrupted_writers_write_the_bytes_of_one(void **state)
{
    (void)state;
    struct scratch plain;
    scratch_init(&plain);
    write_by_threads(&plain, 0, 1, count_tiles(), true);
    for (uint64_t cut = 1; cut < count_tiles(); cut += 7) {
        struct scratch scratch;
        scratch_init(&scratch);
        write_by_threads(&scratch, SLUICE_STORE_WRITER_RESUME, THREADS, cut, false);
        write_by_threads(&scratch, SLUICE_STORE_WRITER_RESUME, THREADS, count_tiles(), true);
        assert_same_files(&plain, &scratch);
        scratch_finish(&scratch);
    }
    scratch_finish(&plain);
}

static void a_refused_tile_ends_its_turn(void **state)
{
    (void)state;
    static const unsigned char texels[TILE];
    struct scratch scratch;
    struct messages messages = {0};
    SluiceStoreWriter *writer;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 0);
    info.log = messages_log(&messages);
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    CHECK_OK(write_turn(writer, 2, false)); /* waits */
    CHECK_RESULT(sluiceWriteStoreTileInTurn(writer, 0, 0, 0, 99, 0, texels, 512),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceWriteStoreTileInTurn(writer, 1, 0, 0, 0, 0, texels, 511),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    uint64_t written, all;
    CHECK_OK(sluiceGetStoreProgress(writer, &written, &all));
    assert_int_equal(written, 1);
    CHECK_RESULT(sluiceWriteStoreTileInTurn(writer, 2, 0, 0, 0, 0, texels, 512),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(messages.last, "turn is 2; all turns before 3 have ended"));
    sluiceDestroyStoreWriter(writer);
    scratch_finish(&scratch);
}

static void tiles_that_wait_for_ever_are_missing(void **state)
{
    (void)state;
    struct scratch scratch;
    SluiceStoreWriter *writer;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, 0);
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    for (uint64_t turn = 1; turn <= 16; turn++)
        CHECK_OK(write_turn(writer, turn, false));
    CHECK_RESULT(sluiceFinishStore(writer), SLUICE_ERROR_INVALID_TILE_STATE);
    CHECK_OK(sluiceWriteStoreTileInTurn(writer, 0, 0, 0, 0, 0, NULL, 0));
    uint64_t written, all;
    CHECK_OK(sluiceGetStoreProgress(writer, &written, &all));
    assert_int_equal(written, 16);
    CHECK_OK(write_turn(writer, 30, false)); /* the writer frees it */
    sluiceDestroyStoreWriter(writer);
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_threads_writes_the_same_bytes),
        cmocka_unit_test(interrupted_writers_write_the_bytes_of_one),
        cmocka_unit_test(a_refused_tile_ends_its_turn),
        cmocka_unit_test(tiles_that_wait_for_ever_are_missing),
    };
    return RUN_TESTS(tests);
}
