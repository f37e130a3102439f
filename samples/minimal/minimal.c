/*
 * Streams three procedural textures onto the walls of a corridor: everything that a renderer does
 * for Sluice, in the order in which it does it. What any Vulkan program does is in vulkan_setup.c.
 */
#include "vulkan_setup.h"

#include <sluice/vulkan.h>

#include "../common/options.h"
#include "../common/png_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SLUICE(call) check_result((call), #call)
#define TEXTURES 3
#define FRAMES_IN_FLIGHT 2
#define REST_FRAMES 80u /* at the end: the lattice of room.frag needs 64 to reach every pixel */

struct draw { /* push constants, as in room.vert and room.frag */
    uint32_t surface, table_index, frame;
    float aspect, eye_z;
};

struct frame {
    VkCommandBuffer commands;
    VkDescriptorSet set;
    uint64_t page_generation;       /* of the pages that the set names */
    SluiceStreamingFrame streaming; /* what its submission signals */
};

struct renderer {
    struct gpu gpu;
    struct picture picture;
    struct drawing drawing;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *sources[TEXTURES];
    SluiceVulkanTexture textures[TEXTURES];
    VkDescriptorSet texture_sets[TEXTURES];
    struct frame frames[FRAMES_IN_FLIGHT];
};

static void check_result(SluiceResult result, const char *what)
{
    check(result == SLUICE_SUCCESS, what, sluiceResultString(result));
}

static void print_message(void *pUserData, SluiceLogSeverity severity, const char *pMessage)
{
    (void)pUserData;
    if (severity != SLUICE_LOG_INFO)
        fprintf(stderr, "%s\n", pMessage);
}
static const SluiceLogCallback log_callback = {NULL, print_message};

/* Opens the first device that can stream in this mode, with the features that it takes. */
static void open_streaming_device(SluiceResidencyMode mode, struct gpu *gpu)
{
    VkPhysicalDevice devices[16];
    uint32_t count = find_devices(gpu, devices);
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceVulkan12Features vulkan12 = {
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
        VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                              .pNext = &vulkan12};
        SluiceVulkanDeviceCapabilities caps;
        SLUICE(sluiceGetVulkanDeviceCapabilities(gpu->instance, devices[i], vkGetInstanceProcAddr,
                                                 &caps));
        gpu->physical_device = devices[i];
        gpu->family = find_queue_family(devices[i], VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT);
        gpu->sparse_family = caps.sparse ? caps.sparseQueueFamilyIndex : gpu->family;
        /* Of room.frag alone: it is compiled once for all modes, and finds pages like this. */
        features.features.shaderSampledImageArrayDynamicIndexing = VK_TRUE;
        vulkan12.shaderSampledImageArrayNonUniformIndexing = VK_TRUE;
        if (sluiceRequireVulkanFeatures(gpu->instance, devices[i], vkGetInstanceProcAddr, mode,
                                        &log_callback, &features.features,
                                        &vulkan12) == SLUICE_SUCCESS &&
            caps.nonUniformIndexing && gpu->family != UINT32_MAX) {
            open_device(gpu, &features);
            return;
        }
        fprintf(stderr, "%s cannot stream in this residency mode\n", caps.deviceName);
    }
    exit(77);
}

static SluiceVulkanStreamer *create_streamer(const struct gpu *gpu, SluiceResidencyMode mode,
                                             bool everything)
{
    SluiceVulkanStreamerCreateInfo info = {.instance = gpu->instance,
                                           .physicalDevice = gpu->physical_device,
                                           .device = gpu->device,
                                           .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                           .sparseQueue = gpu->sparse_queue,
                                           .sparseQueueFamilyIndex = gpu->sparse_family,
                                           .queueFamilyIndex = gpu->family,
                                           .residencyMode = mode,
                                           .log = log_callback,
                                           .framesInFlight = FRAMES_IN_FLIGHT,
                                           .maxPageChunkCount = PAGE_CHUNKS,
                                           .feedbackTimeout = 128, /* frames, our unit of time */
                                           .mapEverything = everything};
    SluiceVulkanStreamer *streamer;
    SLUICE(sluiceCreateVulkanStreamer(&info, &streamer));
    return streamer;
}

