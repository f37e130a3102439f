/* Failing reads, from the source through the loader and the manager to the shown texels. */
#include "vulkan/fake_vulkan.h"

#include "support/streamer_manager.h"
#include "support/gray_source.h"
#include "support/test.h"

#include <stdatomic.h>
#include <string.h>

enum { SIZE = 512, TILES = SIZE / FAKE_TILE, LOADER_ATTEMPTS = 3, MANAGER_ATTEMPTS = 5 };

/* A source that can fail. Broken: two tiles of level 0 cannot be read. Outage: all of level 0
 * cannot be read. Absent: no read is ready. */
struct broken_source {
    SluiceImageSource base;
    SluiceImageSource *inner;
    atomic_bool is_broken, is_out, is_absent;
    atomic_uint refused[TILES][TILES];
};

static bool is_lost(uint32_t x, uint32_t y)
{
    return (x == 2 && y == 1) || (x == 3 && y == 3);
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct broken_source *)base)->inner, info);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct broken_source *source = (struct broken_source *)base;
    uint32_t x = region->x / FAKE_TILE, y = region->y / FAKE_TILE;
    bool is_lost_now = is_lost(x, y) && atomic_load(&source->is_broken);
    if (atomic_load(&source->is_absent))
        return SLUICE_NOT_READY;
    if (region->mipLevel == 0 && (is_lost_now || atomic_load(&source->is_out))) {
        atomic_fetch_add(&source->refused[y][x], 1);
        return SLUICE_ERROR_IO;
    }
    return sluiceReadImageRegion(source->inner, region, texels, row_pitch);
}

static void destroy(SluiceImageSource *base)
{
    (void)base;
}

static const SluiceImageSourceInterface broken_interface = {sizeof broken_interface, get_info,
                                                            read_region, destroy};

static uint8_t want_all(void *user, uint32_t region)
{
    (void)user, (void)region;
    return 0;
}

struct fixture {
    struct fake_vulkan fake;
    struct broken_source source;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanTexture texture;
    uint64_t time;
    uint32_t warnings, recoveries;
    uint32_t loads_in_flight; ///< set before setup; 0: default
    uint32_t lost_copies;     ///< copies to the tiles that cannot be read
};

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct fixture *f = user;
    f->recoveries += severity == SLUICE_LOG_INFO && strstr(message, "can be read again") != NULL;
    if (severity != SLUICE_LOG_WARNING)
        return;
    f->warnings++;
    assert_non_null(strstr(message, f->warnings % 2 ? "broken picture: read failed: SLUICE_"
                                                    : "broken picture: "));
    assert_non_null(strstr(message, f->warnings % 2 ? "retrying in" : "Retrying every"));
}

static void setup_with_rest(struct fixture *f, SluiceResidencyMode mode, uint64_t rest)
{
    SluiceImageInfo image_info = {.structSize = sizeof image_info,
                                  .width = SIZE,
                                  .height = SIZE,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "broken picture"};
    *f = (struct fixture){.loads_in_flight = f->loads_in_flight,
                          .fake = {.tail_page_count = 1, .want = want_all}};
    f->source.base.pInterface = &broken_interface;
    f->source.inner = gray_source_with(&image_info);
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .maxTextureCount = 2,
                                           .maxRegionCount = 256,
                                           .feedbackTimeoutTicks = 1u << 30,
                                           .retryDelayTicks = 1,
                                           .maxLoadsInFlight = f->loads_in_flight,
                                           .givenUpRetryDelayTicks = rest};
    f->fake.log = (SluiceLogCallback){f, on_log};
    f->fake.loaderThreadCount = 2;
    f->fake.readRetry = (SluiceTileRetryPolicy){LOADER_ATTEMPTS, 1, 1};
    fake_vulkan_fill(&info);
    info.residencyMode = mode;
    CHECK_OK(fake_vulkan_create(&f->fake, &info, &f->streamer));
    SluiceVulkanTextureCreateInfo texture_info = {.structSize = sizeof texture_info,
                                                  .source = &f->source.base};
    CHECK_OK(sluiceAddVulkanTexture(f->streamer, &texture_info, &f->texture));
}

static void setup(struct fixture *f, SluiceResidencyMode mode)
{
    setup_with_rest(f, mode, UINT64_C(1) << 40);
}

static void teardown(struct fixture *f)
{
    fake_vulkan_destroy(f->streamer);
    sluiceDestroyImageSource(f->source.inner);
    assert_int_equal(f->fake.live_objects, 0);
}

