/*
 * Streams one procedural texture into a compute shader (vulkan.comp). Shows all that a renderer
 * does for Sluice; gpu.c has the plain Vulkan. Exit status 77: no device can stream.
 */
#include "gpu.h"

#include <sluice/vulkan.h>

#include <stdio.h>

#include "vulkan_comp.h" /* the SPIR-V */

#define FRAME_COUNT 8

struct answer {              /* as in vulkan.comp */
    uint32_t missing_levels; /* 255: nothing is there yet */
    uint32_t padding[3];
    float color[4];
};

struct app {
    struct gpu gpu;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanTexture texture;
    struct answer *answer; /* mapped */
};

static bool can_stream(VkInstance instance, VkPhysicalDevice device,
                       VkPhysicalDeviceFeatures *features,
                       VkPhysicalDeviceVulkan12Features *vulkan12)
{
    return sluiceRequireVulkanFeatures(instance, device, vkGetInstanceProcAddr,
                                       SLUICE_RESIDENCY_MODE_SPARSE, &log_callback, features,
                                       vulkan12) == SLUICE_SUCCESS;
}

static void create_streamer(struct app *app, SluiceImageSource *source)
{
    SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                             .queueFamilyIndex = app->gpu.family,
                                             .instance = app->gpu.instance,
                                             .physicalDevice = app->gpu.physical_device,
                                             .device = app->gpu.device,
                                             .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                             .sparseQueue = app->gpu.queue,
                                             .sparseQueueFamilyIndex = app->gpu.family,
                                             .log = log_callback};
    SLUICE(sluiceCreateVulkanContext(&context, &app->context));
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .context = app->context,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_SPARSE,
                                           .textureArray = SLUICE_TEXTURE_ARRAY_COMBINED,
                                           .ticksPerSecond = 60, /* frames: see draw_frame */
                                           .feedbackTimeoutTicks = 20};
    SLUICE(sluiceCreateVulkanStreamer(&info, &app->streamer));
    SluiceVulkanTextureCreateInfo texture = {.structSize = sizeof texture, .source = source};
    SLUICE(sluiceAddVulkanTexture(app->streamer, &texture, &app->texture));
}

/* Set 0 is Sluice's and has the textures. Set 1 is the program's and has the answer. */
static void create_shader(struct app *app)
{
    VkDescriptorSetLayout set_0;
    SLUICE(sluiceGetVulkanDescriptorSetLayout(app->streamer, &set_0));
    app->answer = create_answer(&app->gpu, sizeof *app->answer);
    create_pipeline(&app->gpu, vulkan_comp, sizeof vulkan_comp, set_0, sizeof(uint32_t));
}

static void wait_for(const struct app *app, const SluiceStreamingFrame *frame)
{
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &frame->semaphore,
                                .pValues = &frame->signalValue};
    VK(vkWaitSemaphores(app->gpu.device, &info, UINT64_MAX));
}

static void draw_frame(struct app *app, uint64_t time_stamp)
{
    *app->answer = (struct answer){0};
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    begin_commands(&app->gpu);
    SLUICE(sluiceBeginStreamingFrame(app->streamer, app->gpu.commands, time_stamp, &frame));

    bind_shader(&app->gpu, frame.descriptorSet);
    vkCmdPushConstants(app->gpu.commands, app->gpu.pipeline_layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                       sizeof app->texture.tableIndex, &app->texture.tableIndex);
    vkCmdDispatch(app->gpu.commands, 8, 8, 1);

    SLUICE(sluiceEndStreamingFrame(app->streamer, app->gpu.commands));
    submit(&app->gpu, frame.semaphore, frame.signalValue);

    /* So that every run is the same. A renderer waits for an older frame, and for no reads. */
    wait_for(app, &frame);
    SLUICE(sluiceWaitVulkanStreamerIdle(app->streamer));
}

static void destroy(struct app *app)
{
    sluiceDestroyVulkanStreamer(app->streamer); /* waits for its frames */
    sluiceDestroyVulkanContext(app->context);
    destroy_gpu(&app->gpu);
}

static void paint_ramp(void *pUserData, uint32_t mipLevel, uint32_t x, uint32_t y, uint32_t width,
                       uint32_t height, float rgba[4])
{
    (void)pUserData;
    rgba[0] = ((float)x + 0.5f) / (float)width;
    rgba[1] = ((float)y + 0.5f) / (float)height;
    rgba[2] = mipLevel > 0 ? 1.0f : 0.0f;
    rgba[3] = 1.0f;
}

int main(void)
{
    const SluiceProceduralImage image = {NULL, paint_ramp};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = 4096,
                                  .height = 4096,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "ramp"};
    SluiceImageSource *source = NULL;
    SLUICE(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));

    struct app app = {0};
    /* One family that draws and binds is simplest. Where they differ, create a queue of each. */
    create_gpu(&app.gpu, VK_QUEUE_COMPUTE_BIT | VK_QUEUE_SPARSE_BINDING_BIT, can_stream);
    create_streamer(&app, source);
    create_shader(&app);
    for (uint64_t frame = 0; frame < FRAME_COUNT; frame++) {
        draw_frame(&app, frame);
        SluiceVulkanStreamerStatistics now = {.structSize = sizeof now};
        sluiceGetVulkanStreamerStatistics(app.streamer, &now);
        printf("frame %u: %u levels missing, %u of %u tiles mapped\n", (unsigned)frame,
               app.answer->missing_levels, now.mappedTileCount, (unsigned)now.tileCount);
    }
    const float *color = app.answer->color;
    printf("color %.2f %.2f %.2f\n", (double)color[0], (double)color[1], (double)color[2]);
    bool sharp = app.answer->missing_levels == 0 && color[2] == 0.0f;
    destroy(&app);
    sluiceDestroyImageSource(source);
    return sharp ? 0 : 1;
}
