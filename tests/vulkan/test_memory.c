/* Device memory of a streamer: all of it is counted. It starts small, grows with pending loads, and
 * shrinks again. */
#include "vulkan/fake_vulkan.h"
#include "vulkan/streamer.h"
#include "vulkan/load_units.h"

#include "support/gray_source.h"
#include "support/test.h"

#include <stdio.h>
#include <string.h>

enum { MODES = 3, TEXTURES = 3, SIZE = 2048 };
static const SluiceResidencyMode modes[MODES] = {
    SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};

#define MIB 1048576u

struct stage {
    struct fake_vulkan fake;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *source;
    SluiceVulkanTexture textures[TEXTURES];
    uint64_t time;
    bool looks;
    uint32_t unmet;   ///< messages that the budget cannot be reached
    uint32_t refused; ///< messages that image memory was refused
    char message[512];
};

static uint8_t want(void *user, uint32_t region)
{
    (void)region;
    return ((struct stage *)user)->looks ? 0 : SLUICE_MIP_UNTOUCHED;
}

static void keep_unmet(void *user, SluiceLogSeverity severity, const char *message)
{
    struct stage *s = user;
    if (strstr(message, "no memory for ") && strstr(message, "KiB of pages: textures stay coarser"))
        s->refused++;
    assert_null(strstr(message, "vkAllocateMemory"));
    if (!strstr(message, "cannot be reached"))
        return;
    assert_int_equal(severity, SLUICE_LOG_WARNING);
    s->unmet++;
    snprintf(s->message, sizeof s->message, "%s", message);
}

static SluiceVulkanStreamerStatistics statistics(const struct stage *s)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(s->streamer, &stats));
    assert_true(stats.deviceMemorySize + stats.hostVisibleMemorySize == s->fake.live_memory);
    assert_true(stats.tileMemorySize <= stats.deviceMemorySize);
    SluiceVulkanContextStatistics all = {.structSize = sizeof all};
    CHECK_OK(sluiceGetVulkanContextStatistics(s->streamer->context, &all));
    assert_true(stats.tileMemorySize == all.tileMemorySize); /* the only user of the context */
    return stats;
}

/* Settings of the next stage, in bytes. */
static uint64_t tile_memory_ahead, device_memory_limit, layer_size = MIB;

static struct stage *stage_init_with(SluiceResidencyMode mode, uint64_t min_staging_size)
{
    static struct stage s; /* large */
    s = (struct stage){
        .fake = {.tail_page_count = 1, .layer_size = layer_size, .want = want, .user = &s}};
    s.fake.log = (SluiceLogCallback){&s, keep_unmet};
    s.source = gray_source(SIZE, SIZE);
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info, .feedbackTimeoutTicks = 2};
    fake_vulkan_fill(&info);
    info.residencyMode = mode;
    s.fake.minStagingSize = min_staging_size;
    s.fake.minTileMemorySize = tile_memory_ahead;
    s.fake.memory_limit = device_memory_limit;
    CHECK_OK(fake_vulkan_create(&s.fake, &info, &s.streamer));
    return &s;
}

static struct stage *stage_init_limited(SluiceResidencyMode mode, uint64_t memory_limit)
{
    device_memory_limit = memory_limit;
    struct stage *s = stage_init_with(mode, 0);
    device_memory_limit = 0;
    return s;
}

static struct stage *stage_init(SluiceResidencyMode mode)
{
    return stage_init_with(mode, 0);
}

static void add_textures(struct stage *s)
{
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = s->source};
    for (int i = 0; i < TEXTURES; i++)
        CHECK_OK(sluiceAddVulkanTexture(s->streamer, &create, &s->textures[i]));
}

static void stage_finish(struct stage *s)
{
    fake_vulkan_destroy(s->streamer);
    sluiceDestroyImageSource(s->source);
    assert_true(s->fake.live_objects == 0 && s->fake.live_memory == 0);
}

