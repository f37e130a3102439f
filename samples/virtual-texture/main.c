/*
 * Zooms into a texture of 2^20 x 2^20 texels without a file. A compute shader makes the visible
 * tiles. At the end the program compares every texel shown with the function that makes it.
 */
#include "../../tools/common/log.h"
#include "../../tools/common/progress.h"
#include "../../tools/common/shared_options.h"
#include "../common/paged_sample.h"
#include "../common/png_file.h"
#include "maker.h"
#include "viewer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define TILE_LOG2 8 /* tiles of bytes have 256 x 256 texels */
#define SETTLE_FRAMES 200u

struct settings {
    struct paged_sample common;
    uint32_t width, height, frames, size_log2, tiles_per_frame;
    bool json;
};

struct app {
    struct settings settings;
    struct gpu gpu;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanTexture texture;
    struct maker maker;
    struct viewer viewer;
    uint32_t frame_count;
};

static bool sluice(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        fprintf(stderr, "virtual-texture: %s: %s\n", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

/* Creates the streamer. Its tables have an entry for each tile of level 0. */
static bool create_streamer(struct app *app)
{
    const uint32_t tile_count = 1u << 2 * (app->settings.size_log2 - TILE_LOG2);
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = app->gpu.family,
                                                   .instance = app->gpu.instance,
                                                   .physicalDevice = app->gpu.physical_device,
                                                   .device = app->gpu.device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .log = {NULL, log_say}};
    const SluiceVulkanStreamerCreateInfo streamer = {.structSize = sizeof streamer,
                                                     .residencyMode = SLUICE_RESIDENCY_MODE_PAGED,
                                                     .framesInFlight = 1,
                                                     .maxTextureCount = 1,
                                                     .tilesPerFrame = app->settings.tiles_per_frame,
                                                     .maxRegionCount = tile_count,
                                                     .feedbackReadbackSize = tile_count,
                                                     .ticksPerSecond = 60,
                                                     .feedbackTimeoutTicks = 20,
                                                     .textureArray = SLUICE_TEXTURE_ARRAY_COMBINED};
    SluiceVulkanStreamerCreateInfo info = streamer;
    if (!sluice(sluiceCreateVulkanContext(&context, &app->context), "context"))
        return false;
    info.context = app->context;
    return sluice(sluiceCreateVulkanStreamer(&info, &app->streamer), "streamer");
}

/* Adds the texture. A callback replaces the source, because no file and no memory holds the whole
 * texture. */
static bool add_texture(struct app *app)
{
    const SluiceImageInfo image = {.structSize = sizeof image,
                                   .width = 1u << app->settings.size_log2,
                                   .height = 1u << app->settings.size_log2,
                                   .format = SLUICE_FORMAT_R8_UNORM,
                                   .pName = "fractal"};
    const SluiceTileProducer producer = {.structSize = sizeof producer,
                                         .pImage = &image,
                                         .pUserData = &app->maker,
                                         .pfnRecordTiles = maker_record_tiles};
    const SluiceVulkanTextureCreateInfo info = {
        .structSize = sizeof info,
        .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .pProducer = &producer};
    return sluice(sluiceAddVulkanTexture(app->streamer, &info, &app->texture), "texture");
}

static bool create(struct app *app)
{
    VkDescriptorSetLayout layout;
    return create_streamer(app) &&
           sluice(sluiceGetVulkanDescriptorSetLayout(app->streamer, &layout), "layout") &&
           maker_create(&app->maker, &app->gpu, app->settings.size_log2) &&
           viewer_create(&app->viewer, &app->gpu, app->settings.width, app->settings.height,
                         layout) &&
           add_texture(app);
}

/* Returns the view at `progress`, 0 to 1: from the whole texture to one pixel per texel. */
static struct FractalView view_at(const struct app *app, double progress)
{
    const double start = 1.0 / app->settings.height, end = ldexp(1, -(int)app->settings.size_log2);
    const double deep_x = (2.25 - 0.743643887) / 3, deep_y = (1.5 + 0.131825904) / 3;
    double scale = start * pow(end / start, progress);
    double share = start > end ? (start - scale) / (start - end) : 1;
    return (struct FractalView){.centerX = (float)(0.5 + (deep_x - 0.5) * share),
                                .centerY = (float)(0.5 + (deep_y - 0.5) * share),
                                .scale = (float)scale,
                                .width = app->settings.width,
                                .height = app->settings.height,
                                .tableIndex = app->texture.tableIndex,
                                .sizeLog2 = app->settings.size_log2};
}

static bool submit(const struct app *app, const SluiceStreamingFrame *frame)
{
    const VkTimelineSemaphoreSubmitInfo values = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &frame->signalValue};
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .pNext = &values,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &app->viewer.commands,
                               .signalSemaphoreCount = 1,
                               .pSignalSemaphores = &frame->semaphore};
    const VkSemaphoreWaitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &frame->semaphore,
                                      .pValues = &frame->signalValue};
    return gpu_check(vkQueueSubmit(app->gpu.queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit") &&
           gpu_check(vkWaitSemaphores(app->gpu.device, &wait, UINT64_MAX), "vkWaitSemaphores");
}

static bool draw_frame(struct app *app, double progress, bool compares)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    VkCommandBuffer commands = app->viewer.commands;
    struct FractalView view = view_at(app, progress);
    view.compares = compares;
    *viewer_counts(&app->viewer) = (struct FractalCounts){.finest = UINT32_MAX};
    maker_begin_frame(&app->maker);
    if (!gpu_check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer") ||
        !sluice(sluiceBeginStreamingFrame(app->streamer, commands, app->frame_count++, &frame),
                "frame"))
        return false;
    viewer_record(&app->viewer, frame.descriptorSet, &view);
    return sluice(sluiceEndStreamingFrame(app->streamer, commands), "frame") &&
           gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") && submit(app, &frame);
}

