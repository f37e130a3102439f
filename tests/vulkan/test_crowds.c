/* More textures than the device supports: the rest streams, and a log line says what to do. */
#include "vulkan/fake_vulkan.h"

#include "support/streamer_manager.h"
#include "support/gray_source.h"
#include "support/test.h"

#include <sluice/vulkan_strict.h>
#include <string.h>

enum { BEARABLE = 3 };

static void note_error(void *user, SluiceLogSeverity severity, const char *message)
{
    if (severity == SLUICE_LOG_ERROR && strstr(message, "paged mode"))
        ++*(uint32_t *)user;
}

static uint8_t want_nothing(void *user, uint32_t region)
{
    (void)user, (void)region;
    return SLUICE_MIP_UNTOUCHED;
}

static void frame(struct fake_vulkan *fake, SluiceVulkanStreamer *streamer, uint64_t time)
{
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    fake->published = false;
    fake->copy_count = fake->bind_count = 0;
    fake->bind_value = fake->submitted_bind_value;
    CHECK_OK(sluiceWaitVulkanStreamerIdle(streamer));
    CHECK_OK(sluiceBeginStreamingFrame(streamer, fake_vulkan_commands(fake), time, &frame));
    CHECK_OK(sluiceEndStreamingFrame(streamer, fake_vulkan_commands(fake)));
    fake->frame_semaphore = frame.semaphore;
    fake->frame_value = frame.signalValue;
}

static void a_texture_beyond_the_tiles_of_the_device_is_refused_and_others_go_on(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    uint32_t errors = 0;
    fake = (struct fake_vulkan){.tail_page_count = 1, .want = want_nothing};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_SPARSE,
                                           .maxTextureCount = 8,
                                           .maxRegionCount = 256,
                                           .maxTouchedTiles = BEARABLE};
    fake.log = (SluiceLogCallback){&errors, note_error};
    fake_vulkan_fill(&info);
    SluiceVulkanStreamer *streamer;
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create};
    create.source = gray_source(64, 64);
    SluiceVulkanTexture texture;
    for (uint32_t i = 0; i < BEARABLE; i++)
        CHECK_OK(sluiceAddVulkanTexture(streamer, &create, &texture));
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &create, &texture), SLUICE_ERROR_LIMIT_EXCEEDED);
    assert_int_equal(errors, 1);
    for (uint64_t time = 1; time < 8; time++)
        frame(&fake, streamer, time);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(streamer, &stats);
    assert_int_equal(stats.mappedTileCount, BEARABLE);
    fake_vulkan_destroy(streamer);
    sluiceDestroyImageSource(create.source);
    assert_int_equal(fake.live_objects, 0);
}

static void count_shortages(void *user, SluiceLogSeverity severity, const char *message)
{
    if (severity == SLUICE_LOG_WARNING && strstr(message, "maxPageChunkCount"))
        ++*(uint32_t *)user;
}

static uint8_t want_all(void *user, uint32_t region)
{
    (void)user, (void)region;
    return 0;
}

static void count_misuse(void *user, const SluiceMisuse *misuse)
{
    assert_true(misuse->kind == SLUICE_MISUSE_CHUNKS_EXHAUSTED && misuse->value == 2);
    assert_non_null(strstr(misuse->pMessage, "all 2 images of pages are in use"));
    assert_non_null(strstr(misuse->pMessage, "Raise maxPageChunkCount"));
    ++*(uint32_t *)user;
}

