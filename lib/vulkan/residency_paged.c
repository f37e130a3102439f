/*
 * Residency by a page table that shaders read: tiles are layers of array images (page_pool.h), and
 * a table in a storage buffer says which. The packed levels are an ordinary image of their own.
 *
 * Nothing has to be waited for: copies and stores to the table are recorded behind a barrier on the
 * queue that draws, so earlier frames have read a page before it is overwritten, and a frame that
 * no longer shows a tile may give its page away (docs/decisions/0023-paged-residency.md).
 */
#include "vulkan/residency.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "vulkan/buffer.h"
#include "vulkan/page_pool.h"
#include "vulkan/sparse_layout.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* In `pages`: the tile was unmapped, and may still be on that page. Also a bit of SLUICE_PAGE_NONE.
 */
#define PAGE_GIVEN 0x8000u
/* In `pages`: the table shows the page, as its texels are there. */
#define PAGE_SHOWN 0x4000u
#define COPY_BATCH 64u
#define STORE_BATCH 256u /* words */

/* The layers of an array have parts of the table of their own and share the tail. */
struct paged_image {
    struct slc_plain_image own_tail; ///< the packed levels; owned by layer 0, of all layers
    VkImage tail;
    uint32_t layer_count; ///< 0 but for layer 0
    SluiceStreamedTextureDesc desc;
    const SluiceImageSource *source; ///< borrowed
    uint32_t source_layer;
    SluiceFormat format;
    uint32_t block_width, block_height; ///< texels
    uint32_t first_word, word_count;    ///< in the table; 0: all levels are packed
    uint64_t recorded_frame;            ///< that wrote its part of the table; 0: none did
    uint64_t stored_frame;              ///< the last that stored words there
    bool is_lost;                       ///< the device may have other words than are in `pages`
};

/* A word of the table that changes with this frame. */
struct store {
    uint32_t word, value;
    uint32_t turn; ///< of equal words the last one counts
};

struct paged_residency {
    struct slc_residency base; ///< must be first
    const struct slc_vk *vk;
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    struct slc_image_memory memory; ///< of tails
    struct slc_page_pool *pool;     ///< borrowed
    uint32_t user;                  ///< of the pool
    struct paged_image *images;     ///< owned
    uint32_t *new_images;           ///< owned; whose part of the table is not written yet
    uint32_t new_image_count, max_image_count;

    struct slc_buffer table;
    struct slc_region_arena arena; ///< its words
    uint32_t *pages;               ///< owned; by word: the page that was taken, shown or not;
                                   ///< or, with PAGE_GIVEN, that was given back
    struct store *stores;          ///< owned
    uint32_t store_count, store_capacity, upload_reserve;
    uint64_t frame, completed_frame;
    bool has_lost; ///< some image is
    uint32_t next_heap, heap_count;
};

static struct paged_residency *paged(struct slc_residency *residency)
{
    return (struct paged_residency *)residency;
}

static void count_memory(struct paged_residency *p)
{
    struct slc_page_pool_counts pool = slc_page_pool_get_counts(p->pool);
    p->base.counters.device_memory_size =
        p->memory.total_size + pool.tile_memory_size + p->table.size;
    p->base.counters.page_chunks = pool.chunk_count;
    p->base.counters.page_chunk_shortages = pool.shortages;
}

static uint32_t level_width(const SluiceStreamedTextureDesc *desc, uint32_t level)
{
    return slc_div_up_u32(slc_mip_size(desc->width, level), desc->tileWidth);
}

/* The first word of a level's tiles, from the beginning of the texture's part of the table: before
 * them stands one word per level that says this to shaders. */
static uint32_t level_word(const SluiceStreamedTextureDesc *desc, uint32_t level)
{
    uint32_t word = desc->regularMipCount;
    for (uint32_t i = 0; i < level; i++)
        word +=
            level_width(desc, i) * slc_div_up_u32(slc_mip_size(desc->height, i), desc->tileHeight);
    return word;
}

