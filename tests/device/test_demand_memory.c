/* Memory: budgets hold, pictures come to rest, and tiles are restored without a read. */
#include "device/demand_runner.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/demand_strict.h>

#include <math.h>
#include <string.h>

static struct harness h;

enum { SIZE = 4096, TILE = 128, TILES = SIZE / TILE };

/* Checks the nearest texel of the finest level that is at least `bias` coarse. */
static void check_blurred(struct runner *r, struct runner_image *image, uint32_t sample,
                          uint32_t level, uint32_t x, uint32_t y)
{
    runner_check_texel(r, sample, image, level, x >> level, y >> level);
}

/* Reports of strict mode. */
static struct {
    uint32_t counts[SLUICE_DEMAND_MISUSE_SOURCE_IN_USE + 1]; ///< by kind
    uint64_t values[SLUICE_DEMAND_MISUSE_SOURCE_IN_USE + 1]; ///< last value by kind
    char text[400];                                          ///< text of the last report
} heard;

static void listen(void *user, const SluiceDemandMisuse *misuse)
{
    (void)user;
    heard.counts[misuse->kind]++;
    heard.values[misuse->kind] = misuse->value;
    strncpy(heard.text, misuse->pMessage, sizeof heard.text - 1);
}

static void listen_to(SluiceDemandLoader *loader)
{
    const SluiceDemandStrictMode strict = {
        .structSize = sizeof strict, .launchesWithoutRequests = 8, .pfnReport = listen};
    memset(&heard, 0, sizeof heard);
    CHECK_OK(sluiceSetDemandStrictMode(loader, &strict));
}

static void a_new_loader_takes_little_staging_memory_and_more_when_it_reads(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    runner_init(&r, &h,
                &(SluiceDemandLoaderCreateInfo){.structSize = sizeof(SluiceDemandLoaderCreateInfo),
                                                .memoryBudget = 40u << 20});
    uint64_t little = runner_statistics(&r).hostVisibleMemorySize;
    assert_true(little < 12u << 20); /* 1024 tiles in flight would take 64 MiB */
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 0);
    runner_add_tiles(&r, runner_add_texture(&r, &image), SIZE, 0, TILES);
    runner_load(&r, 60);
    SluiceDemandStatistics loaded = runner_statistics(&r);
    assert_true(loaded.hostVisibleMemorySize >= little + (4u << 20));
    assert_in_range(loaded.pageChunkCount, 1, 64);
    assert_int_equal(loaded.pageChunkShortages, 0);
    for (uint32_t i = 0; i < 110; i++)
        runner_launch(&r);
    assert_true(runner_statistics(&r).hostVisibleMemorySize == loaded.hostVisibleMemorySize);
    for (uint32_t i = 0; i < 20; i++) /* ends 120 idle launches */
        runner_launch(&r);
    assert_true(runner_statistics(&r).hostVisibleMemorySize < little + (1u << 20));
    runner_finish(&r);
    runner_image_finish(&image);
}

static void a_loader_makes_the_staging_memory_that_it_is_asked_for(void **state)
{
    (void)state;
    uint64_t sizes[2];
    for (int i = 0; i < 2; i++) {
        struct runner r;
        const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                                   .memoryBudget = 40u << 20};
        const SluiceVulkanContextCreateInfo context = {.minStagingSize = i ? UINT64_MAX : 0};
        CHECK_OK(harness_set_context(&h, &context));
        runner_init(&r, &h, &info);
        sizes[i] = runner_statistics(&r).hostVisibleMemorySize;
        runner_finish(&r);
    }
    CHECK_OK(harness_set_context(&h, NULL));
    assert_int_equal(sizes[1] - sizes[0], 60u << 20); /* 1024 tiles in flight, less 4 MiB */
}

static void images_of_pages_are_made_when_the_first_texture_opens(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    const SluiceVulkanContextCreateInfo context = {.minTileMemorySize = 64u << 20};
    CHECK_OK(harness_set_context(&h, &context));
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = 40u << 20};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    runner_add_tiles(&r, runner_add_texture(&r, &image), SIZE, 0, 2);
    runner_load(&r, 60);
    SluiceDemandStatistics statistics = runner_statistics(&r);
    assert_int_equal(statistics.pageChunkCount, 1);
    assert_in_range(statistics.tileMemorySize, 39u << 20, 40u << 20); /* all of the budget */
    for (uint32_t i = 0; i < 100; i++)
        runner_launch(&r);
    assert_int_equal(runner_statistics(&r).tileMemorySize, statistics.tileMemorySize);
    runner_finish(&r);
    runner_image_finish(&image);
    CHECK_OK(harness_set_context(&h, NULL));
}

