/* Small textures: mip tails that share pages, and textures that are forgotten. */
#include "device/demand_runner.h"

#include "support/test.h"

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>

static struct harness h;

enum { COUNT = 600, SIZE = 64, LEVELS = 7, PAGE = 65536 };

struct small {
    struct runner r;
    struct runner_image images[COUNT];
    SluiceDemandTextureId ids[COUNT];
};

static struct small *small_create(const SluiceDemandLoaderCreateInfo *info)
{
    struct small *s = calloc(1, sizeof *s);
    assert_non_null(s);
    runner_init(&s->r, &h, info);
    return s;
}

static void small_destroy(struct small *s)
{
    runner_finish(&s->r);
    for (uint32_t i = 0; i < COUNT; i++)
        if (s->images[i].inner)
            runner_image_finish(&s->images[i]);
    free(s);
}

static void add(struct small *s, uint32_t i, SluiceFormat format, uint32_t width, uint32_t height)
{
    runner_image_init(&s->images[i], format, width, height, i);
    s->ids[i] = runner_add_texture(&s->r, &s->images[i]);
}

/* Samples `level` of textures `first` to `end` - 1, each at another texel. */
static void add_samples(struct small *s, uint32_t first, uint32_t end, uint32_t level)
{
    for (uint32_t i = first; i < end; i++)
        runner_add_texel(&s->r, s->ids[i], SIZE, SIZE, level, i % (SIZE >> level),
                         i / 7 % (SIZE >> level));
}

static void check_samples(struct small *s, uint32_t sample, uint32_t first, uint32_t end,
                          uint32_t level)
{
    for (uint32_t i = first; i < end; i++)
        runner_check_texel(&s->r, sample + i - first, &s->images[i], level, i % (SIZE >> level),
                           i / 7 % (SIZE >> level));
}

/* 600 x 85 KiB / 4 are 200 pages. */
static void three_textures_of_64x64_share_a_page(void **state)
{
    (void)state;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = 13u << 20};
    struct small *s = small_create(&info);
    for (uint32_t i = 0; i < COUNT; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    for (uint32_t l = 0; l + 1 < LEVELS; l++)
        add_samples(s, 0, COUNT, l);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    SluiceDemandStatistics statistics = runner_statistics(&s->r);
    for (uint32_t l = 0; l + 1 < LEVELS; l++)
        check_samples(s, l * COUNT, 0, COUNT, l);
    assert_int_equal(statistics.residentTileCount, COUNT);
    assert_int_equal(statistics.tailPageCount, COUNT / 3);
    assert_true(statistics.tileMemorySize <= info.memoryBudget);
    assert_int_equal(statistics.evictedCount, 0);
    assert_true(statistics.lodBias == 0);
    print_message("# small.bytes_per_texture %u\n",
                  (uint32_t)(statistics.tailPageCount * PAGE / COUNT));
    small_destroy(s);
}

