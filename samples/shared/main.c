/*
 * Rasterizes a room, and traces rays for the reflections in its floor. Both passes sample the same
 * textures. The streamer of the raster pass and the demand loader of the rays share one context:
 * each tile is read once and kept on one page. With --apart each has a context of its own, for
 * comparison.
 */
#include "../../tools/common/log.h"
#include "../../tools/common/shared_options.h"
#include "../common/paged_sample.h"
#include "../common/png_file.h"
#include "passes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define TEXTURE_SIZE 2048
#define BUDGET (UINT64_C(64) << 20) /* bytes of tiles */
#define HEAP_TILES 64 /* the streamer takes its share of the budget in heaps of 4 MiB */

struct settings {
    struct paged_sample common;
    uint32_t width, height, frames;
    bool apart;
};

struct app {
    struct settings settings;
    struct gpu gpu;
    SluiceVulkanContext
        *contexts[2]; ///< contexts of streamer and demand loader; equal unless --apart
    SluiceVulkanStreamer *streamer;
    SluiceDemandLoader *loader;
    SluiceImageSource *sources[TEXTURES];
    uint32_t tables[TEXTURES], ids[TEXTURES]; ///< shaders' indices of the textures
    struct passes passes;
    SluiceStreamingFrame frame;
};

static bool sluice(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        fprintf(stderr, "shared-tiles: %s: %s\n", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

/* Paints tiles, bricks or panels, for u and v in [0, 1). Every level shows the same picture. */
static void paint(void *pUserData, uint32_t mipLevel, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    static const float colors[TEXTURES][2][3] = {{{0.86f, 0.83f, 0.76f}, {0.25f, 0.22f, 0.24f}},
                                                 {{0.62f, 0.27f, 0.18f}, {0.80f, 0.76f, 0.68f}},
                                                 {{0.16f, 0.35f, 0.42f}, {0.85f, 0.70f, 0.35f}}};
    const uint32_t kind = *(const uint32_t *)pUserData;
    float u = ((float)x + 0.5f) / (float)width, v = ((float)y + 0.5f) / (float)height;
    float column, row, mix = 0;
    (void)mipLevel;
    if (kind == 0) {
        mix = ((int)(8 * u) + (int)(8 * v)) % 2 ? 1.0f : 0.0f;
    } else {
        float rows = kind == 1 ? 16.0f : 4.0f;
        float shift = kind == 1 && (int)(rows * v) % 2 ? 0.5f : 0.0f;
        float across = modff(u * rows / 2 + shift, &column), down = modff(v * rows, &row);
        mix = across < 0.06f || down < 0.1f ? 1.0f : 0.0f;
    }
    float shade = 0.85f + 0.15f * sinf(40 * u + 13 * sinf(9 * v)) * sinf(31 * v);
    for (int i = 0; i < 3; i++)
        rgba[i] = shade * (colors[kind][0][i] * (1 - mix) + colors[kind][1][i] * mix);
    rgba[3] = 1;
}

static bool create_context(struct app *app, SluiceVulkanContext **context)
{
    const SluiceVulkanContextCreateInfo info = {.structSize = sizeof info,
                                                .queueFamilyIndex = app->gpu.family,
                                                .instance = app->gpu.instance,
                                                .physicalDevice = app->gpu.physical_device,
                                                .device = app->gpu.device,
                                                .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                .log = {NULL, log_say}};
    return sluice(sluiceCreateVulkanContext(&info, context), "context");
}

static bool create_front_ends(struct app *app)
{
    if (!create_context(app, &app->contexts[0]))
        return false;
    app->contexts[1] = app->contexts[0];
    if (app->settings.apart && !create_context(app, &app->contexts[1]))
        return false;
    const SluiceVulkanStreamerCreateInfo streamer = {.structSize = sizeof streamer,
                                                     .context = app->contexts[0],
                                                     .residencyMode = SLUICE_RESIDENCY_MODE_PAGED,
                                                     .framesInFlight = 1,
                                                     .heapTileCapacity = HEAP_TILES,
                                                     .maxHeapCount = BUDGET / 65536 / HEAP_TILES,
                                                     .ticksPerSecond = 60,
                                                     .feedbackTimeoutTicks = 1000};
    const SluiceDemandLoaderCreateInfo loader = {.structSize = sizeof loader,
                                                 .context = app->contexts[1],
                                                 .launchesInFlight = 1,
                                                 .memoryBudget = BUDGET};
    return sluice(sluiceCreateVulkanStreamer(&streamer, &app->streamer), "streamer") &&
           sluice(sluiceCreateDemandLoader(&loader, &app->loader), "demand loader");
}

/* Adds one source to both the streamer and the demand loader. */
static bool add_texture(struct app *app, uint32_t i)
{
    static const uint32_t kinds[TEXTURES] = {0, 1, 2};
    const SluiceProceduralImage image = {(void *)&kinds[i], paint};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = TEXTURE_SIZE,
                                  .height = TEXTURE_SIZE,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "room"};
    if (!sluice(sluiceCreateProceduralImageSource(&image, &info, NULL, &app->sources[i]), "image"))
        return false;
    const SluiceVulkanTextureCreateInfo streamed = {.structSize = sizeof streamed,
                                                    .source = app->sources[i]};
    const SluiceDemandTextureCreateInfo traced = {.structSize = sizeof traced,
                                                  .image = {.source = app->sources[i]}};
    SluiceVulkanTexture texture;
    SluiceDemandTextureId id;
    if (!sluice(sluiceAddVulkanTexture(app->streamer, &streamed, &texture), "texture") ||
        !sluice(sluiceAddDemandTexture(app->loader, &traced, &id), "texture"))
        return false;
    passes_set_image(&app->passes, i, texture.imageView);
    app->tables[i] = texture.tableIndex;
    app->ids[i] = (uint32_t)id;
    return true;
}

static bool create(struct app *app)
{
    VkDescriptorSetLayout streamer_layout, loader_layout;
    if (!create_front_ends(app) ||
        !sluice(sluiceGetVulkanDescriptorSetLayout(app->streamer, &streamer_layout), "layout") ||
        !sluice(sluiceGetDemandDescriptorSetLayout(app->loader, &loader_layout), "layout") ||
        !passes_create(&app->passes, &app->gpu, app->settings.width, app->settings.height,
                       streamer_layout, loader_layout))
        return false;
    for (uint32_t i = 0; i < TEXTURES; i++)
        if (!add_texture(app, i))
            return false;
    return true;
}

static bool begin(VkCommandBuffer commands)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    return gpu_check(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
}

static bool submit(const struct app *app, VkCommandBuffer commands, VkSemaphore semaphore,
                   uint64_t value)
{
    const VkTimelineSemaphoreSubmitInfo values = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &value};
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .pNext = &values,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &commands,
                               .signalSemaphoreCount = 1,
                               .pSignalSemaphores = &semaphore};
    return gpu_check(vkQueueSubmit(app->gpu.queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
}

static bool draw_frame(struct app *app, uint32_t number)
{
    app->frame.structSize = sizeof app->frame;
    VkCommandBuffer commands = app->passes.commands[0];
    if (!begin(commands) ||
        !sluice(sluiceBeginStreamingFrame(app->streamer, commands, number, &app->frame), "frame"))
        return false;
    passes_record_room(&app->passes, app->frame.descriptorSet, app->tables);
    if (!sluice(sluiceEndStreamingFrame(app->streamer, commands), "frame"))
        return false;
    target_copy_out(&app->passes.target, commands, app->passes.picture.buffer);
    const VkSemaphoreWaitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &app->frame.semaphore,
                                      .pValues = &app->frame.signalValue};
    return gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") &&
           submit(app, commands, app->frame.semaphore, app->frame.signalValue) &&
           gpu_check(vkWaitSemaphores(app->gpu.device, &wait, UINT64_MAX), "vkWaitSemaphores") &&
           sluice(sluiceWaitVulkanStreamerIdle(app->streamer), "reads");
}

