#include "device/demand_images.h"

#include "base/checked.h"
#include "demand/tail_place.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define TEXEL_SIZE 4u
#define LAYERS (DEMAND_CHUNKS * DEMAND_LAYERS)

static uint32_t tile_texels(const struct demand_scene *s)
{
    return 1u << (s->tile_shift[0] + s->tile_shift[1]);
}

static void create_image(struct demand_scene *s, const VkImageCreateInfo *info, VkImage *image,
                         VkDeviceMemory *memory, VkImageView *view, bool array)
{
    struct harness *h = s->h;
    assert_int_equal(h->CreateImage(h->device, info, NULL, image), VK_SUCCESS);
    VkMemoryRequirements needs;
    h->GetImageMemoryRequirements(h->device, *image, &needs);
    VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .allocationSize = needs.size};
    for (uint32_t i = h->memory.memoryTypeCount; i-- > 0;)
        if (needs.memoryTypeBits >> i & 1 &&
            h->memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
            allocate.memoryTypeIndex = i;
    assert_int_equal(h->AllocateMemory(h->device, &allocate, NULL, memory), VK_SUCCESS);
    assert_int_equal(h->BindImageMemory(h->device, *image, *memory, 0), VK_SUCCESS);
    VkImageViewCreateInfo view_info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = *image,
        .viewType = array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
        .format = info->format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, info->mipLevels, 0, info->arrayLayers}};
    assert_int_equal(h->CreateImageView(h->device, &view_info, NULL, view), VK_SUCCESS);
}

static VkImageCreateInfo image_info(const struct demand_scene *s, uint32_t width, uint32_t height,
                                    uint32_t levels, uint32_t layers)
{
    return (VkImageCreateInfo){.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = s->format,
                               .extent = {width, height, 1},
                               .mipLevels = levels,
                               .arrayLayers = layers,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .usage =
                                   VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
}

static VkSampler create_sampler(struct demand_scene *s, uint32_t mode_u, uint32_t mode_v,
                                bool mipmaps)
{
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = VK_FILTER_LINEAR,
                                .minFilter = VK_FILTER_LINEAR,
                                .mipmapMode = mipmaps ? VK_SAMPLER_MIPMAP_MODE_LINEAR
                                                      : VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                .addressModeU = (VkSamplerAddressMode)mode_u,
                                .addressModeV = (VkSamplerAddressMode)mode_v,
                                .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE,
                                .maxLod = mipmaps ? VK_LOD_CLAMP_NONE : 0.0f};
    VkSampler sampler;
    assert_int_equal(s->h->CreateSampler(s->h->device, &info, NULL, &sampler), VK_SUCCESS);
    return sampler;
}

static void write_views(struct demand_scene *s, uint32_t binding, uint32_t count,
                        const VkImageView *views, VkSampler sampler)
{
    VkDescriptorImageInfo infos[DEMAND_CHUNKS];
    for (uint32_t i = 0; i < count; i++)
        infos[i] = (VkDescriptorImageInfo){sampler, views[i], VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = s->set,
                                  .dstBinding = binding,
                                  .descriptorCount = count,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                  .pImageInfo = infos};
    s->h->UpdateDescriptorSets(s->h->device, 1, &write, 0, NULL);
}