static void frame(struct stage *s)
{
    struct fake_vulkan *fake = &s->fake;
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    fake->published = false;
    fake->copy_count = fake->bind_count = fake->destroyed_count = fake->freed_count = 0;
    fake->bind_value = fake->submitted_bind_value;
    CHECK_OK(sluiceWaitVulkanStreamerIdle(s->streamer));
    CHECK_OK(sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(fake), ++s->time, &frame));
    CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(fake)));
    fake->frame_semaphore = frame.semaphore;
    fake->frame_value = frame.signalValue;
    statistics(s);
}

static void a_new_streamer_takes_little_and_counts_all_of_it(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_init(modes[i]);
        SluiceVulkanStreamerStatistics stats = statistics(s);
        assert_true(stats.hostVisibleMemorySize < 8 * MIB);
        /* 6 MiB of it are the six layers of the image for empty elements. */
        assert_true(stats.deviceMemorySize - stats.tileMemorySize < 24 * MIB);
        assert_true(stats.tileMemorySize < MIB);
        stage_finish(s);
    }
}

static void staging_grows_with_the_loads_and_shrinks_when_idle(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_init(modes[i]);
        uint64_t little = statistics(s).hostVisibleMemorySize;
        add_textures(s);
        s->looks = true;
        uint64_t most = 0;
        for (int f = 0; f < 12; f++) {
            frame(s);
            uint64_t size = statistics(s).hostVisibleMemorySize;
            most = size > most ? size : most;
        }
        assert_true(statistics(s).mappedTileCount > TEXTURES * 256);
        assert_true(most >= little + 16 * MIB); /* 256 tiles a frame */
        s->looks = false;
        for (int f = 0; f < 140; f++)
            frame(s);
        assert_true(statistics(s).hostVisibleMemorySize < little + MIB);
        stage_finish(s);
    }
}

/* Default: 1024 loads in flight of 64 KiB each. */
static void staging_that_was_asked_for_is_there_from_the_start_and_stays(void **state)
{
    (void)state;
    struct stage *s = stage_init(SLUICE_RESIDENCY_MODE_PAGED);
    const uint64_t little = statistics(s).hostVisibleMemorySize;
    stage_finish(s);
    const uint64_t asked[] = {1, 4 * MIB + 1, UINT64_MAX}, more[] = {0, 4 * MIB, 60 * MIB};
    for (int i = 0; i < 3; i++) {
        s = stage_init_with(SLUICE_RESIDENCY_MODE_PAGED, asked[i]);
        assert_true(statistics(s).hostVisibleMemorySize == little + more[i]);
        for (int f = 0; f < 140; f++)
            frame(s);
        assert_true(statistics(s).hostVisibleMemorySize == little + more[i]);
        stage_finish(s);
    }
}

static void without_memory_for_more_staging_loads_are_slower_and_all_arrive(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_init(modes[i]);
        uint64_t little = statistics(s).hostVisibleMemorySize;
        add_textures(s);
        s->looks = true;
        s->fake.refused_size = 64 * 65536; /* a block of staging memory; other things are larger */
        uint32_t frames = 0, all = (uint32_t)statistics(s).tileCount;
        for (; frames < 100 && statistics(s).mappedTileCount < all; frames++)
            frame(s);
        assert_true(statistics(s).hostVisibleMemorySize < little + MIB);
        assert_in_range(frames, 12, 99);
        assert_int_equal(statistics(s).failedTileCount, 0);
        stage_finish(s);
    }
}

/* Runs frames until all tiles are mapped. Returns their number. */
static uint32_t fill(struct stage *s)
{
    uint32_t frames = 0;
    s->looks = true;
    for (; statistics(s).mappedTileCount < statistics(s).tileCount; frames++) {
        assert_true(frames < 100);
        frame(s);
    }
    return frames;
}

static void idle(struct stage *s, int frames)
{
    s->looks = false;
    for (int f = 0; f < frames; f++)
        frame(s);
}

static uint64_t tile_memory(const struct stage *s)
{
    return statistics(s).tileMemorySize;
}

