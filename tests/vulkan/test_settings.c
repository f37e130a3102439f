/* Changed settings of a running application take effect with the next frame or launch, or not at
 * all. */
#include "vulkan/fake_vulkan.h"

#include "support/failing_allocator.h"
#include "support/streamer_manager.h"
#include "support/gray_source.h"
#include "support/test.h"

#include <sluice/demand.h>
#include <sluice/vulkan_explain.h>

#include <stddef.h>
#include <string.h>

enum { TEXTURES = 4 };

struct stage {
    struct fake_vulkan fake;
    struct failing_allocator memory;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceDemandLoader *loader;
    SluiceImageSource *source;
    SluiceTextureId last_texture;
    uint64_t time;
    bool looks, looks_at_some;
    char last[256]; ///< last message
};

static uint8_t want(void *user, uint32_t region)
{
    const struct stage *s = user;
    return s->looks || (s->looks_at_some && region % 4 == 0) ? 0 : SLUICE_MIP_UNTOUCHED;
}

static void keep_message(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)severity;
    strncpy(((struct stage *)user)->last, message, sizeof((struct stage *)user)->last - 1);
}

static struct stage *stage_init(const SluiceVulkanStreamerCreateInfo *settings)
{
    static struct stage s; /* large */
    s = (struct stage){.fake = {.tail_page_count = 1, .want = want, .user = &s}, .looks = true};
    failing_allocator_init(&s.memory, UINT64_MAX);
    s.fake.log = (SluiceLogCallback){&s, keep_message};
    s.fake.pAllocator = &s.memory.callbacks;
    s.source = gray_source(1024, 1024);
    SluiceVulkanStreamerCreateInfo info = *settings;
    info.maxTextureCount = TEXTURES;
    info.maxRegionCount = 1 << 10;
    fake_vulkan_fill(&info);
    CHECK_OK(fake_vulkan_create(&s.fake, &info, &s.streamer));
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = s.source};
    SluiceVulkanTexture texture;
    for (int i = 0; i < TEXTURES; i++)
        CHECK_OK(sluiceAddVulkanTexture(s.streamer, &create, &texture));
    s.last_texture = texture.textureId;
    return &s;
}

static void stage_finish(struct stage *s)
{
    fake_vulkan_destroy(s->streamer);
    sluiceDestroyImageSource(s->source);
    assert_true(s->fake.live_objects == 0 && s->memory.live_bytes == 0);
}

static SluiceVulkanStreamerStatistics statistics(const struct stage *s)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(s->streamer, &stats));
    return stats;
}

static void frame(struct stage *s)
{
    struct fake_vulkan *fake = &s->fake;
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    fake->published = false;
    fake->copy_count = fake->bind_count = 0;
    fake->bind_value = fake->submitted_bind_value;
    CHECK_OK(sluiceWaitVulkanStreamerIdle(s->streamer));
    CHECK_OK(sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(fake), ++s->time, &frame));
    CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(fake)));
    fake->frame_semaphore = frame.semaphore;
    fake->frame_value = frame.signalValue;
}

static SluiceVulkanStreamerSettings get(const struct stage *s)
{
    SluiceVulkanStreamerSettings settings = {.structSize = sizeof settings};
    CHECK_OK(sluiceGetVulkanStreamerSettings(s->streamer, &settings));
    return settings;
}

static bool are_same(const SluiceVulkanStreamerSettings *a, const SluiceVulkanStreamerSettings *b)
{
    return a->structSize == b->structSize && a->texturesPerFrame == b->texturesPerFrame &&
           a->tilesPerFrame == b->tilesPerFrame &&
           a->numExtraStandbyTiles == b->numExtraStandbyTiles &&
           a->maxHeapCount == b->maxHeapCount &&
           a->feedbackTimeoutTicks == b->feedbackTimeoutTicks &&
           a->residencyFadeTicks == b->residencyFadeTicks &&
           a->retryDelayTicks == b->retryDelayTicks &&
           a->givenUpRetryDelayTicks == b->givenUpRetryDelayTicks &&
           a->noEviction == b->noEviction && a->noMipBias == b->noMipBias &&
           a->framesPerRound == b->framesPerRound && a->holdLoads == b->holdLoads &&
           a->missesToExpire == b->missesToExpire && a->prefetchLevels == b->prefetchLevels;
}

