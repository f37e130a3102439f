/*
 * Paged residency: tiles are layers of array images (page_pool.h), and shaders find them through a
 * page table in a storage buffer. The packed levels are in an ordinary image of their own.
 *
 * Nothing waits for the GPU. Copies and stores to the table are recorded after a barrier on the
 * queue that draws, so earlier frames have read a page before it is overwritten. A frame that no
 * longer shows a tile may give its page to another tile (docs/decisions/0023-paged-residency.md).
 */
#include "vulkan/residency.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "vulkan/format_caps.h"
#include "vulkan/page_moves.h"
#include "vulkan/page_pool.h"
#include "vulkan/page_table.h"
#include "vulkan/sparse_layout.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>

#define COPY_BATCH 64u

/* Layers of an array have separate parts of the table, and share the tail. */
struct paged_image {
    struct slc_plain_image own_tail; ///< packed levels of all layers; owned by layer 0
    VkImage tail;
    uint32_t layer_count;      ///< layer 0: layers of the array; 0 in all other layers
    SluiceImageSource *source; ///< borrowed
    uint32_t source_layer;
    uint32_t generation;                ///< generation of the texels, for keys of tiles
    SluiceFormat page_format;           ///< may have SLC_PAGE_PRODUCED
    uint32_t block_width, block_height; ///< texels
};

struct paged_residency {
    struct slc_residency base; ///< must be first
    const struct slc_vk *vk;
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    struct slc_image_memory memory; ///< memory of tails
    struct slc_page_pool *pool;     ///< borrowed
    uint32_t user;                  ///< user of `pool`
    struct paged_image *images;     ///< owned
    uint32_t max_image_count;
    struct slc_page_table table; ///< one part per image, by index
    struct slc_page_moves moves;
    uint32_t upload_reserve; ///< changes that unmapping must leave to uploads and moves
    bool packed_outside;
    uint64_t frame;
    uint32_t next_heap, heap_count;
    uint64_t most_tiles; ///< most tiles since a refusal for which slots of a heap were too many
};

static struct paged_residency *paged(struct slc_residency *residency)
{
    return (struct paged_residency *)residency;
}

static void count_memory(struct paged_residency *p)
{
    struct slc_page_pool_counts pool = slc_page_pool_get_counts(p->pool);
    p->base.counters.page_chunks = pool.chunk_count;
    p->base.counters.page_chunk_shortages = pool.shortages;
}

static uint32_t word_of(const struct paged_residency *p, uint32_t index, const SluiceTile *tile)
{
    return slc_page_table_word(&p->table, index, tile->mipLevel, tile->x, tile->y);
}

static void give_pages(struct paged_residency *p, uint32_t index)
{
    const struct slc_page_table_part *part = &p->table.parts[index];
    for (uint32_t i = part->desc.regularMipCount; i < part->word_count; i++) {
        uint32_t entry = p->table.entries[part->first_word + i];
        if (slc_page_is_taken(entry))
            slc_page_pool_give(p->pool, p->user, slc_page_of_entry(entry), SLC_NO_OWNER);
    }
}

/* Destroys an image, also one whose creation failed halfway. */
static void destroy_image(struct slc_residency *residency, uint32_t index)
{
    struct paged_residency *p = paged(residency);
    struct paged_image *layers = &p->images[index];
    slc_plain_image_destroy(&layers[0].own_tail, &p->memory, p->vk, p->cb);
    for (uint32_t i = layers[0].layer_count; i-- > 0;) {
        give_pages(p, index + i);
        slc_page_table_remove(&p->table, index + i);
        layers[i] = (struct paged_image){0};
    }
    count_memory(p);
}

/* Checks that the format has linear filters: the shared sampler and the shaders' blending use them.
 */
static SluiceResult check_filter(const struct paged_residency *p, const SluiceImageInfo *info)
{
    if (slc_filters_linear(p->vk, info->format))
        return SLUICE_SUCCESS;
    slc_log(&p->vk->log, SLUICE_LOG_ERROR,
            "%s: %ux%u %s has no linear filter, which paged mode requires",
            info->pName ? info->pName : "image", info->width, info->height,
            sluiceGetFormatName(info->format));
    return SLUICE_ERROR_UNSUPPORTED;
}

