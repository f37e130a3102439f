/*
 * Sparse residency: one batch of binds per frame, in as few calls of vkQueueBindSparse as
 * maxBindsPerCall allows. The batch signals a timeline semaphore, which is only polled. Unmapped
 * tiles keep their bindings until their pages are needed (sparse_bindings.h).
 */
#include "vulkan/residency.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/map.h"
#include "vulkan/bind_calls.h"
#include "vulkan/bind_list.h"
#include "vulkan/device_heap.h"
#include "vulkan/sparse_bindings.h"
#include "vulkan/sparse_image.h"

#include <assert.h>

/* Most batches in progress. More would only queue up behind a slow binding queue. */
#define MAX_BATCHES 16u

/* Unmapped tile. It is evicted when the last frame that may read it is complete. */
struct pending_unmap {
    uint64_t frame; ///< first frame that does not read the tile
    uint64_t key;   ///< key in pending_tiles
    uint32_t index;
    struct slc_tile_place place;
    bool filled; ///< the texels are on the page
};

/* Released heap. It is freed when no tile is bound to it any more. */
struct dying_heap {
    uint32_t heap_id;
    uint32_t next_slot; ///< slots before this one are unbound
    uint64_t value;     ///< value of the batch with the last unbind
    bool unbound;       ///< all slots are unbound; `value` is final
};

struct sparse_residency {
    struct slc_residency base; ///< must be first
    const struct slc_vk *vk;
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    uint32_t memory_type;
    uint32_t max_image_count, max_changes;
    struct slc_device_heaps heaps;
    struct slc_sparse_image *images; ///< owned
    struct slc_touch_budget touched;
    bool told_of_touched;

    struct pending_unmap *pending; ///< owned ring, oldest first, sorted by frame
    uint32_t pending_first, pending_count, pending_capacity;
    struct slc_map pending_tiles;

    struct slc_sparse_bindings pages;
    struct dying_heap *dying; ///< owned
    uint32_t dying_count, dying_capacity;

    struct slc_bind_list list;
    struct slc_bind_calls calls;
    uint64_t submitted_value, completed_value; ///< batches
    uint64_t batch_ends[MAX_BATCHES];          ///< by batch: value of the semaphore at its end
};

static struct sparse_residency *sparse(struct slc_residency *residency)
{
    return (struct sparse_residency *)residency;
}

static const struct sparse_residency *const_sparse(const struct slc_residency *residency)
{
    return (const struct sparse_residency *)residency;
}

static void destroy_image(struct slc_residency *residency, uint32_t index)
{
    struct sparse_residency *s = sparse(residency);
    for (uint32_t i = 0; i < slc_max_u32(1, s->images[index].layer_count); i++) {
        slc_sparse_bindings_drop_image(&s->pages, index + i);
        slc_touched_tiles_finish(&s->images[index + i].touched, s->cb, &s->touched);
    }
    slc_sparse_image_destroy(&s->images[index], s->vk);
}

/* Counts packed tiles from the start, because they are always needed. */
static SluiceResult reserve_packed(struct sparse_residency *s, struct slc_sparse_image *image,
                                   const SluiceImageInfo *info)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    SluiceResult result = sluiceGetStreamedTextureLayout(&image->layout.desc, &layout);
    if (result == SLUICE_SUCCESS)
        result = slc_touched_tiles_init(&image->touched, s->cb, &s->touched, layout.tileCount,
                                        layout.regularTileCount);
    if (result == SLUICE_ERROR_LIMIT_EXCEEDED)
        slc_log(
            &s->vk->log, SLUICE_LOG_ERROR,
            "%s: no room for its mip tail, %s bears %u different tiles in sparse mode and %u are "
            "taken: use paged mode, or add fewer textures",
            info->pName ? info->pName : "image", s->caps->public.deviceName, s->touched.limit,
            s->touched.count);
    return result;
}

static bool reserve(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct sparse_residency *s = sparse(residency);
    if (slc_touched_tiles_touch(&s->images[index].touched, &s->touched, tile->tileIndex))
        return true;
    if (!s->told_of_touched)
        slc_log(&s->vk->log, SLUICE_LOG_WARNING,
                "reached the limit of %u different tiles that %s bears in sparse mode: finer tiles "
                "will not be loaded; paged mode has no such limit",
                s->touched.count, s->caps->public.deviceName);
    s->told_of_touched = true;
    return false;
}