static uint32_t tile_word(const struct paged_image *image, uint32_t level, uint32_t x, uint32_t y)
{
    return image->first_word + level_word(&image->desc, level) +
           y * level_width(&image->desc, level) + x;
}

static SluiceResult take_words(struct paged_residency *p, struct paged_image *image)
{
    const SluiceStreamedTextureDesc *desc = &image->desc;
    if (desc->regularMipCount == 0)
        return SLUICE_SUCCESS;
    uint32_t count = level_word(desc, desc->regularMipCount);
    if (!slc_region_arena_take(&p->arena, count, &image->first_word))
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    image->word_count = count;
    memset(p->pages + image->first_word, 0xFF, (size_t)count * sizeof *p->pages);
    return SLUICE_SUCCESS;
}

static bool is_taken(uint32_t page)
{
    return !(page & PAGE_GIVEN);
}

static uint32_t page_of(uint32_t entry)
{
    return entry & ~(PAGE_GIVEN | PAGE_SHOWN);
}

static void give_words(struct paged_residency *p, const struct paged_image *image)
{
    for (uint32_t i = image->desc.regularMipCount; i < image->word_count; i++)
        if (is_taken(p->pages[image->first_word + i]))
            slc_page_pool_give(p->pool, p->user, page_of(p->pages[image->first_word + i]),
                               SLC_NO_OWNER);
    if (image->word_count)
        slc_region_arena_give(&p->arena, image->first_word, image->word_count);
}

static void forget_new(struct paged_residency *p, uint32_t index)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < p->new_image_count; i++)
        if (p->new_images[i] != index)
            p->new_images[kept++] = p->new_images[i];
    p->new_image_count = kept;
}

/* Also of one that was not created to the end. */
static void destroy_image(struct slc_residency *residency, uint32_t index)
{
    struct paged_residency *p = paged(residency);
    struct paged_image *layers = &p->images[index];
    slc_plain_image_destroy(&layers[0].own_tail, &p->memory, p->vk, p->cb);
    for (uint32_t i = layers[0].layer_count; i-- > 0;) {
        forget_new(p, index + i);
        give_words(p, &layers[i]);
        layers[i] = (struct paged_image){0};
    }
    count_memory(p);
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
    image->desc = *desc;
    image->format = format;
    image->block_width = info.blockWidth;
    image->block_height = info.blockHeight;
    result = take_words(p, image);
    if (result == SLUICE_SUCCESS && image->word_count)
        p->new_images[p->new_image_count++] = index;
    return result;
}

static SluiceResult create_image(struct slc_residency *residency, uint32_t index,
                                 const SluiceImageInfo *info, struct slc_residency_image *out)
{
    struct paged_residency *p = paged(residency);
    struct paged_image *first = &p->images[index];
    uint32_t layer_count = slc_max_u32(1, info->arrayLayerCount);
    struct slc_sparse_layout layout;
    SluiceResult result = slc_standard_layout_init(&layout, info);
    if (result == SLUICE_SUCCESS)
        result = slc_plain_image_create(&first->own_tail, &p->memory, p->vk, p->caps, p->cb, info,
                                        layout.desc.regularMipCount, layer_count);
    if (result != SLUICE_SUCCESS)
        return result;
    first->layer_count = layer_count;
    for (uint32_t i = 0; i < layer_count && result == SLUICE_SUCCESS; i++)
        result = create_layer(p, index + i, info->format, &layout.desc, first->own_tail.image);
    if (result != SLUICE_SUCCESS) {
        destroy_image(residency, index);
        return result;
    }
    count_memory(p);
    *out = (struct slc_residency_image){
        .image = first->tail, .desc = layout.desc, .uneven = layout.uneven};
    return SLUICE_SUCCESS;
}

static bool image_is_idle(const struct slc_residency *residency, uint32_t index)
{
    (void)residency, (void)index;
    return true;
}