static void settings_begin_as_the_create_info_says(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                          .texturesPerFrame = 3,
                                          .tilesPerFrame = 17,
                                          .numExtraStandbyTiles = 5,
                                          .maxHeapCount = 7,
                                          .feedbackTimeoutTicks = 9,
                                          .residencyFadeTicks = 11,
                                          .retryDelayTicks = 13,
                                          .givenUpRetryDelayTicks = 15});
    SluiceVulkanStreamerSettings settings = get(s);
    assert_int_equal(settings.texturesPerFrame, 3);
    assert_int_equal(settings.tilesPerFrame, 17);
    assert_int_equal(settings.numExtraStandbyTiles, 5);
    assert_int_equal(settings.maxHeapCount, 7);
    assert_int_equal(settings.feedbackTimeoutTicks, 9);
    assert_int_equal(settings.residencyFadeTicks, 11);
    assert_int_equal(settings.retryDelayTicks, 13);
    assert_int_equal(settings.givenUpRetryDelayTicks, 15);
    assert_false(settings.noEviction || settings.noMipBias);
    settings = (SluiceVulkanStreamerSettings){.structSize = sizeof settings,
                                              .texturesPerFrame = 1,
                                              .tilesPerFrame = 40,
                                              .numExtraStandbyTiles = 50,
                                              .maxHeapCount = 70,
                                              .feedbackTimeoutTicks = 90,
                                              .residencyFadeTicks = 110,
                                              .retryDelayTicks = 130,
                                              .givenUpRetryDelayTicks = 150,
                                              .noEviction = true,
                                              .noMipBias = true,
                                              .framesPerRound = 170,
                                              .holdLoads = true};
    CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
    SluiceVulkanStreamerSettings set = get(s);
    assert_true(are_same(&set, &settings));
    stage_finish(s);
}

static void wrong_settings_change_nothing_and_are_named(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .structSize = sizeof(SluiceVulkanStreamerCreateInfo), .texturesPerFrame = 3});
    SluiceVulkanStreamerSettings before = get(s);
    for (int i = 0; i < 6; i++) {
        SluiceVulkanStreamerSettings wrong = before;
        const char *names[] = {"texturesPerFrame", "texturesPerFrame",   "tilesPerFrame",
                               "tilesPerFrame",    "residencyFadeTicks", "structSize"};
        wrong.numExtraStandbyTiles = 99;
        wrong.feedbackTimeoutTicks = 98;
        wrong.texturesPerFrame = i == 0 ? 0 : i == 1 ? 4 : 3;
        wrong.tilesPerFrame = i == 2 ? 0 : i == 3 ? (1 << 14) + 1 : 256;
        wrong.residencyFadeTicks = i == 4 ? ((uint64_t)1 << 40) + 1 : 0;
        wrong.structSize -= i == 5 ? 32 : 0;
        CHECK_RESULT(sluiceSetVulkanStreamerSettings(s->streamer, &wrong),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        if (!strstr(s->last, names[i]))
            fail_msg("\"%s\" does not name %s", s->last, names[i]);
        SluiceVulkanStreamerSettings after = get(s);
        assert_true(are_same(&after, &before));
    }
    SluiceVulkanStreamerSettings unset = {.structSize = 0};
    CHECK_RESULT(sluiceGetVulkanStreamerSettings(s->streamer, &unset),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    stage_finish(s);
}

static void tiles_per_frame_limit_the_next_frame(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                          .tilesPerFrame = 4,
                                          .feedbackTimeoutTicks = 1000});
    for (int i = 0; i < 10; i++)
        frame(s);
    const uint32_t counts[] = {2, 64, 1, 16384};
    for (int i = 0; i < 4; i++) {
        SluiceVulkanStreamerSettings settings = get(s);
        settings.tilesPerFrame = counts[i];
        CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
        uint64_t before = statistics(s).tilesMapped;
        for (int f = 0; f < 4; f++)
            frame(s);
        uint64_t mapped = statistics(s).tilesMapped - before;
        assert_true(mapped > 0 && mapped <= 4 * (uint64_t)counts[i]);
        assert_true(counts[i] < 64 || mapped > 16);
    }
    stage_finish(s);
}

