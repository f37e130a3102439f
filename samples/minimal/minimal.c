/*
 * Streams textures onto the walls of a corridor. Shows everything that a renderer does for Sluice,
 * in order, to copy from. room.frag is the shader's side. vulkan_setup.h and vulkan_drawing.h hold
 * plain Vulkan; corridor.h holds the scene, the command line and the output.
 */
#include "corridor.h"
#include "vulkan_drawing.h"

#include <sluice/vulkan.h>

#include <stdio.h>

#define SLUICE(call) check_result((call), #call)
#define FRAMES_IN_FLIGHT 2

struct frame {
    VkCommandBuffer commands;
    SluiceStreamingFrame streaming; /* semaphore and value that the submission signals */
};

struct renderer {
    struct gpu gpu;
    struct drawing drawing;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *sources[TEXTURES];
    uint32_t table_indices[TEXTURES]; /* shaders' indices of the textures, for room.frag */
    struct frame frames[FRAMES_IN_FLIGHT];
};

static void check_result(SluiceResult result, const char *call)
{
    check(result == SLUICE_SUCCESS, call, sluiceGetResultName(result));
}

static void print_message(void *pUserData, SluiceLogSeverity severity, const char *pMessage)
{
    (void)pUserData;
    if (severity != SLUICE_LOG_INFO)
        fprintf(stderr, "%s\n", pMessage);
}
static const SluiceLogCallback log_callback = {NULL, print_message};

/* 1. Whether a device can stream in a residency mode. Sluice adds its features to the renderer's,
 *    and names the queue family that binds. open_device asks this, and opens the first that can. */
static bool can_stream(VkInstance instance, VkPhysicalDevice device, const void *mode,
                       struct device_needs *needs)
{
    SluiceVulkanDeviceCapabilities caps = {.structSize = sizeof caps};
    SLUICE(sluiceGetVulkanDeviceCapabilities(instance, device, vkGetInstanceProcAddr, &caps));
    if (caps.sparse)
        needs->sparse_family = caps.sparseQueueFamilyIndex;
    return sluiceRequireVulkanFeatures(instance, device, vkGetInstanceProcAddr,
                                       *(const SluiceResidencyMode *)mode, &log_callback,
                                       &needs->features, &needs->vulkan12) == SLUICE_SUCCESS;
}

/* 2. The context of the device, and a streamer. What is not named here has a default. */
static void create_streamer(struct renderer *r, const struct settings *settings)
{
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = r->gpu.family,
                                                   .instance = r->gpu.instance,
                                                   .physicalDevice = r->gpu.physical_device,
                                                   .device = r->gpu.device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .sparseQueue = r->gpu.sparse_queue,
                                                   .sparseQueueFamilyIndex = r->gpu.sparse_family,
                                                   .log = log_callback};
    SLUICE(sluiceCreateVulkanContext(&context, &r->context));
    /* For comparison only: --everything keeps all tiles in memory. */
    const SluiceVulkanStreamerDebugInfo debug = {.structSize = sizeof debug,
                                                 .mapEverything = settings->everything};
    const SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                                 .context = r->context,
                                                 .residencyMode = settings->mode,
                                                 .framesInFlight = FRAMES_IN_FLIGHT,
                                                 .textureArray = SLUICE_TEXTURE_ARRAY_COMBINED,
                                                 .ticksPerSecond = 60, /* one tick per frame */
                                                 .feedbackTimeoutTicks = 128,
                                                 .pDebug = &debug};
    SLUICE(sluiceCreateVulkanStreamer(&info, &r->streamer));
}

/* 3. A texture, between frames at any time. Shaders know it by its index in the table. */
static void add_texture(struct renderer *r, uint32_t i)
{
    SLUICE(create_source(i, &r->sources[i]));
    const SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = r->sources[i]};
    SluiceVulkanTexture added;
    SLUICE(sluiceAddVulkanTexture(r->streamer, &info, &added));
    r->table_indices[i] = added.tableIndex;
}

/* 5. A frame: begin, draw and end in one command buffer, and a submission that signals. */
static void draw_frame(struct renderer *r, uint32_t number, float eye_z)
{
    struct frame *frame = &r->frames[number % FRAMES_IN_FLIGHT];
    SluiceStreamingFrame *streaming = &frame->streaming;
    wait_for(&r->gpu, streaming->semaphore, streaming->signalValue); /* before reusing the frame */
    begin_commands(frame->commands);
    streaming->structSize = sizeof *streaming;
    SLUICE(sluiceBeginStreamingFrame(r->streamer, frame->commands, number, streaming));
    draw_corridor(frame->commands, &r->drawing, streaming->descriptorSet, r->table_indices, number,
                  eye_z);
    SLUICE(sluiceEndStreamingFrame(r->streamer, frame->commands));
    copy_picture(frame->commands, &r->drawing.picture);
    submit(&r->gpu, frame->commands, streaming->semaphore, streaming->signalValue);
}

int main(int argc, char **argv)
{
    const struct settings settings = read_settings(argc, argv);
    struct renderer r = {0};
    open_device(&r.gpu, can_stream, &settings.mode);
    create_streamer(&r, &settings);
    SluiceResidencyMode mode; /* the mode that AUTO resolves to */
    SLUICE(sluiceGetVulkanResidencyMode(r.streamer, &mode));
    VkDescriptorSetLayout set_layout; /* 4. Each frame has a set of this layout. */
    SLUICE(sluiceGetVulkanDescriptorSetLayout(r.streamer, &set_layout));
    create_drawing(&r.gpu, settings.size, set_layout, mode == SLUICE_RESIDENCY_MODE_PAGED,
                   &r.drawing);
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; i++)
        r.frames[i].commands = allocate_commands(&r.gpu, &r.drawing);
    for (uint32_t i = 0; i < TEXTURES; i++)
        add_texture(&r, i);

    for (uint32_t number = 0; number < settings.frames; number++) {
        if (number >= settings.walk_frames) /* only so that all runs end with equal pictures */
            SLUICE(sluiceWaitVulkanStreamerIdle(r.streamer));
        draw_frame(&r, number, eye_in_frame(&settings, number));
        if ((number + 1) % 40 == 0 || number + 1 == settings.frames)
            print_statistics(r.streamer, number + 1);
    }

    sluiceDestroyVulkanStreamer(r.streamer); /* waits for frames and reads */
    sluiceDestroyVulkanContext(r.context);
    for (uint32_t i = 0; i < TEXTURES; i++)
        sluiceDestroyImageSource(r.sources[i]);
    const bool written = write_picture(&settings, r.drawing.picture.texels);
    destroy_drawing(&r.gpu, &r.drawing);
    close_device(&r.gpu);
    return written ? 0 : 1;
}
