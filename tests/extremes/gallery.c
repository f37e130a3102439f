#include "extremes/gallery.h"

#include "support/test.h"

#include <string.h>

/* A picture of the night: nothing is computed and nothing is allocated. */
static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    (void)source;
    *info = (SluiceImageInfo){sizeof(SluiceImageInfo),      512,     512, 10,
                              SLUICE_FORMAT_R8G8B8A8_UNORM, "night", 1};
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    (void)source;
    for (uint32_t y = 0; y < region->height; y++)
        memset((char *)texels + y * row_pitch, 0, region->width * 4u);
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *source)
{
    (void)source;
}

static const SluiceImageSourceInterface night = {sizeof night, get_info, read_region, destroy,
                                                 NULL};

static uint8_t want(void *user, uint32_t region)
{
    (void)region;
    return ((struct gallery *)user)->is_looked_at ? 0 : SLUICE_MIP_UNTOUCHED;
}

void gallery_init(struct gallery *g)
{
    *g = (struct gallery){.is_looked_at = true};
    g->fake = (struct fake_vulkan){.tail_page_count = 1, .want = want, .user = g};
    failing_allocator_init(&g->memory, UINT64_MAX);
    g->source.pInterface = &night;
    CHECK_OK(sluiceCreateArrayImageSource((SluiceImageSource *[]){&g->source, &g->source}, 2, NULL,
                                          &g->array));
}

void gallery_check_nothing_left(const struct gallery *g)
{
    assert_int_equal(g->fake.live_objects, 0);
    assert_int_equal(g->fake.live_memory, 0);
    assert_int_equal(g->memory.live_count, 0);
    assert_int_equal(g->memory.live_bytes, 0);
}

void gallery_finish(struct gallery *g)
{
    fake_vulkan_destroy(g->streamer);
    g->streamer = NULL;
    gallery_check_nothing_left(g);
    sluiceDestroyImageSource(g->array);
}

SluiceResult gallery_create(struct gallery *g, SluiceResidencyMode mode)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .tilesPerFrame = 16,
                                           .maxTextureCount = 5,
                                           .maxRegionCount = 256,
                                           .heapTileCapacity = 8,
                                           .feedbackTimeoutTicks = 20};
    g->fake.pAllocator = &g->memory.callbacks;
    fake_vulkan_fill(&info);
    info.residencyMode = mode;
    return fake_vulkan_create(&g->fake, &info, &g->streamer);
}

SluiceResult gallery_add(struct gallery *g, uint32_t texture)
{
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = &g->source};
    if (texture == GALLERY_TEXTURES - 1)
        info.primaryId = g->textures[0].textureId;
    return sluiceAddVulkanTexture(g->streamer, &info, &g->textures[texture]);
}

SluiceResult gallery_add_array(struct gallery *g)
{
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = g->array};
    return sluiceAddVulkanTextureArray(g->streamer, &info, 2, g->layers);
}

SluiceResult gallery_frame(struct gallery *g)
{
    struct fake_vulkan *fake = &g->fake;
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    fake->bind_count = fake->copy_count = fake->destroyed_count = fake->freed_count = 0;
    fake->published = false;
    fake->bind_value = fake->submitted_bind_value;
    SluiceResult result = sluiceWaitVulkanStreamerIdle(g->streamer);
    if (result == SLUICE_SUCCESS)
        result =
            sluiceBeginStreamingFrame(g->streamer, fake_vulkan_commands(fake), ++g->time, &frame);
    if (result != SLUICE_SUCCESS)
        return result;
    CHECK_OK(sluiceEndStreamingFrame(g->streamer, fake_vulkan_commands(fake)));
    fake->frame_semaphore = frame.semaphore;
    fake->frame_value = frame.signalValue;
    return SLUICE_SUCCESS;
}

SluiceVulkanStreamerStatistics gallery_statistics(const struct gallery *g)
{
    SluiceVulkanStreamerStatistics statistics = {.structSize = sizeof statistics};
    sluiceGetVulkanStreamerStatistics(g->streamer, &statistics);
    return statistics;
}