/* Runs frames until all started loads are resident. Returns the total of mapped tiles. */
static uint64_t mapped_after_frames(struct stage *s)
{
    for (int i = 0; i < 6; i++)
        frame(s);
    return statistics(s).tilesMapped;
}

static void hold(struct stage *s, bool held)
{
    SluiceVulkanStreamerSettings settings = get(s);
    settings.holdLoads = held;
    CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
}

static void held_loads_start_as_many_tiles_as_they_are_stepped(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                          .tilesPerFrame = 4,
                                          .feedbackTimeoutTicks = 1000});
    for (int i = 0; i < 10; i++)
        frame(s);
    CHECK_OK(sluiceStepVulkanLoads(s->streamer, 7)); /* without a hold, steps are not kept */
    hold(s, true);
    uint64_t before = mapped_after_frames(s);
    assert_int_equal(mapped_after_frames(s), before);
    assert_true(statistics(s).requestedTileCount > 20);
    SluiceVulkanExplanation why = {.structSize = sizeof why};
    CHECK_OK(sluiceExplainVulkanTexture(s->streamer, s->last_texture, NULL, &why));
    assert_int_equal(why.reason, SLUICE_COARSE_QUEUED);
    assert_non_null(strstr(why.sentence, "loads are held"));
    const uint32_t steps[] = {1, 1, 3, 0, 11};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        s->memory.refuse_from = 0;
        CHECK_OK(sluiceStepVulkanLoads(s->streamer, steps[i]));
        s->memory.refuse_from = UINT64_MAX;
        assert_int_equal(mapped_after_frames(s) - before, steps[i]);
        before += steps[i];
    }
    CHECK_OK(sluiceStepVulkanLoads(s->streamer, UINT32_MAX)); /* steps add up without overflow */
    CHECK_OK(sluiceStepVulkanLoads(s->streamer, 2));
    frame(s);
    hold(s, false);
    hold(s, true);
    before = mapped_after_frames(s);
    assert_int_equal(mapped_after_frames(s), before);
    hold(s, false);
    assert_true(mapped_after_frames(s) > before + 4);
    stage_finish(s);
}

static void textures_per_frame_are_those_of_the_frame_that_began(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                          .texturesPerFrame = 4,
                                          .feedbackTimeoutTicks = 1000});
    frame(s);
    frame(s);
    uint64_t before = statistics(s).feedbackMaps;
    frame(s);
    assert_int_equal(statistics(s).feedbackMaps - before, 4);
    SluiceVulkanStreamerSettings settings = get(s);
    settings.texturesPerFrame = 1;
    CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
    frame(s); /* reads the last frame's maps */
    before = statistics(s).feedbackMaps;
    for (int i = 0; i < 5; i++)
        frame(s);
    assert_int_equal(statistics(s).feedbackMaps - before, 5);
    settings.texturesPerFrame = 4;
    CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
    frame(s);
    before = statistics(s).feedbackMaps;
    frame(s);
    assert_int_equal(statistics(s).feedbackMaps - before, 4);
    stage_finish(s);
}

/* Returns the number of maps that the last frame has read. */
static uint64_t maps_of_frame(struct stage *s)
{
    uint64_t before = statistics(s).feedbackMaps;
    frame(s);
    return statistics(s).feedbackMaps - before;
}

static void all_textures_have_their_turn_after_a_cut(void **state)
{
    (void)state;
    for (uint32_t most = 1; most <= 6; most++) {
        struct stage *s = stage_init(
            &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                              .texturesPerFrame = 1,
                                              .maxTexturesPerFrame = most,
                                              .feedbackTimeoutTicks = 1000});
        for (int i = 0; i < 5; i++)
            frame(s);
        assert_int_equal(maps_of_frame(s), 1);
        s->memory.refuse_from = 0;
        CHECK_OK(sluiceResolveAllVulkanTextures(s->streamer));
        s->memory.refuse_from = UINT64_MAX;
        assert_int_equal(maps_of_frame(s), 1); /* map of the previous frame */
        for (uint32_t left = TEXTURES; left > 0;) {
            uint32_t maps = left < most ? left : most;
            assert_int_equal(maps_of_frame(s), maps);
            left -= maps;
        }
        assert_int_equal(maps_of_frame(s), 1);
        stage_finish(s);
    }
}

