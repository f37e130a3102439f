/* The largest numbers of textures, tiles and texels. Invisible ones must cost nothing. */
#include "core/sound.h"
#include "extremes/note.h"

#include <stdlib.h>

static bool is_long_run;

/* Limit of bytes for a texture of which nothing was ever wanted. docs/limits.md promises it. */
enum { IDLE_BOUND = 256 };

/* Limits for visible textures, by tile and by feedback region. */
enum { BYTES_PER_TILE = 8, BYTES_PER_REGION = 72 };

enum { MANY = 100000, SEEN = 200, FRAMES = 60 };

/* A texture of 1365 tiles and packed ones. */
static SluiceStreamedTextureDesc large(void)
{
    return full_chain(4096, 4096, 128, 128);
}

static uint64_t mix(uint64_t h, uint64_t value)
{
    h = (h ^ value) * 0x9E3779B97F4A7C15u;
    return h ^ h >> 29;
}

/* Moves a camera past the first textures, ten at a time. Returns a hash of all results. */
static uint64_t pass_by(struct fixture *f, const SluiceTextureId *ids)
{
    uint64_t h = 1, random = 3;
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        for (uint32_t i = 0; i < 10; i++)
            fixture_feed_region(f, ids[(frame * 3 + i) % SEEN], next_random(&random) % 1024, i % 6,
                                frame, 8);
        CHECK_OK(fixture_to_unmap(f, SLUICE_ALL_TEXTURES, 0));
        for (uint32_t i = 0; i < f->count; i++)
            h = mix(h, f->tiles[i].textureId ^ f->tiles[i].tileIndex);
        assert_true(fixture_to_map(f, SLUICE_ALL_TEXTURES) >= 0);
        for (uint32_t i = 0; i < f->count; i++)
            h = mix(h, (f->tiles[i].textureId ^ f->tiles[i].tileIndex) + f->tiles[i].slot);
        fixture_answer_mapped(f);
    }
    return h;
}

struct cost {
    uint64_t hash, calls, bytes;  ///< due to the camera: decisions, allocations, additional bytes
    uint64_t idle_bytes, virtual; ///< before the camera: bytes, tiles
};

static struct cost cost_of(uint32_t count)
{
    static struct fixture f;
    struct cost cost = {0};
    SluiceStreamedTextureDesc desc = large();
    SluiceTextureId *ids = malloc(count * sizeof *ids);
    assert_non_null(ids);
    fixture_open(&f, 64, false);
    for (uint32_t i = 0; i < count; i++)
        ids[i] = fixture_add(&f, &desc);
    cost.idle_bytes = fixture_statistics(&f).hostMemorySize;
    cost.virtual = fixture_statistics(&f).tileCount;
    cost.calls = f.memory.calls;
    cost.hash = pass_by(&f, ids);
    cost.calls = f.memory.calls - cost.calls;
    assert_true(fixture_statistics(&f).hostMemorySize == f.memory.live_bytes);
    cost.bytes = f.memory.live_bytes - cost.idle_bytes;
    fixture_close(&f);
    free(ids);
    return cost;
}

/* Compares with the camera in a manager without other textures. */
static void a_hundred_million_tiles_out_of_sight_change_nothing(void **state)
{
    (void)state;
    struct cost few = cost_of(SEEN), many = cost_of(MANY);
    assert_true(many.virtual >= 100000000);
    assert_true(many.hash == few.hash);
    assert_int_equal(many.calls, few.calls);
    assert_int_equal(many.bytes, few.bytes);
    note("tiles out of sight: bytes per texture", many.virtual, (double)many.idle_bytes / MANY,
         IDLE_BOUND);
    assert_true(many.idle_bytes <= (uint64_t)MANY * IDLE_BOUND);
}

static void a_hundred_thousand_textures_come_and_go_in_the_same_memory(void **state)
{
    (void)state;
    static struct fixture f;
    static SluiceTextureId ids[MANY];
    SluiceStreamedTextureDesc desc = large();
    uint64_t peak = 0, random = 5;
    fixture_open(&f, 64, false);
    for (uint32_t round = 0; round < 3; round++) {
        for (uint32_t i = 0; i < MANY; i++)
            ids[i] = fixture_add(&f, &desc);
        assert_int_equal((uint32_t)ids[MANY - 1], MANY - 1); /* dense */
        if (round == 0)
            peak = f.memory.live_bytes;
        assert_true(f.memory.live_bytes <= peak);
        for (uint32_t i = MANY; i > 0; i--) { /* in any order */
            uint32_t other = next_random(&random) % i;
            CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[other], 0));
            ids[other] = ids[i - 1];
        }
        assert_int_equal(fixture_statistics(&f).textureCount, 0);
        assert_int_equal(fixture_statistics(&f).tileCount, 0);
    }
    note("textures that come and go: bytes at most", 3 * MANY, (double)f.memory.live_bytes,
         (double)peak);
    assert_true(f.memory.live_bytes <= peak);
    fixture_close(&f);
}

/* Sizes around rounding borders and around 16, 20 and 31 bits. */
static const uint32_t sizes[] = {1,     2,     3,     127,   128,   129,    255,     16381,  16384,
                                 20011, 32749, 32768, 65536, 65537, 131071, 1048573, 1048576};
enum { SIZE_COUNT = sizeof sizes / sizeof sizes[0] };

