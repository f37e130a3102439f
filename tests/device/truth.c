#include "device/truth.h"

#include "support/test.h"

#include "truth_comp.h"
#include "truth_frag.h"

#include <string.h>

#define BUFFERS 2u
#define TEXEL_SIZE 8u      /* four half floats */
#define LARGE_HALF 0x7bffu /* the largest: no weight makes 0 of it */

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static void create_image(struct truth *t, const struct SluiceTextureEntry *entry)
{
    struct harness *h = t->h;
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                              .extent = {entry->width, entry->height, 1},
                              .mipLevels = entry->mipLevelCount,
                              .arrayLayers = t->layer_count,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .usage =
                                  VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    assert_int_equal(h->CreateImage(h->device, &info, NULL, &t->image), VK_SUCCESS);
    VkMemoryRequirements memory;
    h->GetImageMemoryRequirements(h->device, t->image, &memory);
    VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .allocationSize = memory.size};
    for (uint32_t i = h->memory.memoryTypeCount; i-- > 0;)
        if (memory.memoryTypeBits >> i & 1 &&
            h->memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
            allocate.memoryTypeIndex = i;
    assert_int_equal(h->AllocateMemory(h->device, &allocate, NULL, &t->memory), VK_SUCCESS);
    assert_int_equal(h->BindImageMemory(h->device, t->image, t->memory, 0), VK_SUCCESS);
    VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = t->image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
        .format = info.format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, info.mipLevels, 0, t->layer_count}};
    assert_int_equal(h->CreateImageView(h->device, &view, NULL, &t->view), VK_SUCCESS);
}

/* Texels of a level in all layers: in the tile with number n, channel n % 4 of layer n / 4. */
static void fill_level(uint16_t *texels, const struct oracle_tiles *tiles, uint32_t level,
                       uint32_t layer_count)
{
    const struct SluiceTextureEntry *e = &tiles->entry;
    uint32_t width = level_size(e->width, level), height = level_size(e->height, level);
    memset(texels, 0, (size_t)width * height * layer_count * TEXEL_SIZE);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint32_t number = tiles->first[level] + y / e->regionHeight * tiles->width[level] +
                              x / e->regionWidth;
            size_t at = ((size_t)(number / 4) * height + y) * width + x;
            texels[at * 4 + number % 4] = LARGE_HALF;
        }
}

struct upload {
    struct truth *t;
    const struct SluiceTextureEntry *entry;
    struct harness_buffer staging;
    VkBufferImageCopy copies[ORACLE_LEVELS];
    PFN_vkCmdCopyBufferToImage copy;
};

static void move_image(struct upload *u, VkCommandBuffer commands, VkImageLayout from,
                       VkImageLayout to)
{
    bool before = from == VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = before ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = before ? VK_ACCESS_TRANSFER_WRITE_BIT : VK_ACCESS_SHADER_READ_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = u->t->image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                             VK_REMAINING_ARRAY_LAYERS}};
    u->t->h->CmdPipelineBarrier(
        commands, before ? VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT : VK_PIPELINE_STAGE_TRANSFER_BIT,
        before ? VK_PIPELINE_STAGE_TRANSFER_BIT : VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0,
        NULL, 1, &barrier);
}

