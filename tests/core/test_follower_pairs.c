#include "core/sound.h"
#include "core/wanted_tiles.h"

#include "base/checked.h"

#include <stdlib.h>
#include <string.h>

static uint32_t random_in(uint64_t *random, uint32_t low, uint32_t high)
{
    return low + next_random(random) % (high - low + 1);
}

/* Half of all textures have sizes and tiles whose borders fall together in UV. */
static void make_even(SluiceStreamedTextureDesc *desc, uint64_t *random)
{
    static const uint32_t sizes[] = {64, 96, 128, 192, 256};
    desc->width = sizes[next_random(random) % 5];
    desc->height = sizes[next_random(random) % 5];
    desc->tileWidth = 8u << next_random(random) % 4;
    desc->tileHeight = 8u << next_random(random) % 4;
}

/* Any size, tile shape, region size and number of regular and packed levels. */
static SluiceStreamedTextureDesc random_desc(uint64_t *random)
{
    SluiceStreamedTextureDesc desc = {
        .width = random_in(random, 1, next_random(random) % 4 ? 300 : 8),
        .height = random_in(random, 1, next_random(random) % 4 ? 300 : 8),
        .tileWidth = random_in(random, 8, 70),
        .tileHeight = random_in(random, 8, 70),
    };
    if (next_random(random) % 2)
        make_even(&desc, random);
    uint32_t most = slc_mip_count(slc_max_u32(desc.width, desc.height));
    desc.mipLevelCount = random_in(random, 1, most);
    desc.regularMipCount = random_in(random, 0, desc.mipLevelCount);
    if (desc.regularMipCount < desc.mipLevelCount)
        desc.packedTileCount = random_in(random, 1, 3);
    if (next_random(random) % 2) {
        desc.feedbackRegionWidth = random_in(random, 8, 350);
        desc.feedbackRegionHeight = random_in(random, 8, 350);
    }
    return desc;
}

enum { MOST_REGIONS = 2048, MOST_TILES = 8192 };

/* A texture of the manager, and the levels that its last map requested. */
struct texture {
    SluiceTextureId id;
    SluiceStreamedTextureDesc desc; ///< region sizes filled in
    uint8_t asked[MOST_REGIONS];
};

static void add_random(struct fixture *f, struct texture *t, uint64_t *random)
{
    SluiceStreamedTextureDesc desc = random_desc(random);
    t->id = fixture_add(f, &desc);
    SluiceStreamedTextureLayout layout = fixture_layout(f, t->id);
    t->desc = layout.desc;
    assert_true(region_count(&t->desc) <= MOST_REGIONS && layout.tileCount <= MOST_TILES);
}

static void feed_random(struct fixture *f, struct texture *t, uint64_t time, uint64_t timeout,
                        uint64_t *random)
{
    uint8_t map[MOST_REGIONS];
    uint32_t count = region_count(&t->desc), rare = random_in(random, 1, 1 + count / 2);
    for (uint32_t i = 0; i < count; i++)
        map[i] =
            next_random(random) % rare ? SLUICE_MIP_UNTOUCHED : (uint8_t)(next_random(random) % 10);
    SluiceStreamedTextureLayout layout = fixture_layout(f, t->id);
    SluiceFeedbackDesc feedback = {sizeof feedback,
                                   map,
                                   layout.feedbackWidth,
                                   layout.feedbackHeight,
                                   (int32_t)random_in(random, 0, 4) - 2,
                                   next_random(random) % 3 ? 0 : random_in(random, 1, 4)};
    SOUND(f, sluiceUpdateWithSamplerFeedback(f->manager, t->id, &feedback, time, timeout));
    asked_levels(&t->desc, &feedback, t->asked);
}

static void check_follower(const struct fixture *f, const struct texture *t, const uint8_t *asked)
{
    static bool wanted[MOST_TILES];
    wanted_tiles(&t->desc, asked, wanted);
    check_requested(f, t->id, wanted, __LINE__);
}

static void random_pairs_match_as_texel_by_texel(void **state)
{
    (void)state;
    static struct texture primary, follower;
    uint64_t random = 21;
    for (uint32_t pair = 0; pair < 150; pair++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        add_random(&f, &primary, &random);
        add_random(&f, &follower, &random);
        bool set = pair % 2;
        if (set)
            SOUND(&f, sluiceSetPrimaryTexture(f.manager, follower.id, primary.id));
        for (uint64_t t = 0; t < 5; t++) {
            feed_random(&f, &primary, t, 0, &random);
            if (!set)
                SOUND(&f, sluiceMatchPrimaryTexture(f.manager, primary.id, follower.id, t, 0));
            memset(follower.asked, SLUICE_MIP_UNTOUCHED, sizeof follower.asked);
            follower_levels(&primary.desc, primary.asked, &follower.desc, follower.asked);
            check_follower(&f, &follower, follower.asked);
        }
        fixture_close(&f);
    }
}

/* The follower has one primary of a set, one that a call matches, and its own map. */
static void a_follower_of_two_primaries_holds_the_union(void **state)
{
    (void)state;
    static struct texture first, second, follower;
    static uint8_t united[MOST_REGIONS];
    uint64_t random = 22;
    for (uint32_t round = 0; round < 200; round++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        add_random(&f, &first, &random);
        add_random(&f, &second, &random);
        add_random(&f, &follower, &random);
        SOUND(&f, sluiceSetPrimaryTexture(f.manager, follower.id, first.id));
        feed_random(&f, &first, 10, 8, &random);
        feed_random(&f, &second, 11, 8, &random);
        SOUND(&f, sluiceMatchPrimaryTexture(f.manager, second.id, follower.id, 12, 8));
        memset(united, SLUICE_MIP_UNTOUCHED, sizeof united);
        if (round % 2) {
            feed_random(&f, &follower, 13, 8, &random);
            memcpy(united, follower.asked, sizeof united);
        }
        follower_levels(&first.desc, first.asked, &follower.desc, united);
        follower_levels(&second.desc, second.asked, &follower.desc, united);
        check_follower(&f, &follower, united);
        fixture_close(&f);
    }
}