/* Counts by definition, level by level. */
static uint64_t count_tiles(const SluiceStreamedTextureDesc *d)
{
    uint64_t count = d->packedTileCount, width = d->width, height = d->height;
    for (uint32_t level = 0; level < d->regularMipCount; level++) {
        count += ((width + d->tileWidth - 1) / d->tileWidth) *
                 ((height + d->tileHeight - 1) / d->tileHeight);
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
    }
    return count;
}

/* Streams the last tile of level 0: only this tile, its parents and packed tiles may load. */
static void stream_last_tile(struct fixture *f, const SluiceStreamedTextureDesc *desc)
{
    SluiceTextureId id = fixture_add(f, desc);
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    fixture_feed_region(f, id, layout.feedbackWidth * layout.feedbackHeight - 1, 0, 1, 10);
    fixture_load(f);
    uint8_t texel = 0;
    SluiceMinMipRect rect = {id, layout.minMipWidth - 1, layout.minMipHeight - 1, 1, 1};
    CHECK_OK(sluiceWriteMinMipRect(f->manager, &rect, 1, 1, &texel));
    assert_int_equal(texel, 0);
    assert_true(fixture_statistics(f).mappedTileCount >=
                desc->regularMipCount + desc->packedTileCount);
    assert_true(fixture_statistics(f).requestedTileCount == 0);
    CHECK_SOUND(f);
    CHECK_OK(sluiceRemoveStreamedTexture(f->manager, id, 0));
}

/* Limits feedback to 64 x 64 regions, and the nodes of a texture to a few megabytes. */
static uint32_t try_size(struct fixture *f, uint32_t width, uint32_t height, uint32_t tile)
{
    SluiceStreamedTextureDesc desc = full_chain(width, height, tile, tile);
    SluiceTextureId id;
    uint64_t expected = count_tiles(&desc);
    desc.feedbackRegionWidth = width / 64 > tile ? width / 64 : 0;
    desc.feedbackRegionHeight = desc.feedbackRegionWidth ? height / 64 + 1 : 0;
    SluiceResult result = sluiceAddStreamedTexture(f->manager, &desc, &id);
    if (expected > SLUICE_MAX_TILES_PER_TEXTURE) {
        CHECK_RESULT(result, SLUICE_ERROR_LIMIT_EXCEEDED);
        return 0;
    }
    CHECK_OK(result);
    assert_int_equal(fixture_layout(f, id).tileCount, expected);
    CHECK_OK(sluiceRemoveStreamedTexture(f->manager, id, 0));
    if (expected > (is_long_run ? 1u << 27 : 1u << 20) || desc.feedbackRegionWidth > tile * 16 ||
        desc.feedbackRegionHeight > tile * 16)
        return 0;
    stream_last_tile(f, &desc);
    return 1;
}

static void every_size_has_the_tiles_that_it_should_and_shows_its_last_one(void **state)
{
    (void)state;
    static const uint32_t tiles[] = {16, 64, 128, 256, 512};
    static struct fixture f;
    uint32_t cases = 0, streamed = 0;
    fixture_open(&f, 64, false);
    for (uint32_t t = 0; t < 5; t++)
        for (uint32_t w = 0; w < SIZE_COUNT; w++)
            for (uint32_t h = 0; h < SIZE_COUNT; h++, cases++)
                streamed += try_size(&f, sizes[w], sizes[h], tiles[t]);
    note("sizes of textures: streamed ones of those that fit", cases, streamed, cases);
    assert_true(streamed > cases / 4);
    fixture_close(&f);
}

/* The largest texture, with tiles of 8 bits: 22 million tiles, of which 21 are visible. */
static void the_largest_texture_is_streamed_to_a_texel_of_its_last_level(void **state)
{
    (void)state;
    static struct fixture f;
    fixture_open(&f, 64, false);
    uint32_t tile = is_long_run ? 128 : 256;
    SluiceStreamedTextureDesc desc = full_chain(1u << 20, 1u << 20, tile, tile);
    desc.feedbackRegionWidth = desc.feedbackRegionHeight = 1u << 10;
    SluiceTextureId id = fixture_add(&f, &desc);
    uint64_t idle = f.memory.live_bytes;
    fixture_feed_region(&f, id, (1u << 20) - 1, 0, 1, 10);
    fixture_load(&f);
    uint64_t per_side = (1u << 10) / tile, expected = desc.packedTileCount;
    for (uint32_t level = 0; level < desc.regularMipCount; level++, per_side /= 2)
        expected += per_side ? per_side * per_side : 1;
    assert_int_equal(fixture_statistics(&f).mappedTileCount, expected);
    uint64_t bytes = f.memory.live_bytes - idle;
    uint64_t regions = UINT64_C(1) << 20;
    uint64_t bound = BYTES_PER_TILE * count_tiles(&desc) + BYTES_PER_REGION * regions;
    note("the largest texture: bytes when it is looked at", count_tiles(&desc), (double)bytes,
         (double)bound);
    assert_true(bytes <= bound);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, id, 0));
    fixture_close(&f);
}

int main(int argc, char **argv)
{
    is_long_run = is_long(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hundred_million_tiles_out_of_sight_change_nothing),
        cmocka_unit_test(a_hundred_thousand_textures_come_and_go_in_the_same_memory),
        cmocka_unit_test(every_size_has_the_tiles_that_it_should_and_shows_its_last_one),
        cmocka_unit_test(the_largest_texture_is_streamed_to_a_texel_of_its_last_level),
    };
    return RUN_TESTS(tests);
}