static bool may_reserve(const struct slc_residency *residency, uint32_t index, uint32_t tile)
{
    const struct sparse_residency *s = (const struct sparse_residency *)residency;
    return slc_touched_tiles_may_touch(&s->images[index].touched, &s->touched, tile);
}

static SluiceResult create_image(struct slc_residency *residency, uint32_t index,
                                 const SluiceImageInfo *info, const struct slc_image_use *use,
                                 const char **refusal, struct slc_residency_image *image)
{
    struct sparse_residency *s = sparse(residency);
    struct slc_sparse_image *sparse_image = &s->images[index];
    assert(!sparse_image->image);
    SluiceResult result =
        slc_sparse_image_create(sparse_image, s->vk, s->caps, s->memory_type, info, use, refusal);
    if (result == SLUICE_ERROR_OUT_OF_DEVICE_MEMORY &&
        slc_device_heaps_free_spare(&s->heaps, s->vk, UINT64_MAX))
        result = slc_sparse_image_create(sparse_image, s->vk, s->caps, s->memory_type, info, use,
                                         refusal);
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < sparse_image->layer_count; i++)
        result = reserve_packed(s, &sparse_image[i], info);
    if (result != SLUICE_SUCCESS) {
        destroy_image(residency, index);
        return result;
    }
    *image = (struct slc_residency_image){.image = sparse_image->image,
                                          .desc = sparse_image->layout.desc,
                                          .uneven = sparse_image->layout.uneven,
                                          .storage = sparse_image->storage};
    return SLUICE_SUCCESS;
}

static bool image_is_idle(const struct slc_residency *residency, uint32_t index)
{
    const struct sparse_residency *s = const_sparse(residency);
    const struct slc_sparse_image *image = &s->images[index];
    return image->last_value <= s->completed_value && image->unmap_count == 0;
}

/* Returns the value at which all listed and submitted changes are complete. */
static uint64_t last_value(const struct sparse_residency *s)
{
    return s->submitted_value + (s->list.count ? 1 : 0);
}

static SluiceResult reserve_dying(struct sparse_residency *s)
{
    uint32_t count = s->heaps.capacity;
    if (count <= s->dying_capacity)
        return SLUICE_SUCCESS;
    struct dying_heap *dying = slc_alloc(s->cb, count, sizeof *dying);
    if (!dying)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < s->dying_count; i++)
        dying[i] = s->dying[i];
    slc_free(s->cb, s->dying, s->dying_capacity, sizeof *dying);
    s->dying = dying;
    s->dying_capacity = count;
    return SLUICE_SUCCESS;
}

static SluiceResult allocate_heap(struct slc_residency *residency, uint64_t size, uint32_t *heap_id)
{
    struct sparse_residency *s = sparse(residency);
    const VkPhysicalDeviceMemoryProperties *memory = &s->caps->memory;
    uint64_t page_count = size / SLC_TILE_SIZE;
    /* Vulkan forbids allocations larger than the memory heap. */
    if (size > memory->memoryHeaps[memory->memoryTypes[s->memory_type].heapIndex].size ||
        page_count > UINT32_MAX)
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    if (s->dying_count) { /* reuses a released heap of equal size; its bindings stay valid */
        *heap_id = s->dying[--s->dying_count].heap_id;
        return SLUICE_SUCCESS;
    }
    SluiceResult result =
        slc_device_heaps_allocate(&s->heaps, s->vk, s->cb, size, s->memory_type, heap_id);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_sparse_bindings_add_heap(&s->pages, s->cb, *heap_id, (uint32_t)page_count);
    if (result == SLUICE_SUCCESS)
        result = reserve_dying(s);
    if (result != SLUICE_SUCCESS)
        slc_device_heaps_release(&s->heaps, s->vk, *heap_id);
    return result;
}

/* Unbinds slots of a released heap. Leaves half of the list to maps. */
static bool unbind_heap(struct sparse_residency *s, struct dying_heap *heap)
{
    for (; heap->next_slot < s->pages.heap_page_count; heap->next_slot++) {
        uint32_t image;
        if (s->list.count >= s->list.capacity / 2 ||
            !slc_sparse_bindings_unbind(&s->pages, &s->list, heap->heap_id, heap->next_slot,
                                        &image))
            return false;
        if (image == SLC_NO_IMAGE)
            continue;
        s->images[image].last_value = s->submitted_value + 1;
        heap->value = s->submitted_value + 1;
    }
    /* The last tiles may have been unbound just now, as neighbors of tiles of other heaps. */
    if (!heap->unbound && last_value(s) > heap->value)
        heap->value = last_value(s);
    heap->unbound = true;
    return true;
}

