/* Stores tell which of their tiles are equal. */
#include "store/stores.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#define SIZE 1000u
#define TILE 128u
#define CONTENTS 3u
#define EDGE (SIZE / TILE)

/* Most tiles are constant; the others are one of two. */
static uint32_t content_of(uint32_t level, uint32_t x, uint32_t y)
{
    uint32_t number = (x * 3 + y * 5 + level) % 10;
    return number < 2 ? 1 + number : 0;
}

static void write_tiles_of(const SluiceStoreCreateInfo *info, bool all_differ)
{
    static unsigned char texels[TILE * TILE * 4];
    SluiceStoreWriter *writer;
    SluiceStoreLayout layout;
    CHECK_OK(sluiceCreateStoreWriter(info, &writer));
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    for (uint32_t l = 0; l < layout.tailFirstLevel; l++)
        for (uint32_t y = 0; y < layout.levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < layout.levelWidthInTiles[l]; x++) {
                memset(texels, (int)content_of(l, x, y) * 16, sizeof texels);
                if (all_differ)
                    texels[0] = (unsigned char)x, texels[1] = (unsigned char)y,
                    texels[2] = (unsigned char)(1 + l);
                CHECK_OK(sluiceWriteStoreTile(writer, 0, l, x, y, texels, TILE * 4));
            }
    const void *levels[16];
    for (uint32_t i = 0; i < 16; i++)
        levels[i] = texels;
    CHECK_OK(sluiceWriteStoreTail(writer, 0, levels, NULL));
    CHECK_OK(sluiceFinishStore(writer));
    sluiceDestroyStoreWriter(writer);
}

static void write_file(const char *path, uint32_t compression, bool all_differ)
{
    const SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                        .pPath = path,
                                        .width = SIZE,
                                        .height = SIZE,
                                        .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                        .compressionLevel = compression};
    write_tiles_of(&info, all_differ);
}

static SluiceImageSource *open_file(const char *path)
{
    SluiceImageSource *source;
    const SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info, .pPath = path};
    CHECK_OK(sluiceCreateStoreImageSource(&info, &source));
    return source;
}

static SluiceImageRegion region_of(uint32_t level, uint32_t x, uint32_t y)
{
    uint32_t size = SIZE >> level, left = size - x * TILE, below = size - y * TILE;
    return (SluiceImageRegion){.mipLevel = level,
                               .x = x * TILE,
                               .y = y * TILE,
                               .width = left < TILE ? left : TILE,
                               .height = below < TILE ? below : TILE};
}

static uint64_t identity_of(SluiceImageSource *source, const SluiceImageRegion *region)
{
    uint64_t identity = 0;
    bool known = source->pInterface->pfnIdentifyRegion(source, region, &identity);
    assert_int_equal(known, identity != 0);
    return identity;
}

static void tiles_with_equal_texels_have_one_number(void **state)
{
    (void)state;
    struct scratch scratch;
    uint64_t numbers[CONTENTS] = {0};
    scratch_init(&scratch);
    write_file(scratch.path, 3, false);
    SluiceImageSource *source = open_file(scratch.path);
    for (uint32_t level = 0; level < 2; level++)
        for (uint32_t y = 0; y < EDGE >> level; y++)
            for (uint32_t x = 0; x < EDGE >> level; x++) {
                SluiceImageRegion region = region_of(level, x, y);
                uint64_t *number = &numbers[content_of(level, x, y)];
                uint64_t identity = identity_of(source, &region);
                assert_true(identity != 0);
                *number = *number ? *number : identity;
                assert_int_equal(identity, *number);
            }
    for (uint32_t i = 0; i < CONTENTS; i++)
        assert_true(numbers[i] != 0 && numbers[i] != numbers[(i + 1) % CONTENTS]);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
}

static void parts_of_tiles_and_tails_have_no_number(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    write_file(scratch.path, 3, false);
    SluiceImageSource *source = open_file(scratch.path);
    const SluiceImageRegion regions[] = {{0, 0, 0, TILE - 4, TILE, 0},
                                         {0, 4, 0, TILE, TILE, 0},
                                         {0, 0, 0, 2 * TILE, TILE, 0},
                                         {5, 0, 0, SIZE >> 5, SIZE >> 5, 0}};
    for (uint32_t i = 0; i < 4; i++)
        assert_int_equal(identity_of(source, &regions[i]), 0);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
}

static void stores_without_equal_tiles_have_no_numbers(void **state)
{
    (void)state;
    const SluiceImageRegion first = region_of(0, 0, 0);
    for (uint32_t i = 0; i < 2; i++) {
        struct scratch scratch;
        scratch_init(&scratch);
        write_file(scratch.path, i ? 3 : 0, i); /* uncompressed files keep every tile */
        SluiceImageSource *source = open_file(scratch.path);
        assert_int_equal(identity_of(source, &first), 0);
        sluiceDestroyImageSource(source);
        scratch_finish(&scratch);
    }
}