/* A heap is a share of the budget; memory comes with the pages. */
static SluiceResult allocate_heap(struct slc_residency *residency, uint64_t size, uint32_t *heap_id)
{
    struct paged_residency *p = paged(residency);
    if (slc_page_pool_is_refused(p->pool) || size > slc_device_memory_size(p->caps))
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    /* After a refusal slots must not run ahead of the pages that there are. */
    uint64_t slots = p->heap_count * (size / SLC_TILE_SIZE);
    if (slc_page_pool_was_refused(p->pool) && slots > slc_page_pool_present(p->pool, p->user))
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

static uint32_t page_room(const struct slc_residency *residency, uint32_t index)
{
    const struct paged_residency *p = (const struct paged_residency *)residency;
    return slc_page_pool_free_count(p->pool, p->user, p->images[index].format);
}

static SluiceResult update(struct slc_residency *residency, uint64_t frame,
                           uint64_t completed_frame)
{
    paged(residency)->frame = frame;
    paged(residency)->completed_frame = completed_frame;
    return SLUICE_SUCCESS;
}

static struct slc_tile_key key_of(const struct paged_image *image, const SluiceTile *tile)
{
    return (struct slc_tile_key){image->source, image->source_layer, tile->mipLevel, tile->x,
                                 tile->y};
}

static void set_source(struct slc_residency *residency, uint32_t index,
                       const SluiceImageSource *source, uint32_t layer)
{
    struct paged_image *image = &paged(residency)->images[index];
    image->source = source;
    image->source_layer = layer;
}

static void announce(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    const struct slc_tile_key key = key_of(&p->images[index], tile);
    slc_page_share_announce(p->pool, p->user, &key);
}

static void withdraw(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    const struct slc_tile_key key = key_of(&p->images[index], tile);
    slc_page_share_withdraw(p->pool, p->user, &key);
}

static void leave_source(struct slc_residency *residency, uint32_t index)
{
    struct paged_residency *p = paged(residency);
    slc_page_share_leave(p->pool, p->user, p->images[index].source);
}

static SluiceResult map(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    const struct paged_image *image = &p->images[index];
    if (tile->mipLevel >= image->desc.regularMipCount)
        return SLUICE_SUCCESS; /* the packed levels have their own image */
    uint32_t *page = &p->pages[tile_word(image, tile->mipLevel, tile->x, tile->y)];
    assert(!is_taken(*page));
    *page = slc_page_pool_take(p->pool, p->user, image->format);
    count_memory(p);
    if (*page == SLUICE_PAGE_NONE)
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    const struct slc_tile_key key = key_of(image, tile);
    slc_page_share_place(p->pool, p->user, &key, *page);
    return SLUICE_SUCCESS;
}

/* What the table is to show of the entry in `pages` from this frame on. */
static void store(struct paged_residency *p, struct paged_image *image, uint32_t word)
{
    uint32_t entry = p->pages[word], turn = p->store_count++;
    bool shown = is_taken(entry) && entry & PAGE_SHOWN;
    assert(turn < p->store_capacity);
    p->stores[turn] = (struct store){word, shown ? page_of(entry) : SLUICE_PAGE_NONE, turn};
    image->stored_frame = p->frame;
}

/* This frame's maps no longer show it, and earlier frames come before what this frame copies. */
static void unmap(struct slc_residency *residency, uint32_t index, const SluiceTile *tile,
                  uint64_t frame, bool filled)
{
    struct paged_residency *p = paged(residency);
    struct paged_image *image = &p->images[index];
    (void)frame;
    if (tile->mipLevel >= image->desc.regularMipCount)
        return;
    uint32_t word = tile_word(image, tile->mipLevel, tile->x, tile->y);
    assert(is_taken(p->pages[word]));
    uint32_t page = page_of(p->pages[word]);
    slc_page_pool_give(p->pool, p->user, page, filled ? word : SLC_NO_OWNER);
    p->pages[word] = filled ? page | PAGE_GIVEN : SLUICE_PAGE_NONE;
    store(p, image, word);
}

/* A tile was copied to its page before it was shown, and only what is shown is unmapped. */
static bool revive(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    uint32_t word = tile_word(&p->images[index], tile->mipLevel, tile->x, tile->y);
    assert(!is_taken(p->pages[word]));
    if (p->pages[word] == SLUICE_PAGE_NONE)
        return false;
    uint32_t page = page_of(p->pages[word]);
    bool there = slc_page_pool_retake(p->pool, p->user, page, word);
    p->pages[word] = there ? page | PAGE_SHOWN : SLUICE_PAGE_NONE;
    if (!there)
        return false;
    const struct slc_tile_key key = key_of(&p->images[index], tile);
    slc_page_share_adopt(p->pool, p->user, &key, page);
    store(p, &p->images[index], word);
    return true;
}

static enum slc_share share(struct slc_residency *residency, uint32_t index, const SluiceTile *tile)
{
    struct paged_residency *p = paged(residency);
    struct paged_image *image = &p->images[index];
    const struct slc_tile_key key = key_of(image, tile);
    enum slc_share answer = slc_page_share_look(p->pool, p->user, &key);
    if (answer != SLC_SHARE_READY)
        return answer;
    uint32_t word = tile_word(image, tile->mipLevel, tile->x, tile->y);
    assert(!is_taken(p->pages[word]));
    uint32_t page = slc_page_share_take(p->pool, p->user, &key);
    if (page == SLUICE_PAGE_NONE)
        return SLC_SHARE_NONE;
    p->pages[word] = page | PAGE_SHOWN;
    store(p, image, word);
    return SLC_SHARE_READY;
}

static uint32_t room_to_unmap(const struct slc_residency *residency)
{
    const struct paged_residency *p = (const struct paged_residency *)residency;
    uint32_t taken = p->upload_reserve + p->store_count;
    return taken < p->store_capacity ? p->store_capacity - taken : 0;
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

/* Before the tiles of a level stands where they begin. */
static void record_header(struct paged_residency *p, const struct paged_image *image,
                          VkCommandBuffer commands)
{
    uint32_t levels = image->desc.regularMipCount, header[SLUICE_MAX_MIP_LEVELS];
    for (uint32_t level = 0; level < levels; level++)
        header[level] = image->first_word + level_word(&image->desc, level);
    VkDeviceSize first = (VkDeviceSize)image->first_word * 4;
    p->vk->CmdUpdateBuffer(commands, p->table.buffer, first, levels * 4, header);
}

static void fill_none(struct paged_residency *p, uint32_t first, uint32_t count,
                      VkCommandBuffer commands)
{
    if (count)
        p->vk->CmdFillBuffer(commands, p->table.buffer, (VkDeviceSize)first * 4,
                             (VkDeviceSize)count * 4, SLUICE_PAGE_NONE);
}

static void record_no_pages(struct paged_residency *p, const struct paged_image *image,
                            VkCommandBuffer commands)
{
    uint32_t levels = image->desc.regularMipCount;
    fill_none(p, image->first_word + levels, image->word_count - levels, commands);
}

static bool is_shown(const struct paged_residency *p, uint32_t word)
{
    return is_taken(p->pages[word]) && p->pages[word] & PAGE_SHOWN;
}

/* Every word of its tiles, as they are before this frame's stores or already with them. */
static void record_words(struct paged_residency *p, const struct paged_image *image,
                         VkCommandBuffer commands)
{
    uint32_t run[STORE_BATCH], end = image->first_word + image->word_count;
    for (uint32_t word = image->first_word + image->desc.regularMipCount; word < end;) {
        uint32_t first = word, count = 0;
        while (word < end && !is_shown(p, word))
            word++;
        fill_none(p, first, word - first, commands);
        for (first = word; word < end && count < STORE_BATCH && is_shown(p, word); word++)
            run[count++] = page_of(p->pages[word]);
        if (count)
            p->vk->CmdUpdateBuffer(commands, p->table.buffer, (VkDeviceSize)first * 4, count * 4,
                                   run);
    }
}

static void record_lost(struct paged_residency *p, uint64_t frame, VkCommandBuffer commands)
{
    for (uint32_t i = 0; i < p->max_image_count; i++) {
        struct paged_image *image = &p->images[i];
        if (!image->is_lost)
            continue;
        record_words(p, image, commands);
        image->stored_frame = frame;
        image->is_lost = false;
    }
    p->has_lost = false;
}

static void record_begin(struct slc_residency *residency, uint64_t frame, VkCommandBuffer commands)
{
    struct paged_residency *p = paged(residency);
    for (uint32_t i = 0; i < p->new_image_count; i++) {
        struct paged_image *image = &p->images[p->new_images[i]];
        record_header(p, image, commands);
        if (!image->is_lost)
            record_no_pages(p, image, commands);
        image->recorded_frame = frame;
    }
    p->new_image_count = 0;
    if (p->has_lost)
        record_lost(p, frame, commands);
    count_memory(p);
}

static void abandon(struct slc_residency *residency, uint64_t frame)
{
    struct paged_residency *p = paged(residency);
    p->store_count = 0; /* of a begin that failed: lost images are written again */
    for (uint32_t i = 0; i < p->max_image_count; i++) {
        struct paged_image *image = &p->images[i];
        if (image->recorded_frame >= frame) {
            image->recorded_frame = 0;
            p->new_images[p->new_image_count++] = i;
            image->is_lost = true;
        }
        image->is_lost |= image->stored_frame >= frame;
        p->has_lost |= image->is_lost;
    }
}

static uint32_t round_up(uint32_t size, uint32_t to)
{
    return slc_div_up_u32(size, to) * to;
}

/* The copy into the image that holds the texels; which one that is. */
static VkImage place_copy(struct paged_residency *p, struct paged_image *image,
                          VkBufferImageCopy *copy)
{
    const SluiceStreamedTextureDesc *desc = &image->desc;
    uint32_t level = copy->imageSubresource.mipLevel;
    if (level >= desc->regularMipCount) {
        copy->imageSubresource.mipLevel = level - desc->regularMipCount;
        return image->tail;
    }
    uint32_t word = tile_word(image, level, (uint32_t)copy->imageOffset.x / desc->tileWidth,
                              (uint32_t)copy->imageOffset.y / desc->tileHeight);
    assert(is_taken(p->pages[word]));
    uint32_t page = page_of(p->pages[word]);
    p->pages[word] |= PAGE_SHOWN;
    slc_page_share_written(p->pool, p->user, page, p->frame);
    copy->imageSubresource.mipLevel = 0;
    copy->imageSubresource.baseArrayLayer = page & 0xFFFFu;
    copy->imageOffset.x %= (int32_t)desc->tileWidth;
    copy->imageOffset.y %= (int32_t)desc->tileHeight;
    /* A tile at the edge ends inside the page, where only whole blocks may end. */
    copy->imageExtent.width = round_up(copy->imageExtent.width, image->block_width);
    copy->imageExtent.height = round_up(copy->imageExtent.height, image->block_height);
    store(p, image, word);
    return slc_page_image(p->pool, page);
}

static void record_uploads(struct slc_residency *residency, uint32_t index,
                           VkCommandBuffer commands, VkBuffer buffer, uint32_t count,
                           const VkBufferImageCopy *regions)
{
    struct paged_residency *p = paged(residency);
    VkBufferImageCopy copies[COPY_BATCH];
    VkImage target = VK_NULL_HANDLE;
    uint32_t copy_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        VkBufferImageCopy copy = regions[i];
        VkImage image = place_copy(p, &p->images[index], &copy);
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

/* By word; of a tile that went and came in one frame, as it did. */
static int compare_stores(const void *a, const void *b)
{
    const struct store *x = a, *y = b;
    if (x->word != y->word)
        return x->word < y->word ? -1 : 1;
    return x->turn < y->turn ? -1 : 1;
}

static void record_publish(struct slc_residency *residency, VkCommandBuffer commands)
{
    struct paged_residency *p = paged(residency);
    uint32_t run[STORE_BATCH], run_count = 0, first = 0;
    if (p->store_count > 1)
        qsort(p->stores, p->store_count, sizeof *p->stores, compare_stores);
    for (uint32_t i = 0; i < p->store_count; i++) {
        const struct store *s = &p->stores[i];
        if (i + 1 < p->store_count && s[1].word == s->word)
            continue;
        if (run_count && (s->word != first + run_count || run_count == STORE_BATCH)) {
            p->vk->CmdUpdateBuffer(commands, p->table.buffer, (VkDeviceSize)first * 4,
                                   run_count * 4, run);
            run_count = 0;
        }
        if (run_count == 0)
            first = s->word;
        run[run_count++] = s->value;
    }
    if (run_count)
        p->vk->CmdUpdateBuffer(commands, p->table.buffer, (VkDeviceSize)first * 4, run_count * 4,
                               run);
    p->store_count = 0;
}

static VkBuffer page_table(const struct slc_residency *residency)
{
    return ((const struct paged_residency *)residency)->table.buffer;
}

static uint32_t page_table_offset(const struct slc_residency *residency, uint32_t index)
{
    return ((const struct paged_residency *)residency)->images[index].first_word;
}

static void destroy(struct slc_residency *residency)
{
    struct paged_residency *p = paged(residency);
    const SluiceAllocationCallbacks *cb = p->cb;
    if (p->images)
        for (uint32_t i = 0; i < p->max_image_count; i++)
            slc_plain_image_destroy(&p->images[i].own_tail, &p->memory, p->vk, cb);
    slc_image_memory_finish(&p->memory, cb);
    slc_buffer_finish(&p->table, p->vk);
    slc_free(cb, p->stores, p->store_capacity, sizeof *p->stores);
    slc_free(cb, p->pages, p->arena.size, sizeof *p->pages);
    slc_free(cb, p->new_images, p->max_image_count, sizeof *p->new_images);
    slc_free(cb, p->images, p->max_image_count, sizeof *p->images);
    slc_region_arena_finish(&p->arena, cb);
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
    .page_room = page_room,
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
    .record_begin = record_begin,
    .record_uploads = record_uploads,
    .record_publish = record_publish,
    .abandon = abandon,
    .page_table = page_table,
    .page_table_offset = page_table_offset,
};

/* A chain has less than twice the tiles of level 0, but for rounding up at the edges. */
static uint32_t table_size(const struct slc_residency_create_info *info)
{
    uint64_t words = 2ull * info->max_region_count + 64ull * info->max_image_count;
    uint64_t limit = info->caps->max_storage_buffer_range / 4;
    return (uint32_t)(words < limit ? words : limit);
}

static SluiceResult create_arrays(struct paged_residency *p,
                                  const struct slc_residency_create_info *info)
{
    SluiceResult result =
        slc_region_arena_init(&p->arena, p->cb, table_size(info), info->max_image_count);
    if (result != SLUICE_SUCCESS)
        return result;
    p->max_image_count = info->max_image_count;
    p->upload_reserve = 4 * info->max_changes; /* copied, revived, shared, deferred */
    p->store_capacity = 8 * info->max_changes;
    p->images = slc_calloc(p->cb, p->max_image_count, sizeof *p->images);
    p->new_images = slc_alloc(p->cb, p->max_image_count, sizeof *p->new_images);
    p->pages = slc_alloc(p->cb, p->arena.size, sizeof *p->pages);
    p->stores = slc_alloc(p->cb, p->store_capacity, sizeof *p->stores);
    if (!p->images || !p->new_images || !p->pages || !p->stores)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    return SLUICE_SUCCESS;
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
    p->pool = info->pages;
    p->user = info->page_user;
    SluiceResult result = create_arrays(p, info);
    if (result == SLUICE_SUCCESS)
        result =
            slc_buffer_init(&p->table, p->vk, p->caps, (uint64_t)p->arena.size * 4,
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                            SLC_BUFFER_DEVICE);
    if (result != SLUICE_SUCCESS) {
        destroy(&p->base);
        return result;
    }
    count_memory(p);
    *residency = &p->base;
    return SLUICE_SUCCESS;
}