/* All tiles take 64 MiB, in heaps of 16 MiB. */
static void memory_for_tiles_is_there_before_they_need_it_and_stays(void **state)
{
    (void)state;
    layer_size = 65536;
    for (int i = 0; i < 2; i++) { /* sparse and paged */
        tile_memory_ahead = 0;
        struct stage *s = stage_init(modes[i]);
        add_textures(s);
        uint64_t little = tile_memory(s);
        assert_true(little < 32 * MIB);
        uint32_t frames = fill(s);
        stage_finish(s);

        tile_memory_ahead = 128 * MIB;
        s = stage_init(modes[i]);
        add_textures(s);
        uint64_t ahead = tile_memory(s);
        assert_in_range(ahead, 128 * MIB, 128 * MIB + little);
        assert_int_equal(fill(s), frames); /* decisions are unchanged */
        assert_true(tile_memory(s) == ahead);
        for (int t = 0; t < TEXTURES; t++)
            CHECK_OK(sluiceRemoveVulkanTexture(s->streamer, s->textures[t].textureId));
        idle(s, 140);
        assert_in_range(tile_memory(s), 128 * MIB, 128 * MIB + little);
        stage_finish(s);
    }
    layer_size = MIB;
    tile_memory_ahead = 0;
}

static void a_budget_that_falls_frees_memory_without_tiles_first(void **state)
{
    (void)state;
    layer_size = 65536;
    for (int i = 0; i < 2; i++) {
        tile_memory_ahead = 256 * MIB;
        struct stage *s = stage_init(modes[i]);
        add_textures(s);
        fill(s);
        uint32_t mapped = (uint32_t)statistics(s).mappedTileCount;
        assert_true(tile_memory(s) >= 256 * MIB);
        CHECK_OK(sluiceSetVulkanMemoryBudget(s->streamer->context, 192 * MIB));
        for (int f = 0; f < 20; f++)
            frame(s);
        assert_true(tile_memory(s) <= 192 * MIB);
        assert_int_equal(statistics(s).mappedTileCount, mapped);
        stage_finish(s);
    }
    layer_size = MIB;
    tile_memory_ahead = 0;
}

/* Expects a message if and only if more memory stays in use. */
static void lower_budget(struct stage *s, uint64_t budget)
{
    char words[64];
    uint32_t before = s->unmet;
    CHECK_OK(sluiceSetVulkanMemoryBudget(s->streamer->context, budget));
    for (int f = 0; f < 200; f++)
        frame(s);
    assert_int_equal(s->unmet - before, budget > 0 && tile_memory(s) > budget);
    if (s->unmet == before)
        return;
    snprintf(words, sizeof words, " %llu bytes too many stay in use",
             (unsigned long long)(tile_memory(s) - budget));
    assert_non_null(strstr(s->message, words));
}

/* In sparse mode one heap of 16 MiB remains. */
static void a_budget_that_cannot_be_reached_is_told_once_with_what_is_too_much(void **state)
{
    (void)state;
    layer_size = 65536;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_init(modes[i]);
        bool sparse = modes[i] == SLUICE_RESIDENCY_MODE_SPARSE;
        add_textures(s);
        fill(s);
        lower_budget(s, 32 * MIB); /* enough for coarser tiles */
        assert_int_equal(s->unmet, 0);
        lower_budget(s, 4 * MIB);
        assert_true(s->unmet == 1 || !sparse);
        lower_budget(s, 0);
        lower_budget(s, 4 * MIB);
        assert_true(s->unmet == 2 || !sparse);
        stage_finish(s);
    }
    layer_size = MIB;
}

static void a_device_with_less_memory_makes_less_ahead(void **state)
{
    (void)state;
    layer_size = 65536;
    for (int i = 0; i < 2; i++) {
        tile_memory_ahead = 0;
        struct stage *s = stage_init(modes[i]);
        add_textures(s);
        uint64_t little = s->fake.live_memory;
        stage_finish(s);

        tile_memory_ahead = UINT64_MAX;
        s = stage_init_limited(modes[i], little + 100 * MIB);
        add_textures(s);
        assert_in_range(s->fake.live_memory, little + 64 * MIB, little + 100 * MIB);
        SluiceVulkanContextStatistics all = {.structSize = sizeof all};
        CHECK_OK(sluiceGetVulkanContextStatistics(s->streamer->context, &all));
        assert_true(all.memoryBlockCount < 40);
        fill(s);
        assert_int_equal(statistics(s).failedTileCount, 0);
        stage_finish(s);
    }
    layer_size = MIB;
    tile_memory_ahead = 0;
}