static void print_figure(const struct app *app, const char *name, double value, const char *unit)
{
    if (app->settings.json)
        printf("{\"name\": \"%s\", \"value\": %.17g, \"unit\": \"%s\"}\n", name, value, unit);
    else
        printf("%-20s %.10g %s\n", name, value, unit);
}

static bool print_figures(const struct app *app)
{
    const struct FractalCounts *counts = viewer_counts(&app->viewer);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    if (!sluice(sluiceGetVulkanStreamerStatistics(app->streamer, &stats), "statistics"))
        return false;
    if (app->settings.json)
        gpu_print_json(&app->gpu);
    print_figure(app, "texture_width", ldexp(1, (int)app->settings.size_log2), "texels");
    print_figure(app, "texture_tiles", (double)stats.tileCount, "tiles");
    print_figure(app, "frames", app->frame_count, "frames");
    print_figure(app, "tiles_made", (double)stats.tilesProduced, "tiles");
    print_figure(app, "bytes_read", (double)stats.bytesRead, "bytes");
    print_figure(app, "bytes_uploaded", (double)stats.bytesUploaded, "bytes");
    print_figure(app, "tile_memory", (double)stats.tileMemorySize, "bytes");
    print_figure(app, "finest_level", counts->finest, "");
    print_figure(app, "coarse_pixels", counts->coarse, "pixels");
    print_figure(app, "compared_texels", counts->compared, "texels");
    print_figure(app, "wrong_texels", counts->wrong, "texels");
    return true;
}

/* Draws frames until every pixel shows its requested level, but at most SETTLE_FRAMES. */
static bool settle(struct app *app)
{
    for (uint32_t i = 0; i < SETTLE_FRAMES; i++) {
        if (!draw_frame(app, 1, true))
            return false;
        if (i > 3 && viewer_counts(&app->viewer)->coarse == 0)
            return true;
    }
    return true;
}

static bool run(struct app *app)
{
    struct progress progress;
    progress_begin(&progress, "zooming", "frames", app->settings.frames);
    for (uint32_t i = 0; i < app->settings.frames; i++) {
        if (!draw_frame(app, (double)i / app->settings.frames, false))
            return false;
        progress_update(&progress, i + 1);
    }
    progress_end(&progress);
    if (!settle(app) || !print_figures(app))
        return false;
    const struct FractalCounts *counts = viewer_counts(&app->viewer);
    if (counts->wrong > 0 || counts->coarse > 0)
        fprintf(stderr, "virtual-texture: %u of %u texels are wrong, %u pixels are too coarse\n",
                counts->wrong, counts->compared, counts->coarse);
    if (!png_file_write(app->settings.common.output, app->viewer.pixels.mapped, app->settings.width,
                        app->settings.height))
        return false;
    fprintf(stderr, "virtual-texture: wrote %s\n", app->settings.common.output);
    return counts->wrong == 0 && counts->coarse == 0;
}

static void destroy(struct app *app)
{
    sluiceDestroyVulkanStreamer(app->streamer);
    maker_destroy(&app->maker);
    viewer_destroy(&app->viewer);
    sluiceDestroyVulkanContext(app->context);
    gpu_destroy(&app->gpu);
}

static enum option_outcome read_settings(struct settings *settings, int argc, char **argv)
{
    uint32_t size[2];
    const struct option options[] = {
        {OPTION_TEXT, "output", "FILE", "virtual-texture.png", &settings->common.output,
         "the last picture, as PNG", .letter = 'o'},
        {OPTION_EXTENT, "size", "WxH", "640x360", size, "pixels", 16, 4096},
        {OPTION_UINT, "frames", "N", "120", &settings->frames, "frames of the zoom", 1, 1000000},
        {OPTION_UINT, "texture-size-log2", "N", "20", &settings->size_log2,
         "width and height of the texture in texels, as a power of 2", 9, 20},
        option_tiles_per_frame(&settings->tiles_per_frame, 4096),
        option_device(&settings->common.device),
        option_list_devices(&settings->common.list_devices),
        option_validation(&settings->common.validation),
        option_json(&settings->json),
    };
    const struct option_table table = {
        "virtual-texture",
        "usage: virtual-texture [options]\n\n"
        "Zooms into a texture of 2^20 x 2^20 texels whose tiles the GPU makes on demand.\n",
        "Exit status: 0; 1 if something failed or a texel is wrong; 2 for wrong usage; 77 if no\n"
        "device has pages.\n",
        options, sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    settings->width = size[0];
    settings->height = size[1];
    return outcome;
}

int main(int argc, char **argv)
{
    struct app app = {0};
    enum option_outcome outcome = read_settings(&app.settings, argc, argv);
    int status = paged_sample_begin(outcome, &app.settings.common, &app.gpu);
    if (status != PAGED_SAMPLE_GOES_ON)
        return status;
    bool good = create(&app) && run(&app);
    destroy(&app);
    return paged_sample_end(&app.gpu, good);
}