static void a_working_set_beyond_the_budget_ends_complete_and_blurrier(void **state)
{
    (void)state;
    enum { COUNT = 2 };
    struct runner r;
    struct runner_image images[COUNT];
    SluiceDemandTextureId ids[COUNT];
    /* 2048 tiles of level 0 in memory for 640: those of level 1 fit. */
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = 40u << 20, .maxTilesInFlight = 256};
    runner_init(&r, &h, &info);
    for (uint32_t i = 0; i < COUNT; i++) {
        runner_image_init(&images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, i);
        ids[i] = runner_add_texture(&r, &images[i]);
        runner_add_tiles(&r, ids[i], SIZE, 0, TILES);
    }
    listen_to(r.loader);
    uint32_t launches = runner_load(&r, 60);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_TILES_EXHAUSTED], 1);
    assert_int_equal(heard.values[SLUICE_DEMAND_MISUSE_TILES_EXHAUSTED], info.memoryBudget / 65536);
    assert_non_null(strstr(heard.text, "room for 640: textures are"));
    print_message("# launches.blurrier %u launches\n", launches);
    assert_in_range(launches, 4, 30);
    assert_true(runner_all_resident(&r));
    SluiceDemandStatistics before = runner_statistics(&r);
    assert_true(before.lodBias > 0 && before.lodBias <= 2);
    assert_true(before.tileMemorySize <= info.memoryBudget);
    uint32_t level = (uint32_t)(before.lodBias + 0.499f);
    for (uint32_t i = 0; i < r.count; i++) {
        uint32_t tile = i % (TILES * TILES);
        check_blurred(&r, &images[i / (TILES * TILES)], i, level, tile % TILES * TILE + 7,
                      tile / TILES * TILE + 9);
    }
    for (uint32_t i = 0; i < 10; i++) {
        runner_launch(&r);
        assert_int_equal(r.requests.missingCount, 0);
        assert_int_equal(r.launch.tileCount, 0);
    }
    assert_int_equal(runner_statistics(&r).bytesUploaded, before.bytesUploaded);
    runner_finish(&r);
    for (uint32_t i = 0; i < COUNT; i++)
        runner_image_finish(&images[i]);
}

static void without_a_bias_some_tiles_stay_away_and_coarser_ones_are_shown_there(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = 8u << 20,
                                               .maxTilesInFlight = 64,
                                               .noLodBias = true};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    runner_add_tiles(&r, runner_add_texture(&r, &image), SIZE, 0, TILES);
    listen_to(r.loader);
    runner_load(&r, 60);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_TILES_EXHAUSTED], 1);
    assert_non_null(strstr(heard.text, "0.00 levels coarser, and"));
    assert_true(runner_all_resident(&r));
    SluiceDemandStatistics statistics = runner_statistics(&r);
    assert_true(statistics.lodBias == 0);
    assert_true(statistics.tileMemorySize <= info.memoryBudget);
    assert_in_range(statistics.residentTileCount, 100, info.memoryBudget / 65536);
    uint32_t sharp = 0;
    for (uint32_t i = 0; i < r.count; i++) {
        float rgba[4];
        struct RunnerOutput out = runner_output(&r, i);
        runner_image_texel(&image, 0, i % TILES * TILE + 7, i / TILES * TILE + 9, rgba);
        sharp += fabsf(out.color[0] - rgba[0]) < 1e-6f && fabsf(out.color[1] - rgba[1]) < 1e-6f;
    }
    assert_in_range(sharp, 32, info.memoryBudget / 65536 + 4); /* few colors exist twice */
    runner_finish(&r);
    runner_image_finish(&image);
}