void demand_images_init(struct demand_scene *s)
{
    VkImageCreateInfo info =
        image_info(s, 1u << s->tile_shift[0], 1u << s->tile_shift[1], 1, DEMAND_LAYERS);
    for (uint32_t i = 0; i < DEMAND_CHUNKS; i++)
        create_image(s, &info, &s->images[i], &s->memories[i], &s->views[i], true);
    s->sampler = create_sampler(s, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false);
    write_views(s, 9, DEMAND_CHUNKS, s->views, s->sampler);
    harness_buffer_init(s->h, &s->staging, (uint64_t)LAYERS * tile_texels(s) * TEXEL_SIZE,
                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const struct demand_texture one = {.width = 1, .height = 1};
    demand_scene_clear(s);
    demand_images_plain(s, demand_scene_add(s, &one));
}

void demand_images_finish(struct demand_scene *s)
{
    struct harness *h = s->h;
    demand_images_plain_finish(s);
    harness_buffer_finish(h, &s->staging);
    h->DestroySampler(h->device, s->sampler, NULL);
    for (uint32_t i = 0; i < DEMAND_CHUNKS; i++) {
        h->DestroyImageView(h->device, s->views[i], NULL);
        h->DestroyImage(h->device, s->images[i], NULL);
        h->FreeMemory(h->device, s->memories[i], NULL);
    }
}

/* NaN, or magenta; and layers are handed out in no order. */
void demand_images_clear(struct demand_scene *s)
{
    const uint32_t poison = s->format == VK_FORMAT_R32_SFLOAT ? 0x7fc00000u : 0xffff00ffu;
    uint32_t *texels = s->staging.mapped;
    for (uint32_t i = 0; i < LAYERS * tile_texels(s); i++)
        texels[i] = poison;
    for (uint32_t i = 0; i < LAYERS; i++) {
        uint32_t j = (uint32_t)roll() % (i + 1);
        s->layers[i] = s->layers[j];
        s->layers[j] = i;
    }
}

static uint32_t hash(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

static uint32_t packed_texel(uint32_t index, uint32_t level, uint32_t x, uint32_t y)
{
    return hash(hash(hash(x) + y) + level * 64 + index);
}

void demand_texel(const struct demand_scene *s, uint32_t index, uint32_t level, uint32_t x,
                  uint32_t y, float rgba[4])
{
    uint32_t word = packed_texel(index, level, x, y);
    for (uint32_t i = 0; i < 4; i++)
        rgba[i] = (float)(word >> 8 * i & 255) / 255.0f;
    if (s->format == VK_FORMAT_R32_SFLOAT)
        rgba[1] = rgba[2] = 0, rgba[3] = 1;
}

static uint32_t texel_bits(const struct demand_scene *s, uint32_t index, uint32_t level, uint32_t x,
                           uint32_t y)
{
    if (s->format != VK_FORMAT_R32_SFLOAT)
        return packed_texel(index, level, x, y);
    float rgba[4];
    uint32_t word;
    demand_texel(s, index, level, x, y, rgba);
    memcpy(&word, rgba, sizeof word);
    return word;
}

static uint32_t word_of(const struct demand_scene *s, uint32_t page)
{
    uint32_t block = ((const uint32_t *)s->directory.mapped)[page / SLUICE_DEMAND_BLOCK_PAGES];
    return ((const uint32_t *)s->blocks
                .mapped)[block * SLUICE_DEMAND_BLOCK_WORDS + page % SLUICE_DEMAND_BLOCK_PAGES];
}

/* Slot bits of the tail of a texture: another slot for each texture. */
static uint32_t choose_slot(const struct demand_scene *s, const struct SluiceDemandTexture *e,
                            uint32_t index, uint32_t regular, uint32_t levels)
{
    struct slc_tail_cut cut = slc_tail_cut(
        1u << s->tile_shift[0], 1u << s->tile_shift[1], (e->shape & SLUICE_DEMAND_BLOCKS) != 0,
        slc_mip_size(e->width, regular), slc_mip_size(e->height, regular), levels - regular);
    return slc_tail_slot_bits(&cut, index * 7 % slc_tail_slot_count(&cut));
}

/* The layer of a page, which it gets if it has none and is wanted; NULL if it is not. */
static uint32_t *layer_of(struct demand_scene *s, uint32_t page, uint32_t slot,
                          bool (*wanted)(void *user, uint32_t page), void *user)
{
    if (demand_refused(s, page))
        return NULL;
    if (!demand_resident(s, page)) {
        if (wanted && !wanted(user, page))
            return NULL;
        assert_true(s->layer_count < LAYERS);
        uint32_t layer = s->layers[s->layer_count++];
        demand_scene_set_page(s, page, layer / DEMAND_LAYERS << 16 | layer % DEMAND_LAYERS | slot,
                              0);
    }
    uint32_t word = word_of(s, page) & SLUICE_DEMAND_PLACE_MASK;
    uint32_t layer = (word >> 16) * DEMAND_LAYERS + (word & 0xffff);
    return (uint32_t *)s->staging.mapped + (size_t)layer * tile_texels(s);
}

/* The tile's part of a level; `origin` is where that begins in the tile. */
static void write_tile(struct demand_scene *s, uint32_t index, uint32_t level, uint32_t left,
                       uint32_t top, struct slc_demand_place origin, uint32_t *texels)
{
    const struct SluiceDemandTexture *e = demand_scene_entry(s, index);
    uint32_t right = slc_min_u32(slc_mip_size(e->width, level), left + (1u << s->tile_shift[0]));
    uint32_t bottom = slc_min_u32(slc_mip_size(e->height, level), top + (1u << s->tile_shift[1]));
    for (uint32_t y = top; y < bottom; y++)
        for (uint32_t x = left; x < right; x++)
            texels[((y - top + origin.y) << s->tile_shift[0]) + x - left + origin.x] =
                texel_bits(s, index, level, x, y);
}

void demand_images_load(struct demand_scene *s, uint32_t index,
                        bool (*wanted)(void *user, uint32_t page), void *user)
{
    const struct SluiceDemandTexture *e = demand_scene_entry(s, index);
    const uint32_t tile[2] = {1u << s->tile_shift[0], 1u << s->tile_shift[1]};
    uint32_t levels = slc_mip_count(slc_max_u32(e->width, e->height));
    uint32_t regular = slc_demand_regular_count(e->width, e->height, tile[0], tile[1]);
    for (uint32_t l = 0; l < regular; l++)
        for (uint32_t y = 0; y < slc_mip_size(e->height, l); y += tile[1])
            for (uint32_t x = 0; x < slc_mip_size(e->width, l); x += tile[0]) {
                uint32_t *texels =
                    layer_of(s, demand_scene_page(s, index, l, x, y), 0, wanted, user);
                if (texels)
                    write_tile(s, index, l, x, y, (struct slc_demand_place){0, 0}, texels);
            }
    bool blocks = e->shape & SLUICE_DEMAND_BLOCKS;
    uint32_t slot = choose_slot(s, e, index, regular, levels);
    uint32_t *texels = layer_of(s, e->tailPage, slot, wanted, user);
    for (uint32_t l = regular; texels && l < levels; l++)
        write_tile(
            s, index, l, 0, 0,
            slc_demand_tail_place(tile[0], tile[1], blocks, word_of(s, e->tailPage), l - regular),
            texels);
}

struct copy {
    struct demand_scene *s;
    struct harness_buffer *from;
    VkImage *images;
    uint32_t image_count, layer_count, level_count;
    const VkBufferImageCopy *regions; ///< one per level, of each image
    VkDeviceSize image_size;
};

static void move_image(const struct copy *c, VkCommandBuffer commands, VkImage image, bool before)
{
    VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = before ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = before ? VK_ACCESS_TRANSFER_WRITE_BIT : VK_ACCESS_SHADER_READ_BIT,
        .oldLayout = before ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL,
        .newLayout = VK_IMAGE_LAYOUT_GENERAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, c->level_count, 0, c->layer_count}};
    c->s->h->CmdPipelineBarrier(
        commands, before ? VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT : VK_PIPELINE_STAGE_TRANSFER_BIT,
        before ? VK_PIPELINE_STAGE_TRANSFER_BIT : VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0,
        NULL, 1, &barrier);
}