static void turns_of_all_come_again_if_their_frame_is_abandoned(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                          .texturesPerFrame = 1,
                                          .maxTexturesPerFrame = TEXTURES,
                                          .feedbackTimeoutTicks = 1000});
    for (int i = 0; i < 5; i++)
        frame(s);
    CHECK_OK(sluiceResolveAllVulkanTextures(s->streamer));
    SluiceStreamingFrame lost = {.structSize = sizeof lost};
    VkCommandBuffer commands = fake_vulkan_commands(&s->fake);
    s->fake.copy_count = s->fake.bind_count = 0;
    CHECK_OK(sluiceBeginStreamingFrame(s->streamer, commands, ++s->time, &lost));
    CHECK_OK(sluiceEndStreamingFrame(s->streamer, commands));
    CHECK_OK(sluiceAbandonStreamingFrame(s->streamer, &lost));
    frame(s);
    assert_int_equal(maps_of_frame(s), TEXTURES);
    assert_int_equal(maps_of_frame(s), 1);
    stage_finish(s);
}

static void rounds_take_at_most_so_many_frames(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                          .texturesPerFrame = 1,
                                          .maxTexturesPerFrame = 3,
                                          .framesPerRound = 2,
                                          .feedbackTimeoutTicks = 1000});
    const uint32_t rounds[] = {2, 4, 3, 1, 0}, maps[] = {2, 1, 2, 3, 1};
    for (uint32_t i = 0; i < 5; i++) {
        SluiceVulkanStreamerSettings settings = get(s);
        settings.framesPerRound = rounds[i];
        if (i > 0)
            CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
        frame(s);
        frame(s);
        assert_int_equal(maps_of_frame(s), maps[i]);
    }
    stage_finish(s);
    struct stage *wrong = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .texturesPerFrame = 5, .maxTexturesPerFrame = 4};
    fake_vulkan_fill(&info);
    SluiceVulkanStreamer *refused;
    CHECK_RESULT(fake_vulkan_create(&wrong->fake, &info, &refused), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(wrong->last, "maxTexturesPerFrame is 4"));
    stage_finish(wrong);
}

static void timeout_and_standby_follow_the_settings(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                          .feedbackTimeoutTicks = 1000000,
                                          .numExtraStandbyTiles = 10000,
                                          .tilesPerFrame = 1000});
    for (int i = 0; i < 12; i++)
        frame(s);
    uint32_t mapped = statistics(s).mappedTileCount;
    assert_true(mapped > 4 * 64);
    s->looks = false;
    for (int i = 0; i < 30; i++)
        frame(s);
    assert_int_equal(statistics(s).mappedTileCount, mapped); /* the timeout is long */
    SluiceVulkanStreamerSettings settings = get(s);
    settings.feedbackTimeoutTicks = 0;
    CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
    for (int i = 0; i < 60; i++)
        frame(s);
    uint32_t standby = statistics(s).standbyTileCount;
    assert_true(standby > 4 * 64);
    settings.numExtraStandbyTiles = 3;
    CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
    for (int i = 0; i < 4; i++)
        frame(s);
    assert_int_equal(statistics(s).standbyTileCount, 3);
    stage_finish(s);
}