static void tiles_that_nobody_uses_make_room_and_come_back_unread(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = 16u << 20, .maxTilesInFlight = 64};
    runner_init(&r, &h, &info); /* 256 tiles: 8 rows */
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    listen_to(r.loader);
    /* Six rows, then two others and the sixth: as many as fit. */
    runner_add_tiles(&r, id, SIZE, 0, 6);
    runner_load(&r, 30);
    assert_true(runner_all_resident(&r));
    runner_clear(&r);
    runner_add_tiles(&r, id, SIZE, 6, 4); /* at least two of the first six rows are evicted */
    assert_in_range(runner_load(&r, 30), 2, 29);
    assert_true(runner_all_resident(&r));
    SluiceDemandStatistics statistics = runner_statistics(&r);
    assert_true(statistics.lodBias == 0);
    assert_in_range(statistics.evictedCount, 2 * TILES - 8, 3 * TILES);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_TILES_EXHAUSTED], 0);
    assert_true(statistics.tileMemorySize <= info.memoryBudget);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void views_that_walk_to_and_fro_never_show_other_texels(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = 16u << 20, .maxTilesInFlight = 64};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    for (uint32_t i = 0; i < 12; i++) {
        runner_clear(&r);
        runner_add_tiles(&r, id, SIZE, i % 3 * 3, 5);
        runner_load(&r, 30);
        assert_true(runner_all_resident(&r));
        for (uint32_t s = 0; s < r.count; s++)
            runner_check_texel(&r, s, &image, 0, s % TILES * TILE + 7,
                               (i % 3 * 3 + s / TILES) * TILE + 9);
    }
    assert_true(runner_statistics(&r).evictedCount > 0);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void tiles_that_were_evicted_and_not_overwritten_need_no_read(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image, other;
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = 16u << 20, .maxTilesInFlight = 64};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    runner_image_init(&other, SLUICE_FORMAT_R32G32B32A32_SFLOAT, SIZE, SIZE, 2);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    SluiceDemandTextureId other_id = runner_add_texture(&r, &other);
    runner_add_tiles(&r, id, SIZE, 0, 7);
    runner_load(&r, 30);
    uint64_t reads = image.source.read_count;
    /* Tiles of another format evict them, but cannot use their places yet. */
    runner_clear(&r);
    runner_add_tiles(&r, other_id, SIZE, 0, 1);
    runner_load(&r, 2); /* the first launch opens it */
    assert_true(runner_statistics(&r).evictedCount > 0);
    runner_clear(&r);
    runner_add_tiles(&r, id, SIZE, 0, 7);
    runner_load(&r, 30);
    for (uint32_t s = 0; s < r.count; s++)
        runner_check_texel(&r, s, &image, 0, s % TILES * TILE + 7, s / TILES * TILE + 9);
    assert_true(runner_statistics(&r).restoredCount > 0);
    assert_int_equal(image.source.read_count, reads);
    runner_finish(&r);
    runner_image_finish(&image);
    runner_image_finish(&other);
}

/* Texture 0 was not told of the change and keeps old texels. Its restored tiles must not be shared
 * with texture 1. */
static void restored_tiles_are_not_shared_with_a_texture_that_changed(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image, other;
    SluiceDemandTextureId ids[2];
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = 16u << 20, .maxTilesInFlight = 64};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    runner_image_init(&other, SLUICE_FORMAT_R32G32B32A32_SFLOAT, SIZE, SIZE, 2);
    const SluiceDemandTextureCreateInfo create = {.structSize = sizeof create,
                                                  .image.source = &image.source.base,
                                                  .pSampler = &runner_nearest};
    for (uint32_t i = 0; i < 2; i++) {
        CHECK_OK(sluiceAddDemandTexture(r.loader, &create, &ids[i]));
        runner_add_tiles(&r, ids[i], SIZE, 0, 1);
        runner_load(&r, 30); /* both are open */
    }
    SluiceDemandTextureId other_id = runner_add_texture(&r, &other);
    runner_clear(&r);
    runner_add_tiles(&r, ids[0], SIZE, 0, 7);
    runner_load(&r, 30);
    runner_clear(&r);
    runner_add_tiles(&r, other_id, SIZE, 0, 1);
    runner_load(&r, 2); /* evicts, and copies nothing yet */
    image.seed += 12345;
    CHECK_OK(sluiceInvalidateDemandTexture(r.loader, ids[1]));
    runner_clear(&r);
    runner_add_tiles(&r, ids[0], SIZE, 0, 7);
    uint64_t restored = runner_statistics(&r).restoredCount;
    runner_load(&r, 30);
    assert_true(runner_statistics(&r).restoredCount > restored);
    runner_clear(&r);
    runner_add_tiles(&r, ids[1], SIZE, 0, 7);
    runner_load(&r, 30);
    for (uint32_t s = 0; s < r.count; s++)
        runner_check_texel(&r, s, &image, 0, s % TILES * TILE + 7, s / TILES * TILE + 9);
    runner_finish(&r);
    runner_image_finish(&image);
    runner_image_finish(&other);
}