static void record_copy(void *user, VkCommandBuffer commands)
{
    const struct copy *c = user;
    struct harness *h = c->s->h;
    PFN_vkCmdCopyBufferToImage copy =
        (PFN_vkCmdCopyBufferToImage)h->GetDeviceProcAddr(h->device, "vkCmdCopyBufferToImage");
    for (uint32_t i = 0; i < c->image_count; i++) {
        move_image(c, commands, c->images[i], true);
        for (uint32_t l = 0; l < c->level_count; l++) {
            VkBufferImageCopy region = c->regions[l];
            region.bufferOffset += i * c->image_size;
            copy(commands, c->from->buffer, c->images[i], VK_IMAGE_LAYOUT_GENERAL, 1, &region);
        }
        move_image(c, commands, c->images[i], false);
    }
}

void demand_images_upload(struct demand_scene *s)
{
    const VkBufferImageCopy region = {
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, DEMAND_LAYERS},
        .imageExtent = {1u << s->tile_shift[0], 1u << s->tile_shift[1], 1}};
    struct copy c = {.s = s,
                     .from = &s->staging,
                     .images = s->images,
                     .image_count = DEMAND_CHUNKS,
                     .layer_count = DEMAND_LAYERS,
                     .level_count = 1,
                     .regions = &region,
                     .image_size = (VkDeviceSize)DEMAND_LAYERS * tile_texels(s) * TEXEL_SIZE};
    harness_run(s->h, record_copy, &c);
}

void demand_images_plain(struct demand_scene *s, uint32_t index)
{
    struct harness *h = s->h;
    const struct SluiceDemandTexture *e = demand_scene_entry(s, index);
    VkBufferImageCopy regions[16];
    uint32_t levels = slc_mip_count(slc_max_u32(e->width, e->height));
    VkImageCreateInfo info = image_info(s, e->width, e->height, levels, 1);
    create_image(s, &info, &s->plain, &s->plain_memory, &s->plain_view, false);
    s->plain_sampler = create_sampler(s, e->shape >> SLUICE_DEMAND_MODE_U_SHIFT & 7,
                                      e->shape >> SLUICE_DEMAND_MODE_V_SHIFT & 7, true);
    write_views(s, 10, 1, &s->plain_view, s->plain_sampler);
    struct harness_buffer staging;
    harness_buffer_init(h, &staging, (uint64_t)(e->width + 1) * (e->height + 1) * TEXEL_SIZE * 2,
                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    uint32_t *texels = staging.mapped;
    for (uint32_t l = 0; l < levels; l++) {
        uint32_t width = slc_mip_size(e->width, l), height = slc_mip_size(e->height, l);
        regions[l] = (VkBufferImageCopy){
            .bufferOffset = (VkDeviceSize)((char *)texels - (char *)staging.mapped),
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, l, 0, 1},
            .imageExtent = {width, height, 1}};
        for (uint32_t i = 0; i < width * height; i++)
            *texels++ = texel_bits(s, index, l, i % width, i / width);
    }
    struct copy c = {.s = s,
                     .from = &staging,
                     .images = &s->plain,
                     .image_count = 1,
                     .layer_count = 1,
                     .level_count = levels,
                     .regions = regions};
    harness_run(h, record_copy, &c);
    harness_buffer_finish(h, &staging);
}

void demand_images_plain_finish(struct demand_scene *s)
{
    struct harness *h = s->h;
    h->DestroySampler(h->device, s->plain_sampler, NULL);
    h->DestroyImageView(h->device, s->plain_view, NULL);
    h->DestroyImage(h->device, s->plain, NULL);
    h->FreeMemory(h->device, s->plain_memory, NULL);
}
