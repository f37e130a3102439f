#include "traced_show.h"

#include "../../samples/common/one_time.h"

#include "traced_show_comp.h"

#include <string.h>

#define GROUP 8u
#define BINDINGS 7u
#define IMAGE_BINDING 2u
#define LEAST_TILES 64u
#define LEAST_PICTURES 256u
/* Same values as in shaders/view_colors.glsl. */
#define MARK_THRASHES 16u
#define MARK_OLDEST 0xFFFFu

struct push {
    uint32_t width, height;
    float scale, tint;
    uint32_t view, launch, tile_mask, picture_count, is_short;
};

static VkDescriptorType type_of(uint32_t binding)
{
    return binding == IMAGE_BINDING ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                    : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

static bool create_layouts(struct traced_show *s)
{
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){.binding = i,
                                                     .descriptorType = type_of(i),
                                                     .descriptorCount = 1,
                                                     .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    const VkDescriptorSetLayoutCreateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = BINDINGS,
        .pBindings = bindings};
    if (!gpu_check(vkCreateDescriptorSetLayout(s->gpu->device, &set, NULL, &s->set_layout),
                   "vkCreateDescriptorSetLayout"))
        return false;
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct push)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &s->set_layout,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &push};
    return gpu_check(vkCreatePipelineLayout(s->gpu->device, &layout, NULL, &s->layout),
                     "vkCreatePipelineLayout");
}

static bool create_set(struct traced_show *s)
{
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BINDINGS - 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    if (!gpu_check(vkCreateDescriptorPool(s->gpu->device, &pool, NULL, &s->pool),
                   "vkCreateDescriptorPool"))
        return false;
    const VkDescriptorSetAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = s->pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &s->set_layout};
    return gpu_check(vkAllocateDescriptorSets(s->gpu->device, &info, &s->set),
                     "vkAllocateDescriptorSets");
}

/* Grows the hash map, and empties it, so that a search ends. */
static bool grow_tiles(struct traced_show *s, uint32_t count)
{
    if (count <= s->tile_room)
        return true;
    gpu_destroy_buffer(s->gpu, &s->tiles);
    s->tiles = (struct gpu_buffer){0};
    s->tile_room = 0;
    if (!gpu_create_buffer(s->gpu, count * sizeof(uint32_t[2]), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                           &s->tiles))
        return false;
    memset(s->tiles.mapped, 0xff, count * sizeof(uint32_t[2]));
    s->tile_room = count;
    s->tile_mask = count - 1;
    return true;
}

uint32_t *traced_show_pictures(struct traced_show *s, uint32_t count)
{
    size_t size = s->pictures.size;
    if (count * sizeof(uint32_t) <= size)
        return s->pictures.mapped;
    for (size = size ? size : LEAST_PICTURES * sizeof(uint32_t); size < count * sizeof(uint32_t);)
        size *= 2;
    gpu_destroy_buffer(s->gpu, &s->pictures);
    s->pictures = (struct gpu_buffer){0};
    if (!gpu_create_buffer(s->gpu, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &s->pictures))
        return NULL;
    memset(s->pictures.mapped, 0, size);
    return s->pictures.mapped;
}

bool traced_show_create(const struct gpu *gpu, struct traced_show *s)
{
    *s = (struct traced_show){.gpu = gpu};
    return create_layouts(s) && create_set(s) && grow_tiles(s, LEAST_TILES) &&
           traced_show_pictures(s, 1) &&
           gpu_create_compute_pipeline(gpu, s->layout, traced_show_comp, sizeof traced_show_comp,
                                       NULL, &s->pipeline);
}

void traced_show_destroy(struct traced_show *s)
{
    if (!s->gpu)
        return;
    gpu_destroy_image(s->gpu, &s->image);
    gpu_destroy_buffer(s->gpu, &s->tiles);
    gpu_destroy_buffer(s->gpu, &s->pictures);
    vkDestroyPipeline(s->gpu->device, s->pipeline, NULL);
    vkDestroyDescriptorPool(s->gpu->device, s->pool, NULL);
    vkDestroyPipelineLayout(s->gpu->device, s->layout, NULL);
    vkDestroyDescriptorSetLayout(s->gpu->device, s->set_layout, NULL);
    *s = (struct traced_show){0};
}

