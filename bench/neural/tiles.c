#include "tiles.h"

#include "../../tools/common/log.h"
#include "../manager/figures.h"

#include <sluice/vulkan_neural.h>

#include <stdio.h>
#include <stdlib.h>

/* Copies of the material along each axis of the image, for large batches. */
#define COPIES 4u
#define MAX_SIDE 4096u

/* Tiles have 64 KiB, as in sparse images. */
static const struct format {
    const char *name;
    SluiceFormat format;
    VkFormat vk_format;
    uint32_t width, height, channels;
} formats[] = {
    {"rgba8", SLUICE_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, 128, 128, 4},
    {"rgba16f", SLUICE_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT, 128, 64, 4},
    {"bc1", SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, VK_FORMAT_BC1_RGB_UNORM_BLOCK, 512, 256, 3},
    {"bc4", SLUICE_FORMAT_BC4_UNORM_BLOCK, VK_FORMAT_BC4_UNORM_BLOCK, 512, 256, 1},
    {"bc5", SLUICE_FORMAT_BC5_UNORM_BLOCK, VK_FORMAT_BC5_UNORM_BLOCK, 256, 256, 2},
    {"bc7", SLUICE_FORMAT_BC7_UNORM_BLOCK, VK_FORMAT_BC7_UNORM_BLOCK, 256, 256, 4},
};
#define FORMAT_COUNT (sizeof formats / sizeof *formats)

struct tiles {
    const struct gpu *gpu;
    const struct material *material;
    const struct stopwatch *stopwatch;
    uint32_t repeats;
    uint32_t width, height; ///< size of the images
    SluiceVulkanContext *context;
    SluiceVulkanNeuralDecoder *decoder;
    struct gpu_buffer host, device; ///< RGBA8 texels of one image
    double copy_rate;               ///< texels per second, from device memory
};

/* Commands of one run, and their objects. */
struct job {
    const struct format *format;
    const SluiceTileProducer *producer; ///< NULL: a copy
    VkBuffer from;                      ///< source of a copy
    VkImage image;
    SluiceTileTarget *targets;
    uint32_t width, height, count; ///< size and number of tiles
};

static bool check(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static uint32_t min_of(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static bool create(struct tiles *t)
{
    const struct material *m = t->material;
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = t->gpu->family,
                                                   .instance = t->gpu->instance,
                                                   .physicalDevice = t->gpu->physical_device,
                                                   .device = t->gpu->device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .log = {NULL, log_say}};
    if (!check(sluiceCreateVulkanContext(&context, &t->context), "sluiceCreateVulkanContext"))
        return false;
    const SluiceVulkanNeuralDecoderCreateInfo decoder = {.structSize = sizeof decoder,
                                                         .context = t->context,
                                                         .pConstants = &m->constants,
                                                         .pLatents = m->latents,
                                                         .latentSize = m->latent_size,
                                                         .pWeights = m->weights,
                                                         .weightSize = m->weight_size};
    const VkDeviceSize size = (VkDeviceSize)t->width * t->height * 4;
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    return check(sluiceCreateVulkanNeuralDecoder(&decoder, &t->decoder),
                 "sluiceCreateVulkanNeuralDecoder") &&
           gpu_create_buffer(t->gpu, size, usage, &t->host) &&
           gpu_create_device_buffer(t->gpu, size, usage, &t->device);
}

/* Places the material's tiles repeatedly. */
static bool place_targets(const struct tiles *t, struct job *job)
{
    const uint32_t width = t->material->constants.width, height = t->material->constants.height;
    job->width = min_of(job->format->width, width);
    job->height = min_of(job->format->height, height);
    const uint32_t columns = t->width / job->width, rows = t->height / job->height;
    job->count = columns * rows;
    job->targets = calloc(job->count, sizeof *job->targets);
    for (uint32_t i = 0; job->targets && i < job->count; i++) {
        uint32_t x = i % columns * job->width, y = i / columns * job->height;
        job->targets[i] =
            (SluiceTileTarget){.region = {.x = min_of(x % width, width - job->width) / 4 * 4,
                                          .y = min_of(y % height, height - job->height) / 4 * 4,
                                          .width = job->width,
                                          .height = job->height},
                               .x = x,
                               .y = y};
    }
    return job->targets != NULL;
}

static bool record_copies(const struct job *job, VkCommandBuffer commands)
{
    VkBufferImageCopy *copies = calloc(job->count, sizeof *copies);
    const VkDeviceSize size = (VkDeviceSize)job->width * job->height * 4;
    for (uint32_t i = 0; copies && i < job->count; i++)
        copies[i] = (VkBufferImageCopy){
            .bufferOffset = i * size,
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
            .imageOffset = {(int32_t)job->targets[i].x, (int32_t)job->targets[i].y, 0},
            .imageExtent = {job->width, job->height, 1}};
    if (copies)
        vkCmdCopyBufferToImage(commands, job->from, job->image, VK_IMAGE_LAYOUT_GENERAL, job->count,
                               copies);
    free(copies);
    return copies != NULL;
}

static bool record_tiles(const struct tiles *t, const struct job *job, VkCommandBuffer commands)
{
    SluiceResult *results = calloc(job->count, sizeof *results);
    const SluiceTileBatch batch = {.structSize = sizeof batch,
                                   .commandBuffer = commands,
                                   .image = job->image,
                                   .tileCount = job->count,
                                   .pTiles = job->targets,
                                   .levelWidth = t->width,
                                   .levelHeight = t->height};
    bool done =
        results && check(job->producer->pfnRecordTiles(job->producer->pUserData, &batch, results),
                         "pfnRecordTiles");
    for (uint32_t i = 0; done && i < job->count; i++)
        done = check(results[i], "a tile");
    free(results);
    return done;
}

static void to_general(VkCommandBuffer commands, VkImage image)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .newLayout = VK_IMAGE_LAYOUT_GENERAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
}

