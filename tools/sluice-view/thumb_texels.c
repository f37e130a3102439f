#include "thumb_texels.h"

#include "../../samples/common/one_time.h"

#include <stdlib.h>
#include <string.h>

#define SAME(name) [SLUICE_FORMAT_##name] = VK_FORMAT_##name

static const VkFormat formats[SLUICE_FORMAT_COUNT] = {
    SAME(R8_UNORM),
    SAME(R8G8_UNORM),
    SAME(R8G8B8A8_UNORM),
    SAME(R8G8B8A8_SRGB),
    SAME(R16_SFLOAT),
    SAME(R16G16_SFLOAT),
    SAME(R16G16B16A16_SFLOAT),
    SAME(R32_SFLOAT),
    SAME(R32G32_SFLOAT),
    SAME(R32G32B32A32_SFLOAT),
    SAME(A2B10G10R10_UNORM_PACK32),
    SAME(B10G11R11_UFLOAT_PACK32),
    SAME(E5B9G9R9_UFLOAT_PACK32),
    SAME(BC1_RGB_UNORM_BLOCK),
    SAME(BC1_RGB_SRGB_BLOCK),
    SAME(BC1_RGBA_UNORM_BLOCK),
    SAME(BC1_RGBA_SRGB_BLOCK),
    SAME(BC2_UNORM_BLOCK),
    SAME(BC2_SRGB_BLOCK),
    SAME(BC3_UNORM_BLOCK),
    SAME(BC3_SRGB_BLOCK),
    SAME(BC4_UNORM_BLOCK),
    SAME(BC4_SNORM_BLOCK),
    SAME(BC5_UNORM_BLOCK),
    SAME(BC5_SNORM_BLOCK),
    SAME(BC6H_UFLOAT_BLOCK),
    SAME(BC6H_SFLOAT_BLOCK),
    SAME(BC7_UNORM_BLOCK),
    SAME(BC7_SRGB_BLOCK),
    SAME(R16_UNORM),
    SAME(R16G16_UNORM),
    SAME(R16G16B16A16_UNORM),
    SAME(R8_SNORM),
    SAME(R8G8_SNORM),
    SAME(R8G8B8A8_SNORM),
    SAME(R16_SNORM),
    SAME(R16G16_SNORM),
    SAME(R16G16B16A16_SNORM),
};

static bool is_float(SluiceFormat format)
{
    return (format >= SLUICE_FORMAT_R16_SFLOAT && format <= SLUICE_FORMAT_R32G32B32A32_SFLOAT) ||
           format == SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32 ||
           format == SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32 ||
           format == SLUICE_FORMAT_BC6H_UFLOAT_BLOCK || format == SLUICE_FORMAT_BC6H_SFLOAT_BLOCK;
}

static bool is_srgb(SluiceFormat format)
{
    return format == SLUICE_FORMAT_R8G8B8A8_SRGB || format == SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK ||
           format == SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK || format == SLUICE_FORMAT_BC2_SRGB_BLOCK ||
           format == SLUICE_FORMAT_BC3_SRGB_BLOCK || format == SLUICE_FORMAT_BC7_SRGB_BLOCK;
}

static VkFormatFeatureFlags features_of(const struct gpu *gpu, SluiceFormat format)
{
    VkFormatProperties properties = {0};
    if ((uint32_t)format < SLUICE_FORMAT_COUNT && formats[format])
        vkGetPhysicalDeviceFormatProperties(gpu->physical_device, formats[format], &properties);
    return properties.optimalTilingFeatures;
}

bool thumb_texels_fit(const struct gpu *gpu, SluiceFormat format)
{
    const VkFormatFeatureFlags needed = VK_FORMAT_FEATURE_BLIT_SRC_BIT |
                                        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
                                        VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    return (features_of(gpu, format) & needed) == needed;
}

struct conversion {
    struct gpu_image from, to;
    struct gpu_buffer upload, download;
    uint32_t width, height; ///< size of the texels
    uint32_t columns, rows; ///< size of the part of the cell that they fill
    VkFilter filter;
};

static void record_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from,
                          VkImageLayout to)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = from == VK_IMAGE_LAYOUT_UNDEFINED ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = to == VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL ? VK_ACCESS_TRANSFER_WRITE_BIT
                                                                    : VK_ACCESS_TRANSFER_READ_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         0, 0, NULL, 0, NULL, 1, &barrier);
}

