#include "maker.h"

#include "../../tools/common/clock.h"

#include "bench_make_comp.h"

#include <math.h>

#define TILE_SIZE 128u /* texels of RGBA8 */
#define BATCH 64u      /* tiles in a dispatch, as the streamer has them at most */
#define LAYERS 1024u

static bool create_pipeline(struct maker *m)
{
    VkDevice device = m->bench->gpu.device;
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL}};
    const VkDescriptorSetLayoutCreateInfo sets = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 2,
        .pBindings = bindings};
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct BenchMake)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &m->set_layout,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    if (!gpu_check(vkCreateDescriptorSetLayout(device, &sets, NULL, &m->set_layout),
                   "set layout") ||
        !gpu_check(vkCreatePipelineLayout(device, &layout, NULL, &m->layout), "pipeline layout"))
        return false;
    return gpu_create_compute_pipeline(&m->bench->gpu, m->layout, bench_make_comp,
                                       sizeof bench_make_comp, NULL, &m->pipeline);
}

static bool create_sets(struct maker *m)
{
    VkDevice device = m->bench->gpu.device;
    const uint32_t count = RIG_FRAMES * MAKER_SETS;
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, count},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = count,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    static VkDescriptorSetLayout layouts[RIG_FRAMES * MAKER_SETS];
    for (uint32_t i = 0; i < count; i++)
        layouts[i] = m->set_layout;
    if (!gpu_check(vkCreateDescriptorPool(device, &pool, NULL, &m->pool), "descriptor pool"))
        return false;
    const VkDescriptorSetAllocateInfo sets = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = m->pool,
                                              .descriptorSetCount = count,
                                              .pSetLayouts = layouts};
    return gpu_check(vkAllocateDescriptorSets(device, &sets, m->sets), "descriptor sets");
}

bool maker_create(struct maker *m, const struct bench *bench, uint32_t steps)
{
    *m = (struct maker){.bench = bench, .steps = steps};
    return gpu_create_buffer(&bench->gpu, RIG_FRAMES * MAKER_TILES * sizeof(struct BenchTile),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &m->tiles) &&
           create_pipeline(m) && create_sets(m);
}

void maker_destroy(struct maker *m)
{
    VkDevice device = m->bench->gpu.device;
    vkDestroyPipeline(device, m->pipeline, NULL);
    vkDestroyPipelineLayout(device, m->layout, NULL);
    vkDestroyDescriptorPool(device, m->pool, NULL);
    vkDestroyDescriptorSetLayout(device, m->set_layout, NULL);
    gpu_destroy_buffer(&m->bench->gpu, &m->tiles);
}

static VkDescriptorSet write_set(struct maker *m, VkImageView view)
{
    uint32_t slot = (uint32_t)(m->frame % RIG_FRAMES);
    VkDescriptorSet set = m->sets[slot * MAKER_SETS + m->set_count++];
    const VkDescriptorImageInfo image = {.imageView = view, .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo tiles = {m->tiles.buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet writes[] = {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = set,
                                            .dstBinding = 0,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                            .pImageInfo = &image},
                                           {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = set,
                                            .dstBinding = 1,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                            .pBufferInfo = &tiles}};
    vkUpdateDescriptorSets(m->bench->gpu.device, 2, writes, 0, NULL);
    return set;
}

/* Records a dispatch for tiles of the list, the first of which is `first`. */
static void dispatch(const struct maker *m, VkCommandBuffer commands, VkDescriptorSet set,
                     uint32_t first, uint32_t count)
{
    const struct BenchMake make = {first, m->steps};
    const struct BenchTile *tiles = (const struct BenchTile *)m->tiles.mapped + first;
    uint32_t width = 0, height = 0;
    for (uint32_t i = 0; i < count; i++) {
        width = tiles[i].width > width ? tiles[i].width : width;
        height = tiles[i].height > height ? tiles[i].height : height;
    }
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, m->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, m->layout, 0, 1, &set, 0,
                            NULL);
    vkCmdPushConstants(commands, m->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof make, &make);
    vkCmdDispatch(commands, (width + BENCH_MAKE_GROUP - 1) / BENCH_MAKE_GROUP,
                  (height + BENCH_MAKE_GROUP - 1) / BENCH_MAKE_GROUP, count);
}

