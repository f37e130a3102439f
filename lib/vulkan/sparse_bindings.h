/**
 * Record of sparse bindings: the page to which each tile of each image is bound once the bind list
 * has been executed, and the tiles among them that were evicted.
 *
 * An evicted tile keeps its binding. Its page is unbound when another tile gets it, or when its
 * heap is released. Evicted neighbors in its row are unbound with it, because a run costs as much
 * as one tile. No unbind is paid for if the tile is bound again first, or its image is destroyed.
 * Knows nothing of Vulkan handles, frames or time.
 *
 * The manager assigns slots; here each slot stands for a page of its heap. Two slots may swap their
 * pages while neither is in use. So a tile gets its old page back whatever slot it was given.
 */
#ifndef SLC_VULKAN_SPARSE_BINDINGS_H
#define SLC_VULKAN_SPARSE_BINDINGS_H

#include "base/map.h"
#include "vulkan/bind_list.h"

#define SLC_NO_BOUND_PAGE UINT32_MAX
#define SLC_NO_IMAGE UINT32_MAX

/** Key of one tile among the tiles of all images. */
static inline uint64_t slc_place_key(uint32_t image, struct slc_tile_place place)
{
    /* 5 bits of level, 13 and 14 of column and row: 2^20 texels are 2^14 tiles of 64 texels */
    uint32_t level = place.level == SLC_TAIL_LEVEL ? 31 : place.level;
    return (uint64_t)image << 37 | (uint64_t)level << 32 | (uint64_t)place.y << 16 | place.x;
}

struct slc_bound_page {
    uint32_t image; ///< SLC_NO_IMAGE: bound nowhere
    struct slc_tile_place place;
    bool live;               ///< false: evicted
    bool spoiled;            ///< the page may have texels of another tile
    uint32_t previous, next; ///< pages of the same image
    uint32_t slot;           ///< slot that stands for this page
    uint32_t page_of_slot;   ///< page that the slot with this page's index stands for
};

struct slc_sparse_bindings {
    struct slc_bound_page *pages; ///< owned; heap id * heap_page_count + slot
    uint32_t page_count;
    uint32_t heap_page_count; ///< pages of every heap; 0 until there is a heap
    struct slc_map places;    ///< (image, place) -> page
    uint32_t *first_pages;    ///< owned; by image
    uint32_t image_count;
    uint64_t unbind_count;  ///< unbinds put into lists
    uint64_t unbinds_saved; ///< evicted tiles that needed no unbind
};

SluiceResult slc_sparse_bindings_init(struct slc_sparse_bindings *bindings,
                                      const SluiceAllocationCallbacks *cb, uint32_t image_count);
void slc_sparse_bindings_finish(struct slc_sparse_bindings *bindings,
                                const SluiceAllocationCallbacks *cb);

/**
 * Makes room for a heap. All heaps have the same number of pages. Errors: OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_sparse_bindings_add_heap(struct slc_sparse_bindings *bindings,
                                          const SluiceAllocationCallbacks *cb, uint32_t heap_id,
                                          uint32_t page_count);

/**
 * Lists the bind of the tile to the page. Lists the unbinds of the evicted tile that is still bound
 * to the page, and of its evicted neighbors. Lists nothing if slc_sparse_bindings_restore is true.
 *
 * `*unbound` is the image of the unbinds, or SLC_NO_IMAGE. Only an evicted tile may be bound to the
 * page, and the place of the tile may hold only an evicted binding. Returns false, with nothing
 * changed, if the list has no room for two.
 */
bool slc_sparse_bindings_bind(struct slc_sparse_bindings *bindings, struct slc_bind_list *list,
                              uint32_t image, struct slc_tile_place place, uint32_t heap_id,
                              uint32_t slot, uint32_t *unbound);

/**
 * Binds an evicted tile again without a sparse bind. Returns true if the tile is still bound to a
 * page of the heap, with its texels. From then on the slot stands for that page.
 *
 * Only an evicted tile may be bound to the page of the slot. Ask slc_sparse_bindings_is_spoiled
 * first if the texels matter.
 */
bool slc_sparse_bindings_restore(struct slc_sparse_bindings *bindings, uint32_t image,
                                 struct slc_tile_place place, uint32_t heap_id, uint32_t slot);

/** Evicts a tile that is bound. */
void slc_sparse_bindings_evict(struct slc_sparse_bindings *bindings, uint32_t image,
                               struct slc_tile_place place);

/** Marks a bound tile: its page may hold other texels. Holds until the tile is bound again. */
void slc_sparse_bindings_spoil(struct slc_sparse_bindings *bindings, uint32_t image,
                               struct slc_tile_place place);
/** Marks a tile like slc_sparse_bindings_spoil, if it has a page. */
void slc_sparse_bindings_spoil_evicted(struct slc_sparse_bindings *bindings, uint32_t image,
                                       struct slc_tile_place place);
bool slc_sparse_bindings_is_spoiled(const struct slc_sparse_bindings *bindings, uint32_t image,
                                    struct slc_tile_place place);

/**
 * Lists the unbind of the evicted tile that is bound to the page. `*image` is its image, or
 * SLC_NO_IMAGE if there is none. Returns false, with nothing changed, if the list is full.
 */
bool slc_sparse_bindings_unbind(struct slc_sparse_bindings *bindings, struct slc_bind_list *list,
                                uint32_t heap_id, uint32_t slot, uint32_t *image);

/** Drops all bindings of an image that is destroyed. */
void slc_sparse_bindings_drop_image(struct slc_sparse_bindings *bindings, uint32_t image);

#endif /* SLC_VULKAN_SPARSE_BINDINGS_H */