/* Tiles of regular levels that are anything but FREE. */
static uint32_t regular_in_use(const struct fixture *f, SluiceTextureId id)
{
    uint32_t count = 0, end = fixture_layout(f, id).regularTileCount;
    for (uint32_t i = 0; i < end; i++)
        count += fixture_state(f, id, i) != SLUICE_TILE_STATE_FREE;
    return count;
}

static void a_primary_that_asks_for_packed_levels_gives_no_regular_tile(void **state)
{
    (void)state;
    for (uint32_t always = 0; always < 2; always++) {
        struct fixture f;
        fixture_open(&f, 64, always);
        SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
        SluiceStreamedTextureDesc wide = full_chain(1024, 1024, 256, 64);
        SluiceTextureId primary = fixture_add(&f, &desc), same = fixture_add(&f, &desc);
        SluiceTextureId other = fixture_add(&f, &wide);
        SOUND(&f, sluiceSetPrimaryTexture(f.manager, same, primary));
        SOUND(&f, sluiceSetPrimaryTexture(f.manager, other, primary));
        for (uint32_t level = desc.regularMipCount; level < desc.mipLevelCount; level++) {
            sound_feed(&f, primary, (uint8_t)level, level, 0);
            sound_load(&f); /* the primary's packed tile is resident from here on */
            CHECK_STATE(&f, primary, 85, MAPPED);
            assert_int_equal(regular_in_use(&f, same), 0);
            assert_int_equal(regular_in_use(&f, other), 0);
            CHECK_STATE(&f, same, 85, MAPPED);
        }
        fixture_close(&f);
    }
}

static void packed_tiles_of_a_primary_pin_nothing_of_its_followers(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, true);
    SluiceTextureId primary = fixture_add_small(&f), follower = fixture_add_small(&f);
    SOUND(&f, sluiceSetPrimaryTexture(f.manager, follower, primary));
    sound_feed(&f, primary, 0, 0, 10);
    sound_load(&f);
    assert_int_equal(regular_in_use(&f, follower), 5);
    for (uint64_t t = 1; t < 12; t++) { /* wanted for ever, but by no map */
        sound_feed(&f, primary, t < 5 ? 7 : SLUICE_MIP_UNTOUCHED, t, 10);
        CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
        CHECK_SOUND(&f);
    }
    CHECK_STATE(&f, primary, 5, MAPPED);
    CHECK_STATE(&f, follower, 5, MAPPED);
    assert_int_equal(regular_in_use(&f, primary) + regular_in_use(&f, follower), 0);
    fixture_close(&f);
}

static void a_follower_with_nothing_to_request_is_left_alone(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, true); /* packed tiles are wanted anyway */
    SluiceStreamedTextureDesc flat = full_chain(64, 64, 128, 128);
    assert_int_equal(flat.regularMipCount, 0);
    SluiceTextureId ids[2] = {fixture_add_small(&f), fixture_add(&f, &flat)};
    sound_feed(&f, ids[0], 0, 5, 10);
    sound_load(&f);
    uint64_t digest = fixture_digest(&f, 2, ids);
    for (uint64_t t = 5; t < 40; t += 5) {
        SOUND(&f, sluiceMatchPrimaryTexture(f.manager, ids[0], ids[1], t, 10));
        assert_true(fixture_digest(&f, 2, ids) == digest);
    }
    CHECK_STATE(&f, ids[1], 0, MAPPED);
    fixture_close(&f);
}

static void a_follower_of_packed_levels_alone_holds_them_by_timeout(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceStreamedTextureDesc flat = full_chain(64, 64, 128, 128);
    flat.packedTileCount = 2;
    SluiceTextureId primary = fixture_add_small(&f), follower = fixture_add(&f, &flat);
    sound_feed_region(&f, primary, 3, 1, 0, 10);
    SOUND(&f, sluiceMatchPrimaryTexture(f.manager, primary, follower, 0, 10));
    CHECK_STATE(&f, follower, 0, REQUESTED);
    CHECK_STATE(&f, follower, 1, REQUESTED);
    sound_feed(&f, primary, SLUICE_MIP_UNTOUCHED, 9, 10);
    SOUND(&f, sluiceMatchPrimaryTexture(f.manager, primary, follower, 9, 10));
    CHECK_STATE(&f, follower, 1, REQUESTED);
    SOUND(&f, sluiceMatchPrimaryTexture(f.manager, primary, follower, 10, 10));
    CHECK_STATE(&f, follower, 0, FREE);
    CHECK_STATE(&f, follower, 1, FREE);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_pairs_match_as_texel_by_texel),
        cmocka_unit_test(a_follower_of_two_primaries_holds_the_union),
        cmocka_unit_test(a_primary_that_asks_for_packed_levels_gives_no_regular_tile),
        cmocka_unit_test(packed_tiles_of_a_primary_pin_nothing_of_its_followers),
        cmocka_unit_test(a_follower_with_nothing_to_request_is_left_alone),
        cmocka_unit_test(a_follower_of_packed_levels_alone_holds_them_by_timeout),
    };
    return RUN_TESTS(tests);
}