/* Runs frames far enough apart that every delay of the manager has passed. */
static void run_frames(struct fixture *f, uint32_t count)
{
    struct fake_vulkan *fake = &f->fake;
    for (uint32_t i = 0; i < count; i++) {
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        fake->published = false;
        fake->copy_count = fake->bind_count = 0;
        fake->bind_value = fake->submitted_bind_value;
        f->time += 1000;
        CHECK_OK(sluiceWaitVulkanStreamerIdle(f->streamer));
        CHECK_OK(
            sluiceBeginStreamingFrame(f->streamer, fake_vulkan_commands(fake), f->time, &frame));
        for (uint32_t k = 0; k < fake->copy_count; k++)
            f->lost_copies +=
                fake->copies[k].level == 0 && is_lost(fake->copies[k].x, fake->copies[k].y);
        CHECK_OK(sluiceEndStreamingFrame(f->streamer, fake_vulkan_commands(fake)));
        fake->frame_semaphore = frame.semaphore;
        fake->frame_value = frame.signalValue;
    }
}

/* Checks the state and the sampled level of each tile of level 0. */
static void check_level_0(struct fixture *f, SluiceTileState lost_state, uint8_t lost_level)
{
    SluiceStreamedTextureManager *manager = manager_of(f->streamer);
    uint8_t map[TILES * TILES];
    CHECK_OK(sluiceWriteMinMipData(manager, f->texture.textureId, TILES, sizeof map, map));
    for (uint32_t y = 0; y < TILES; y++)
        for (uint32_t x = 0; x < TILES; x++) {
            SluiceTileState tile_state;
            CHECK_OK(sluiceGetTileState(manager, f->texture.textureId, y * TILES + x, &tile_state,
                                        NULL));
            assert_int_equal(tile_state, is_lost(x, y) ? lost_state : SLUICE_TILE_STATE_MAPPED);
            assert_int_equal(map[y * TILES + x], is_lost(x, y) ? lost_level : 0);
        }
}

static void check_given_up(struct fixture *f)
{
    SluiceStreamedTextureManager *manager = manager_of(f->streamer);
    SluiceTile tiles[8];
    uint32_t count = 8;
    CHECK_OK(sluiceGetGivenUpTiles(manager, &count, tiles));
    assert_int_equal(count, 2);
    for (uint32_t i = 0; i < 2; i++)
        assert_true(tiles[i].mipLevel == 0 && is_lost(tiles[i].x, tiles[i].y));
}

static void check_counts(struct fixture *f)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    SluiceTileLoaderStatistics reads = {.structSize = sizeof reads},
                               all = {.structSize = sizeof all};
    sluiceGetVulkanStreamerStatistics(f->streamer, &stats);
    CHECK_OK(sluiceGetVulkanReadStatistics(f->streamer, &f->source.base, &reads));
    CHECK_OK(sluiceGetVulkanReadStatistics(f->streamer, NULL, &all));
    assert_int_equal(stats.tilesFailed, 2 * MANAGER_ATTEMPTS);
    assert_int_equal(stats.givenUpTileCount, 2);
    assert_int_equal(stats.loadsInFlight, 0);
    assert_int_equal(reads.givenUpCount, 2 * MANAGER_ATTEMPTS);
    assert_int_equal(reads.failedCount, 2 * MANAGER_ATTEMPTS * LOADER_ATTEMPTS);
    assert_int_equal(reads.retriedCount, 2 * MANAGER_ATTEMPTS * (LOADER_ATTEMPTS - 1));
    assert_int_equal(reads.byteCount, stats.bytesRead);
    assert_memory_equal(&reads, &all, sizeof all); /* there is one source */
    assert_int_equal(f->warnings, 2);              /* one for failing reads, one for giving up */
    assert_int_equal(f->recoveries, 0);
    for (uint32_t y = 0; y < TILES; y++)
        for (uint32_t x = 0; x < TILES; x++)
            assert_int_equal(f->source.refused[y][x],
                             is_lost(x, y) ? MANAGER_ATTEMPTS * LOADER_ATTEMPTS : 0);
}

static void check_story(SluiceResidencyMode mode)
{
    static struct fixture f; /* large */
    setup(&f, mode);
    f.source.is_broken = true;
    run_frames(&f, 30);
    check_level_0(&f, SLUICE_TILE_STATE_GIVEN_UP, 1);
    check_given_up(&f);
    check_counts(&f);
    if (mode == SLUICE_RESIDENCY_MODE_SPARSE) /* in other modes, copies go to pages */
        assert_int_equal(f.lost_copies, 0);

    f.source.is_broken = false;
    run_frames(&f, 5); /* no retry without a request */
    check_level_0(&f, SLUICE_TILE_STATE_GIVEN_UP, 1);
    SluiceStreamedTextureManager *manager = manager_of(f.streamer);
    CHECK_OK(sluiceRetryFailedTiles(manager, f.texture.textureId));
    run_frames(&f, 5);
    check_level_0(&f, SLUICE_TILE_STATE_MAPPED, 0);
    if (mode == SLUICE_RESIDENCY_MODE_SPARSE)
        assert_int_equal(f.lost_copies, 2);
    assert_int_equal(f.warnings, 2);
    assert_int_equal(f.recoveries, 1);
    teardown(&f);
}