static void without_eviction_what_is_there_stays(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = 8u << 20,
                                               .maxTilesInFlight = 64,
                                               .noEviction = true};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    runner_add_tiles(&r, id, SIZE, 0, 3);
    runner_load(&r, 30);
    runner_clear(&r);
    runner_add_tiles(&r, id, SIZE, 10, 6); /* more than is left */
    runner_load(&r, 30);
    assert_int_equal(runner_statistics(&r).evictedCount, 0);
    uint64_t reads = image.source.read_count;
    runner_clear(&r);
    runner_add_tiles(&r, id, SIZE, 0, 3);
    runner_load(&r, 30);
    assert_int_equal(image.source.read_count, reads);
    assert_true(runner_statistics(&r).tileMemorySize <= info.memoryBudget);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void formats_share_a_budget(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image images[2];
    SluiceDemandTextureId ids[2];
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = 16u << 20, .maxTilesInFlight = 64};
    runner_init(&r, &h, &info);
    for (uint32_t i = 0; i < 2; i++) {
        runner_image_init(&images[i],
                          i ? SLUICE_FORMAT_R32G32B32A32_SFLOAT : SLUICE_FORMAT_R8G8B8A8_UNORM,
                          SIZE, SIZE, i);
        ids[i] = runner_add_texture(&r, &images[i]);
    }
    for (uint32_t round = 0; round < 4; round++) {
        runner_clear(&r);
        runner_add_tiles(&r, ids[round % 2], SIZE, 0, 6);
        /* Chunks of the other format must become empty first. */
        assert_in_range(runner_load(&r, 100), 1, 99);
        SluiceDemandStatistics statistics = runner_statistics(&r);
        assert_true(runner_all_resident(&r));
        assert_true(statistics.tileMemorySize <= info.memoryBudget);
    }
    runner_finish(&r);
    for (uint32_t i = 0; i < 2; i++)
        runner_image_finish(&images[i]);
}

/* There is one image of pages per format. The tiles of the first format occupy all images at first.
 * The second format gets its image when one of them is empty. */
static void formats_share_few_images_of_pages(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image images[2];
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = 512u << 20};
    const SluiceVulkanContextCreateInfo context = {.maxPageChunkCount = 2};
    CHECK_OK(harness_set_context(&h, &context));
    h.quiet = true;
    runner_init(&r, &h, &info);
    assert_non_null(strstr(h.last_message, "at most 8 MiB of the memoryBudget"));
    for (uint32_t i = 0; i < 2; i++) {
        runner_image_init(&images[i],
                          i ? SLUICE_FORMAT_R32G32B32A32_SFLOAT : SLUICE_FORMAT_R8G8B8A8_UNORM,
                          SIZE, SIZE, i);
        runner_add_tiles(&r, runner_add_texture(&r, &images[i]), SIZE, 0, TILES);
    }
    listen_to(r.loader);
    for (uint32_t i = 0; i < 60; i++) {
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    }
    assert_in_range(runner_load(&r, 60), 1, 59);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_CHUNKS_EXHAUSTED], 1);
    assert_int_equal(heard.values[SLUICE_DEMAND_MISUSE_CHUNKS_EXHAUSTED], 2);
    SluiceDemandStatistics statistics = runner_statistics(&r);
    assert_true(runner_all_resident(&r));
    assert_int_equal(statistics.pageChunkCount, 2);
    assert_true(statistics.lodBias < 4);
    assert_in_range(statistics.residentTileCount, 50, 2 * 64);
    h.quiet = false;
    runner_finish(&r);
    for (uint32_t i = 0; i < 2; i++)
        runner_image_finish(&images[i]);
    CHECK_OK(harness_set_context(&h, NULL));
}

/* Launches without misses must not look like launches without samples. With few tiles in flight,
 * shaders report used tiles for strict mode only. */
static void resident_tiles_that_are_sampled_are_no_misuse(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .maxTilesInFlight = 16};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    runner_add_texel(&r, runner_add_texture(&r, &image), 300, 300, 0, 2, 2);
    runner_load(&r, 9);
    listen_to(r.loader);
    for (uint32_t i = 0; i < 30; i++)
        runner_launch(&r);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_NO_REQUESTS], 0);
    runner_clear(&r);
    for (uint32_t i = 0; i < 9; i++)
        runner_launch(&r);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_NO_REQUESTS], 1);
    assert_int_equal(heard.values[SLUICE_DEMAND_MISUSE_NO_REQUESTS], 8);
    runner_finish(&r);
    runner_image_finish(&image);
}

