/* Defaults of a zeroed create info: times in seconds, for any unit of the time stamps. */
#include "vulkan/fake_vulkan.h"

#include "vulkan/time_defaults.h"

#include "support/streamer_manager.h"
#include "support/gray_source.h"
#include "support/test.h"

#include <string.h>

enum { TILES = 16 }; /* tiles of level 0 */

struct stage {
    struct fake_vulkan fake;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *source;
    uint64_t time, step;
    uint32_t warnings;
    bool looks; ///< shaders sample everything
};

static uint8_t want(void *user, uint32_t region)
{
    (void)region;
    const struct stage *s = user;
    return s->looks ? 0 : SLUICE_MIP_UNTOUCHED;
}

static void count_warnings(void *user, SluiceLogSeverity severity, const char *message)
{
    struct stage *s = user;
    if (severity != SLUICE_LOG_WARNING)
        return;
    s->warnings++;
    assert_non_null(strstr(message, "ticksPerSecond"));
}

/* Creates a stage. Keeps the unit and the times of `info`. */
static struct stage *stage_init(SluiceVulkanStreamerCreateInfo info, uint64_t step)
{
    static struct stage s; /* large */
    s = (struct stage){.fake = {.tail_page_count = 1, .want = want, .user = &s}, .step = step};
    s.source = gray_source(512, 512);
    const SluiceVulkanStreamerCreateInfo asked = info;
    fake_vulkan_fill(&info);
    info.ticksPerSecond = asked.ticksPerSecond;
    info.newestFeedbackMapOnly = asked.newestFeedbackMapOnly;
    info.noStandbyTiles = asked.noStandbyTiles;
    info.retryDelayTicks = asked.retryDelayTicks;
    info.maxTextureCount = 4;
    info.maxRegionCount = 256;
    s.fake.log = (SluiceLogCallback){&s, count_warnings};
    CHECK_OK(fake_vulkan_create(&s.fake, &info, &s.streamer));
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = s.source};
    SluiceVulkanTexture texture;
    CHECK_OK(sluiceAddVulkanTexture(s.streamer, &create, &texture));
    return &s;
}

static void stage_finish(struct stage *s)
{
    fake_vulkan_destroy(s->streamer);
    sluiceDestroyImageSource(s->source);
    assert_int_equal(s->fake.live_objects, 0);
}

static void frames(struct stage *s, uint32_t count)
{
    struct fake_vulkan *fake = &s->fake;
    for (uint32_t i = 0; i < count; i++) {
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        fake->published = false;
        fake->copy_count = fake->bind_count = 0;
        fake->bind_value = fake->submitted_bind_value;
        CHECK_OK(sluiceWaitVulkanStreamerIdle(s->streamer));
        CHECK_OK(sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(fake),
                                           s->time += s->step, &frame));
        CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(fake)));
        fake->frame_semaphore = frame.semaphore;
        fake->frame_value = frame.signalValue;
    }
}

static SluiceStreamedTextureStatistics statistics(const struct stage *s)
{
    SluiceStreamedTextureStatistics stats = {.structSize = sizeof stats};
    sluiceGetStatistics(manager_of(s->streamer), &stats);
    return stats;
}

static void what_a_few_maps_miss_stays_by_default(void **state)
{
    (void)state;
    const uint64_t steps[] = {16666667, 16667, 1}; /* frames in ns, us, and counted */
    const uint64_t units[] = {0, 1000000, 60};
    for (int i = 0; i < 3; i++) {
        struct stage *s = stage_init(
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .ticksPerSecond = units[i]},
            steps[i]);
        s->looks = true;
        frames(s, 12);
        uint32_t mapped = statistics(s).mappedTileCount;
        assert_true(mapped > TILES);
        s->looks = false;
        frames(s, 40);
        assert_int_equal(statistics(s).mappedTileCount, mapped);
        frames(s, 60); /* more than a second since they were seen: kept, but not wanted */
        assert_int_equal(statistics(s).mappedTileCount, 1);
        assert_int_equal(statistics(s).standbyTileCount, mapped - 1);
        assert_int_equal(statistics(s).unmappedTotal, 0);
        stage_finish(s);
    }
}

static void the_newest_map_alone_counts_where_it_is_asked_for(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .newestFeedbackMapOnly = true,
                                         .noStandbyTiles = true},
        16666667);
    s->looks = true;
    frames(s, 12);
    uint32_t mapped = statistics(s).mappedTileCount;
    s->looks = false;
    frames(s, 12);
    assert_int_equal(statistics(s).mappedTileCount, 1);
    assert_int_equal(statistics(s).unmappedTotal, mapped - 1);
    stage_finish(s);
}

static void frames_taken_for_nanoseconds_are_warned_of_once(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .maxTextureCount = 4},
        1);
    frames(s, 256);
    assert_int_equal(s->warnings, 0);
    frames(s, 300);
    assert_int_equal(s->warnings, 1);
    stage_finish(s);
    s = stage_init(
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .ticksPerSecond = 60},
        1);
    frames(s, 300);
    assert_int_equal(s->warnings, 0);
    stage_finish(s);
    s = stage_init(
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .maxTextureCount = 4},
        100000);
    frames(s, 300);
    assert_int_equal(s->warnings, 0);
    stage_finish(s);
}

static void defaults_are_seconds_in_any_unit(void **state)
{
    (void)state;
    const struct {
        uint64_t unit, timeout, retry;
    } cases[] = {{0, 1000000000, 250000000},
                 {1000, 1000, 250},
                 {60, 60, 15},
                 {1, 1, 1},
                 {1000000000000, 1000000000000, 250000000000}};
    for (int i = 0; i < 5; i++) {
        SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                               .ticksPerSecond = cases[i].unit};
        CHECK_OK(slc_fill_in_times(&info, NULL));
        assert_true(info.feedbackTimeoutTicks == cases[i].timeout);
        assert_true(info.retryDelayTicks == cases[i].retry);
        assert_int_equal(info.numExtraStandbyTiles, 1024);
        assert_int_equal(info.residencyFadeTicks, 0);
    }
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .feedbackTimeoutTicks = UINT64_MAX,
                                           .retryDelayTicks = 1,
                                           .numExtraStandbyTiles = 1};
    CHECK_OK(slc_fill_in_times(&info, NULL));
    assert_true(info.feedbackTimeoutTicks == UINT64_MAX && info.retryDelayTicks == 1);
    assert_int_equal(info.numExtraStandbyTiles, 1);
}

static void contradictions_are_refused(void **state)
{
    (void)state;
    SluiceVulkanStreamerCreateInfo cases[] = {
        {.structSize = sizeof(SluiceVulkanStreamerCreateInfo), .ticksPerSecond = 1000000000001},
        {.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
         .newestFeedbackMapOnly = true,
         .feedbackTimeoutTicks = 1},
        {.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
         .noStandbyTiles = true,
         .numExtraStandbyTiles = 1},
    };
    for (int i = 0; i < 3; i++)
        CHECK_RESULT(slc_fill_in_times(&cases[i], NULL), SLUICE_ERROR_INVALID_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_few_maps_miss_stays_by_default),
        cmocka_unit_test(the_newest_map_alone_counts_where_it_is_asked_for),
        cmocka_unit_test(frames_taken_for_nanoseconds_are_warned_of_once),
        cmocka_unit_test(defaults_are_seconds_in_any_unit),
        cmocka_unit_test(contradictions_are_refused),
    };
    return RUN_TESTS(tests);
}
