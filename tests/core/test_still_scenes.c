/**
 * Still scenes of random textures in random budgets come to rest. Every texture repeats its map, so
 * in the end nothing is loaded and the picture stays.
 */
#include "core/fixture.h"

#include "core/check.h"

#include <string.h>

enum { TEXTURES = 4, MAX_REGIONS = 4096, LOADS = 64, PATIENCE = 16 };

struct still {
    struct fixture f;
    uint32_t count, followers; ///< followers: the last textures follow the first one
    SluiceTextureId ids[TEXTURES];
    uint8_t maps[TEXTURES][MAX_REGIONS];
    uint32_t periods[TEXTURES]; ///< frames between maps
    uint64_t chance; ///< 0: constant periods; else random state: periods vary up to twice as long
    uint64_t due[TEXTURES]; ///< frame of the next map
    uint32_t room, latency; ///< room of lists; latency: frames until slots retire
    uint64_t frame, uploads, last_change;
    uint32_t bias, bias_changes;
};

static struct still s;

static uint32_t range(uint64_t *seed, uint32_t least, uint32_t most)
{
    return least + (uint32_t)((uint64_t)next_random(seed) % (most - least + 1));
}

static SluiceStreamedTextureDesc random_desc(uint64_t *seed)
{
    SluiceStreamedTextureDesc desc;
    do {
        uint32_t tile = 32u << range(seed, 0, 3), region = tile;
        if (range(seed, 0, 1))
            region = tile << range(seed, 0, 2);
        else if (range(seed, 0, 3) == 0)
            region = range(seed, 16, 300);
        desc = full_chain(range(seed, 1, 2100), range(seed, 1, 2100), tile, tile);
        if (range(seed, 0, 2) == 0)
            desc = full_chain(2048, 2048, tile, tile);
        desc.feedbackRegionWidth = desc.feedbackRegionHeight = region;
    } while ((uint64_t)desc.width * desc.height / desc.feedbackRegionWidth /
                     desc.feedbackRegionHeight >
                 MAX_REGIONS / 2 ||
             (uint64_t)desc.width * desc.height / desc.tileWidth / desc.tileHeight > 1500);
    return desc;
}

/* Fills a map: all of the texture, a window, or levels that differ by region. */
static void fill_map(struct still *scene, uint32_t i, uint64_t *seed)
{
    SluiceStreamedTextureLayout l = fixture_layout(&scene->f, scene->ids[i]);
    uint32_t kind = range(seed, 0, 5), width = range(seed, 1, l.feedbackWidth);
    assert_true(l.feedbackWidth * l.feedbackHeight <= MAX_REGIONS);
    for (uint32_t y = 0; y < l.feedbackHeight; y++)
        for (uint32_t x = 0; x < l.feedbackWidth; x++) {
            uint8_t level = kind == 2 ? (uint8_t)range(seed, 0, 3) : 0;
            bool seen = kind != 1 || x < width;
            scene->maps[i][y * l.feedbackWidth + x] = seen ? level : SLUICE_MIP_UNTOUCHED;
        }
}

/* Sets a budget between a tenth of the bias threshold and a bit above it. */
static void set_budget(uint32_t capacity, uint64_t *seed)
{
    uint64_t tiles = fixture_statistics(&s.f).tileCount;
    uint32_t slots = (uint32_t)(tiles * 2 / 7 * range(seed, 10, 110) / 100);
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                 .numExtraStandbyTiles =
                                                     range(seed, 0, 1) ? range(seed, 0, 100) : 0,
                                                 .maxHeapCount = slots / capacity + 1,
                                                 .missesToExpire = range(seed, 0, 1)};
    if (range(seed, 0, 1)) { /* the application says when there is no more */
        s.f.heaps.limit = config.maxHeapCount;
        config.maxHeapCount = 0;
    }
    CHECK_OK(sluiceSetConfig(s.f.manager, &config));
}

static void open_still(uint64_t seed)
{
    uint32_t capacity = range(&seed, 1, 32);
    memset(&s, 0, sizeof s);
    fixture_open(&s.f, capacity, range(&seed, 0, 1));
    s.count = range(&seed, 0, 1) ? 1 : range(&seed, 2, TEXTURES);
    s.followers = range(&seed, 0, 1) ? range(&seed, 0, s.count - 1) : 0;
    bool slow = range(&seed, 0, 2) == 0;
    s.chance = range(&seed, 0, 1) ? seed | 1 : 0;
    for (uint32_t i = 0; i < s.count; i++) {
        SluiceStreamedTextureDesc desc = random_desc(&seed);
        s.ids[i] = fixture_add(&s.f, &desc);
        fill_map(&s, i, &seed);
        s.periods[i] = slow ? range(&seed, 1, PATIENCE - 1) : 1;
        if (i >= s.count - s.followers)
            CHECK_OK(sluiceSetPrimaryTexture(s.f.manager, s.ids[i], s.ids[0]));
    }
    set_budget(capacity, &seed);
    s.room = range(&seed, 0, 1) ? range(&seed, 1, 16) : FIXTURE_ROOM;
    s.latency = range(&seed, 0, 3);
}