/* Two of three textures go, and others take their slots. */
static void slots_of_removed_textures_are_taken_again(void **state)
{
    (void)state;
    struct small *s = small_create(NULL);
    for (uint32_t i = 0; i < COUNT / 2; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(s, 0, COUNT / 2, 1);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    uint64_t pages = runner_statistics(&s->r).tailPageCount;
    assert_int_equal(pages, COUNT / 6);
    runner_clear(&s->r);
    for (uint32_t i = 0; i < COUNT / 2; i++)
        if (i % 3)
            CHECK_OK(sluiceRemoveDemandTexture(s->r.loader, s->ids[i]));
    for (uint32_t i = COUNT / 2; i < COUNT / 2 + COUNT / 3; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(s, COUNT / 2, COUNT / 2 + COUNT / 3, 2);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    check_samples(s, 0, COUNT / 2, COUNT / 2 + COUNT / 3, 2);
    assert_int_equal(runner_statistics(&s->r).tailPageCount, pages);
    runner_clear(&s->r);
    for (uint32_t i = 0; i < COUNT / 2; i += 3)
        add_samples(s, i, i + 1, 0);
    runner_launch(&s->r);
    assert_int_equal(s->r.requests.missingCount, 0);
    for (uint32_t i = 0; i < COUNT / 2; i += 3)
        check_samples(s, i / 3, i, i + 1, 0);
    for (uint32_t i = 0; i < COUNT / 2 + COUNT / 3; i++)
        if (i >= COUNT / 2 || i % 3 == 0)
            CHECK_OK(sluiceRemoveDemandTexture(s->r.loader, s->ids[i]));
    assert_int_equal(runner_statistics(&s->r).tailPageCount, 0);
    assert_int_equal(runner_statistics(&s->r).residentTileCount, 0);
    small_destroy(s);
}

/* Formats and sizes have pages of their own: 1x1 to 64x64, wide and high. */
static void textures_of_all_sizes_keep_their_texels(void **state)
{
    (void)state;
    const SluiceFormat formats[] = {SLUICE_FORMAT_R8G8B8A8_UNORM,
                                    SLUICE_FORMAT_R32G32B32A32_SFLOAT};
    struct small *s = small_create(NULL);
    uint32_t sizes[COUNT][2];
    for (uint32_t i = 0; i < COUNT; i++) {
        sizes[i][0] = 1 + i * 37 % 64;
        sizes[i][1] = 1 + i * 53 / 2 % 64;
        add(s, i, formats[i % 2], sizes[i][0], sizes[i][1]);
        runner_add_texel(&s->r, s->ids[i], sizes[i][0], sizes[i][1], 0, sizes[i][0] - 1,
                         sizes[i][1] - 1);
        runner_add_texel(&s->r, s->ids[i], sizes[i][0], sizes[i][1], 0, 0, 0);
    }
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    for (uint32_t i = 0; i < COUNT; i++) {
        runner_check_texel(&s->r, 2 * i, &s->images[i], 0, sizes[i][0] - 1, sizes[i][1] - 1);
        runner_check_texel(&s->r, 2 * i + 1, &s->images[i], 0, 0, 0);
    }
    small_destroy(s);
}

/* 8 MiB are 128 pages: for 384 textures. The others show their last level's color. */
static void tails_beyond_the_budget_are_refused_when_every_slot_is_taken(void **state)
{
    (void)state;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 8u << 20};
    struct small *s = small_create(&info);
    for (uint32_t i = 0; i < COUNT; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(s, 0, COUNT, 0);
    runner_load(&s->r, 40);
    SluiceDemandStatistics statistics = runner_statistics(&s->r);
    assert_true(statistics.tileMemorySize <= info.memoryBudget);
    assert_int_equal(statistics.tailPageCount, 128);
    assert_int_equal(statistics.residentTileCount, 384);
    small_destroy(s);
}

static uint32_t open_count(struct small *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < COUNT; i++)
        count += atomic_load(&s->images[i].opened) - atomic_load(&s->images[i].closed);
    return count;
}

/* Half of the textures is sampled by every launch, the others only by the first ones. */
static void textures_without_use_are_forgotten_and_come_back(void **state)
{
    (void)state;
    enum { USED = 50, ALL = 100, LAUNCHES = 8 };
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .forgetAfterLaunches = LAUNCHES};
    struct small *s = small_create(&info);
    for (uint32_t i = 0; i < ALL; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(s, 0, ALL, 1);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    runner_launch(&s->r);
    assert_int_equal(open_count(s), ALL);
    runner_clear(&s->r);
    add_samples(s, 0, USED, 1);
    for (uint32_t i = 0; i + 1 < LAUNCHES; i++)
        runner_launch(&s->r);
    assert_int_equal(runner_statistics(&s->r).texturesForgotten, 0);
    for (uint32_t i = 0; i < 2; i++)
        runner_launch(&s->r);
    SluiceDemandStatistics statistics = runner_statistics(&s->r);
    assert_int_equal(statistics.texturesForgotten, ALL - USED);
    assert_int_equal(statistics.residentTileCount, USED);
    assert_int_equal(open_count(s), USED);
    check_samples(s, 0, 0, USED, 1);
    add_samples(s, USED, ALL, 2);
    assert_in_range(runner_load(&s->r, 20), 2, 19);
    check_samples(s, USED, USED, ALL, 2);
    assert_int_equal(open_count(s), ALL);
    assert_int_equal(runner_statistics(&s->r).texturesOpened, 2 * ALL - USED);
    small_destroy(s);
}

/* 4 MiB hold 192 of 600 textures. Each is sampled for a while, a few at a time. */
static void textures_sampled_once_each_need_no_more_than_the_budget(void **state)
{
    (void)state;
    enum { STEP = 60 };
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 4u << 20};
    struct small *s = small_create(&info);
    for (uint32_t i = 0; i < COUNT; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    for (uint32_t pass = 0; pass < 2; pass++)
        for (uint32_t first = 0; first < COUNT; first += STEP) {
            runner_clear(&s->r);
            add_samples(s, first, first + STEP, 0);
            assert_in_range(runner_load(&s->r, 20), 1, 19);
            check_samples(s, 0, first, first + STEP, 0);
            assert_in_range(open_count(s), STEP, 192);
        }
    SluiceDemandStatistics statistics = runner_statistics(&s->r);
    assert_true(statistics.tileMemorySize <= info.memoryBudget);
    assert_int_equal(statistics.refusedCount, 0);
    assert_true(statistics.lodBias == 0);
    assert_int_equal(statistics.texturesOpened - statistics.texturesForgotten, open_count(s));
    assert_in_range(statistics.texturesForgotten, 2 * COUNT - 192, 2 * COUNT);
    small_destroy(s);
}

/* Small textures come and go beside a large one whose tiles take most of the memory. */
static void textures_go_before_tiles_that_were_used_later(void **state)
{
    (void)state;
    enum { STEP = 30, LARGE = 1024, TILES = 40 };
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 4u << 20};
    struct small *s = small_create(&info);
    add(s, 0, SLUICE_FORMAT_R8G8B8A8_UNORM, LARGE, LARGE);
    for (uint32_t i = 1; i < COUNT; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    for (uint32_t first = 1; first + STEP <= COUNT; first += STEP) {
        runner_clear(&s->r);
        for (uint32_t i = 0; i < TILES; i++)
            runner_add_texel(&s->r, s->ids[0], LARGE, LARGE, 0, i % 8 * 128, i / 8 * 128);
        add_samples(s, first, first + STEP, 0);
        assert_in_range(runner_load(&s->r, 20), 1, 19);
        check_samples(s, TILES, first, first + STEP, 0);
        for (uint32_t i = 0; i < TILES; i++)
            runner_check_texel(&s->r, i, &s->images[0], 0, i % 8 * 128, i / 8 * 128);
    }
    assert_int_equal(runner_statistics(&s->r).evictedCount, 0);
    assert_int_equal(atomic_load(&s->images[0].opened), 1);
    small_destroy(s);
}

/* All pages that the context allows belong to another loader. */
static void loader_without_a_page_waits_for_one(void **state)
{
    (void)state;
    enum { FILL = 192, MORE = 4 };
    CHECK_OK(harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.maxPageChunkCount = 1}));
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 4u << 20};
    struct small *first = small_create(&info);
    for (uint32_t i = 0; i < FILL; i++)
        add(first, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(first, 0, FILL, 0);
    runner_load(&first->r, 20);
    struct small *second = small_create(&info);
    for (uint32_t i = 0; i < MORE; i++)
        add(second, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(second, 0, MORE, 0);
    runner_load(&second->r, 10);
    assert_int_equal(runner_statistics(&second->r).residentTileCount, 0);
    small_destroy(first);
    for (uint32_t i = 0; i < 100; i++) /* until refused pages are tried again */
        runner_load(&second->r, 20);
    check_samples(second, 0, 0, MORE, 0);
    small_destroy(second);
    CHECK_OK(harness_set_context(&h, NULL));
}

/* Tiles of a large texture that were used before the small textures were. */
static void tiles_go_before_textures_that_were_used_later(void **state)
{
    (void)state;
    enum { FIRST = 30, MORE = 60, LARGE = 1024, TILES = 40 };
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 4u << 20};
    struct small *s = small_create(&info);
    add(s, 0, SLUICE_FORMAT_R8G8B8A8_UNORM, LARGE, LARGE);
    for (uint32_t i = 1; i <= FIRST + MORE; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    for (uint32_t i = 0; i < TILES; i++)
        runner_add_texel(&s->r, s->ids[0], LARGE, LARGE, 0, i % 8 * 128, i / 8 * 128);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    const uint32_t first[] = {1, 1 + FIRST}, end[] = {1 + FIRST, 1 + FIRST + MORE};
    for (uint32_t i = 0; i < 2; i++) {
        runner_clear(&s->r);
        runner_add_texel(&s->r, s->ids[0], LARGE, LARGE, 0, 0, 0);
        add_samples(s, first[i], end[i], 0);
        assert_in_range(runner_load(&s->r, 20), 1, 19);
        check_samples(s, 1, first[i], end[i], 0);
    }
    SluiceDemandStatistics statistics = runner_statistics(&s->r);
    assert_in_range(statistics.evictedCount, 6, TILES);
    assert_int_equal(statistics.texturesForgotten, 0);
    small_destroy(s);
}

static void nothing_is_forgotten_without_eviction(void **state)
{
    (void)state;
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .noEviction = true, .forgetAfterLaunches = 1};
    struct small *s = small_create(&info);
    for (uint32_t i = 0; i < 10; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(s, 0, 10, 1);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    runner_clear(&s->r);
    for (uint32_t i = 0; i < 10; i++)
        runner_launch(&s->r);
    assert_int_equal(runner_statistics(&s->r).texturesForgotten, 0);
    assert_int_equal(open_count(s), 10);
    small_destroy(s);
}

/* The colors of these levels are in the table of textures, so that no page is looked up and none is
 * resident. */
static void textures_whose_last_level_is_sampled_are_in_use(void **state)
{
    (void)state;
    enum { USED = 10, ALL = 20, LAUNCHES = 8 };
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .forgetAfterLaunches = LAUNCHES};
    struct small *s = small_create(&info);
    for (uint32_t i = 0; i < ALL; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(s, 0, ALL, LEVELS - 1);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    runner_clear(&s->r);
    add_samples(s, 0, USED, LEVELS - 1);
    for (uint32_t i = 0; i < 8 * LAUNCHES; i++) {
        runner_launch(&s->r);
        assert_true(runner_all_resident(&s->r));
    }
    assert_int_equal(runner_statistics(&s->r).texturesOpened, ALL);
    assert_int_equal(runner_statistics(&s->r).texturesForgotten, ALL - USED);
    assert_int_equal(runner_statistics(&s->r).residentTileCount, 0);
    small_destroy(s);
}

/* Far textures are sampled by every launch, near ones a few at a time: memory is short. */
static void far_textures_stay_open_while_near_ones_come_and_go(void **state)
{
    (void)state;
    enum { FAR = 100, STEP = 60 };
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 4u << 20};
    struct small *s = small_create(&info);
    for (uint32_t i = 0; i < COUNT; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    for (uint32_t first = FAR; first + STEP <= COUNT; first += STEP) {
        runner_clear(&s->r);
        add_samples(s, 0, FAR, LEVELS - 1);
        add_samples(s, first, first + STEP, 0);
        assert_in_range(runner_load(&s->r, 20), 1, 19);
        check_samples(s, FAR, first, first + STEP, 0);
    }
    for (uint32_t i = 0; i < FAR; i++)
        assert_int_equal(atomic_load(&s->images[i].opened), 1);
    assert_in_range(runner_statistics(&s->r).texturesForgotten, 1, COUNT - FAR);
    small_destroy(s);
}

/* A tile that failed is not to be read again. */
static void failed_tiles_are_not_read_again_because_of_age(void **state)
{
    (void)state;
    enum { LARGE = 1024, LAUNCHES = 4 };
    static const SluiceResult script[] = {SLUICE_SUCCESS, SLUICE_ERROR_CORRUPT_DATA,
                                          SLUICE_ERROR_CORRUPT_DATA};
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .forgetAfterLaunches = LAUNCHES,
                                               .failureRetryDelayNs = UINT64_MAX};
    struct small *s = small_create(&info);
    add(s, 0, SLUICE_FORMAT_R8G8B8A8_UNORM, LARGE, LARGE);
    s->images[0].source.script = script;
    s->images[0].source.script_length = 3;
    h.quiet = true;
    runner_add_texel(&s->r, s->ids[0], LARGE, LARGE, 0, 1, 1);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    uint64_t reads = atomic_load(&s->images[0].source.read_count);
    assert_int_equal(runner_statistics(&s->r).failedCount, 1);
    runner_clear(&s->r);
    for (uint32_t i = 0; i < 4 * LAUNCHES; i++)
        runner_launch(&s->r);
    runner_add_texel(&s->r, s->ids[0], LARGE, LARGE, 0, 1, 1);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    assert_int_equal(atomic_load(&s->images[0].source.read_count), reads);
    assert_int_equal(runner_statistics(&s->r).texturesForgotten, 0);
    runner_clear(&s->r);
    CHECK_OK(sluiceRetryDemandTexture(s->r.loader, s->ids[0]));
    for (uint32_t i = 0; i < 4 * LAUNCHES; i++)
        runner_launch(&s->r);
    assert_int_equal(runner_statistics(&s->r).texturesForgotten, 1);
    h.quiet = false;
    small_destroy(s);
}