/* Waves of ever finer scale, as far as the level can show them; any thread calls this. */
static void paint(void *pUserData, uint32_t mipLevel, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    const float *color = pUserData;
    const float u = ((float)x + 0.5f) / (float)width, v = ((float)y + 0.5f) / (float)height;
    float value = 0.5f, strength = 0.25f;
    (void)mipLevel;
    for (float waves = 4.0f; 4.0f * waves <= (float)(width < height ? width : height);
         waves *= 4.0f) {
        value += strength * sinf(6.2831853f * waves * u) * sinf(6.2831853f * waves * v);
        strength *= 0.8f;
    }
    for (int c = 0; c < 4; c++)
        rgba[c] = c < 3 ? color[c] * value : 1.0f;
}

static SluiceImageSource *create_source(uint32_t index)
{
    static float colors[TEXTURES][3] = {{0.9f, 0.6f, 0.3f}, {0.4f, 0.8f, 0.5f}, {0.9f, 0.4f, 0.5f}};
    const SluiceProceduralImage image = {colors[index], paint};
    const SluiceImageInfo info = {.width = 4096u >> index, /* a different size for each */
                                  .height = 2048,
                                  .format = SLUICE_FORMAT_R8G8B8A8_SRGB,
                                  .pName = "waves"};
    SluiceImageSource *source;
    SLUICE(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
    return source;
}

/* Waits until the frame that last used these is over. */
static void wait_for(const struct gpu *gpu, const struct frame *frame)
{
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &frame->streaming.semaphore,
                                .pValues = &frame->streaming.signalValue};
    if (frame->streaming.semaphore)
        VK(vkWaitSemaphores(gpu->device, &info, UINT64_MAX));
}

/* The array of page views changes seldom, and only in sluiceBeginStreamingFrame. */
static void update_pages(const struct gpu *gpu, SluiceVulkanStreamer *streamer, struct frame *frame)
{
    SluiceVulkanPages pages;
    sluiceGetVulkanPages(streamer, &pages);
    if (frame->page_generation != pages.generation)
        write_images(gpu, frame->set, 4, pages.viewCount, pages.pViews, pages.sampler);
    frame->page_generation = pages.generation;
}

static void submit(const struct gpu *gpu, const struct frame *frame)
{
    VkTimelineSemaphoreSubmitInfo values = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &frame->streaming.signalValue};
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .pNext = &values,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &frame->commands,
                         .signalSemaphoreCount = 1,
                         .pSignalSemaphores = &frame->streaming.semaphore};
    VK(vkQueueSubmit(gpu->queue, 1, &info, VK_NULL_HANDLE));
}

static void draw_frame(struct renderer *r, struct draw draw)
{
    struct frame *frame = &r->frames[draw.frame % FRAMES_IN_FLIGHT];
    wait_for(&r->gpu, frame);
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK(vkBeginCommandBuffer(frame->commands, &begin));
    SLUICE(sluiceBeginStreamingFrame(r->streamer, frame->commands, draw.frame, &frame->streaming));
    update_pages(&r->gpu, r->streamer, frame);

    begin_drawing(frame->commands, &r->drawing, &r->picture);
    for (draw.surface = 0; draw.surface < 4; draw.surface++) {
        const uint32_t texture = draw.surface == 0 ? 0 : draw.surface == 3 ? 2 : 1;
        const VkDescriptorSet sets[] = {frame->set, r->texture_sets[texture]};
        draw.table_index = r->textures[texture].tableIndex;
        vkCmdBindDescriptorSets(frame->commands, VK_PIPELINE_BIND_POINT_GRAPHICS, r->drawing.layout,
                                0, 2, sets, 0, NULL);
        vkCmdPushConstants(frame->commands, r->drawing.layout,
                           VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                           sizeof draw, &draw);
        vkCmdDraw(frame->commands, 6, 1, 0, 0);
    }
    vkCmdEndRenderPass(frame->commands);

    SLUICE(sluiceEndStreamingFrame(r->streamer, frame->commands));
    copy_picture(frame->commands, &r->picture);
    VK(vkEndCommandBuffer(frame->commands));
    submit(&r->gpu, frame);
}