static void a_damaged_index_has_no_numbers(void **state)
{
    (void)state;
    struct scratch scratch;
    const SluiceImageRegion first = region_of(0, 0, 0);
    scratch_init(&scratch);
    write_file(scratch.path, 3, false);
    size_t size;
    unsigned char *bytes = read_bytes(scratch.path, &size);
    bytes[4096 + 20] ^= 1;
    write_bytes(scratch.path, bytes, size);
    free(bytes);
    SluiceImageSource *source = open_file(scratch.path);
    assert_int_equal(identity_of(source, &first), 0);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
}

struct unreadable {
    unsigned char *bytes;
    size_t size;
};

/* Block 0 of the index cannot be read. */
static SluiceResult read_unreadable(void *user, uint64_t offset, void *bytes, size_t size)
{
    const struct unreadable *file = user;
    if (offset < 8192 && offset + size > 4096)
        return SLUICE_ERROR_IO;
    memcpy(bytes, file->bytes + offset, size);
    return SLUICE_SUCCESS;
}

static void a_store_with_an_unreadable_index_block_opens_without_numbers(void **state)
{
    (void)state;
    struct scratch scratch;
    struct unreadable file;
    SluiceImageSource *source;
    scratch_init(&scratch);
    write_file(scratch.path, 3, false);
    file.bytes = read_bytes(scratch.path, &file.size);
    const SluiceInput input = {.structSize = sizeof input,
                               .size = file.size,
                               .pUserData = &file,
                               .pfnRead = read_unreadable};
    const SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info, .pInput = &input};
    CHECK_OK(sluiceCreateStoreImageSource(&info, &source));
    SluiceImageRegion region = region_of(0, 0, 0);
    assert_int_equal(identity_of(source, &region), 0);
    sluiceDestroyImageSource(source);
    free(file.bytes);
    scratch_finish(&scratch);
}

static void without_memory_tiles_have_no_number(void **state)
{
    (void)state;
    struct scratch scratch;
    const SluiceImageRegion first = region_of(0, 0, 0);
    uint32_t opened = 0, known = 0;
    scratch_init(&scratch);
    write_file(scratch.path, 3, false);
    for (uint64_t n = 0; known == 0; n++) {
        struct failing_allocator memory;
        failing_allocator_init(&memory, n);
        const SluiceStoreImageSourceCreateInfo info = {
            .structSize = sizeof info, .pPath = scratch.path, .pAllocator = &memory.callbacks};
        SluiceImageSource *source;
        SluiceResult result = sluiceCreateStoreImageSource(&info, &source);
        if (result == SLUICE_SUCCESS) {
            opened++;
            known += identity_of(source, &first) != 0;
            sluiceDestroyImageSource(source);
        } else {
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        }
        assert_int_equal(memory.live_bytes, 0);
    }
    assert_in_range(opened, 2, 8);
    scratch_finish(&scratch);
}

static void wrapped_stores_tell_what_the_stores_know(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    write_file(scratch.path, 3, false);
    SluiceImageSource *layers[] = {open_file(scratch.path), open_file(scratch.path)};
    SluiceImageSource *array, *complete;
    CHECK_OK(sluiceCreateArrayImageSource(layers, 2, NULL, &array));
    const SluiceCompleteChainSourceCreateInfo info = {.structSize = sizeof info, .source = array};
    CHECK_OK(sluiceCreateCompleteChainSource(&info, &complete));
    SluiceImageInfo image = {.structSize = sizeof image};
    SluiceImageRegion first = region_of(0, 2, 0), second = region_of(0, 4, 0), other = first;
    assert_int_equal(content_of(0, 2, 0), content_of(0, 4, 0));
    other.arrayLayer = 1;
    assert_int_equal(identity_of(complete, &first), 0); /* it was not opened */
    CHECK_OK(sluiceGetImageInfo(complete, &image));
    assert_int_equal(identity_of(complete, &first), identity_of(layers[0], &first));
    assert_int_equal(identity_of(complete, &first), identity_of(complete, &second));
    assert_int_not_equal(identity_of(complete, &first), identity_of(complete, &other));
    sluiceDestroyImageSource(complete);
    sluiceDestroyImageSource(array);
    sluiceDestroyImageSource(layers[0]);
    sluiceDestroyImageSource(layers[1]);
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_with_equal_texels_have_one_number),
        cmocka_unit_test(parts_of_tiles_and_tails_have_no_number),
        cmocka_unit_test(stores_without_equal_tiles_have_no_numbers),
        cmocka_unit_test(a_damaged_index_has_no_numbers),
        cmocka_unit_test(a_store_with_an_unreadable_index_block_opens_without_numbers),
        cmocka_unit_test(without_memory_tiles_have_no_number),
        cmocka_unit_test(wrapped_stores_tell_what_the_stores_know),
    };
    return RUN_TESTS(tests);
}