static void record_upload(void *user, VkCommandBuffer commands)
{
    struct upload *u = user;
    move_image(u, commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    u->copy(commands, u->staging.buffer, u->t->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            u->entry->mipLevelCount, u->copies);
    move_image(u, commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

static void upload(struct truth *t, const struct oracle_tiles *tiles)
{
    struct harness *h = t->h;
    struct upload u = {.t = t, .entry = &tiles->entry};
    u.copy = (PFN_vkCmdCopyBufferToImage)h->GetDeviceProcAddr(h->device, "vkCmdCopyBufferToImage");
    uint64_t size = 0;
    for (uint32_t l = 0; l < u.entry->mipLevelCount; l++) {
        uint32_t w = level_size(u.entry->width, l), n = level_size(u.entry->height, l);
        u.copies[l] = (VkBufferImageCopy){
            .bufferOffset = size,
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, l, 0, t->layer_count},
            .imageExtent = {w, n, 1}};
        size += (uint64_t)w * n * t->layer_count * TEXEL_SIZE;
    }
    harness_buffer_init(h, &u.staging, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    for (uint32_t l = 0; l < u.entry->mipLevelCount; l++)
        fill_level((uint16_t *)((uint8_t *)u.staging.mapped + u.copies[l].bufferOffset), tiles, l,
                   t->layer_count);
    harness_run(h, record_upload, &u);
    harness_buffer_finish(h, &u.staging);
}

void truth_init(struct truth *t, struct harness *h, const struct SluiceTextureEntry *entry)
{
    static struct oracle_tiles tiles;
    oracle_tiles_init(&tiles, entry);
    *t = (struct truth){.h = h, .layer_count = (tiles.count + 3) / 4};
    assert_true(tiles.count <= TRUTH_WORDS * 32);
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    harness_buffer_init(h, &t->inputs, CONFORM_CAPACITY * sizeof(struct ConformInput), usage);
    harness_buffer_init(h, &t->touched, CONFORM_CAPACITY * TRUTH_WORDS * sizeof(uint32_t), usage);
    conform_create_set(h, BUFFERS, 1, sizeof(struct TruthParams), &t->set);
    conform_write_buffers(h, &t->set, BUFFERS,
                          (const struct harness_buffer *const[]){&t->inputs, &t->touched});
    conform_create_target(h, &t->pass, &t->framebuffer);
    t->pipelines[CONFORM_STAGE_COMPUTE] = conform_compute_pipeline(
        h, t->set.layout, conform_module(h, truth_comp, sizeof truth_comp), NULL);
    t->pipelines[CONFORM_STAGE_FRAGMENT] =
        conform_graphics_pipeline(h, t->set.layout, t->pass, conform_vertex_module(h),
                                  conform_module(h, truth_frag, sizeof truth_frag), 0);
    create_image(t, entry);
    upload(t, &tiles);
}

void truth_finish(struct truth *t)
{
    struct harness *h = t->h;
    for (uint32_t i = 0; i < CONFORM_STAGE_COUNT; i++)
        h->DestroyPipeline(h->device, t->pipelines[i], NULL);
    h->DestroySampler(h->device, t->sampler, NULL);
    h->DestroyImageView(h->device, t->view, NULL);
    h->DestroyImage(h->device, t->image, NULL);
    h->FreeMemory(h->device, t->memory, NULL);
    h->DestroyFramebuffer(h->device, t->framebuffer, NULL);
    h->DestroyRenderPass(h->device, t->pass, NULL);
    conform_destroy_set(h, &t->set);
    harness_buffer_finish(h, &t->inputs);
    harness_buffer_finish(h, &t->touched);
}

void truth_set_sampler(struct truth *t, const struct SluiceTextureEntry *entry, bool nearest,
                       bool nearest_mip, float anisotropy)
{
    struct harness *h = t->h;
    h->DestroySampler(h->device, t->sampler, NULL);
    VkFilter filter = nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = filter,
                                .minFilter = filter,
                                .mipmapMode = nearest_mip ? VK_SAMPLER_MIPMAP_MODE_NEAREST
                                                          : VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                .addressModeU = (VkSamplerAddressMode)entry->addressModeU,
                                .addressModeV = (VkSamplerAddressMode)entry->addressModeV,
                                .anisotropyEnable = anisotropy > 1,
                                .maxAnisotropy = anisotropy,
                                .maxLod = VK_LOD_CLAMP_NONE};
    assert_int_equal(h->CreateSampler(h->device, &info, NULL, &t->sampler), VK_SUCCESS);
    VkDescriptorImageInfo image = {t->sampler, t->view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = t->set.set,
                                  .dstBinding = BUFFERS,
                                  .descriptorCount = 1,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                  .pImageInfo = &image};
    h->UpdateDescriptorSets(h->device, 1, &write, 0, NULL);
}

void truth_run(struct truth *t, enum conform_stage stage, const struct conform_sample *samples,
               uint32_t count)
{
    assert_true(count <= CONFORM_CAPACITY);
    for (uint32_t i = 0; i < count; i++)
        ((struct ConformInput *)t->inputs.mapped)[i] = samples[i].in;
    struct TruthParams params = {count, t->layer_count};
    struct conform_job job = {.set = &t->set,
                              .stage = stage,
                              .pipeline = t->pipelines[stage],
                              .pass = t->pass,
                              .framebuffer = t->framebuffer,
                              .count = count,
                              .push = &params,
                              .push_size = sizeof params};
    conform_run_job(t->h, &job);
}

void truth_add(const struct truth *t, uint32_t at, struct oracle_tiles *tiles)
{
    const uint32_t *words = (const uint32_t *)t->touched.mapped + at * TRUTH_WORDS;
    for (uint32_t i = 0; i < tiles->count; i++)
        tiles->has[i] |= words[i / 32] >> i % 32 & 1;
}