SluiceResult maker_record_tiles(void *user, const SluiceTileBatch *batch, SluiceResult *results)
{
    struct maker *m = user;
    (void)results; /* all tiles of a batch have one answer */
    if (!batch->imageView)
        return SLUICE_ERROR_UNSUPPORTED;
    if (batch->frameIndex != m->frame)
        m->set_count = m->tile_count = 0;
    m->frame = batch->frameIndex;
    if (m->set_count == MAKER_SETS || m->tile_count + batch->tileCount > MAKER_TILES)
        return SLUICE_NOT_READY;
    uint32_t first = (uint32_t)(m->frame % RIG_FRAMES) * MAKER_TILES + m->tile_count;
    struct BenchTile *tiles = (struct BenchTile *)m->tiles.mapped + first;
    for (uint32_t i = 0; i < batch->tileCount; i++) {
        const SluiceTileTarget *t = &batch->pTiles[i];
        const SluiceImageRegion *r = &t->region;
        tiles[i] =
            (struct BenchTile){r->mipLevel, r->x, r->y, r->width, r->height, t->x, t->y, t->layer};
    }
    m->tile_count += batch->tileCount;
    dispatch(m, batch->commandBuffer, write_set(m, batch->imageView), first, batch->tileCount);
    return SLUICE_SUCCESS;
}

struct floor_image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
    VkCommandBuffer commands;
};

static bool create_floor_image(const struct gpu *gpu, struct floor_image *f)
{
    const VkImageCreateInfo image = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                     .imageType = VK_IMAGE_TYPE_2D,
                                     .format = VK_FORMAT_R8G8B8A8_UNORM,
                                     .extent = {TILE_SIZE, TILE_SIZE, 1},
                                     .mipLevels = 1,
                                     .arrayLayers = LAYERS,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .usage =
                                         VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT};
    if (!gpu_check(vkCreateImage(gpu->device, &image, NULL, &f->image), "vkCreateImage"))
        return false;
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(gpu->device, f->image, &needs);
    const VkMemoryAllocateInfo memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                         .allocationSize = needs.size,
                                         .memoryTypeIndex =
                                             device_local_type(gpu, needs.memoryTypeBits)};
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = f->image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
        .format = image.format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, LAYERS}};
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = gpu->command_pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1};
    return gpu_check(vkAllocateMemory(gpu->device, &memory, NULL, &f->memory), "memory") &&
           gpu_check(vkBindImageMemory(gpu->device, f->image, f->memory, 0), "memory") &&
           gpu_check(vkCreateImageView(gpu->device, &view, NULL, &f->view), "view") &&
           gpu_check(vkAllocateCommandBuffers(gpu->device, &commands, &f->commands), "commands");
}

static void destroy_floor_image(const struct gpu *gpu, struct floor_image *f)
{
    if (f->commands)
        vkFreeCommandBuffers(gpu->device, gpu->command_pool, 1, &f->commands);
    vkDestroyImageView(gpu->device, f->view, NULL);
    vkDestroyImage(gpu->device, f->image, NULL);
    vkFreeMemory(gpu->device, f->memory, NULL);
}

/* Orders writes to the same layers. The first one also gives the image its layout. */
static void order(VkCommandBuffer commands, VkImage image, bool first)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
        .oldLayout = first ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL,
        .newLayout = VK_IMAGE_LAYOUT_GENERAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, LAYERS}};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                         VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
}

/* Measures from recording until the device is idle. */
static bool run_floor(struct maker *m, const struct floor_image *f, uint32_t tile_count,
                      double *seconds)
{
    VkQueue queue = m->bench->gpu.queue;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &f->commands};
    m->frame = 0;
    m->set_count = 0;
    VkDescriptorSet set = write_set(m, f->view);
    double start = clock_seconds();
    if (!gpu_check(vkBeginCommandBuffer(f->commands, &begin), "vkBeginCommandBuffer"))
        return false;
    for (uint32_t done = 0; done < tile_count; done += BATCH) {
        if (done % LAYERS == 0)
            order(f->commands, f->image, done == 0);
        dispatch(m, f->commands, set, done % LAYERS,
                 tile_count - done < BATCH ? tile_count - done : BATCH);
    }
    if (!gpu_check(vkEndCommandBuffer(f->commands), "vkEndCommandBuffer") ||
        !gpu_check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit") ||
        !gpu_check(vkQueueWaitIdle(queue), "vkQueueWaitIdle"))
        return false;
    *seconds = clock_seconds() - start;
    return true;
}

bool maker_floor(struct maker *m, uint32_t tile_count, double *rate)
{
    struct floor_image f = {0};
    struct BenchTile *tiles = m->tiles.mapped;
    for (uint32_t i = 0; i < LAYERS; i++)
        tiles[i] = (struct BenchTile){.x = i % 64 * TILE_SIZE,
                                      .y = i / 64 * TILE_SIZE,
                                      .width = TILE_SIZE,
                                      .height = TILE_SIZE,
                                      .layer = i};
    bool done = create_floor_image(&m->bench->gpu, &f);
    double best = INFINITY;
    for (uint32_t i = 0; done && i < 3; i++) {
        double seconds = INFINITY;
        done = run_floor(m, &f, tile_count, &seconds);
        best = seconds < best ? seconds : best;
    }
    destroy_floor_image(&m->bench->gpu, &f);
    *rate = tile_count / best;
    return done;
}