static void configuration_of_the_manager_and_settings_are_one(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .structSize = sizeof(SluiceVulkanStreamerCreateInfo), .feedbackTimeoutTicks = 5});
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                 .numExtraStandbyTiles = 21,
                                                 .missesToExpire = 2,
                                                 .prefetchLevels = 1};
    CHECK_OK(sluiceSetConfig(manager_of(s->streamer), &config));
    SluiceVulkanStreamerSettings settings = get(s);
    assert_int_equal(settings.numExtraStandbyTiles, 21);
    assert_int_equal(settings.missesToExpire, 2);
    assert_int_equal(settings.prefetchLevels, 1);
    SluiceVulkanStreamerSettings old = settings; /* the program only knows holdLoads */
    old.structSize = offsetof(SluiceVulkanStreamerSettings, missesToExpire);
    old.missesToExpire = old.prefetchLevels = 0;
    CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &old));
    SluiceVulkanStreamerSettings kept = get(s);
    assert_true(are_same(&kept, &settings));
    /* The old struct ends with padding where missesToExpire is now. */
    old.structSize = offsetof(SluiceVulkanStreamerSettings, prefetchLevels);
    old.missesToExpire = 77;
    CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &old));
    kept = get(s);
    assert_true(are_same(&kept, &settings));
    stage_finish(s);
}

static void coarse_levels_are_prefetched_once_the_settings_say_so(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .structSize = sizeof(SluiceVulkanStreamerCreateInfo), .numExtraStandbyTiles = 1000});
    s->looks = false;
    for (int i = 0; i < 12; i++)
        frame(s);
    assert_int_equal(statistics(s).standbyTileCount, 0);
    SluiceVulkanStreamerSettings settings = get(s);
    settings.prefetchLevels = 2;
    CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
    for (int i = 0; i < 30; i++)
        frame(s);
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(sluiceGetTextureLayout(manager_of(s->streamer), s->last_texture, &layout));
    const uint32_t last = layout.desc.regularMipCount - 1;
    uint32_t tiles = 0;
    for (uint32_t level = last - 1; level <= last; level++)
        tiles += layout.levelWidthInTiles[level] * layout.levelHeightInTiles[level];
    assert_int_equal(statistics(s).standbyTileCount, TEXTURES * tiles);
    stage_finish(s);
}

static void regions_expire_once_as_many_maps_miss_them_as_the_settings_say(void **state)
{
    (void)state;
    for (uint32_t misses = 1; misses <= 16; misses += 15) {
        struct stage *s = stage_init(
            &(SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                              .feedbackTimeoutTicks = 1,
                                              .tilesPerFrame = 1000});
        SluiceVulkanStreamerSettings settings = get(s);
        settings.missesToExpire = misses;
        CHECK_OK(sluiceSetVulkanStreamerSettings(s->streamer, &settings));
        for (int i = 0; i < 12; i++)
            frame(s);
        const uint32_t mapped = statistics(s).mappedTileCount;
        assert_true(mapped > 4 * 64);
        s->looks = false;
        s->looks_at_some = true; /* an empty map would count for many */
        for (int i = 0; i < 10; i++)
            frame(s);
        assert_int_equal(statistics(s).mappedTileCount < mapped - 4 * 16, misses == 1);
        stage_finish(s);
    }
}

static void settings_survive_every_refused_allocation(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .structSize = sizeof(SluiceVulkanStreamerCreateInfo), .tilesPerFrame = 8});
    SluiceVulkanStreamerSettings before = get(s), settings = before;
    settings.tilesPerFrame = 9;
    settings.feedbackTimeoutTicks = 77;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint64_t n = 0;
    for (; result != SLUICE_SUCCESS; n++) {
        s->memory.refuse_from = s->memory.calls + n;
        result = sluiceSetVulkanStreamerSettings(s->streamer, &settings);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        SluiceVulkanStreamerSettings after = get(s);
        assert_true(are_same(&after, &before));
    }
    s->memory.refuse_from = UINT64_MAX;
    assert_int_equal(n, 4);
    for (int i = 0; i < 10; i++)
        frame(s);
    stage_finish(s);
}

static SluiceDemandLoaderSettings get_of_loader(const struct stage *s)
{
    SluiceDemandLoaderSettings settings = {.structSize = sizeof settings};
    CHECK_OK(sluiceGetDemandLoaderSettings(s->loader, &settings));
    return settings;
}