static bool trace(struct app *app, uint32_t *missing)
{
    VkCommandBuffer commands = app->passes.commands[1];
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    SluiceDemandTicket ticket;
    if (!begin(commands) ||
        !sluice(sluiceBeginDemandLaunch(app->loader, commands, &launch), "launch"))
        return false;
    passes_record_reflections(&app->passes, launch.descriptorSet, app->ids);
    if (!sluice(sluiceEndDemandLaunch(app->loader, commands), "launch") ||
        !gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") ||
        !submit(app, commands, launch.semaphore, launch.signalValue) ||
        !sluice(sluiceProcessDemandRequests(app->loader, &launch, UINT64_MAX, &requests, &ticket),
                "requests"))
        return false;
    *missing = requests.missingCount;
    return sluice(sluiceWaitDemandTicket(app->loader, ticket, UINT64_MAX, NULL), "reads");
}

/* Blends the reflections over the picture by their weights. */
static bool write_picture(const struct app *app)
{
    uint8_t *picture = app->passes.picture.mapped;
    const uint8_t *reflections = app->passes.reflections.mapped;
    for (size_t i = 0; i < (size_t)app->settings.width * app->settings.height; i++) {
        float weight = (float)reflections[4 * i + 3] / 255.0f;
        for (size_t k = 4 * i; k < 4 * i + 3; k++)
            picture[k] =
                (uint8_t)((float)picture[k] * (1 - weight) + (float)reflections[k] * weight + 0.5f);
    }
    return png_file_write(app->settings.common.output, picture, app->settings.width,
                          app->settings.height);
}