static SluiceResult create_layer(struct paged_residency *p, uint32_t index, SluiceFormat format,
                                 const SluiceStreamedTextureDesc *desc, VkImage tail)
{
    struct paged_image *image = &p->images[index];
    SluiceFormatInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetFormatInfo(format, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    image->tail = tail;
    image->block_width = info.blockWidth;
    image->block_height = info.blockHeight;
    return slc_page_table_add(&p->table, index, desc);
}

static SluiceResult create_image(struct slc_residency *residency, uint32_t index,
                                 const SluiceImageInfo *info, const struct slc_image_use *use,
                                 const char **refusal, struct slc_residency_image *out)
{
    (void)refusal;
    struct paged_residency *p = paged(residency);
    if (use->mutable_format) {
        slc_log(&p->vk->log, SLUICE_LOG_ERROR,
                "%s: mutableFormat is not for textures in paged mode: pages have views of one "
                "format",
                info->pName ? info->pName : "image");
        return SLUICE_ERROR_UNSUPPORTED;
    }
    struct paged_image *first = &p->images[index];
    uint32_t layer_count = slc_max_u32(1, info->arrayLayerCount);
    struct slc_sparse_layout layout;
    SluiceResult result = slc_standard_layout_init(&layout, info);
    if (result == SLUICE_SUCCESS && p->packed_outside)
        layout.desc.packedTilesOutside = true;
    if (result == SLUICE_SUCCESS)
        result = slc_plain_image_create(&first->own_tail, &p->memory, p->vk, p->caps, p->cb, info,
                                        layout.desc.regularMipCount, layer_count, use);
    if (result != SLUICE_SUCCESS)
        return result;
    first->layer_count = layer_count;
    result = check_filter(p, info);
    for (uint32_t i = 0; i < layer_count && result == SLUICE_SUCCESS; i++)
        result = create_layer(p, index + i, info->format, &layout.desc, first->own_tail.image);
    for (uint32_t i = 0; i < layer_count; i++)
        p->images[index + i].page_format = slc_page_format(info->format, use->produced);
    if (result != SLUICE_SUCCESS) {
        destroy_image(residency, index);
        return result;
    }
    slc_page_pool_prepare(p->pool, p->user, slc_page_format(info->format, use->produced));
    count_memory(p);
    *out = (struct slc_residency_image){.image = first->tail,
                                        .desc = layout.desc,
                                        .uneven = layout.uneven,
                                        .storage = first->own_tail.storage,
                                        .first_level = layout.desc.regularMipCount};
    return SLUICE_SUCCESS;
}

static bool image_is_idle(const struct slc_residency *residency, uint32_t index)
{
    (void)residency, (void)index;
    return true;
}

/* After a refusal, slots may exceed the existing pages by one heap only. The heap is necessary:
 * tiles that share pages could fill all slots, and then no tile would ask for pages again. */
static bool may_have_heap(struct paged_residency *p, uint64_t slots)
{
    uint64_t tiles = slc_page_pool_present(p->pool, p->user);
    if (!slc_page_pool_was_refused(p->pool))
        p->most_tiles = 0;
    else if (slots > tiles && tiles <= p->most_tiles)
        return false;
    else if (slots > tiles)
        p->most_tiles = tiles;
    return true;
}

/* Makes a heap without memory. It counts against the budget; pages have the memory. */
static SluiceResult allocate_heap(struct slc_residency *residency, uint64_t size, uint32_t *heap_id)
{
    struct paged_residency *p = paged(residency);
    if (slc_page_pool_is_refused(p->pool) || size > slc_device_memory_size(p->caps))
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    if (!may_have_heap(p, p->heap_count * (size / SLC_TILE_SIZE)))
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    *heap_id = p->next_heap++;
    p->heap_count++;
    return SLUICE_SUCCESS;
}

static void release_heap(struct slc_residency *residency, uint32_t heap_id)
{
    (void)heap_id;
    paged(residency)->heap_count--;
}

static uint32_t gather(struct slc_residency *residency, uint64_t size)
{
    struct paged_residency *p = paged(residency);
    uint32_t held;
    if (size)
        slc_page_pool_hurry(p->pool);
    uint64_t going = slc_page_pool_going_size(p->pool);
    if (size <= going) {
        slc_page_pool_stay(p->pool, p->user);
        return SLC_NONE;
    }
    p->moves.left = UINT32_MAX;
    return slc_page_pool_choose_leaving(p->pool, p->user, size - going, &held);
}

static uint32_t compact(struct slc_residency *residency, uint32_t most)
{
    struct paged_residency *p = paged(residency);
    uint32_t held, lacking = slc_page_pool_choose_leaving(p->pool, p->user, 0, &held);
    slc_page_pool_hurry(p->pool);
    p->moves.left = slc_min_u32(most, SLC_PAGE_MOVES_PER_FRAME);
    if (lacking == 0)
        return slc_min_u32(p->moves.left, held);
    slc_page_pool_stay(p->pool, p->user);
    return 0;
}

static uint32_t page_room(const struct slc_residency *residency, uint32_t index)
{
    const struct paged_residency *p = (const struct paged_residency *)residency;
    return slc_page_pool_free_count(p->pool, p->user, p->images[index].page_format);
}

static SluiceResult update(struct slc_residency *residency, uint64_t frame,
                           uint64_t completed_frame)
{
    paged(residency)->frame = frame;
    slc_page_moves_complete(&paged(residency)->moves, completed_frame);
    return SLUICE_SUCCESS;
}

static struct slc_tile_key key_of(const struct paged_residency *p, uint32_t index,
                                  const SluiceTile *tile)
{
    const struct paged_image *image = &p->images[index];
    const SluiceStreamedTextureDesc *desc = &p->table.parts[index].desc;
    SluiceImageRegion region = {.mipLevel = tile->mipLevel,
                                .x = tile->x * desc->tileWidth,
                                .y = tile->y * desc->tileHeight,
                                .arrayLayer = image->source_layer};
    region.width =
        slc_min_u32(desc->tileWidth, slc_mip_size(desc->width, tile->mipLevel) - region.x);
    region.height =
        slc_min_u32(desc->tileHeight, slc_mip_size(desc->height, tile->mipLevel) - region.y);
    return slc_tile_key(image->source, &region, image->generation);
}

static void set_source(struct slc_residency *residency, uint32_t index, SluiceImageSource *source,
                       uint32_t layer)
{
    struct paged_image *image = &paged(residency)->images[index];
    image->source = source;
    image->generation = slc_page_share_generation(paged(residency)->pool, source);
    image->source_layer = layer;
}

static void announce(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    const struct slc_tile_key key = key_of(p, index, tile);
    slc_page_share_announce(p->pool, p->user, &key);
}

static void withdraw(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    const struct slc_tile_key key = key_of(p, index, tile);
    slc_page_share_withdraw(p->pool, p->user, &key);
}

static void leave_source(struct slc_residency *residency, uint32_t index)
{
    struct paged_residency *p = paged(residency);
    slc_page_share_leave(p->pool, p->user, p->images[index].source);
}

static void drop_source(struct slc_residency *residency, uint32_t index)
{
    struct paged_residency *p = paged(residency);
    p->images[index].generation = slc_page_share_drop(p->pool, p->images[index].source);
}

static void spoil(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    uint32_t *entry = &p->table.entries[word_of(p, index, tile)];
    if (!slc_page_is_taken(*entry))
        *entry = SLUICE_PAGE_NONE;
}

static bool renew(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    uint32_t *entry = &p->table.entries[word_of(p, index, tile)];
    assert(slc_page_is_taken(*entry));
    uint32_t page = slc_page_of_entry(*entry);
    if (!slc_page_is_shared(p->pool, p->user, page))
        return true;
    uint32_t own = slc_page_pool_take(p->pool, p->user, p->images[index].page_format);
    count_memory(p);
    if (own == SLUICE_PAGE_NONE)
        return false;
    if (!slc_page_views_has(slc_page_pool_views(p->pool, p->user), own >> 16)) {
        /* A chunk made in this frame has neither layout nor view before the next frame. */
        slc_page_pool_give(p->pool, p->user, own, SLC_NO_OWNER);
        return false;
    }
    slc_page_pool_give(p->pool, p->user, page, SLC_NO_OWNER);
    *entry = own | SLC_PAGE_SHOWN;
    return true;
}

static SluiceResult map(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    const struct paged_image *image = &p->images[index];
    if (tile->mipLevel >= p->table.parts[index].desc.regularMipCount)
        return SLUICE_SUCCESS; /* packed levels are in an image of their own */
    uint32_t *page = &p->table.entries[word_of(p, index, tile)];
    assert(!slc_page_is_taken(*page));
    *page = slc_page_pool_take(p->pool, p->user, image->page_format);
    count_memory(p);
    if (*page == SLUICE_PAGE_NONE)
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    const struct slc_tile_key key = key_of(p, index, tile);
    slc_page_share_place(p->pool, p->user, &key, *page);
    return SLUICE_SUCCESS;
}

/* Gives the page back at once: this frame hides the tile, and its copies wait for earlier frames.
 */
static void unmap(struct slc_residency *residency, uint32_t index, const SluiceTile *tile,
                  uint64_t frame, bool filled)
{
    struct paged_residency *p = paged(residency);
    (void)frame;
    if (tile->mipLevel >= p->table.parts[index].desc.regularMipCount)
        return;
    uint32_t word = word_of(p, index, tile), *entry = &p->table.entries[word];
    assert(slc_page_is_taken(*entry));
    uint32_t page = slc_page_of_entry(*entry);
    slc_page_pool_give(p->pool, p->user, page, filled ? word : SLC_NO_OWNER);
    *entry = filled ? page | SLC_PAGE_GIVEN : SLUICE_PAGE_NONE;
    slc_page_table_store(&p->table, index, word, p->frame);
}

static void discard(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    if (tile->mipLevel >= p->table.parts[index].desc.regularMipCount)
        return;
    uint32_t *entry = &p->table.entries[word_of(p, index, tile)];
    assert(slc_page_is_taken(*entry) && !(*entry & SLC_PAGE_SHOWN));
    slc_page_pool_give(p->pool, p->user, slc_page_of_entry(*entry), SLC_NO_OWNER);
    *entry = SLUICE_PAGE_NONE;
}

static struct slc_tile_page find_page(const struct slc_residency *residency, uint32_t index,
                                      const SluiceTile *tile)
{
    const struct paged_residency *p = (const struct paged_residency *)residency;
    uint32_t entry = p->table.entries[word_of(p, index, tile)];
    assert(slc_page_is_taken(entry));
    uint32_t page = slc_page_of_entry(entry);
    return (struct slc_tile_page){slc_page_image(p->pool, page),
                                  slc_page_storage_view(p->pool, page), page >> 16, page & 0xFFFFu};
}

static void show(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    uint32_t word = word_of(p, index, tile);
    assert(slc_page_is_taken(p->table.entries[word]));
    p->table.entries[word] |= SLC_PAGE_SHOWN;
    slc_page_table_store(&p->table, index, word, p->frame);
}

/* The texels are complete: a tile is copied before it is shown, and only shown tiles are unmapped.
 */
static bool revive(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    uint32_t word = word_of(p, index, tile), *entry = &p->table.entries[word];
    assert(!slc_page_is_taken(*entry));
    if (*entry == SLUICE_PAGE_NONE)
        return false;
    uint32_t page = slc_page_of_entry(*entry);
    bool there = slc_page_pool_retake(p->pool, p->user, page, word);
    *entry = there ? page | SLC_PAGE_SHOWN : SLUICE_PAGE_NONE;
    if (!there)
        return false;
    const struct slc_tile_key key = key_of(p, index, tile);
    if (key.source)
        slc_page_share_adopt(p->pool, p->user, &key, page);
    slc_page_table_store(&p->table, index, word, p->frame);
    return true;
}

static enum slc_share share(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    const struct slc_tile_key key = key_of(p, index, tile);
    enum slc_share answer = slc_page_share_look(p->pool, p->user, &key);
    if (answer != SLC_SHARE_READY)
        return answer;
    uint32_t word = word_of(p, index, tile);
    assert(!slc_page_is_taken(p->table.entries[word]));
    uint32_t page = slc_page_share_take(p->pool, p->user, &key);
    if (page == SLUICE_PAGE_NONE)
        return SLC_SHARE_NONE;
    p->table.entries[word] = page | SLC_PAGE_SHOWN;
    slc_page_table_store(&p->table, index, word, p->frame);
    return SLC_SHARE_READY;
}

static uint32_t room_to_unmap(const struct slc_residency *residency)
{
    const struct paged_residency *p = (const struct paged_residency *)residency;
    uint32_t taken = p->upload_reserve + p->table.store_count;
    return taken < p->table.store_capacity ? p->table.store_capacity - taken : 0;
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

static void record_begin(struct slc_residency *residency, uint64_t frame, VkCommandBuffer commands)
{
    struct paged_residency *p = paged(residency);
    slc_page_table_record_begin(&p->table, frame, commands);
    slc_page_moves_record(&p->moves, frame, commands);
    count_memory(p);
}

static void abandon(struct slc_residency *residency, uint64_t frame)
{
    slc_page_moves_abandon(&paged(residency)->moves, frame);
    slc_page_table_abandon(&paged(residency)->table, frame);
}

static uint32_t round_up(uint32_t size, uint32_t to)
{
    return slc_div_up_u32(size, to) * to;
}

/* Redirects a copy to the page or tail with the texels. Returns the image. */
static VkImage place_copy(struct paged_residency *p, uint32_t index, VkBufferImageCopy *copy,
                          bool shows)
{
    const struct paged_image *image = &p->images[index];
    const SluiceStreamedTextureDesc *desc = &p->table.parts[index].desc;
    uint32_t level = copy->imageSubresource.mipLevel;
    if (level >= desc->regularMipCount) {
        copy->imageSubresource.mipLevel = level - desc->regularMipCount;
        return image->tail;
    }
    uint32_t x = (uint32_t)copy->imageOffset.x / desc->tileWidth;
    uint32_t y = (uint32_t)copy->imageOffset.y / desc->tileHeight;
    uint32_t word = slc_page_table_word(&p->table, index, level, x, y);
    assert(slc_page_is_taken(p->table.entries[word]));
    uint32_t page = slc_page_of_entry(p->table.entries[word]);
    if (shows) {
        p->table.entries[word] |= SLC_PAGE_SHOWN;
        slc_page_share_written(p->pool, p->user, page, p->frame);
        slc_page_table_store(&p->table, index, word, p->frame);
    }
    copy->imageSubresource.mipLevel = 0;
    copy->imageSubresource.baseArrayLayer = page & 0xFFFFu;
    copy->imageOffset.x %= (int32_t)desc->tileWidth;
    copy->imageOffset.y %= (int32_t)desc->tileHeight;
    /* A tile at the edge ends inside the page, and must end with a whole block there. */
    copy->imageExtent.width = round_up(copy->imageExtent.width, image->block_width);
    copy->imageExtent.height = round_up(copy->imageExtent.height, image->block_height);
    return slc_page_image(p->pool, page);
}

static void record_uploads(struct slc_residency *residency, uint32_t index,
                           VkCommandBuffer commands, VkBuffer buffer, uint32_t count,
                           const VkBufferImageCopy *regions, uint32_t parts)
{
    struct paged_residency *p = paged(residency);
    VkBufferImageCopy copies[COPY_BATCH];
    VkImage target = VK_NULL_HANDLE;
    uint32_t copy_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        VkBufferImageCopy copy = regions[i];
        VkImage image = place_copy(p, index, &copy, parts & SLC_UPLOAD_SHOW);
        if (!(parts & SLC_UPLOAD_COPY))
            continue;
        if (copy_count && (image != target || copy_count == COPY_BATCH)) {
            p->vk->CmdCopyBufferToImage(commands, buffer, target, VK_IMAGE_LAYOUT_GENERAL,
                                        copy_count, copies);
            copy_count = 0;
        }
        target = image;
        copies[copy_count++] = copy;
    }
    if (copy_count)
        p->vk->CmdCopyBufferToImage(commands, buffer, target, VK_IMAGE_LAYOUT_GENERAL, copy_count,
                                    copies);
}

static void record_publish(struct slc_residency *residency, VkCommandBuffer commands)
{
    slc_page_table_record_publish(&paged(residency)->table, commands);
}

static const struct slc_buffer *page_table(const struct slc_residency *residency)
{
    return &((const struct paged_residency *)residency)->table.buffer;
}

static uint32_t page_table_offset(const struct slc_residency *residency, uint32_t index)
{
    return ((const struct paged_residency *)residency)->table.parts[index].first_word;
}

static void destroy(struct slc_residency *residency)
{
    struct paged_residency *p = paged(residency);
    const SluiceAllocationCallbacks *cb = p->cb;
    if (p->images)
        for (uint32_t i = 0; i < p->max_image_count; i++)
            slc_plain_image_destroy(&p->images[i].own_tail, &p->memory, p->vk, cb);
    slc_image_memory_finish(&p->memory, cb);
    slc_page_table_finish(&p->table);
    slc_free(cb, p->images, p->max_image_count, sizeof *p->images);
    slc_free(cb, p, 1, sizeof *p);
}

static const struct slc_residency_interface paged_interface = {
    .destroy = destroy,
    .create_image = create_image,
    .destroy_image = destroy_image,
    .image_is_idle = image_is_idle,
    .revive = revive,
    .set_source = set_source,
    .share = share,
    .announce = announce,
    .withdraw = withdraw,
    .leave_source = leave_source,
    .drop_source = drop_source,
    .spoil = spoil,
    .renew = renew,
    .page_room = page_room,
    .gather = gather,
    .compact = compact,
    .allocate_heap = allocate_heap,
    .release_heap = release_heap,
    .update = update,
    .map = map,
    .unmap = unmap,
    .discard = discard,
    .find_page = find_page,
    .show = show,
    .room_to_unmap = room_to_unmap,
    .submit = submit,
    .wait = wait,
    .completed_value = completed_value,
    .retire_limit = retire_limit,
    .record_begin = record_begin,
    .record_uploads = record_uploads,
    .record_publish = record_publish,
    .abandon = abandon,
    .page_table = page_table,
    .page_table_offset = page_table_offset,
};

/* A chain has less than twice the tiles of level 0, apart from rounding up at the edges. */
static uint32_t table_size(const struct slc_residency_create_info *info)
{
    uint64_t words = 2ull * info->max_region_count + 64ull * info->max_image_count;
    uint64_t limit = info->caps->max_storage_buffer_range / 4;
    return (uint32_t)(words < limit ? words : limit);
}

SluiceResult slc_create_paged_residency(const struct slc_residency_create_info *info,
                                        struct slc_residency **residency)
{
    struct paged_residency *p = slc_calloc(info->cb, 1, sizeof *p);
    if (!p)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    p->base.interface = &paged_interface;
    p->vk = info->vk;
    p->caps = info->caps;
    p->cb = info->cb;
    p->memory.quiet = info->may_lack_memory;
    p->pool = info->pages;
    p->user = info->page_user;
    p->max_image_count = info->max_image_count;
    p->packed_outside = info->packed_outside;
    /* four kinds of changes: copied, revived, shared, deferred tiles; and moves */
    p->upload_reserve = 4 * info->max_changes + SLC_PAGE_MOVES_PER_FRAME;
    p->moves.pool = p->pool;
    p->moves.table = &p->table;
    p->moves.user = p->user;
    p->moves.store_reserve = p->upload_reserve;
    p->images = slc_calloc(p->cb, p->max_image_count, sizeof *p->images);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (p->images)
        result = slc_page_table_init(&p->table, p->vk, p->caps, p->cb, table_size(info),
                                     p->max_image_count, 8 * info->max_changes);
    if (result != SLUICE_SUCCESS) {
        destroy(&p->base);
        return result;
    }
    count_memory(p);
    *residency = &p->base;
    return SLUICE_SUCCESS;
}
