/* Packed levels that come when their texture is first seen, and go when nothing of it is wanted. */
#include "vulkan/fake_vulkan.h"

#include "support/gray_source.h"
#include "support/test.h"

enum { MODES = 3, TEXTURES = 3, SIZE = 512, SETTLE = 24 };
static const SluiceResidencyMode modes[MODES] = {
    SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};

struct stage {
    struct fake_vulkan fake;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *source;
    uint64_t time;
    uint32_t seed, regions; ///< feedback regions of a texture
    uint32_t seen;          ///< a bit per texture
    bool random;            ///< each region is seen or not
};

static uint32_t draw(struct stage *s)
{
    s->seed = s->seed * 1664525u + 1013904223u;
    return s->seed >> 16;
}

static uint8_t want(void *user, uint32_t region)
{
    struct stage *s = user;
    bool seen = s->seen >> (region / s->regions) & 1 && (!s->random || draw(s) % 4 == 0);
    return seen ? (uint8_t)(s->random ? draw(s) % 4 : 0) : SLUICE_MIP_UNTOUCHED;
}

static struct stage *stage_init(SluiceResidencyMode mode, SluiceVulkanStreamerCreateInfo info)
{
    static struct stage s; /* large */
    s = (struct stage){.fake = {.tail_page_count = 3, .want = want, .user = &s},
                       .seed = 1,
                       .regions = SIZE / FAKE_TILE * (SIZE / FAKE_TILE)};
    s.source = gray_source(SIZE, SIZE);
    info.packedLevelsOnDemand = true;
    info.feedbackTimeoutTicks = 2;
    info.maxTextureCount = 4;
    info.maxRegionCount = 256;
    info.tilesPerFrame = 4; /* so that packed tiles are handed out in parts */
    fake_vulkan_fill(&info);
    info.residencyMode = mode;
    CHECK_OK(fake_vulkan_create(&s.fake, &info, &s.streamer));
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = s.source};
    SluiceVulkanTexture texture;
    for (int i = 0; i < TEXTURES; i++)
        CHECK_OK(sluiceAddVulkanTexture(s.streamer, &create, &texture));
    return &s;
}

static void stage_finish(struct stage *s)
{
    fake_vulkan_destroy(s->streamer);
    sluiceDestroyImageSource(s->source);
    assert_true(s->fake.live_objects == 0 && s->fake.live_memory == 0);
}

static void frames(struct stage *s, uint32_t count)
{
    struct fake_vulkan *fake = &s->fake;
    for (uint32_t i = 0; i < count; i++) {
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        fake->published = false;
        fake->copy_count = fake->bind_count = fake->destroyed_count = fake->freed_count = 0;
        fake->bind_value = fake->submitted_bind_value;
        CHECK_OK(sluiceWaitVulkanStreamerIdle(s->streamer));
        CHECK_OK(
            sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(fake), ++s->time, &frame));
        CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(fake)));
        fake->frame_semaphore = frame.semaphore;
        fake->frame_value = frame.signalValue;
    }
}

static SluiceVulkanStreamerStatistics statistics(const struct stage *s)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(s->streamer, &stats));
    return stats;
}

static void textures_that_nobody_sees_read_nothing_and_hold_no_heap(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_init(
            modes[i],
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
        frames(s, 20);
        SluiceVulkanStreamerStatistics stats = statistics(s);
        assert_true(stats.bytesRead == 0 && stats.tilesMapped == 0);
        assert_int_equal(stats.heapCount, 0);
        stage_finish(s);
    }
}

static void packed_levels_come_with_the_first_look_and_go_with_the_last(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_init(
            modes[i],
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
        uint64_t tiles = statistics(s).tileCount / TEXTURES;
        for (int round = 0; round < 3; round++) {
            s->seen = 1u << round;
            frames(s, SETTLE);
            SluiceVulkanStreamerStatistics stats = statistics(s);
            assert_int_equal(stats.mappedTileCount, tiles);
            assert_int_equal(stats.tilesMapped - stats.tilesUnmapped, tiles);
            s->seen = 0;
            frames(s, SETTLE);
            assert_int_equal(statistics(s).mappedTileCount, 0);
            assert_true(statistics(s).tilesMapped == statistics(s).tilesUnmapped);
        }
        stage_finish(s);
    }
}

/* Few slots and a standby list that ends between the packed tiles of a texture. */
static void parts_of_packed_levels_that_were_evicted_come_back(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++)
        for (uint32_t seed = 1; seed <= 12; seed++) {
            struct stage *s =
                stage_init(modes[i], (SluiceVulkanStreamerCreateInfo){
                                         .structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .heapTileCapacity = 32,
                                         .maxHeapCount = seed % 3 ? 1 : 0,
                                         .numExtraStandbyTiles = seed % 4 ? 2 : 0});
            s->seed = seed;
            for (int turn = 0; turn < 40; turn++) {
                s->seen = draw(s) % 8;
                s->random = turn % 2;
                frames(s, 1 + draw(s) % 5);
            }
            s->random = false;
            s->seen = 1u << seed % TEXTURES;
            frames(s, 2 * SETTLE);
            SluiceVulkanStreamerStatistics stats = statistics(s);
            assert_int_equal(stats.mappedTileCount, stats.tileCount / TEXTURES);
            assert_int_equal(stats.requestedTileCount + stats.allocatedTileCount, 0);
            stage_finish(s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(textures_that_nobody_sees_read_nothing_and_hold_no_heap),
        cmocka_unit_test(packed_levels_come_with_the_first_look_and_go_with_the_last),
        cmocka_unit_test(parts_of_packed_levels_that_were_evicted_come_back),
    };
    return RUN_TESTS(tests);
}
