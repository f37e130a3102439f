/** Smallest and largest values of a description. */
#include "core/fixture.h"

#include "core/check.h"

#include <stdlib.h>
#include <string.h>

static void check_sound(const struct fixture *f)
{
    const char *wrong = slc_manager_check(f->manager);
    assert_string_equal(wrong ? wrong : "", "");
}

static SluiceStreamedTextureDesc shape(uint32_t width, uint32_t height, uint32_t regular,
                                       uint32_t tile, uint32_t region)
{
    SluiceStreamedTextureDesc d = full_chain(width, height, 1, 1);
    d.regularMipCount = regular < d.mipLevelCount ? regular : d.mipLevelCount;
    d.packedTileCount = d.regularMipCount < d.mipLevelCount;
    d.tileWidth = d.tileHeight = tile;
    d.feedbackRegionWidth = d.feedbackRegionHeight = region;
    return d;
}

/* A region of 2^32 tiles or more along each axis has a product beyond 64 bits. */
static void a_region_may_be_any_number_of_tiles_large(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {UINT32_MAX, UINT32_MAX - 1, 1u << 31, 3u << 30, 1u << 20};
    for (uint32_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct fixture f;
        fixture_open(&f, 256, false);
        SluiceStreamedTextureDesc d = shape(128, 128, 8, 1, sizes[i]);
        SluiceTextureId id = fixture_add(&f, &d);
        fixture_feed(&f, id, 0, 1, 10);
        check_sound(&f);
        SluiceStreamedTextureLayout layout = fixture_layout(&f, id);
        assert_int_equal(fixture_statistics(&f).requestedTileCount, layout.tileCount);
        fixture_close(&f);
    }
}

/* Loads the requests of random maps, with too few slots. Each state ends by removal at least
 * once. */
static void stream(struct fixture *f, SluiceTextureId id, SluiceTextureId follower, uint64_t begin,
                   uint64_t *random)
{
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    size_t size = (size_t)layout.feedbackWidth * layout.feedbackHeight;
    uint8_t *map = malloc(size);
    assert_non_null(map);
    for (uint64_t frame = begin; frame < begin + 11; frame++) {
        for (size_t i = 0; i < size; i++)
            map[i] = next_random(random) % 3 ? (uint8_t)(next_random(random) % 22) : 255;
        fixture_feed_map(f, id, frame % 5 ? map : memset(map, 255, size), frame, frame % 4);
        CHECK_OK(sluiceMatchPrimaryTexture(f->manager, id, follower, frame, 3));
        fixture_to_unmap(f, SLUICE_ALL_TEXTURES, frame);
        CHECK_OK(sluiceCompleteRetireValue(f->manager, frame - 1));
        fixture_to_map(f, frame % 3 ? SLUICE_ALL_TEXTURES : id);
        if (frame % 4)
            fixture_answer_mapped(f);
        check_sound(f);
    }
    free(map);
}

static void every_shape_streams(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1},   {1u << 20, 1}, {1, 1u << 20}, {17, 1},
                                        {15, 33}, {16, 16},      {255, 3},      {1u << 12, 5}};
    static const uint32_t tiles[] = {1, 3, 16, 1u << 20, UINT32_MAX};
    static const uint32_t regions[] = {0, 1, 2, 7, 1u << 20, UINT32_MAX};
    uint64_t random = 7;
    for (uint32_t i = 0; i < 8 * 5 * 6 * 4; i++) {
        const uint32_t *size = sizes[i % 8];
        static const uint32_t levels[] = {0, 1, 5, 21};
        uint32_t tile = tiles[i / 8 % 5], region = regions[i / 40 % 6];
        if (size[0] * (uint64_t)size[1] > 1u << 16 && (tile < 16 || (region && region < 16)))
            continue; /* covered by smaller sizes; slow */
        struct fixture f;
        fixture_open(&f, 8, i % 2);
        SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                     .numExtraStandbyTiles = i % 5,
                                                     .maxHeapCount = 1 + i % 3,
                                                     .prefetchLevels = i % 7};
        CHECK_OK(sluiceSetConfig(f.manager, &config));
        SluiceStreamedTextureDesc d = shape(size[0], size[1], levels[i / 240 % 4], tile, region);
        SluiceStreamedTextureDesc other = shape(65, 31, 3, 4, 3);
        SluiceTextureId id = fixture_add(&f, &d), follower = fixture_add(&f, &other);
        stream(&f, id, follower, 1, &random);
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, i % 3 ? id : follower, 20));
        check_sound(&f);
        stream(&f, i % 3 ? follower : id, fixture_add(&f, &other), 21, &random);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_region_may_be_any_number_of_tiles_large),
        cmocka_unit_test(every_shape_streams),
    };
    return RUN_TESTS(tests);
}