static SluiceResult fill_page(void *user, uint32_t page, uint64_t *value)
{
    (void)user;
    *value = page;
    return SLUICE_SUCCESS;
}

static void pages_and_ids_that_run_out_are_reported(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandResourceId id;
    uint32_t first;
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .pageCapacity = 1u << 12, .maxTextureCount = 64};
    const SluiceDemandResourceCreateInfo resource = {.structSize = sizeof resource,
                                                     .pageCount = 100,
                                                     .maxResidentPageCount = 10,
                                                     .pfnFill = fill_page};
    h.quiet = true;
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 16384, 16384, 1);
    image.info.pName = "large";
    CHECK_OK(sluiceAddDemandResource(r.loader, &resource, &id, &first));
    listen_to(r.loader);
    for (uint32_t i = 0; i < 25; i++)
        runner_add_page(&r, first + i);
    runner_launch(&r);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_PAGES_EXHAUSTED], 1);
    assert_int_equal(heard.values[SLUICE_DEMAND_MISUSE_PAGES_EXHAUSTED], 15);
    runner_clear(&r);
    runner_add_texel(&r, runner_add_texture(&r, &image), 16384, 16384, 0, 2, 2);
    runner_load(&r, 9);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_IDS_EXHAUSTED], 1);
    assert_int_equal(heard.values[SLUICE_DEMAND_MISUSE_IDS_EXHAUSTED], 1u << 12);
    runner_finish(&r);
    runner_image_finish(&image);
    h.quiet = false;
}

static void preloaded_levels_are_there_before_they_are_sampled(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandTicket ticket;
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .maxTilesInFlight = 32};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 2048, 2048, 1);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    CHECK_OK(sluicePreloadDemandTexture(r.loader, id, 1, &ticket));
    uint32_t launches = 0;
    do { /* more tiles than may be in flight: launches copy arrived tiles */
        CHECK_OK(sluiceWaitDemandTicket(r.loader, ticket, UINT64_MAX, &status));
        runner_launch(&r);
        assert_true(++launches < 50);
    } while (status.remainingCount);
    runner_launch(&r);
    /* The opening; levels 1 to 4 with 64, 16, 4 and 1 tiles; and the tail, where 64 is half a
     * tile. */
    assert_int_equal(status.taskCount, 1 + 64 + 16 + 4 + 1 + 1);
    assert_int_equal(status.failedCount, 0);
    assert_int_equal(runner_statistics(&r).residentTileCount, status.taskCount - 1);
    for (uint32_t i = 0; i < 64; i++)
        runner_add_texel(&r, id, 2048, 2048, 1, i % 8 * TILE, i / 8 * TILE);
    for (uint32_t l = 2; l < 12; l++)
        runner_add_texel(&r, id, 2048, 2048, l, 0, 0);
    runner_launch(&r);
    assert_int_equal(r.requests.missingCount, 0);
    runner_check_texel(&r, 63, &image, 1, 7 * TILE, 7 * TILE);
    /* A second preload has nothing to do. */
    CHECK_OK(sluicePreloadDemandTexture(r.loader, id, 1, &ticket));
    CHECK_OK(sluiceWaitDemandTicket(r.loader, ticket, 0, &status));
    assert_int_equal(status.taskCount, 0);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void what_finds_no_memory_is_left_out_of_a_preload(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandTicket ticket;
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = 4u << 20, .maxTilesInFlight = 32};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    CHECK_OK(sluicePreloadDemandTexture(r.loader, runner_add_texture(&r, &image), 0, &ticket));
    uint32_t launches = 0;
    do {
        CHECK_OK(sluiceWaitDemandTicket(r.loader, ticket, UINT64_MAX, &status));
        runner_launch(&r);
        assert_true(++launches < 50);
    } while (status.remainingCount);
    runner_launch(&r);
    SluiceDemandStatistics statistics = runner_statistics(&r);
    assert_in_range(statistics.residentTileCount, 32, 64);
    assert_int_equal(statistics.evictedCount, 0);
    assert_true(statistics.tileMemorySize <= info.memoryBudget);
    runner_finish(&r);
    runner_image_finish(&image);
}