static void run_frame(uint64_t timeout)
{
    uint64_t now = ++s.frame;
    for (uint32_t i = 0; i < s.count - s.followers; i++)
        if (now >= s.due[i]) {
            uint32_t late = s.chance ? range(&s.chance, 0, s.periods[i]) : 0;
            fixture_feed_map(&s.f, s.ids[i], s.maps[i], now, timeout);
            s.due[i] = now + s.periods[i] + late;
        }
    CHECK_OK(fixture_to_unmap(&s.f, SLUICE_ALL_TEXTURES, now));
    uint32_t unmapped = s.f.count;
    if (now > s.latency)
        CHECK_OK(sluiceCompleteRetireValue(s.f.manager, now - s.latency));
    assert_true(fixture_to_map_at_most(&s.f, SLUICE_ALL_TEXTURES, s.room) >= 0);
    fixture_answer_mapped(&s.f);
    uint32_t bias = fixture_statistics(&s.f).globalMipBias;
    s.bias_changes += bias != s.bias;
    if (s.f.count || unmapped || bias != s.bias)
        s.last_change = now;
    s.uploads += s.f.count;
    s.bias = bias;
}

/* Checks the frames of the last upload, the last unmapping and the last bias change. */
static uint64_t check_rest(uint64_t seed, uint32_t frames, uint32_t rest, uint64_t timeout)
{
    while (s.frame < frames)
        run_frame(timeout);
    if (s.last_change + rest > frames)
        fail_msg("seed %llu: changes in frame %llu of %u, %llu uploads, bias %u, changed %u times",
                 (unsigned long long)seed, (unsigned long long)s.last_change, (unsigned)frames,
                 (unsigned long long)s.uploads, (unsigned)s.bias, (unsigned)s.bias_changes);
    return s.last_change;
}

static void close_still(void)
{
    const char *wrong = slc_manager_check(s.f.manager);
    assert_string_equal(wrong ? wrong : "", "");
    fixture_close(&s.f);
}

static void random_scenes_that_stand_still_come_to_rest(void **state)
{
    (void)state;
    uint32_t biased = 0;
    for (uint64_t seed = 1; seed <= 250; seed++) {
        open_still(seed);
        check_rest(seed, 1200, 300, 2 + seed % 40);
        biased += s.bias_changes > 0;
        close_still();
    }
    assert_true(biased > 15);
}

static SluiceStreamedTextureDesc in_tiles(uint32_t width, uint32_t height, uint32_t tile,
                                          uint32_t region)
{
    SluiceStreamedTextureDesc desc = full_chain(width, height, tile, tile);
    desc.feedbackRegionWidth = desc.feedbackRegionHeight = region;
    return desc;
}

static void open_full(uint32_t count, const SluiceStreamedTextureDesc *desc, uint32_t slots)
{
    memset(&s, 0, sizeof s);
    fixture_open(&s.f, slots, false);
    fixture_configure(&s.f, 0, 1, 0, 0);
    s.count = count;
    s.room = FIXTURE_ROOM;
    for (uint32_t i = 0; i < count; i++) {
        s.ids[i] = fixture_add(&s.f, desc);
        s.periods[i] = 1;
    }
}

/* One step of the bias makes all these textures one level finer. That is more than four times as
 * many tiles, because coarser levels shrink less. */
static void a_bias_step_that_fits_only_one_way_is_taken_once(void **state)
{
    (void)state;
    const SluiceStreamedTextureDesc descs[] = {in_tiles(1025, 1025, 128, 256),
                                               in_tiles(2048, 922, 256, 256)};
    static const uint32_t slots[] = {28, 11};
    for (uint32_t i = 0; i < 2; i++) {
        open_full(1, &descs[i], slots[i]);
        assert_true(check_rest(i, 300, 200, 2) < 20);
        assert_true(s.uploads <= 2 * slots[i] && s.bias_changes <= 3);
        close_still();
    }
}

/* Requests from before a raise of the bias count until the next map. They must not raise it
 * again. */
static void a_texture_that_is_seen_rarely_is_waited_for(void **state)
{
    (void)state;
    const SluiceStreamedTextureDesc desc = in_tiles(2048, 2048, 64, 64);
    uint32_t all_at_once = 0;
    for (uint32_t period = 1; period < PATIENCE; period += 7) {
        open_full(3, &desc, 256);
        s.periods[1] = s.periods[2] = period;
        check_rest(period, 100 + 40 * period, 10, 100);
        if (period == 1)
            all_at_once = s.bias;
        assert_true(all_at_once > 0);
        assert_in_range(s.bias, all_at_once - 4, all_at_once + 4);
        close_still();
    }
}

static void a_texture_that_gets_no_maps_any_more_is_not_waited_for_for_good(void **state)
{
    (void)state;
    const SluiceStreamedTextureDesc desc = in_tiles(2048, 2048, 64, 64);
    open_full(2, &desc, 128); /* and 448 may be wanted, of 1 366 each */
    run_frame(1000);
    run_frame(1000);
    uint32_t bias = s.bias;
    assert_true(bias > 0);
    s.due[1] = UINT64_MAX;
    for (uint32_t i = 1; i < PATIENCE; i++)
        run_frame(1000);
    assert_int_equal(s.bias, bias); /* the requests may still shrink */
    for (uint32_t i = 0; i < 2 * PATIENCE; i++)
        run_frame(1000);
    assert_true(s.bias > bias);
    close_still();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_scenes_that_stand_still_come_to_rest),
        cmocka_unit_test(a_bias_step_that_fits_only_one_way_is_taken_once),
        cmocka_unit_test(a_texture_that_is_seen_rarely_is_waited_for),
        cmocka_unit_test(a_texture_that_gets_no_maps_any_more_is_not_waited_for_for_good),
    };
    return RUN_TESTS(tests);
}