static struct stage *stage_of_loader(void)
{
    static struct stage s; /* large */
    s = (struct stage){.fake = {.no_resolve = true}};
    failing_allocator_init(&s.memory, UINT64_MAX);
    s.fake.log = (SluiceLogCallback){&s, keep_message};
    s.fake.pAllocator = &s.memory.callbacks;
    const SluiceVulkanContextCreateInfo context = fake_vulkan_context_info(&s.fake);
    CHECK_OK(sluiceCreateVulkanContext(&context, &s.context));
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .context = s.context,
                                         .maxTextureCount = 64,
                                         .pageCapacity = 1 << 16,
                                         .maxRequestsPerLaunch = 100,
                                         .failureRetryDelayNs = 5};
    CHECK_OK(sluiceCreateDemandLoader(&info, &s.loader));
    return &s;
}

static void settings_of_a_loader_take_no_memory(void **state)
{
    (void)state;
    struct stage *s = stage_of_loader();
    SluiceDemandLoaderSettings settings = get_of_loader(s), wrong = settings;
    assert_int_equal(settings.maxRequestsPerLaunch, 100);
    assert_int_equal(settings.failureRetryDelayNs, 5);
    assert_false(settings.noEviction || settings.noLodBias);
    wrong.maxRequestsPerLaunch = 101;
    CHECK_RESULT(sluiceSetDemandLoaderSettings(s->loader, &wrong), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(s->last, "maxRequestsPerLaunch"));
    settings = (SluiceDemandLoaderSettings){.structSize = sizeof settings,
                                            .maxRequestsPerLaunch = 1,
                                            .failureRetryDelayNs = UINT64_MAX,
                                            .noEviction = true,
                                            .noLodBias = true,
                                            .forgetAfterLaunches = 7};
    uint64_t calls = s->memory.calls;
    s->memory.refuse_from = 0;
    CHECK_OK(sluiceSetDemandLoaderSettings(s->loader, &settings));
    SluiceDemandLoaderSettings set = get_of_loader(s);
    assert_true(set.maxRequestsPerLaunch == 1 && set.failureRetryDelayNs == UINT64_MAX);
    assert_true(set.noEviction && set.noLodBias && set.forgetAfterLaunches == 7);
    assert_int_equal(s->memory.calls, calls);
    s->memory.refuse_from = UINT64_MAX;
    for (int i = 0; i < 2; i++) {
        SluiceDemandLaunch launch = {.structSize = sizeof launch};
        SluiceDemandRequests requests = {.structSize = sizeof requests};
        VkCommandBuffer commands = fake_vulkan_commands(&s->fake);
        CHECK_OK(sluiceBeginDemandLaunch(s->loader, commands, &launch));
        CHECK_OK(sluiceEndDemandLaunch(s->loader, commands));
        s->fake.frame_semaphore = launch.semaphore;
        s->fake.frame_value = launch.signalValue;
        CHECK_OK(sluiceProcessDemandRequests(s->loader, &launch, 0, &requests, NULL));
        settings.noEviction = settings.noLodBias = false;
        CHECK_OK(sluiceSetDemandLoaderSettings(s->loader, &settings));
    }
    sluiceDestroyDemandLoader(s->loader);
    sluiceDestroyVulkanContext(s->context);
    assert_true(s->fake.live_objects == 0 && s->memory.live_bytes == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(settings_begin_as_the_create_info_says),
        cmocka_unit_test(wrong_settings_change_nothing_and_are_named),
        cmocka_unit_test(tiles_per_frame_limit_the_next_frame),
        cmocka_unit_test(held_loads_start_as_many_tiles_as_they_are_stepped),
        cmocka_unit_test(textures_per_frame_are_those_of_the_frame_that_began),
        cmocka_unit_test(all_textures_have_their_turn_after_a_cut),
        cmocka_unit_test(turns_of_all_come_again_if_their_frame_is_abandoned),
        cmocka_unit_test(rounds_take_at_most_so_many_frames),
        cmocka_unit_test(timeout_and_standby_follow_the_settings),
        cmocka_unit_test(configuration_of_the_manager_and_settings_are_one),
        cmocka_unit_test(coarse_levels_are_prefetched_once_the_settings_say_so),
        cmocka_unit_test(regions_expire_once_as_many_maps_miss_them_as_the_settings_say),
        cmocka_unit_test(settings_survive_every_refused_allocation),
        cmocka_unit_test(settings_of_a_loader_take_no_memory),
    };
    return RUN_TESTS(tests);
}
