/*
 * Dense residency: ordinary images with memory for all levels from the start. Only the manager
 * tracks maps. A reference to compare other modes with, and a mode for few or small textures on any
 * device.
 *
 * Copies are recorded after a barrier on the queue that draws. So a tile may be copied again while
 * earlier frames are in progress, without waiting.
 */
#include "vulkan/residency.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "vulkan/plain_image.h"
#include "vulkan/sparse_layout.h"

/* The layers of an array share the image; the first owns it. */
struct dense_image {
    struct slc_plain_image own;
    VkImage image;
    uint32_t layer_count; ///< layers of the array, in its first layer; 0 in others
};

struct dense_residency {
    struct slc_residency base; ///< must be first
    const struct slc_vk *vk;
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    struct slc_image_memory memory;
    struct dense_image *images; ///< owned
    uint32_t max_image_count;
    uint32_t next_heap;
    bool whole;
};

static struct dense_residency *dense(struct slc_residency *residency)
{
    return (struct dense_residency *)residency;
}

static SluiceResult create_image(struct slc_residency *residency, uint32_t index,
                                 const SluiceImageInfo *info, const struct slc_image_use *use,
                                 const char **refusal, struct slc_residency_image *image)
{
    (void)refusal;
    struct dense_residency *d = dense(residency);
    struct dense_image *layers = &d->images[index];
    uint32_t layer_count = slc_max_u32(1, info->arrayLayerCount);
    struct slc_sparse_layout layout;
    SluiceResult result =
        d->whole ? slc_whole_layout_init(&layout, info) : slc_standard_layout_init(&layout, info);
    if (result == SLUICE_SUCCESS)
        result = slc_plain_image_create(&layers[0].own, &d->memory, d->vk, d->caps, d->cb, info, 0,
                                        layer_count, use);
    if (result != SLUICE_SUCCESS)
        return result;
    layers[0].layer_count = layer_count;
    for (uint32_t i = 0; i < layer_count; i++)
        layers[i].image = layers[0].own.image;
    *image = (struct slc_residency_image){.image = layers[0].image,
                                          .desc = layout.desc,
                                          .uneven = layout.uneven,
                                          .storage = layers[0].own.storage};
    return SLUICE_SUCCESS;
}

static void destroy_image(struct slc_residency *residency, uint32_t index)
{
    struct dense_residency *d = dense(residency);
    struct dense_image *layers = &d->images[index];
    slc_plain_image_destroy(&layers[0].own, &d->memory, d->vk, d->cb);
    for (uint32_t i = layers[0].layer_count; i-- > 0;)
        layers[i] = (struct dense_image){0};
}

static bool image_is_idle(const struct slc_residency *residency, uint32_t index)
{
    (void)residency, (void)index;
    return true;
}

/* Makes a heap without memory. It counts against the budget only. */
static SluiceResult allocate_heap(struct slc_residency *residency, uint64_t size, uint32_t *heap_id)
{
    struct dense_residency *d = dense(residency);
    if (size > slc_device_memory_size(d->caps))
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    *heap_id = d->next_heap++;
    return SLUICE_SUCCESS;
}

static void release_heap(struct slc_residency *residency, uint32_t heap_id)
{
    (void)residency, (void)heap_id;
}

static SluiceResult update(struct slc_residency *residency, uint64_t frame,
                           uint64_t completed_frame)
{
    (void)residency, (void)frame, (void)completed_frame;
    return SLUICE_SUCCESS;
}

static SluiceResult map(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    (void)residency, (void)index, (void)tile;
    return SLUICE_SUCCESS;
}

static void unmap(struct slc_residency *residency, uint32_t index, const SluiceTile *tile,
                  uint64_t frame, bool filled)
{
    (void)residency, (void)index, (void)tile, (void)frame, (void)filled;
}

static uint32_t room_to_unmap(const struct slc_residency *residency)
{
    (void)residency;
    return UINT32_MAX;
}

static SluiceResult submit(struct slc_residency *residency, uint64_t *value)
{
    (void)residency;
    *value = 0;
    return SLUICE_SUCCESS;
}

static SluiceResult wait(struct slc_residency *residency)
{
    (void)residency;
    return SLUICE_SUCCESS;
}

static uint64_t completed_value(const struct slc_residency *residency)
{
    (void)residency;
    return 0;
}

static uint64_t retire_limit(const struct slc_residency *residency, uint64_t completed_frame)
{
    (void)residency;
    return completed_frame;
}

static void record_uploads(struct slc_residency *residency, uint32_t index,
                           VkCommandBuffer commands, VkBuffer buffer, uint32_t count,
                           const VkBufferImageCopy *regions, uint32_t parts)
{
    struct dense_residency *d = dense(residency);
    if (parts & SLC_UPLOAD_COPY)
        d->vk->CmdCopyBufferToImage(commands, buffer, d->images[index].image,
                                    VK_IMAGE_LAYOUT_GENERAL, count, regions);
}

static void destroy(struct slc_residency *residency)
{
    struct dense_residency *d = dense(residency);
    const SluiceAllocationCallbacks *cb = d->cb;
    if (d->images)
        for (uint32_t i = 0; i < d->max_image_count; i++)
            slc_plain_image_destroy(&d->images[i].own, &d->memory, d->vk, cb);
    slc_image_memory_finish(&d->memory, cb);
    slc_free(cb, d->images, d->max_image_count, sizeof *d->images);
    slc_free(cb, d, 1, sizeof *d);
}

static const struct slc_residency_interface dense_interface = {
    .ordinary_images = true,
    .destroy = destroy,
    .create_image = create_image,
    .destroy_image = destroy_image,
    .image_is_idle = image_is_idle,
    .allocate_heap = allocate_heap,
    .release_heap = release_heap,
    .update = update,
    .map = map,
    .unmap = unmap,
    .room_to_unmap = room_to_unmap,
    .submit = submit,
    .wait = wait,
    .completed_value = completed_value,
    .retire_limit = retire_limit,
    .record_uploads = record_uploads,
};

SluiceResult slc_create_dense_residency(const struct slc_residency_create_info *info,
                                        struct slc_residency **residency)
{
    struct dense_residency *d = slc_calloc(info->cb, 1, sizeof *d);
    if (!d)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    d->base.interface = &dense_interface;
    d->vk = info->vk;
    d->caps = info->caps;
    d->cb = info->cb;
    d->memory.quiet = info->may_lack_memory;
    d->whole = info->whole;
    d->max_image_count = info->max_image_count;
    d->images = slc_calloc(d->cb, d->max_image_count, sizeof *d->images);
    if (!d->images) {
        destroy(&d->base);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    *residency = &d->base;
    return SLUICE_SUCCESS;
}
