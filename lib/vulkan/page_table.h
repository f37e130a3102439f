/**
 * What is bound where, once the bind list has been executed; and which of it only remains because
 * nobody has needed the page since.
 *
 * A tile that is given up keeps its binding: its page is unbound when another tile gets it, or when
 * its heap goes; then the neighbours in its row that were given up are unbound with it, since a run
 * costs as much as one tile. Until then nothing is paid, and if the tile is bound again first, or
 * its image goes, nothing ever is. Knows nothing of Vulkan handles, frames or time.
 *
 * Slots are what others call pages. Which slot of a heap stands for which of its pages may change
 * while neither is in use, so that a tile gets its old page back whatever slot it was given.
 */
#ifndef SLC_VULKAN_PAGE_TABLE_H
#define SLC_VULKAN_PAGE_TABLE_H

#include "base/map.h"
#include "vulkan/bind_list.h"

#define SLC_NO_PAGE UINT32_MAX
#define SLC_NO_IMAGE UINT32_MAX

/** Of one tile of one image among all. */
static inline uint64_t slc_place_key(uint32_t image, struct slc_tile_place place)
{
    /* 5 bits of level, 13 and 14 of column and row: 2^20 texels are 2^14 tiles of 64 texels */
    uint32_t level = place.level == SLC_TAIL_LEVEL ? 31 : place.level;
    return (uint64_t)image << 37 | (uint64_t)level << 32 | (uint64_t)place.y << 16 | place.x;
}

struct slc_page {
    uint32_t image; ///< SLC_NO_IMAGE: bound nowhere
    struct slc_tile_place place;
    bool live;               ///< false: given up
    bool spoiled;            ///< it may hold other texels than the tile's
    uint32_t previous, next; ///< pages of the same image
    uint32_t slot;           ///< that stands for this page; an index, as the next
    uint32_t page_of_slot;   ///< the page that the slot of this index stands for
};

struct slc_page_table {
    struct slc_page *pages; ///< owned; heap id * heap_page_count + slot
    uint32_t page_count;
    uint32_t heap_page_count; ///< of every heap; 0 until there is one
    struct slc_map places;    ///< (image, place) -> page
    uint32_t *first_pages;    ///< owned; by image
    uint32_t image_count;
    uint64_t unbind_count;  ///< put into lists
    uint64_t unbinds_saved; ///< of tiles that were given up: none was needed
};

SluiceResult slc_page_table_init(struct slc_page_table *table, const SluiceAllocationCallbacks *cb,
                                 uint32_t image_count);
void slc_page_table_finish(struct slc_page_table *table, const SluiceAllocationCallbacks *cb);

/**
 * Makes room for a heap. All heaps have the same number of pages. Errors: OUT_OF_HOST_MEMORY,
 * INVALID_ARGUMENT for another number of pages.
 */
SluiceResult slc_page_table_add_heap(struct slc_page_table *table,
                                     const SluiceAllocationCallbacks *cb, uint32_t heap_id,
                                     uint32_t page_count);

/**
 * Puts into the list what binds the tile to the page: the bind, and the unbind of the tile that had
 * given up the page and of its neighbours; nothing where slc_page_table_revive is true.
 * `*displaced` is the image of the unbind, or SLC_NO_IMAGE. No tile that has not been given up may
 * have the page or lie there. False, and nothing has changed, if the list has no room for two.
 */
bool slc_page_table_bind(struct slc_page_table *table, struct slc_bind_list *list, uint32_t image,
                         struct slc_tile_place place, uint32_t heap_id, uint32_t slot,
                         uint32_t *displaced);

/**
 * True: the tile was given up and its page, with its texels, is one of the heap's; from now on the
 * slot stands for that page, and the tile is bound as if it had not been given up. No tile that has
 * not been given up may have the slot. Ask slc_page_table_is_spoiled first where the texels matter.
 */
bool slc_page_table_revive(struct slc_page_table *table, uint32_t image,
                           struct slc_tile_place place, uint32_t heap_id, uint32_t slot);

/** The tile is given up; it was bound. */
void slc_page_table_give_up(struct slc_page_table *table, uint32_t image,
                            struct slc_tile_place place);

/** What is on the page of the tile, which is bound, may not be its texels; until it is bound again.
 */
void slc_page_table_spoil(struct slc_page_table *table, uint32_t image,
                          struct slc_tile_place place);
bool slc_page_table_is_spoiled(const struct slc_page_table *table, uint32_t image,
                               struct slc_tile_place place);

/**
 * Puts into the list what unbinds whatever has given up a page. `*image`: of that, or SLC_NO_IMAGE
 * if there is nothing to do. False, and nothing has changed, if the list is full.
 */
bool slc_page_table_unbind(struct slc_page_table *table, struct slc_bind_list *list,
                           uint32_t heap_id, uint32_t slot, uint32_t *image);

/** The image is gone, and all of its bindings with it. */
void slc_page_table_drop_image(struct slc_page_table *table, uint32_t image);

#endif /* SLC_VULKAN_PAGE_TABLE_H */
