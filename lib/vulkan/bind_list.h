/**
 * Sparse binds and unbinds of one batch: one final state per tile, sorted so that rectangles of
 * tiles with consecutive pages become one bind.
 *
 * A range that occurs twice in a batch is an error. Validation layers do not report it, and drivers
 * resolve it the wrong way round. So the list merges them. Knows nothing of Vulkan handles.
 */
#ifndef SLC_VULKAN_BIND_LIST_H
#define SLC_VULKAN_BIND_LIST_H

#include "vulkan/sparse_layout.h"

#define SLC_UNBIND UINT32_MAX

/** One tile's new state. */
struct slc_bind {
    uint32_t image; ///< index of the streamer's texture
    struct slc_tile_place place;
    uint32_t heap_id; ///< SLC_UNBIND: nothing
    uint32_t slot;
    uint32_t sequence; ///< set by slc_bind_list_put; later ones win
};

/** A rectangle of tiles. Their slots follow each other row by row, or they are unbound. */
struct slc_bind_run {
    uint32_t image;
    struct slc_tile_place place; ///< place of the first tile
    uint32_t column_count, row_count;
    uint32_t heap_id, slot;
};

struct slc_bind_list {
    struct slc_bind *binds;    ///< owned
    struct slc_bind_run *runs; ///< owned
    uint32_t count, capacity, run_count;
};

SluiceResult slc_bind_list_init(struct slc_bind_list *list, const SluiceAllocationCallbacks *cb,
                                uint32_t capacity);
void slc_bind_list_finish(struct slc_bind_list *list, const SluiceAllocationCallbacks *cb);

/** False, and nothing is added, if the list is full. */
bool slc_bind_list_put(struct slc_bind_list *list, uint32_t image, struct slc_tile_place place,
                       uint32_t heap_id, uint32_t slot);

/** Merges, sorts by image, level, row and column, and fills `runs`. A run has several rows if no
 *  other run lies beside them: usually whole rows of a level. Pages of a tail stay single. */
void slc_bind_list_build_runs(struct slc_bind_list *list);

void slc_bind_list_clear(struct slc_bind_list *list);

#endif /* SLC_VULKAN_BIND_LIST_H */