static bool print_counts(const struct app *app, uint32_t missing)
{
    SluiceVulkanStreamerStatistics streamed = {.structSize = sizeof streamed};
    SluiceDemandStatistics traced = {.structSize = sizeof traced};
    if (!sluice(sluiceGetVulkanStreamerStatistics(app->streamer, &streamed), "statistics") ||
        !sluice(sluiceGetDemandStatistics(app->loader, &traced), "statistics"))
        return false;
    printf("streamer: %llu tiles mapped, %llu of them from the demand loader\n",
           (unsigned long long)streamed.tilesMapped, (unsigned long long)streamed.tilesShared);
    printf("demand loader: %llu tiles resident, %llu of them from the streamer, %u missing\n",
           (unsigned long long)traced.residentTileCount, (unsigned long long)traced.sharedCount,
           missing);
    printf("read: %llu KiB\n", (unsigned long long)((streamed.bytesRead + traced.bytesRead) >> 10));
    return true;
}

static bool run(struct app *app)
{
    uint32_t missing = 0;
    for (uint32_t i = 1; i <= app->settings.frames; i++)
        if (!draw_frame(app, i) || !trace(app, &missing))
            return false;
    return print_counts(app, missing) && write_picture(app);
}

static void destroy(struct app *app)
{
    sluiceDestroyVulkanStreamer(app->streamer);
    sluiceDestroyDemandLoader(app->loader);
    passes_destroy(&app->passes);
    if (app->contexts[1] != app->contexts[0])
        sluiceDestroyVulkanContext(app->contexts[1]);
    sluiceDestroyVulkanContext(app->contexts[0]);
    for (uint32_t i = 0; i < TEXTURES; i++)
        sluiceDestroyImageSource(app->sources[i]);
    gpu_destroy(&app->gpu);
}

static enum option_outcome read_settings(struct settings *settings, int argc, char **argv)
{
    uint32_t size[2];
    const struct option options[] = {
        {OPTION_TEXT, "output", "FILE", "shared.png", &settings->common.output,
         "the picture, as PNG", .letter = 'o'},
        {OPTION_EXTENT, "size", "WxH", "640x360", size, "pixels", 16, 4096},
        {OPTION_UINT, "frames", "N", "30", &settings->frames, "frames, and as many launches", 1,
         1000000},
        {OPTION_FLAG, "apart", NULL, NULL, &settings->apart,
         "a context for each front end: nothing is shared"},
        option_device(&settings->common.device),
        option_list_devices(&settings->common.list_devices),
        option_validation(&settings->common.validation),
    };
    const struct option_table table = {
        "shared-tiles",
        "usage: shared-tiles [options]\n\n"
        "Rasterizes a room and traces what its floor reflects, with the same textures.\n",
        "Exit status: 0; 1 if something failed; 2 for wrong usage; 77 if no device has pages.\n",
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