static void create_renderer(struct renderer *r, SluiceResidencyMode mode, bool everything,
                            const uint32_t size[2])
{
    open_streaming_device(mode, &r->gpu);
    r->streamer = create_streamer(&r->gpu, mode, everything);
    create_picture(&r->gpu, size[0], size[1], &r->picture);
    create_drawing(&r->gpu, &r->picture,
                   sluiceGetVulkanResidencyMode(r->streamer) == SLUICE_RESIDENCY_MODE_PAGED,
                   sizeof(struct draw), &r->drawing);
    for (uint32_t i = 0; i < TEXTURES; i++) {
        r->sources[i] = create_source(i);
        const SluiceVulkanTextureCreateInfo info = {.source = r->sources[i]};
        SLUICE(sluiceAddVulkanTexture(r->streamer, &info, &r->textures[i]));
        r->texture_sets[i] = allocate_set(&r->gpu, &r->drawing, 1);
        write_images(&r->gpu, r->texture_sets[i], 0, 1, &r->textures[i].imageView,
                     r->drawing.sampler);
    }
    SluiceVulkanBuffers own; /* the same for the streamer's whole life, whatever is added */
    sluiceGetVulkanBuffers(r->streamer, &own);
    const VkBuffer buffers[] = {own.textureTable, own.minMip, own.feedback, own.pageTable};
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; i++) {
        r->frames[i].commands = allocate_commands(&r->gpu, &r->drawing);
        r->frames[i].set = allocate_set(&r->gpu, &r->drawing, 0);
        write_buffers(&r->gpu, r->frames[i].set, 4, buffers);
    }
}

static void destroy_renderer(struct renderer *r)
{
    sluiceDestroyVulkanStreamer(r->streamer); /* waits for the device, and for reads of sources */
    for (uint32_t i = 0; i < TEXTURES; i++)
        sluiceDestroyImageSource(r->sources[i]);
    destroy_drawing(&r->gpu, &r->drawing);
    destroy_picture(&r->gpu, &r->picture);
    close_device(&r->gpu);
}

static void print_statistics(const struct renderer *r)
{
    static const char *const modes[] = {"auto", "sparse", "paged", "dense"};
    SluiceVulkanStreamerStatistics now;
    sluiceGetVulkanStreamerStatistics(r->streamer, &now);
    printf("%s: %u of %u tiles mapped, %.1f MB of texels read, %.1f MB of device memory\n",
           modes[sluiceGetVulkanResidencyMode(r->streamer)], now.manager.mappedTileCount,
           (unsigned)now.manager.tileCount, (double)now.bytesRead * 1e-6,
           (double)now.deviceMemorySize * 1e-6);
}

int main(int argc, char **argv)
{
    int residency = SLUICE_RESIDENCY_MODE_AUTO;
    uint32_t frames = 120, size[2] = {960, 540};
    bool everything = false;
    const char *output = "minimal.png";
    const struct option options[] = {
        {OPTION_CHOICE, "residency", "auto|sparse|paged|dense", &residency, "how tiles get memory",
         0, 0},
        {OPTION_UINT, "frames", "N", &frames, "to walk, before the eye rests", 1, 100000},
        {OPTION_SIZE, "size", "WxH", size, "of the picture in pixels", 1, 4096},
        {OPTION_FLAG, "everything", NULL, &everything, "have every tile, wanted or not", 0, 0},
        {OPTION_TEXT, "output", "FILE", &output, "the last picture, as PNG", 0, 0}};
    enum option_outcome outcome =
        options_parse(options, sizeof options / sizeof *options,
                      "minimal: walks along a corridor of streamed textures\n\n", argc, argv);
    if (outcome != OPTIONS_RUN)
        return outcome == OPTIONS_HELP ? 0 : 2;

    static struct renderer r;
    create_renderer(&r, (SluiceResidencyMode)residency, everything, size);
    struct draw draw = {.aspect = (float)size[0] / (float)size[1]};
    for (draw.frame = 0; draw.frame < frames + REST_FRAMES; draw.frame++) {
        const uint32_t step = draw.frame < frames ? draw.frame : frames;
        draw.eye_z = 1.0f - 4.0f * (float)step / (float)frames;
        if (draw.frame >= frames) /* only so that each run ends with the same picture */
            SLUICE(sluiceWaitVulkanStreamerIdle(r.streamer));
        draw_frame(&r, draw);
    }
    wait_for(&r.gpu, &r.frames[(draw.frame - 1) % FRAMES_IN_FLIGHT]);
    print_statistics(&r);
    bool written = png_file_write(output, r.picture.texels, size[0], size[1]);
    destroy_renderer(&r);
    return written ? 0 : 1;
}