static void release_dying(struct sparse_residency *s)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->dying_count; i++) {
        struct dying_heap heap = s->dying[i];
        if (unbind_heap(s, &heap) && heap.value <= s->completed_value)
            slc_device_heaps_release(&s->heaps, s->vk, heap.heap_id);
        else
            s->dying[kept++] = heap;
    }
    s->dying_count = kept;
}

static void release_heap(struct slc_residency *residency, uint32_t heap_id)
{
    struct sparse_residency *s = sparse(residency);
    assert(s->dying_count < s->dying_capacity);
    /* Batches in progress may still move tiles of the heap to other pages. */
    s->dying[s->dying_count++] = (struct dying_heap){heap_id, 0, last_value(s), false};
}

static void prepare_heaps(struct slc_residency *residency, uint64_t size, uint32_t max_count)
{
    struct sparse_residency *s = sparse(residency);
    slc_device_heaps_prepare(&s->heaps, s->vk, s->cb, size, s->memory_type, max_count);
}

static uint64_t free_spare(struct slc_residency *residency, uint64_t wanted)
{
    struct sparse_residency *s = sparse(residency);
    return slc_device_heaps_free_spare(&s->heaps, s->vk, wanted);
}

static uint64_t going_size(const struct slc_residency *residency)
{
    const struct sparse_residency *s = const_sparse(residency);
    return (uint64_t)s->dying_count * s->pages.heap_page_count * SLC_TILE_SIZE;
}

static uint32_t room_to_unmap(const struct slc_residency *residency)
{
    const struct sparse_residency *s = const_sparse(residency);
    return s->pending_capacity - s->pending_count;
}

static void unmap(struct slc_residency *residency, uint32_t index, const SluiceTile *tile,
                  uint64_t frame, bool filled)
{
    struct sparse_residency *s = sparse(residency);
    assert(s->pending_count < s->pending_capacity);
    struct slc_tile_place place = slc_sparse_layout_place(&s->images[index].layout, tile);
    uint32_t at = (s->pending_first + s->pending_count++) % s->pending_capacity;
    s->pending[at] =
        (struct pending_unmap){frame, slc_place_key(index, place), index, place, filled};
    slc_map_add(&s->pending_tiles, s->pending[at].key, at);
    s->images[index].unmap_count++;
}

static void discard(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct sparse_residency *s = sparse(residency);
    struct slc_tile_place place = slc_sparse_layout_place(&s->images[index].layout, tile);
    slc_sparse_bindings_spoil(&s->pages, index, place);
    slc_sparse_bindings_evict(&s->pages, index, place);
}

static SluiceResult map(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct sparse_residency *s = sparse(residency);
    struct slc_tile_place place = slc_sparse_layout_place(&s->images[index].layout, tile);
    /* Frames in progress may still read the old page through their MinMip maps. */
    if (slc_map_get(&s->pending_tiles, slc_place_key(index, place)) != SLC_MAP_NONE)
        return SLUICE_NOT_READY;
    uint32_t unbound, count = s->list.count;
    /* The list may be full, because it grows while no batch can be submitted. */
    if (!slc_sparse_bindings_bind(&s->pages, &s->list, index, place, tile->heapId, tile->slot,
                                  &unbound))
        return SLUICE_NOT_READY;
    /* the image is not idle from here on */
    if (s->list.count > count)
        s->images[index].last_value = s->submitted_value + 1;
    if (unbound != SLC_NO_IMAGE)
        s->images[unbound].last_value = s->submitted_value + 1;
    return SLUICE_SUCCESS;
}

/* An evicted tile was shown, so its texels are on its page, unless unmap had `filled` false. */
static bool revive(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct sparse_residency *s = sparse(residency);
    struct slc_tile_place place = slc_sparse_layout_place(&s->images[index].layout, tile);
    return !slc_sparse_bindings_is_spoiled(&s->pages, index, place) &&
           slc_sparse_bindings_restore(&s->pages, index, place, tile->heapId, tile->slot);
}