static void a_lack_of_page_chunks_is_logged_once_and_counted(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    uint32_t warnings = 0;
    fake = (struct fake_vulkan){.want = want_all, .maxPageChunkCount = 2};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .maxTextureCount = 8,
                                           .maxRegionCount = 1024,
                                           .feedbackTimeoutTicks = 1000};
    fake.log = (SluiceLogCallback){&warnings, count_shortages};
    fake_vulkan_fill(&info);
    info.residencyMode = SLUICE_RESIDENCY_MODE_PAGED;
    SluiceVulkanStreamer *streamer;
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create};
    create.source = gray_source(2048, 2048);
    SluiceVulkanTexture texture;
    CHECK_OK(sluiceAddVulkanTexture(streamer, &create, &texture));
    uint32_t misuse_count = 0;
    const SluiceVulkanStrictMode strict = {
        .structSize = sizeof strict, .pUserData = &misuse_count, .pfnReport = count_misuse};
    CHECK_OK(sluiceSetVulkanStrictMode(streamer, &strict));
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(streamer, &stats));
    assert_int_equal(stats.pageChunkCount, 0);
    for (uint64_t time = 1; time < 200; time++)
        frame(&fake, streamer, time);
    CHECK_OK(sluiceGetVulkanStreamerStatistics(streamer, &stats));
    assert_int_equal(stats.pageChunkCount, 2); /* 64 tiles each; level 0 alone has 256 */
    assert_in_range(stats.pageChunkShortages, 2, 10);
    assert_int_equal(warnings, 1);
    assert_int_equal(misuse_count, 1); /* the next report follows after 600 frames */
    assert_int_equal(stats.tilesMapped - stats.tilesUnmapped, 2 * 64 + 2);
    fake_vulkan_destroy(streamer);
    sluiceDestroyImageSource(create.source);
    assert_int_equal(fake.live_objects, 0);
}

/* The first texture has the regions below 256, the second one the others. */
static uint8_t want_one(void *user, uint32_t region)
{
    return (region < 256) == (*(uint32_t *)user == 0) ? 0 : SLUICE_MIP_UNTOUCHED;
}

static void standby_tiles_give_their_pages_to_tiles_that_are_wanted(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    uint32_t seen = 0;
    fake = (struct fake_vulkan){.want = want_one, .user = &seen, .maxPageChunkCount = 2};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .maxTextureCount = 8,
                                           .maxRegionCount = 1024,
                                           .feedbackTimeoutTicks = 2,
                                           .numExtraStandbyTiles = 1024};
    fake_vulkan_fill(&info);
    info.residencyMode = SLUICE_RESIDENCY_MODE_PAGED;
    SluiceVulkanStreamer *streamer;
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    SluiceImageSource *sources[2];
    SluiceVulkanTexture texture;
    for (uint32_t i = 0; i < 2; i++) {
        sources[i] = gray_source(2048 >> i, 2048 >> i);
        SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = sources[i]};
        CHECK_OK(sluiceAddVulkanTexture(streamer, &create, &texture));
    }
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    for (uint64_t time = 1; time < 60; time++)
        frame(&fake, streamer, time);
    seen = 1; /* 85 tiles; 128 have pages */
    for (uint64_t time = 60; time < 100; time++)
        frame(&fake, streamer, time);
    CHECK_OK(sluiceGetVulkanStreamerStatistics(streamer, &stats));
    assert_true(stats.pageChunkShortages > 0);
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    const SluiceStreamedTextureManager *manager = manager_of(streamer);
    CHECK_OK(sluiceGetTextureLayout(manager, texture.textureId, &layout));
    for (uint32_t i = 0; i < layout.tileCount; i++) {
        SluiceTileState tile_state;
        CHECK_OK(sluiceGetTileState(manager, texture.textureId, i, &tile_state, NULL));
        assert_int_equal(tile_state, SLUICE_TILE_STATE_MAPPED);
    }
    assert_in_range(stats.standbyTileCount, 30, 128); /* only as many as necessary were evicted */
    fake_vulkan_destroy(streamer);
    for (uint32_t i = 0; i < 2; i++)
        sluiceDestroyImageSource(sources[i]);
    assert_int_equal(fake.live_objects, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lack_of_page_chunks_is_logged_once_and_counted),
        cmocka_unit_test(standby_tiles_give_their_pages_to_tiles_that_are_wanted),
        cmocka_unit_test(a_texture_beyond_the_tiles_of_the_device_is_refused_and_others_go_on),
    };
    return RUN_TESTS(tests);
}
