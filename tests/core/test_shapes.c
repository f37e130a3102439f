/* Textures with equal descriptions share derived data. The number of descriptions is unlimited. */
#include "core/fixture.h"
#include "core/same_desc.h"

#include <string.h>

enum { SHAPES = 4000, SHAPES_PER_ROW = 100 }; /* about 16 per entry of the table */

static SluiceStreamedTextureDesc desc_of(uint32_t number)
{
    return full_chain(1 + number % SHAPES_PER_ROW, 1 + number / SHAPES_PER_ROW, 16, 16);
}

static void check_layout(const struct fixture *f, SluiceTextureId id, uint32_t number)
{
    SluiceStreamedTextureDesc desc = desc_of(number);
    SluiceStreamedTextureLayout expected = {.structSize = sizeof expected},
                                layout = fixture_layout(f, id);
    CHECK_OK(sluiceGetStreamedTextureLayout(&desc, &expected));
    assert_true(same_desc(&layout.desc, &expected.desc));
    assert_int_equal(layout.tileCount, expected.tileCount);
    for (uint32_t l = 0; l < desc.regularMipCount; l++)
        assert_int_equal(layout.levelFirstTile[l], expected.levelFirstTile[l]);
}

/* Returns the order of removal: oldest first, newest first, or from the middle outwards. */
static uint32_t nth_to_go(uint32_t order, uint32_t n)
{
    uint32_t side = n % 2 ? SHAPES - 1 - n / 2 : n / 2;
    return order == 0 ? n : order == 1 ? SHAPES - 1 - n : (side + SHAPES / 2) % SHAPES;
}

static void every_texture_keeps_its_layout_whoever_comes_and_goes(void **state)
{
    (void)state;
    static SluiceTextureId ids[2][SHAPES];
    for (uint32_t order = 0; order < 3; order++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        for (uint32_t i = 0; i < 2 * SHAPES; i++) {
            SluiceStreamedTextureDesc desc = desc_of(i % SHAPES);
            ids[i / SHAPES][i % SHAPES] = fixture_add(&f, &desc);
        }
        for (uint32_t n = 0; n < SHAPES; n++) {
            uint32_t i = nth_to_go(order, n), other = nth_to_go(order, SHAPES - 1 - n);
            CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[0][i], 0));
            check_layout(&f, ids[1][i], i);
            check_layout(&f, ids[1][other], other);
        }
        for (uint32_t n = 0; n < SHAPES; n++) {
            uint32_t i = nth_to_go((order + 1) % 3, n);
            CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1][i], 0));
        }
        fixture_close(&f);
    }
}

static void a_second_texture_of_a_description_takes_no_memory_for_it(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceStreamedTextureDesc desc = full_chain(1000, 600, 128, 128), changed[10];
    fixture_add(&f, &desc);
    uint64_t one = f.memory.live_bytes;
    desc.feedbackRegionWidth = desc.feedbackRegionHeight = 128; /* the default for 0 */
    fixture_add(&f, &desc);
    const uint64_t packed = sizeof(uint32_t);
    assert_int_equal(f.memory.live_bytes, one + packed);
    for (uint32_t i = 0; i < 10; i++) /* one member is another one */
        changed[i] = desc;
    changed[0].width++;
    changed[1].height++;
    changed[2].mipLevelCount--;
    changed[3].regularMipCount--;
    changed[4].packedTileCount++;
    changed[5].tileWidth++;
    changed[6].tileHeight++;
    changed[7].feedbackRegionWidth++;
    changed[8].feedbackRegionHeight++;
    changed[9].packedTilesOutside = true;
    for (uint32_t i = 0; i < 10; i++) {
        uint64_t before = f.memory.live_bytes;
        SluiceStreamedTextureLayout layout = fixture_layout(&f, fixture_add(&f, &changed[i]));
        assert_true(same_desc(&layout.desc, &changed[i]));
        assert_true(f.memory.live_bytes > before + changed[i].packedTileCount * packed);
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texture_keeps_its_layout_whoever_comes_and_goes),
        cmocka_unit_test(a_second_texture_of_a_description_takes_no_memory_for_it),
    };
    return RUN_TESTS(tests);
}