static void spoil(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct sparse_residency *s = sparse(residency);
    struct slc_tile_place place = slc_sparse_layout_place(&s->images[index].layout, tile);
    uint32_t pending = slc_map_get(&s->pending_tiles, slc_place_key(index, place));
    if (pending != SLC_MAP_NONE)
        s->pending[pending].filled = false;
    else
        slc_sparse_bindings_spoil_evicted(&s->pages, index, place);
}

/* Evicts unmapped tiles that no incomplete frame reads: other tiles may have their pages. */
static void release_pending(struct sparse_residency *s, uint64_t completed_frame)
{
    while (s->pending_count) {
        struct pending_unmap *unmap = &s->pending[s->pending_first];
        if (unmap->frame > completed_frame + 1)
            return;
        if (!unmap->filled)
            slc_sparse_bindings_spoil(&s->pages, unmap->index, unmap->place);
        slc_sparse_bindings_evict(&s->pages, unmap->index, unmap->place);
        slc_map_remove(&s->pending_tiles, unmap->key);
        s->images[unmap->index].unmap_count--;
        s->pending_first = (s->pending_first + 1) % s->pending_capacity;
        s->pending_count--;
    }
}

static SluiceResult update(struct slc_residency *residency, uint64_t frame,
                           uint64_t completed_frame)
{
    struct sparse_residency *s = sparse(residency);
    (void)frame;
    uint64_t value = 0;
    SluiceResult result = slc_vk_result(
        s->vk, s->vk->GetSemaphoreCounterValue(s->vk->device, s->calls.semaphore, &value),
        "vkGetSemaphoreCounterValue");
    if (result != SLUICE_SUCCESS)
        return result;
    while (s->completed_value < s->submitted_value &&
           s->batch_ends[(s->completed_value + 1) % MAX_BATCHES] <= value)
        s->completed_value++;
    release_pending(s, completed_frame);
    release_dying(s);
    s->base.counters.unbinds = s->pages.unbind_count;
    s->base.counters.unbinds_saved = s->pages.unbinds_saved;
    return SLUICE_SUCCESS;
}

static uint64_t completed_value(const struct slc_residency *residency)
{
    return const_sparse(residency)->completed_value;
}

static uint64_t retire_limit(const struct slc_residency *residency, uint64_t completed_frame)
{
    const struct sparse_residency *s = const_sparse(residency);
    uint64_t first = s->pending_count ? s->pending[s->pending_first].frame : UINT64_MAX;
    return slc_min_u64(completed_frame, first - 1);
}

struct slot_memory {
    VkDeviceMemory memory; ///< VK_NULL_HANDLE to unbind
    VkDeviceSize offset;
};

/* Returns the memory of the first slot of a run. */
static struct slot_memory slot_memory(const struct sparse_residency *s,
                                      const struct slc_bind_run *run)
{
    if (run->heap_id == SLC_UNBIND)
        return (struct slot_memory){0};
    const struct slc_memory *heap = &s->heaps.at[run->heap_id].memory;
    return (struct slot_memory){heap->memory,
                                heap->offset + (VkDeviceSize)run->slot * SLC_TILE_SIZE};
}

static VkSparseImageMemoryBind tile_bind(const struct sparse_residency *s,
                                         const struct slc_sparse_image *image,
                                         const struct slc_bind_run *run)
{
    const SluiceStreamedTextureDesc *desc = &image->layout.desc;
    uint32_t level = run->place.level;
    uint32_t x = run->place.x * desc->tileWidth, y = run->place.y * desc->tileHeight;
    const struct slot_memory heap = slot_memory(s, run);
    return (VkSparseImageMemoryBind){
        .subresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, image->layer},
        .offset = {(int32_t)x, (int32_t)y, 0},
        /* Tiles at the edge are clipped to the level. */
        .extent = {slc_min_u32(run->column_count * desc->tileWidth,
                               slc_mip_size(desc->width, level) - x),
                   slc_min_u32(run->row_count * desc->tileHeight,
                               slc_mip_size(desc->height, level) - y),
                   1},
        .memory = heap.memory,
        .memoryOffset = heap.offset};
}