/* Measures the median time of all tiles. The first run warms up. */
static bool measure(const struct tiles *t, const struct job *job, double *seconds)
{
    struct samples samples;
    samples_init(&samples, t->repeats);
    bool done = true;
    for (uint32_t i = 0; done && i <= t->repeats; i++) {
        VkCommandBuffer commands;
        double taken = 0;
        done = commands_begin(t->gpu, &commands);
        if (!done)
            break;
        to_general(commands, job->image);
        stopwatch_start(t->stopwatch, commands);
        done = job->producer ? record_tiles(t, job, commands) : record_copies(job, commands);
        stopwatch_stop(t->stopwatch, commands);
        done = stopwatch_run(t->stopwatch, t->gpu, commands, &taken) && done;
        if (i > 0)
            samples_add(&samples, taken * 1e9);
    }
    *seconds = 1e-9 * samples_quantile(&samples, 0.5);
    samples_finish(&samples);
    return done;
}

/* Returns texels per second in `*rate`. */
static bool run(const struct tiles *t, const char *name, struct job *job, double *rate)
{
    struct gpu_image image = {0};
    char figure_name[64];
    double seconds = 1;
    bool done = gpu_create_texture(t->gpu, job->format->vk_format, t->width, t->height, 1, &image);
    job->image = image.image;
    done = done && place_targets(t, job) && measure(t, job, &seconds);
    *rate = (double)job->count * job->width * job->height / seconds;
    if (done) {
        snprintf(figure_name, sizeof figure_name, "tiles.%s.rate", name);
        figure("neural", figure_name, job->count / seconds, "tiles/s");
        snprintf(figure_name, sizeof figure_name, "tiles.%s.texels", name);
        figure("neural", figure_name, *rate * 1e-9, "Gtexel/s");
    }
    free(job->targets);
    gpu_destroy_image(t->gpu, &image);
    return done;
}

static bool run_format(const struct tiles *t, const struct format *format)
{
    const SluiceVulkanNeuralOutput output = {
        .structSize = sizeof output, .format = format->format, .channelCount = format->channels};
    struct job job = {.format = format};
    char name[64];
    double rate;
    if (!check(sluiceAddVulkanNeuralOutput(t->decoder, &output, &job.producer), format->name) ||
        !run(t, format->name, &job, &rate))
        return false;
    snprintf(name, sizeof name, "tiles.%s.ratio", format->name);
    figure("neural", name, rate / t->copy_rate, "");
    return true;
}

bool tiles_measure(const struct gpu *gpu, const struct material *material,
                   const struct stopwatch *stopwatch, uint32_t repeats)
{
    const SluiceNeuralConstants *k = &material->constants;
    struct tiles t = {.gpu = gpu,
                      .material = material,
                      .stopwatch = stopwatch,
                      .repeats = repeats,
                      .width = min_of(COPIES * k->width, MAX_SIDE),
                      .height = min_of(COPIES * k->height, MAX_SIDE)};
    double upload_rate;
    bool done = create(&t);
    struct job copy = {.format = &formats[0], .from = t.device.buffer};
    struct job upload = {.format = &formats[0], .from = t.host.buffer};
    done = done && run(&t, "copied", &copy, &t.copy_rate) &&
           run(&t, "uploaded", &upload, &upload_rate);
    for (size_t i = 0; done && i < FORMAT_COUNT; i++)
        done = run_format(&t, &formats[i]);
    gpu_destroy_buffer(gpu, &t.host);
    gpu_destroy_buffer(gpu, &t.device);
    sluiceDestroyVulkanNeuralDecoder(t.decoder);
    sluiceDestroyVulkanContext(t.context);
    return done;
}