static void tiles_that_are_given_up_stay_coarser_until_they_are_asked_for_again(void **state)
{
    (void)state;
    check_story(SLUICE_RESIDENCY_MODE_SPARSE);
    check_story(SLUICE_RESIDENCY_MODE_PAGED);
    check_story(SLUICE_RESIDENCY_MODE_DENSE);
}

/* Fails while the manager still retries by itself. */
static void tiles_that_fail_for_a_while_come_by_themselves(void **state)
{
    (void)state;
    static struct fixture f; /* large */
    setup(&f, SLUICE_RESIDENCY_MODE_SPARSE);
    f.source.is_broken = true;
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    while (stats.tilesFailed < 4) {
        run_frames(&f, 1);
        sluiceGetVulkanStreamerStatistics(f.streamer, &stats);
    }
    f.source.is_broken = false;
    run_frames(&f, 10);
    check_level_0(&f, SLUICE_TILE_STATE_MAPPED, 0);
    sluiceGetVulkanStreamerStatistics(f.streamer, &stats);
    assert_true(stats.tilesFailed >= 4 && stats.tilesFailed <= 6); /* two may be under way */
    assert_int_equal(f.warnings, 1);
    assert_int_equal(f.recoveries, 1);
    assert_int_equal(stats.givenUpTileCount, 0);
    teardown(&f);
}

static uint32_t count_refused(const struct fixture *f)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < TILES * TILES; i++)
        count += f->source.refused[i / TILES][i % TILES];
    return count;
}

/* Lasts longer than all attempts, without calls: four reads per interval at first, later all. */
static void after_an_outage_every_tile_comes_by_itself(void **state)
{
    (void)state;
    static const SluiceResidencyMode modes[] = {
        SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};
    for (int m = 0; m < 3; m++) {
        static struct fixture f; /* large */
        setup_with_rest(&f, modes[m], 50 * 1000);
        f.source.is_out = true;
        run_frames(&f, 30);
        uint32_t first = count_refused(&f);
        assert_int_equal(first, TILES * TILES * MANAGER_ATTEMPTS * LOADER_ATTEMPTS);
        run_frames(&f, 200);
        assert_true(count_refused(&f) > first);
        assert_true(count_refused(&f) <= first + 5 * 4 * LOADER_ATTEMPTS);
        assert_int_equal(f.warnings, 2);
        f.source.is_out = false;
        run_frames(&f, 60);
        check_level_0(&f, SLUICE_TILE_STATE_MAPPED, 0);
        assert_int_equal(f.warnings, 2);
        assert_int_equal(f.recoveries, 1);
        teardown(&f);
    }
}