/* Reads of another texture have all the memory for reads, and wait. */
static void a_texture_stays_open_while_its_preload_waits(void **state)
{
    (void)state;
    enum { LARGE = 1024, LAUNCHES = 4, TILES = 64, PRELOADED = 64 + 16 + 4 + 1 + 1 };
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = 32u << 20,
                                               .forgetAfterLaunches = LAUNCHES,
                                               .maxTilesInFlight = 16};
    struct small *s = small_create(&info);
    SluiceDemandTicket ticket;
    SluiceDemandTicketStatus status = {.structSize = sizeof status, .remainingCount = 1};
    for (uint32_t i = 0; i < 2; i++) {
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, LARGE, LARGE);
        runner_add_texel(&s->r, s->ids[i], LARGE, LARGE, 3, 1, 1);
    }
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    runner_clear(&s->r);
    s->images[0].source.holds = true;
    for (uint32_t i = 0; i < TILES; i++)
        runner_add_texel(&s->r, s->ids[0], LARGE, LARGE, 0, i % 8 * 128, i / 8 * 128);
    runner_launch(&s->r);
    CHECK_OK(sluicePreloadDemandTexture(s->r.loader, s->ids[1], 0, &ticket));
    for (uint32_t i = 0; i < 4 * LAUNCHES; i++)
        runner_launch(&s->r);
    assert_int_equal(runner_statistics(&s->r).texturesForgotten, 0);
    fault_source_release(&s->images[0].source);
    /* Threads that read may be late on a busy machine, and the preload waits for them. */
    for (uint32_t i = 0; i < 4000 && status.remainingCount; i++) {
        runner_launch(&s->r);
        CHECK_OK(sluiceWaitDemandTicket(s->r.loader, ticket, UINT64_MAX, &status));
        sched_yield();
    }
    assert_int_equal(status.remainingCount + status.failedCount, 0);
    runner_launch(&s->r); /* shows the last of them */
    assert_int_equal(runner_statistics(&s->r).texturesForgotten, 0);
    uint64_t resident = runner_statistics(&s->r).residentTileCount;
    for (uint32_t i = 0; i < 4 * LAUNCHES; i++)
        runner_launch(&s->r);
    assert_int_equal(runner_statistics(&s->r).texturesForgotten, 1);
    assert_int_equal(resident - runner_statistics(&s->r).residentTileCount, PRELOADED);
    small_destroy(s);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_textures_of_64x64_share_a_page),
        cmocka_unit_test(slots_of_removed_textures_are_taken_again),
        cmocka_unit_test(textures_of_all_sizes_keep_their_texels),
        cmocka_unit_test(tails_beyond_the_budget_are_refused_when_every_slot_is_taken),
        cmocka_unit_test(textures_without_use_are_forgotten_and_come_back),
        cmocka_unit_test(textures_sampled_once_each_need_no_more_than_the_budget),
        cmocka_unit_test(textures_go_before_tiles_that_were_used_later),
        cmocka_unit_test(tiles_go_before_textures_that_were_used_later),
        cmocka_unit_test(loader_without_a_page_waits_for_one),
        cmocka_unit_test(nothing_is_forgotten_without_eviction),
        cmocka_unit_test(textures_whose_last_level_is_sampled_are_in_use),
        cmocka_unit_test(far_textures_stay_open_while_near_ones_come_and_go),
        cmocka_unit_test(failed_tiles_are_not_read_again_because_of_age),
        cmocka_unit_test(a_texture_stays_open_while_its_preload_waits),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