/* Binds one page of a tail. Drivers bind only the first page of longer opaque binds. */
static VkSparseMemoryBind page_bind(const struct sparse_residency *s,
                                    const struct slc_sparse_image *image,
                                    const struct slc_bind_run *run)
{
    const struct slc_sparse_layout *layout = &image->layout;
    uint64_t offset = (uint64_t)run->place.x * SLC_TILE_SIZE;
    const struct slot_memory heap = slot_memory(s, run);
    uint64_t tail = layout->tail_offset + image->layer * layout->tail_stride;
    return (VkSparseMemoryBind){.resourceOffset = tail + offset,
                                .size = slc_min_u64(SLC_TILE_SIZE, layout->tail_size - offset),
                                .memory = heap.memory,
                                .memoryOffset = heap.offset};
}

static VkSparseMemoryBind metadata_bind(const struct slc_sparse_image *image)
{
    const struct slc_sparse_layout *layout = &image->layout;
    return (VkSparseMemoryBind){
        .resourceOffset = layout->metadata_offset + image->layer * layout->metadata_stride,
        .size = layout->metadata_size,
        .memory = image->metadata.memory,
        .memoryOffset = image->metadata.offset + image->layer * layout->metadata_size,
        .flags = VK_SPARSE_MEMORY_BIND_METADATA_BIT};
}

/* Begins the binds of an image, before its first run. */
static SluiceResult begin_image(struct sparse_residency *s, struct slc_sparse_image *image)
{
    image->last_value = s->submitted_value + 1;
    if (!image->metadata.memory || image->metadata_bound)
        return SLUICE_SUCCESS;
    const VkSparseMemoryBind bind = metadata_bind(image);
    return slc_bind_calls_add_page(&s->calls, image->image, &bind);
}

static SluiceResult add_run(struct sparse_residency *s, const struct slc_bind_run *run)
{
    const struct slc_sparse_image *image = &s->images[run->image];
    if (run->place.level == SLC_TAIL_LEVEL) {
        const VkSparseMemoryBind page = page_bind(s, image, run);
        return slc_bind_calls_add_page(&s->calls, image->image, &page);
    }
    const VkSparseImageMemoryBind tile = tile_bind(s, image, run);
    return slc_bind_calls_add_tile(&s->calls, image->image, &tile);
}

static SluiceResult submit_runs(struct sparse_residency *s)
{
    SluiceResult result = SLUICE_SUCCESS;
    slc_bind_calls_begin(&s->calls);
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < s->list.run_count; i++) {
        const struct slc_bind_run *run = &s->list.runs[i];
        if (i == 0 || run->image != s->list.runs[i - 1].image)
            result = begin_image(s, &s->images[run->image]);
        if (result == SLUICE_SUCCESS)
            result = add_run(s, run);
    }
    return result == SLUICE_SUCCESS ? slc_bind_calls_end(&s->calls) : result;
}

/* After an error the list is kept, and the next batch repeats all of its binds. */
static SluiceResult submit(struct slc_residency *residency, uint64_t *value)
{
    struct sparse_residency *s = sparse(residency);
    /* Collected changes are submitted with the next batch, by this call or a later one. Tiles that
     * got their old pages again are in no batch. */
    *value = last_value(s);
    if (s->list.count == 0 || s->submitted_value - s->completed_value == MAX_BATCHES)
        return SLUICE_SUCCESS;
    slc_bind_list_build_runs(&s->list);
    SluiceResult result = submit_runs(s);
    s->base.counters.bind_calls = s->calls.count;
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t i = 0; i < s->list.run_count; i++)
        s->images[s->list.runs[i].image].metadata_bound = true;
    s->submitted_value++;
    s->batch_ends[s->submitted_value % MAX_BATCHES] = s->calls.signaled;
    s->base.counters.bind_runs += s->list.run_count;
    slc_bind_list_clear(&s->list);
    return SLUICE_SUCCESS;
}

static SluiceResult wait(struct slc_residency *residency)
{
    struct sparse_residency *s = sparse(residency);
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &s->calls.semaphore,
                                .pValues = &s->calls.signaled};
    return slc_vk_result(s->vk, s->vk->WaitSemaphores(s->vk->device, &info, UINT64_MAX),
                         "vkWaitSemaphores");
}

