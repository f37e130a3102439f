/**
 * Page table of paged mode, which shaders read (sluice/paged.glsl): a buffer of words, with one
 * part per texture. A part begins with one word per regular level, the index of the level's first
 * tile. A word per tile follows: its page, or SLUICE_PAGE_NONE.
 *
 * Tiles take, show and give back pages here. The device gets these changes with the next
 * slc_page_table_record_publish.
 */
#ifndef SLC_VULKAN_PAGE_TABLE_H
#define SLC_VULKAN_PAGE_TABLE_H

#include "vulkan/buffer.h"
#include "vulkan/region_arena.h"

#include <sluice/manager.h>

/* Bit of an entry: the tile was unmapped, and may still be on that page. SLUICE_PAGE_NONE has this
 * bit, too. */
#define SLC_PAGE_GIVEN 0x8000u
/* Bit of an entry: shaders see the page, because its texels are there. */
#define SLC_PAGE_SHOWN 0x4000u

struct slc_page_table_part {
    SluiceStreamedTextureDesc desc;
    uint32_t first_word, word_count; ///< 0: all levels are packed
    uint64_t recorded_frame;         ///< frame that wrote the part; 0: none
    uint64_t stored_frame;           ///< last frame that stored words of the part
    bool is_lost;                    ///< the device may have other words than `entries`
};

struct slc_page_store;

struct slc_page_table {
    const struct slc_vk *vk; ///< borrowed
    const SluiceAllocationCallbacks *cb;
    struct slc_buffer buffer;
    struct slc_region_arena arena;     ///< words of `buffer`
    struct slc_page_table_part *parts; ///< owned; by texture
    uint32_t part_count;
    uint32_t *new_parts; ///< owned; parts that are not written yet
    uint32_t new_part_count;
    uint32_t *entries;             ///< owned; by word: the page that was taken, shown or not; with
                                   ///< SLC_PAGE_GIVEN: the page that was given back
    struct slc_page_store *stores; ///< owned
    uint32_t store_count, store_capacity;
    bool has_lost; ///< some part has is_lost set
};

/** `change_count`: most calls of slc_page_table_store between two publications, unless
 *  slc_page_table_make_room allows more. Finish the table
 *  after an error, too. Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_page_table_init(struct slc_page_table *table, const struct slc_vk *vk,
                                 const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                 uint32_t word_count, uint32_t part_count, uint32_t change_count);
void slc_page_table_finish(struct slc_page_table *table);

/** Adds a part. None of its tiles is on a page. Errors: LIMIT_EXCEEDED. */
SluiceResult slc_page_table_add(struct slc_page_table *table, uint32_t part,
                                const SluiceStreamedTextureDesc *desc);
/** Removes a part. Does not give its pages back. */
void slc_page_table_remove(struct slc_page_table *table, uint32_t part);

uint32_t slc_page_table_word(const struct slc_page_table *table, uint32_t part, uint32_t level,
                             uint32_t x, uint32_t y);

static inline bool slc_page_is_taken(uint32_t entry)
{
    return !(entry & SLC_PAGE_GIVEN);
}

static inline uint32_t slc_page_of_entry(uint32_t entry)
{
    return entry & ~(SLC_PAGE_GIVEN | SLC_PAGE_SHOWN);
}

/** Stores the entry of the word for the device. Its shaders see it from `frame` on. */
void slc_page_table_store(struct slc_page_table *table, uint32_t part, uint32_t word,
                          uint64_t frame);

/** Makes room for `count` more stores in this frame. Returns false without host memory. */
bool slc_page_table_make_room(struct slc_page_table *table, uint32_t count);

/** Records whole parts: new ones, and those that abandoned frames wrote to. Call it before
 *  anything is drawn. */
void slc_page_table_record_begin(struct slc_page_table *table, uint64_t frame,
                                 VkCommandBuffer commands);
/** Records the words stored since the last call. Call it after the copies to pages. */
void slc_page_table_record_publish(struct slc_page_table *table, VkCommandBuffer commands);
/** Records again later whatever `frame` and later frames recorded: these frames never run. */
void slc_page_table_abandon(struct slc_page_table *table, uint64_t frame);

#endif /* SLC_VULKAN_PAGE_TABLE_H */
