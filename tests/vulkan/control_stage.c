#include "vulkan/control_stage.h"

#include "support/gray_source.h"

#include <string.h>

const SluiceJobSystem *stage_job_system;

static uint8_t want(void *user, uint32_t region)
{
    return ((struct stage *)user)->seen[region / (TILES * TILES)][region % (TILES * TILES)];
}

static void keep_message(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)severity;
    strncpy(((struct stage *)user)->last, message, sizeof((struct stage *)user)->last - 1);
}

struct stage *stage_init(const SluiceVulkanStreamerCreateInfo *settings)
{
    static struct stage s; /* large */
    s = (struct stage){.fake = {.tail_page_count = 1, .want = want, .user = &s}};
    memset(s.seen, SLUICE_MIP_UNTOUCHED, sizeof s.seen);
    failing_allocator_init(&s.memory, UINT64_MAX);
    s.fake.log = (SluiceLogCallback){&s, keep_message};
    s.fake.pAllocator = &s.memory.callbacks;
    s.fake.pJobSystem = stage_job_system;
    s.source = gray_source(SIZE, SIZE);
    fault_source_init(&s.faults, s.source);
    SluiceVulkanStreamerCreateInfo info = *settings;
    info.structSize = sizeof info;
    info.maxTextureCount = TEXTURES;
    info.maxRegionCount = 1 << 10;
    fake_vulkan_fill(&info);
    CHECK_OK(fake_vulkan_create(&s.fake, &info, &s.streamer));
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = &s.faults.base};
    for (int i = 0; i < TEXTURES; i++)
        CHECK_OK(sluiceAddVulkanTexture(s.streamer, &create, &s.textures[i]));
    return &s;
}

void stage_finish(struct stage *s)
{
    fake_vulkan_destroy(s->streamer);
    fault_source_finish(&s->faults);
    sluiceDestroyImageSource(s->source);
    assert_true(s->fake.live_objects == 0 && s->memory.live_bytes == 0);
}

void frames(struct stage *s, uint32_t count)
{
    struct fake_vulkan *fake = &s->fake;
    for (; count > 0; count--) {
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        fake->published = false;
        fake->copy_count = fake->bind_count = 0;
        fake->bind_value = fake->submitted_bind_value;
        CHECK_OK(sluiceWaitVulkanStreamerIdle(s->streamer));
        CHECK_OK(
            sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(fake), ++s->time, &frame));
        CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(fake)));
        fake->frame_semaphore = frame.semaphore;
        fake->frame_value = frame.signalValue;
    }
}

void set_control(struct stage *s, uint32_t texture, SluiceVulkanTextureControl control)
{
    control.structSize = sizeof control;
    CHECK_OK(sluiceSetVulkanTextureControl(s->streamer, s->textures[texture].textureId, &control));
}

SluiceVulkanStreamerStatistics statistics(const struct stage *s)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(s->streamer, &stats));
    return stats;
}