static void record_uploads(struct slc_residency *residency, uint32_t index,
                           VkCommandBuffer commands, VkBuffer buffer, uint32_t count,
                           const VkBufferImageCopy *regions, uint32_t parts)
{
    struct sparse_residency *s = sparse(residency);
    if (parts & SLC_UPLOAD_COPY)
        s->vk->CmdCopyBufferToImage(commands, buffer, s->images[index].image,
                                    VK_IMAGE_LAYOUT_GENERAL, count, regions);
}

static void destroy(struct slc_residency *residency)
{
    struct sparse_residency *s = sparse(residency);
    const SluiceAllocationCallbacks *cb = s->cb;
    if (s->images && s->pages.first_pages)
        for (uint32_t i = 0; i < s->max_image_count; i++)
            if (s->images[i].layer == 0)
                destroy_image(residency, i);
    slc_device_heaps_finish(&s->heaps, s->vk, cb);
    slc_bind_calls_finish(&s->calls, cb);
    slc_bind_list_finish(&s->list, cb);
    slc_sparse_bindings_finish(&s->pages, cb);
    slc_free(cb, s->dying, s->dying_capacity, sizeof *s->dying);
    slc_map_finish(&s->pending_tiles, cb);
    slc_free(cb, s->pending, s->pending_capacity, sizeof *s->pending);
    slc_free(cb, s->images, s->max_image_count, sizeof *s->images);
    slc_free(cb, s, 1, sizeof *s);
}

static const struct slc_residency_interface sparse_interface = {
    .destroy = destroy,
    .create_image = create_image,
    .destroy_image = destroy_image,
    .image_is_idle = image_is_idle,
    .revive = revive,
    .spoil = spoil,
    .reserve = reserve,
    .may_reserve = may_reserve,
    .allocate_heap = allocate_heap,
    .release_heap = release_heap,
    .prepare_heaps = prepare_heaps,
    .free_spare = free_spare,
    .going_size = going_size,
    .update = update,
    .map = map,
    .unmap = unmap,
    .maps_unread = true,
    .discard = discard,
    .room_to_unmap = room_to_unmap,
    .submit = submit,
    .wait = wait,
    .completed_value = completed_value,
    .retire_limit = retire_limit,
    .record_uploads = record_uploads,
};

static SluiceResult create_arrays(struct sparse_residency *s)
{
    uint32_t capacity = 4 * s->max_changes; /* a map may unbind the tile that had its page */
    SluiceResult result = slc_bind_list_init(&s->list, s->cb, capacity);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_sparse_bindings_init(&s->pages, s->cb, s->max_image_count);
    if (result != SLUICE_SUCCESS)
        return result;
    s->pending_capacity = 4 * s->max_changes;
    result = slc_map_init(&s->pending_tiles, s->cb, s->pending_capacity);
    if (result != SLUICE_SUCCESS)
        return result;
    s->images = slc_calloc(s->cb, s->max_image_count, sizeof *s->images);
    s->pending = slc_alloc(s->cb, s->pending_capacity, sizeof *s->pending);
    return s->images && s->pending ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static SluiceResult create_calls(struct sparse_residency *s,
                                 const struct slc_residency_create_info *info)
{
    const struct slc_bind_calls_limits limits = {
        .regions_per_call = info->max_binds_per_call,
        .tile_count = s->list.capacity,
        .page_count = s->list.capacity + s->max_image_count, /* metadata once per image */
        .image_count = s->max_image_count};
    return slc_bind_calls_init(&s->calls, s->vk, info->sparse_queue, s->cb, &limits);
}

SluiceResult slc_create_sparse_residency(const struct slc_residency_create_info *info,
                                         struct slc_residency **residency)
{
    struct sparse_residency *s = slc_calloc(info->cb, 1, sizeof *s);
    if (!s)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    s->base.interface = &sparse_interface;
    s->vk = info->vk;
    s->caps = info->caps;
    s->cb = info->cb;
    s->max_image_count = info->max_image_count;
    s->max_changes = info->max_changes;
    s->touched.limit = info->max_touched_tiles;
    s->heaps.kept_size = info->kept_heap_size;
    SluiceResult result = create_arrays(s);
    if (result == SLUICE_SUCCESS)
        result = create_calls(s, info);
    if (result == SLUICE_SUCCESS)
        result = slc_sparse_memory_type(s->vk, s->caps, &s->memory_type);
    if (result != SLUICE_SUCCESS) {
        destroy(&s->base);
        return result;
    }
    *residency = &s->base;
    return SLUICE_SUCCESS;
}