static void only_memory_that_the_driver_refuses_is_told_with_its_size(void **state)
{
    (void)state;
    layer_size = 65536;
    struct stage *s = stage_init(SLUICE_RESIDENCY_MODE_PAGED);
    add_textures(s);
    uint64_t little = s->fake.live_memory;
    CHECK_OK(sluiceSetVulkanMemoryBudget(s->streamer->context, tile_memory(s) + 4 * MIB));
    s->looks = true;
    for (int f = 0; f < 20; f++)
        frame(s);
    SluiceVulkanContextStatistics all = {.structSize = sizeof all};
    CHECK_OK(sluiceGetVulkanContextStatistics(s->streamer->context, &all));
    assert_true(all.refusedBlockCount > 0);
    assert_int_equal(s->refused, 0);
    stage_finish(s);

    s = stage_init_limited(SLUICE_RESIDENCY_MODE_PAGED, little + 20 * MIB);
    add_textures(s);
    s->looks = true;
    for (int f = 0; f < 20; f++)
        frame(s);
    assert_true(s->refused > 0);
    stage_finish(s);
    layer_size = MIB;
}

struct order {
    uint32_t tiles[1024], count;
};

/* Reverses the slots, as other textures' reads may have returned them. */
static void turn_slots(SluiceVulkanStreamer *s)
{
    s->free_units = (struct slc_unit_list){SLC_NONE, SLC_NONE};
    for (uint32_t slot = s->info.maxLoadsInFlight; slot-- > 0;)
        slc_unit_list_append(s, &s->free_units, slot);
}

static void play(SluiceResidencyMode mode, bool turned, struct order *order)
{
    struct stage *s = stage_init(mode);
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = s->source};
    CHECK_OK(sluiceAddVulkanTexture(s->streamer, &create, &s->textures[0]));
    if (turned)
        turn_slots(s->streamer);
    s->looks = true;
    *order = (struct order){.count = 0};
    for (uint32_t f = 0; f < 8; f++) {
        uint64_t before = s->streamer->counts.tilesMapped;
        memset(s->streamer->tile_indices, 0, s->streamer->info.tilesPerFrame * sizeof(uint32_t));
        frame(s);
        uint32_t added = (uint32_t)(s->streamer->counts.tilesMapped - before);
        assert_true(added <= s->streamer->info.tilesPerFrame && order->count + added <= 1024);
        memcpy(order->tiles + order->count, s->streamer->tile_indices, added * sizeof(uint32_t));
        order->count += added;
    }
    stage_finish(s);
}

static void tiles_are_told_in_the_order_of_their_arrival_whatever_their_slots(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct order plain, turned;
        play(modes[i], false, &plain);
        play(modes[i], true, &turned);
        assert_true(plain.count > 256);
        assert_int_equal(plain.count, turned.count);
        assert_memory_equal(plain.tiles, turned.tiles, plain.count * sizeof(uint32_t));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_streamer_takes_little_and_counts_all_of_it),
        cmocka_unit_test(staging_grows_with_the_loads_and_shrinks_when_idle),
        cmocka_unit_test(staging_that_was_asked_for_is_there_from_the_start_and_stays),
        cmocka_unit_test(without_memory_for_more_staging_loads_are_slower_and_all_arrive),
        cmocka_unit_test(memory_for_tiles_is_there_before_they_need_it_and_stays),
        cmocka_unit_test(a_budget_that_falls_frees_memory_without_tiles_first),
        cmocka_unit_test(a_budget_that_cannot_be_reached_is_told_once_with_what_is_too_much),
        cmocka_unit_test(a_device_with_less_memory_makes_less_ahead),
        cmocka_unit_test(only_memory_that_the_driver_refuses_is_told_with_its_size),
        cmocka_unit_test(tiles_are_told_in_the_order_of_their_arrival_whatever_their_slots),
    };
    return RUN_TESTS(tests);
}