static void record(void *user_data, VkCommandBuffer commands)
{
    const struct conversion *c = user_data;
    const VkImageLayout read = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const VkImageLayout write = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    const VkImageSubresourceLayers layers = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkBufferImageCopy up = {.imageSubresource = layers,
                                  .imageExtent = {c->width, c->height, 1}};
    const VkImageBlit blit = {.srcSubresource = layers,
                              .srcOffsets = {{0}, {(int32_t)c->width, (int32_t)c->height, 1}},
                              .dstSubresource = layers,
                              .dstOffsets = {{0}, {(int32_t)c->columns, (int32_t)c->rows, 1}}};
    const VkBufferImageCopy down = {.imageSubresource = layers,
                                    .imageExtent = {c->columns, c->rows, 1}};
    const VkMemoryBarrier host = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                  .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                  .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    record_layout(commands, c->from.image, VK_IMAGE_LAYOUT_UNDEFINED, write);
    vkCmdCopyBufferToImage(commands, c->upload.buffer, c->from.image, write, 1, &up);
    record_layout(commands, c->from.image, write, read);
    record_layout(commands, c->to.image, VK_IMAGE_LAYOUT_UNDEFINED, write);
    vkCmdBlitImage(commands, c->from.image, read, c->to.image, write, 1, &blit, c->filter);
    record_layout(commands, c->to.image, write, read);
    vkCmdCopyImageToBuffer(commands, c->to.image, read, c->download.buffer, 1, &down);
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &host, 0, NULL, 0, NULL);
}

static bool create(const struct gpu *gpu, const struct thumb_texels *t, struct conversion *c)
{
    const VkFormat to = is_srgb(t->format) || is_float(t->format) ? VK_FORMAT_R8G8B8A8_SRGB
                                                                  : VK_FORMAT_R8G8B8A8_UNORM;
    const uint32_t longer = t->width > t->height ? t->width : t->height;
    const uint64_t size = sluiceGetFormatRegionSize(t->format, t->width, t->height);
    c->width = t->width;
    c->height = t->height;
    c->columns = t->width * THUMBS_CELL / longer;
    c->rows = t->height * THUMBS_CELL / longer;
    c->columns += c->columns == 0;
    c->rows += c->rows == 0;
    c->filter = features_of(gpu, t->format) & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT
                    ? VK_FILTER_LINEAR
                    : VK_FILTER_NEAREST;
    if (!gpu_create_image(gpu, formats[t->format], t->width, t->height, VK_SAMPLE_COUNT_1_BIT,
                          VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                              VK_IMAGE_USAGE_SAMPLED_BIT,
                          VK_IMAGE_ASPECT_COLOR_BIT, &c->from) ||
        !gpu_create_image(gpu, to, THUMBS_CELL, THUMBS_CELL, VK_SAMPLE_COUNT_1_BIT,
                          VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                              VK_IMAGE_USAGE_SAMPLED_BIT,
                          VK_IMAGE_ASPECT_COLOR_BIT, &c->to) ||
        !gpu_create_buffer(gpu, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, &c->upload) ||
        !gpu_create_buffer(gpu, THUMBS_CELL * THUMBS_CELL * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           &c->download))
        return false;
    memcpy(c->upload.mapped, t->bytes, size);
    return true;
}

static void read_back(const struct conversion *c, SluiceFormat format,
                      uint8_t cell[THUMBS_CELL][THUMBS_CELL][4])
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    const bool gray =
        sluiceGetFormatInfo(format, &info) == SLUICE_SUCCESS && info.channelCount == 1;
    memset(cell, 0, THUMBS_CELL * sizeof *cell);
    for (uint32_t y = 0; y < c->rows; y++)
        for (uint32_t x = 0; x < c->columns; x++) {
            const uint8_t *from = (const uint8_t *)c->download.mapped + (y * c->columns + x) * 4;
            for (uint32_t i = 0; i < 3; i++)
                cell[y][x][i] = from[gray ? 0 : i];
            cell[y][x][3] = 255;
        }
}

bool thumb_texels_convert(const struct gpu *gpu, const struct thumb_texels *t,
                          uint8_t cell[THUMBS_CELL][THUMBS_CELL][4])
{
    struct conversion c = {0};
    const bool done = create(gpu, t, &c) && one_time_run(gpu, record, &c);
    if (done)
        read_back(&c, t->format, cell);
    gpu_destroy_image(gpu, &c.from);
    gpu_destroy_image(gpu, &c.to);
    gpu_destroy_buffer(gpu, &c.upload);
    gpu_destroy_buffer(gpu, &c.download);
    return done;
}

void thumb_texels_finish(struct thumb_texels *t)
{
    free(t->bytes);
    *t = (struct thumb_texels){0};
}
