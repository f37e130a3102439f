/* Chunks with equal hashes share their bytes in the file if the bytes are equal, too. */
#define _POSIX_C_SOURCE 200809L

#include "store/repeats.h"
#include "store/store_writer.h"

#include "store/naive_store.h"
#include "store/stores.h"
#include "support/test.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OFFSET = 77, SIZE = 10000 };

static void one_byte_anywhere_makes_chunks_differ(void **state)
{
    (void)state;
    static const uint32_t places[] = {0, 1, 4095, 4096, 8191, 8192, SIZE - 1};
    static unsigned char bytes[OFFSET + SIZE];
    struct scratch scratch;
    struct messages messages = {0};
    scratch_init(&scratch);
    for (uint32_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char)(i * i >> 3);
    write_bytes(scratch.path, bytes, sizeof bytes);
    struct slc_store_file file = {.log = messages_log(&messages),
                                  .path = scratch.path,
                                  .descriptor = open(scratch.path, O_RDONLY)};
    const struct slc_store_repeat repeat = {.offset = OFFSET, .size = SIZE};
    assert_true(slc_store_repeat_is_equal(&file, &repeat, bytes + OFFSET));
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        bytes[OFFSET + places[i]] ^= 1;
        assert_false(slc_store_repeat_is_equal(&file, &repeat, bytes + OFFSET));
        bytes[OFFSET + places[i]] ^= 1;
    }
    assert_int_equal(messages.errors, 0);
    const struct slc_store_repeat beyond = {.offset = OFFSET + 1, .size = SIZE};
    assert_false(slc_store_repeat_is_equal(&file, &beyond, bytes + OFFSET));
    close(file.descriptor);
    scratch_finish(&scratch);
}

/* The only chunk that a writer has noted. */
static struct slc_store_repeat *noted(SluiceStoreWriter *writer)
{
    struct slc_store_repeat *found = NULL;
    for (uint32_t i = 0; i < SLC_STORE_REPEATS; i++)
        if (writer->repeats->at[i].size > 0) {
            assert_null(found);
            found = &writer->repeats->at[i];
        }
    assert_non_null(found);
    return found;
}

static void begin(const char *path, const void *texels, SluiceStoreWriter **writer)
{
    const SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                        .pPath = path,
                                        .width = 256,
                                        .height = 128,
                                        .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                        .compressionLevel = 3};
    CHECK_OK(sluiceCreateStoreWriter(&info, writer));
    CHECK_OK(sluiceWriteStoreTile(*writer, 0, 0, 0, 0, texels, 512));
}

/* A second writer tells the hash of the second tile; the first is made to find its own tile there.
 */
static void tiles_whose_hashes_collide_keep_their_own_bytes(void **state)
{
    (void)state;
    static unsigned char tiles[2][65536], tail[65536], got[2 * 65536];
    const SluiceImageRegion all = {.width = 256, .height = 128};
    struct scratch scratch, other;
    SluiceStoreWriter *writer, *teller;
    struct naive_store store;
    const void *levels[16];
    scratch_init(&scratch);
    scratch_init(&other);
    paint(PICTURE_NOISE, SLUICE_FORMAT_R8G8B8A8_UNORM, &all, got, 1024);
    memcpy(tiles, got, sizeof tiles);
    begin(scratch.path, tiles[0], &writer);
    begin(other.path, tiles[1], &teller);
    struct slc_store_repeat planted = *noted(teller);
    assert_int_equal(planted.size, noted(writer)->size);
    planted.offset = noted(writer)->offset;
    slc_store_repeats_add(writer->repeats, &planted);
    CHECK_OK(sluiceWriteStoreTile(writer, 0, 0, 1, 0, tiles[1], 512));
    for (uint32_t i = 0; i < 16; i++)
        levels[i] = tail;
    CHECK_OK(sluiceWriteStoreTail(writer, 0, levels, NULL));
    CHECK_OK(sluiceFinishStore(writer));
    assert_null(naive_store_load(&store, scratch.path));
    assert_null(naive_store_level(&store, 0, 0, got));
    for (uint32_t y = 0; y < 128; y++)
        for (uint32_t x = 0; x < 2; x++)
            assert_memory_equal(got + y * 1024 + x * 512, tiles[x] + y * 512, 512);
    naive_store_finish(&store);
    sluiceDestroyStoreWriter(writer);
    sluiceDestroyStoreWriter(teller);
    scratch_finish(&scratch);
    scratch_finish(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_byte_anywhere_makes_chunks_differ),
        cmocka_unit_test(tiles_whose_hashes_collide_keep_their_own_bytes),
    };
    return RUN_TESTS(tests);
}