static void a_source_that_is_said_to_be_well_is_read_at_once(void **state)
{
    (void)state;
    static struct fixture f; /* large */
    setup(&f, SLUICE_RESIDENCY_MODE_PAGED);
    f.source.is_out = true;
    run_frames(&f, 30);
    f.source.is_out = false;
    CHECK_RESULT(sluiceRetryVulkanSource(NULL, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_OK(sluiceRetryVulkanSource(f.streamer, f.source.inner)); /* belongs to no texture */
    run_frames(&f, 5);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(f.streamer, &stats);
    assert_int_equal(stats.givenUpTileCount, TILES * TILES);
    CHECK_OK(sluiceRetryVulkanSource(f.streamer, &f.source.base));
    run_frames(&f, 5);
    check_level_0(&f, SLUICE_TILE_STATE_MAPPED, 0);
    teardown(&f);
}

/* A source that fails and recovers repeatedly must not log two lines each time. */
static void messages_of_a_source_that_comes_and_goes_are_bounded(void **state)
{
    (void)state;
    static struct fixture f; /* large */
    setup_with_rest(&f, SLUICE_RESIDENCY_MODE_PAGED, 1000 * 1000);
    for (uint32_t i = 0; i < 50; i++) {
        f.source.is_broken = i % 2 == 0;
        CHECK_OK(sluiceRetryVulkanSource(f.streamer, NULL));
        run_frames(&f, 3);
        SluiceStreamedTextureManager *manager = manager_of(f.streamer);
        CHECK_OK(sluiceTrimStandbyTiles(manager, 0));
    }
    assert_true(f.warnings <= 2);
    assert_true(f.recoveries <= 1);
    teardown(&f);
}

/* Textures that are not ready must not occupy every staging slot. */
static void sources_that_are_not_ready_leave_room_for_others(void **state)
{
    (void)state;
    static struct fixture f; /* large */
    static struct broken_source other;
    f.loads_in_flight = 8;
    setup(&f, SLUICE_RESIDENCY_MODE_PAGED);
    run_frames(&f, 1); /* coarse levels are there */
    f.source.is_absent = true;
    other = (struct broken_source){.base.pInterface = &broken_interface, .inner = f.source.inner};
    SluiceVulkanTexture second;
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = &other.base};
    run_frames(&f, 5);
    CHECK_OK(sluiceAddVulkanTexture(f.streamer, &info, &second));
    run_frames(&f, 20);
    SluiceStreamedTextureManager *manager = manager_of(f.streamer);
    for (uint32_t i = 0; i < TILES * TILES; i++) {
        SluiceTileState tile_state;
        CHECK_OK(sluiceGetTileState(manager, second.textureId, i, &tile_state, NULL));
        assert_int_equal(tile_state, SLUICE_TILE_STATE_MAPPED);
    }
    teardown(&f);
}

/* With few loads in flight, most tiles are reported to the manager as failed, and requested
 * again. */
static void sources_that_are_not_ready_are_no_trouble(void **state)
{
    (void)state;
    static struct fixture f; /* large */
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    f.loads_in_flight = 8;
    setup(&f, SLUICE_RESIDENCY_MODE_SPARSE);
    f.source.is_absent = true;
    run_frames(&f, 20);
    sluiceGetVulkanStreamerStatistics(f.streamer, &stats);
    assert_true(stats.tilesNotReady > 0);
    assert_int_equal(stats.tilesFailed, 0);
    f.source.is_absent = false;
    CHECK_OK(sluiceRetryVulkanSource(f.streamer, &f.source.base));
    run_frames(&f, 60);
    for (uint32_t i = 0; i < TILES * TILES; i++) {
        SluiceTileState tile_state;
        CHECK_OK(
            sluiceGetTileState(manager_of(f.streamer), f.texture.textureId, i, &tile_state, NULL));
        assert_int_equal(tile_state, SLUICE_TILE_STATE_MAPPED);
    }
    assert_true(f.warnings == 0 && f.recoveries == 0);
    teardown(&f);
}

static void statistics_of_a_removed_texture_are_forgotten(void **state)
{
    (void)state;
    static struct fixture f; /* large */
    SluiceTileLoaderStatistics reads = {.structSize = sizeof reads};
    setup(&f, SLUICE_RESIDENCY_MODE_SPARSE);
    SluiceVulkanTextureCreateInfo again = {.structSize = sizeof again, .source = &f.source.base};
    SluiceVulkanTexture second;
    CHECK_OK(sluiceAddVulkanTexture(f.streamer, &again, &second));
    run_frames(&f, 10);
    CHECK_OK(sluiceRemoveVulkanTexture(f.streamer, f.texture.textureId));
    run_frames(&f, 5);
    CHECK_OK(sluiceGetVulkanReadStatistics(f.streamer, &f.source.base, &reads));
    assert_true(reads.readCount > 0); /* the other one still has it */
    CHECK_OK(sluiceRemoveVulkanTexture(f.streamer, second.textureId));
    run_frames(&f, 5);
    CHECK_OK(sluiceGetVulkanReadStatistics(f.streamer, &f.source.base, &reads));
    assert_int_equal(reads.readCount, 0);
    CHECK_OK(sluiceGetVulkanReadStatistics(f.streamer, NULL, &reads));
    assert_true(reads.readCount > 0);
    CHECK_RESULT(sluiceGetVulkanReadStatistics(NULL, NULL, &reads), SLUICE_ERROR_NULL_POINTER);
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_that_are_given_up_stay_coarser_until_they_are_asked_for_again),
        cmocka_unit_test(tiles_that_fail_for_a_while_come_by_themselves),
        cmocka_unit_test(sources_that_are_not_ready_are_no_trouble),
        cmocka_unit_test(statistics_of_a_removed_texture_are_forgotten),
        cmocka_unit_test(after_an_outage_every_tile_comes_by_itself),
        cmocka_unit_test(a_source_that_is_said_to_be_well_is_read_at_once),
        cmocka_unit_test(messages_of_a_source_that_comes_and_goes_are_bounded),
        cmocka_unit_test(sources_that_are_not_ready_leave_room_for_others),
    };
    return RUN_TESTS(tests);
}