static void write_set(const struct traced_show *s)
{
    const VkBuffer buffers[BINDINGS] = {s->sums,  s->latest,       VK_NULL_HANDLE,    s->probes,
                                        s->views, s->tiles.buffer, s->pictures.buffer};
    VkDescriptorBufferInfo infos[BINDINGS];
    VkWriteDescriptorSet writes[BINDINGS];
    const VkDescriptorImageInfo image = {.imageView = s->image.view,
                                         .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    for (uint32_t i = 0; i < BINDINGS; i++) {
        infos[i] = (VkDescriptorBufferInfo){buffers[i], 0, VK_WHOLE_SIZE};
        writes[i] = (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                           .dstSet = s->set,
                                           .dstBinding = i,
                                           .descriptorCount = 1,
                                           .descriptorType = type_of(i),
                                           .pBufferInfo = &infos[i],
                                           .pImageInfo = &image};
    }
    vkUpdateDescriptorSets(s->gpu->device, BINDINGS, writes, 0, NULL);
}

bool traced_show_fit(struct traced_show *s, const struct film *film, const struct traced_view *view)
{
    gpu_destroy_image(s->gpu, &s->image);
    s->image = (struct gpu_image){0};
    s->drawn = false;
    s->width = film->width;
    s->height = film->height;
    if (!gpu_create_image(s->gpu, VK_FORMAT_R8G8B8A8_UNORM, s->width, s->height,
                          VK_SAMPLE_COUNT_1_BIT,
                          VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                              VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                          VK_IMAGE_ASPECT_COLOR_BIT, &s->image))
        return false;
    s->sums = film->sums.buffer;
    s->latest = film->latest.buffer;
    s->probes = view->probes.buffer;
    s->views = view->views.buffer;
    return true;
}

/* Returns the word of a tile: MARK_THRASHES and age, in the layout of view_colors.glsl. */
static uint32_t word_of(const struct traced_tile *tile, uint64_t now)
{
    const uint64_t age = (now - tile->loaded[0]) / 62500u; /* 1/16 s */
    return (age < MARK_OLDEST ? (uint32_t)age : MARK_OLDEST) << 16 |
           (traced_tile_thrashes(tile, now) ? MARK_THRASHES : 0u);
}

bool traced_show_keep_tiles(struct traced_show *s, const struct traced_tiles *tiles, uint64_t now)
{
    if (tiles->capacity == 0)
        return true;
    if (!grow_tiles(s, tiles->capacity))
        return false;
    uint32_t(*words)[2] = s->tiles.mapped;
    for (uint32_t i = 0; i < tiles->capacity; i++) {
        const struct traced_tile *tile = &tiles->entries[i];
        words[i][0] = tile->slot.page;
        words[i][1] = tile->slot.page == UINT32_MAX ? 0 : word_of(tile, now);
    }
    s->tile_mask = tiles->capacity - 1;
    return true;
}

static void move_image(const struct traced_show *s, VkCommandBuffer commands, bool to_shader)
{
    const VkImageLayout before =
        s->drawn ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED;
    const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    const VkPipelineStageFlags fragment = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = to_shader ? VK_ACCESS_SHADER_WRITE_BIT : 0,
        .dstAccessMask = to_shader ? VK_ACCESS_SHADER_READ_BIT : VK_ACCESS_SHADER_WRITE_BIT,
        .oldLayout = to_shader ? VK_IMAGE_LAYOUT_GENERAL : before,
        .newLayout = to_shader ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_GENERAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = s->image.image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands, to_shader ? compute : fragment, to_shader ? fragment : compute,
                         0, 0, NULL, 0, NULL, 1, &barrier);
}

static void record(void *user_data, VkCommandBuffer commands)
{
    struct traced_show *s = user_data;
    const struct traced_look *look = &s->look;
    const struct push push = {s->width,     s->height,           look->scale,
                              look->tint,   look->view,          look->launch,
                              s->tile_mask, look->picture_count, look->is_short};
    move_image(s, commands, false);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, s->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, s->layout, 0, 1, &s->set, 0,
                            NULL);
    vkCmdPushConstants(commands, s->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
    vkCmdDispatch(commands, (s->width + GROUP - 1) / GROUP, (s->height + GROUP - 1) / GROUP, 1);
    move_image(s, commands, true);
}

bool traced_show_draw(struct traced_show *s, const struct traced_look *look)
{
    s->look = *look;
    write_set(s); /* not in use: each picture is waited for */
    if (!one_time_run(s->gpu, record, s))
        return false;
    s->drawn = true;
    return true;
}

/* Records a copy. Afterwards the user interface samples the picture. */
void traced_show_copy(const struct traced_show *s, VkCommandBuffer commands, VkBuffer buffer)
{
    VkImageMemoryBarrier image = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                  .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT,
                                  .oldLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                  .newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                  .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                  .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                  .image = s->image.image,
                                  .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    const VkBufferImageCopy region = {
        .imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1},
        .imageExtent = {s->width, s->height, 1}};
    const VkBufferMemoryBarrier to_host = {.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
                                           .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                           .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
                                           .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .buffer = buffer,
                                           .size = VK_WHOLE_SIZE};
    const VkPipelineStageFlags transfer = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkPipelineStageFlags fragment = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    vkCmdPipelineBarrier(commands, fragment, transfer, 0, 0, NULL, 0, NULL, 1, &image);
    vkCmdCopyImageToBuffer(commands, s->image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer,
                           1, &region);
    image.srcAccessMask = 0;
    image.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    image.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    image.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    vkCmdPipelineBarrier(commands, transfer, fragment, 0, 0, NULL, 0, NULL, 1, &image);
    vkCmdPipelineBarrier(commands, transfer, VK_PIPELINE_STAGE_HOST_BIT, 0, 0, NULL, 1, &to_host, 0,
                         NULL);
}
