/* Streamers that read in jobs of the application decide what streamers with threads decide. */
#include "vulkan/control_stage.h"

#include "support/job_system.h"

#include <string.h>

enum { FRAMES = 16 };

static const struct job_system_habits systems[] = {
    {.thread_count = 1},
    {.thread_count = 4},
    {.thread_count = 0},                                                /* inline */
    {.thread_count = 2, .refuse_count = UINT32_MAX},                    /* takes nothing */
    {.thread_count = 2, .refuse_after = 3, .refuse_count = UINT32_MAX}, /* ends to take jobs */
    {.thread_count = 2, .delay_us = 200},
};

static void look(struct stage *s, uint32_t frame)
{
    memset(s->seen, SLUICE_MIP_UNTOUCHED, sizeof s->seen);
    for (uint32_t i = 0; i < 5; i++)
        s->seen[frame % TEXTURES][(7 * frame + 11 * i) % (TILES * TILES)] = (uint8_t)(i % 3);
}

/* Resident level of each tile after each frame. */
static void fly(uint32_t *levels, SluiceVulkanStreamerStatistics *stats)
{
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 5});
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        look(s, frame);
        frames(s, 1);
        for (uint32_t i = 0; i < TEXTURES * TILES * TILES; i++) {
            const uint32_t tile = i % (TILES * TILES);
            const SluiceTextureRect rect = {tile % TILES * 128, tile / TILES * 128, 128, 128};
            SluiceVulkanTextureState now = {.structSize = sizeof now};
            CHECK_OK(sluiceGetVulkanTextureState(
                s->streamer, s->textures[i / (TILES * TILES)].textureId, &rect, &now));
            *levels++ = now.residentLevel;
        }
    }
    *stats = statistics(s);
    stage_finish(s);
}

static void jobs_and_threads_lead_to_one_residency(void **state)
{
    (void)state;
    static uint32_t own[FRAMES * TEXTURES * TILES * TILES],
        levels[FRAMES * TEXTURES * TILES * TILES];
    SluiceVulkanStreamerStatistics expected, stats;
    fly(own, &expected);
    for (uint32_t i = 0; i < sizeof systems / sizeof systems[0]; i++) {
        struct job_system system;
        job_system_init(&system, systems[i]);
        stage_job_system = &system.callbacks;
        fly(levels, &stats);
        stage_job_system = NULL;
        job_system_finish(&system);
        assert_memory_equal(levels, own, sizeof own);
        assert_int_equal(stats.bytesRead, expected.bytesRead);
        assert_true(system.submitted_count > 0 || system.refused_count > 0);
    }
    assert_true(expected.bytesRead > 20 << 16);
}

static void waits_for_requests_end_though_jobs_are_refused(void **state)
{
    (void)state;
    struct job_system system;
    SluiceTextureRequestId request;
    SluiceVulkanWaitStatus status = SLUICE_VULKAN_WAIT_FRAME;
    const SluiceVulkanTextureRequest all = {.structSize = sizeof all, .until = UINT64_MAX};
    job_system_init(&system, (struct job_system_habits){.refuse_count = UINT32_MAX});
    stage_job_system = &system.callbacks;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 100});
    stage_job_system = NULL;
    CHECK_OK(sluiceRequestVulkanTexture(s->streamer, s->textures[0].textureId, &all, &request));
    for (uint32_t i = 0; i < 30 && status != SLUICE_VULKAN_WAIT_READY; i++) {
        frames(s, 1);
        CHECK_OK(sluiceWaitVulkanRequest(s->streamer, request, 60000000000, &status));
        assert_int_not_equal(status, SLUICE_VULKAN_WAIT_TIMEOUT);
    }
    assert_int_equal(status, SLUICE_VULKAN_WAIT_READY);
    stage_finish(s);
    job_system_finish(&system);
    assert_int_equal(system.submitted_count, 0);
}

static void waits_of_no_time_read_nothing(void **state)
{
    (void)state;
    struct job_system system;
    SluiceTextureRequestId request;
    SluiceVulkanWaitStatus status;
    const SluiceVulkanTextureRequest all = {.structSize = sizeof all, .until = UINT64_MAX};
    uint32_t timeouts = 0;
    job_system_init(&system, (struct job_system_habits){.refuse_count = UINT32_MAX});
    stage_job_system = &system.callbacks;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 100});
    stage_job_system = NULL;
    CHECK_OK(sluiceRequestVulkanTexture(s->streamer, s->textures[0].textureId, &all, &request));
    for (uint32_t i = 0; i < 6; i++) {
        frames(s, 1);
        CHECK_OK(sluiceWaitVulkanRequest(s->streamer, request, 0, &status));
        timeouts += status == SLUICE_VULKAN_WAIT_TIMEOUT;
    }
    assert_true(timeouts > 0);
    stage_finish(s);
    job_system_finish(&system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_and_threads_lead_to_one_residency),
        cmocka_unit_test(waits_for_requests_end_though_jobs_are_refused),
        cmocka_unit_test(waits_of_no_time_read_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