static SluiceResult read_byte_page(void *user, uint32_t page, uint32_t size, void *bytes)
{
    (void)user;
    memset(bytes, (int)page, size);
    return SLUICE_SUCCESS;
}

static void tiles_give_the_share_of_byte_pages_up_while_they_are_sampled(void **state)
{
    (void)state;
    if (!h.reads_bytes)
        skip();
    const uint64_t budget = 32u << 20, share = 12u << 20;
    struct runner r;
    struct runner_image image;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = budget,
                                               .byteMemoryBudget = share,
                                               .maxTextureCount = 64,
                                               .pageCapacity = 1u << 16};
    h.runs_bytes = true;
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    runner_add_tiles(&r, runner_add_texture(&r, &image), SIZE, 0, 15);
    runner_load(&r, 60);
    assert_true(runner_statistics(&r).tileMemorySize > budget - share);
    const SluiceDemandResourceCreateInfo create = {.structSize = sizeof create,
                                                   .pageCount = 160,
                                                   .rank = 1,
                                                   .pageSize = 65536,
                                                   .pfnRead = read_byte_page};
    SluiceDemandResourceId id;
    uint32_t first;
    CHECK_OK(sluiceAddDemandResource(r.loader, &create, &id, &first));
    for (uint32_t i = 0; i < create.pageCount; i++)
        runner_add(&r, (struct RunnerInput){
                           .kind = RUNNER_BYTES, .index = first + i, .dx = {(float)65536}});
    for (uint32_t i = 0; i < 16; i++) {
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    }
    SluiceDemandStatistics after = runner_statistics(&r);
    print_message("# shareOfBytes tiles %llu, byte pages %llu of %llu bytes\n",
                  (unsigned long long)after.tileMemorySize,
                  (unsigned long long)after.byteMemorySize, (unsigned long long)budget);
    assert_true(after.tileMemorySize <= budget - share);
    assert_true(runner_load(&r, 60) < 60);
    assert_true(runner_all_resident(&r));
    assert_true(runner_statistics(&r).tileMemorySize <= budget - share);
    runner_finish(&r);
    h.runs_bytes = false;
    runner_image_finish(&image);
}

static void page_tables_of_64_mi_pages_cost_at_most_64_megabytes(void **state)
{
    (void)state;
    struct runner r;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .pageCapacity = 1u << 26,
                                               .maxTextureCount = 1u << 17,
                                               .memoryBudget = 256u << 20};
    runner_init(&r, &h, &info);
    uint64_t size = runner_statistics(&r).deviceMemorySize;
    print_message("# deviceMemory.pages %llu bytes\n", (unsigned long long)size);
    assert_true(size <= 64000000);
    runner_finish(&r);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_loader_takes_little_staging_memory_and_more_when_it_reads),
        cmocka_unit_test(a_loader_makes_the_staging_memory_that_it_is_asked_for),
        cmocka_unit_test(images_of_pages_are_made_when_the_first_texture_opens),
        cmocka_unit_test(a_working_set_beyond_the_budget_ends_complete_and_blurrier),
        cmocka_unit_test(without_a_bias_some_tiles_stay_away_and_coarser_ones_are_shown_there),
        cmocka_unit_test(tiles_that_nobody_uses_make_room_and_come_back_unread),
        cmocka_unit_test(views_that_walk_to_and_fro_never_show_other_texels),
        cmocka_unit_test(tiles_that_were_evicted_and_not_overwritten_need_no_read),
        cmocka_unit_test(restored_tiles_are_not_shared_with_a_texture_that_changed),
        cmocka_unit_test(without_eviction_what_is_there_stays),
        cmocka_unit_test(formats_share_a_budget),
        cmocka_unit_test(formats_share_few_images_of_pages),
        cmocka_unit_test(resident_tiles_that_are_sampled_are_no_misuse),
        cmocka_unit_test(pages_and_ids_that_run_out_are_reported),
        cmocka_unit_test(preloaded_levels_are_there_before_they_are_sampled),
        cmocka_unit_test(what_finds_no_memory_is_left_out_of_a_preload),
        cmocka_unit_test(tiles_give_the_share_of_byte_pages_up_while_they_are_sampled),
        cmocka_unit_test(page_tables_of_64_mi_pages_cost_at_most_64_megabytes),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
