#include "gpu.h"

/** Returns the first type with all flags of `wanted`, else the first with all of `needed`. */
static uint32_t find_memory_type(const struct gpu *gpu, uint32_t allowed,
                                 VkMemoryPropertyFlags needed, VkMemoryPropertyFlags wanted)
{
    uint32_t found = UINT32_MAX;
    for (uint32_t i = 0; i < gpu->memory.memoryTypeCount; i++) {
        VkMemoryPropertyFlags flags = gpu->memory.memoryTypes[i].propertyFlags;
        if (!(allowed & (1u << i)))
            continue;
        if ((flags & wanted) == wanted)
            return i;
        if (found == UINT32_MAX && (flags & needed) == needed)
            found = i;
    }
    return found;
}

static bool allocate(const struct gpu *gpu, const VkMemoryRequirements *requirements,
                     VkMemoryPropertyFlags needed, VkMemoryPropertyFlags wanted, const void *next,
                     VkDeviceMemory *memory)
{
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                 .pNext = next,
                                 .allocationSize = requirements->size,
                                 .memoryTypeIndex = find_memory_type(
                                     gpu, requirements->memoryTypeBits, needed, needed | wanted)};
    return gpu_check(vkAllocateMemory(gpu->device, &info, NULL, memory), "vkAllocateMemory");
}

static bool create_buffer(const struct gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                          VkMemoryPropertyFlags required, VkMemoryPropertyFlags wanted,
                          struct gpu_buffer *buffer)
{
    *buffer = (struct gpu_buffer){.size = size};
    const uint32_t families[2] = {gpu->family, gpu->build_family};
    VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    if (families[0] != families[1]) {
        info.sharingMode = VK_SHARING_MODE_CONCURRENT;
        info.queueFamilyIndexCount = 2;
        info.pQueueFamilyIndices = families;
    }
    if (!gpu_check(vkCreateBuffer(gpu->device, &info, NULL, &buffer->buffer), "vkCreateBuffer"))
        return false;
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(gpu->device, buffer->buffer, &requirements);
    const VkMemoryAllocateFlagsInfo addressed = {.sType =
                                                     VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                                 .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    const void *next = usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT ? &addressed : NULL;
    if (allocate(gpu, &requirements, required, wanted, next, &buffer->memory) &&
        gpu_check(vkBindBufferMemory(gpu->device, buffer->buffer, buffer->memory, 0),
                  "vkBindBufferMemory") &&
        (!(required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) ||
         gpu_check(vkMapMemory(gpu->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->mapped),
                   "vkMapMemory")))
        return true;
    gpu_destroy_buffer(gpu, buffer);
    return false;
}

bool gpu_create_buffer(const struct gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                       struct gpu_buffer *buffer)
{
    const VkMemoryPropertyFlags host =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    /* Prefer cached memory for buffers that the host reads, and device-local memory for buffers
     * that shaders use. */
    VkMemoryPropertyFlags wanted = 0;
    if (usage == VK_BUFFER_USAGE_TRANSFER_DST_BIT)
        wanted = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    else if (usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)
        wanted = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    return create_buffer(gpu, size, usage, host, wanted, buffer);
}

bool gpu_create_device_buffer(const struct gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                              struct gpu_buffer *buffer)
{
    return create_buffer(gpu, size, usage, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, buffer);
}

void gpu_destroy_buffer(const struct gpu *gpu, struct gpu_buffer *buffer)
{
    vkDestroyBuffer(gpu->device, buffer->buffer, NULL);
    vkFreeMemory(gpu->device, buffer->memory, NULL);
    *buffer = (struct gpu_buffer){0};
}

static bool create_view(const struct gpu *gpu, VkFormat format, uint32_t levels,
                        VkImageAspectFlags aspect, struct gpu_image *image)
{
    VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = image->image,
                                  .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                  .format = format,
                                  .subresourceRange = {aspect, 0, levels, 0, 1}};
    return gpu_check(vkCreateImageView(gpu->device, &info, NULL, &image->view),
                     "vkCreateImageView");
}

static bool create_image(const struct gpu *gpu, const VkImageCreateInfo *info,
                         VkImageAspectFlags aspect, struct gpu_image *image)
{
    *image = (struct gpu_image){0};
    if (!gpu_check(vkCreateImage(gpu->device, info, NULL, &image->image), "vkCreateImage"))
        return false;

    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(gpu->device, image->image, &requirements);
    if (allocate(gpu, &requirements, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, NULL,
                 &image->memory) &&
        gpu_check(vkBindImageMemory(gpu->device, image->image, image->memory, 0),
                  "vkBindImageMemory") &&
        create_view(gpu, info->format, info->mipLevels, aspect, image))
        return true;
    gpu_destroy_image(gpu, image);
    return false;
}

bool gpu_create_image(const struct gpu *gpu, VkFormat format, uint32_t width, uint32_t height,
                      VkSampleCountFlagBits samples, VkImageUsageFlags usage,
                      VkImageAspectFlags aspect, struct gpu_image *image)
{
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = format,
                              .extent = {width, height, 1},
                              .mipLevels = 1,
                              .arrayLayers = 1,
                              .samples = samples,
                              .tiling = VK_IMAGE_TILING_OPTIMAL,
                              .usage = usage};
    return create_image(gpu, &info, aspect, image);
}

bool gpu_create_viewed_image(const struct gpu *gpu, const VkFormat formats[2], uint32_t width,
                             uint32_t height, VkImageUsageFlags usage, struct gpu_image *image)
{
    const VkImageFormatListCreateInfo list = {.sType =
                                                  VK_STRUCTURE_TYPE_IMAGE_FORMAT_LIST_CREATE_INFO,
                                              .viewFormatCount = 2,
                                              .pViewFormats = formats};
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .pNext = &list,
                              .flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = formats[0],
                              .extent = {width, height, 1},
                              .mipLevels = 1,
                              .arrayLayers = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .tiling = VK_IMAGE_TILING_OPTIMAL,
                              .usage = usage};
    return create_image(gpu, &info, VK_IMAGE_ASPECT_COLOR_BIT, image);
}

bool gpu_create_texture(const struct gpu *gpu, VkFormat format, uint32_t width, uint32_t height,
                        uint32_t levels, struct gpu_image *image)
{
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = format,
                              .extent = {width, height, 1},
                              .mipLevels = levels,
                              .arrayLayers = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .tiling = VK_IMAGE_TILING_OPTIMAL,
                              .usage =
                                  VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    return create_image(gpu, &info, VK_IMAGE_ASPECT_COLOR_BIT, image);
}

void gpu_destroy_image(const struct gpu *gpu, struct gpu_image *image)
{
    vkDestroyImageView(gpu->device, image->view, NULL);
    vkDestroyImage(gpu->device, image->image, NULL);
    vkFreeMemory(gpu->device, image->memory, NULL);
    *image = (struct gpu_image){0};
}
