/**
 * Tiles move from one page to another, so that an array image runs empty and its memory is freed.
 * Equal tiles have one page and move together.
 *
 * The copy is recorded in a frame, and the page table of that frame shows the new page. The old
 * page stays held until the frame is complete: if the frame is abandoned, the tiles are shown from
 * there again.
 */
#ifndef SLC_VULKAN_PAGE_MOVES_H
#define SLC_VULKAN_PAGE_MOVES_H

#include "vulkan/page_leaving.h"
#include "vulkan/page_table.h"

#define SLC_PAGE_MOVES 1024u         /* under way at a time */
#define SLC_PAGE_MOVES_PER_FRAME 64u /* 4 MiB */
#define SLC_PAGE_MOVED_TILES 4096u   /* per frame, unless one page has more */

struct slc_page_move {
    uint32_t from, to;               ///< pages
    uint64_t frame;                  ///< frame that copies
    struct slc_page_readers readers; ///< others whose frames may still read `from`
};

struct slc_page_moves {
    struct slc_page_pool *pool; ///< borrowed, as the next one
    struct slc_page_table *table;
    uint32_t user;                                  ///< of the pool
    uint32_t store_reserve;                         ///< stores that a frame needs besides the moves
    struct slc_page_move under_way[SLC_PAGE_MOVES]; ///< oldest first
    uint32_t count;
    uint32_t next_part; ///< where the search for tiles goes on
    uint32_t left;      ///< pages that may still be moved; UINT32_MAX: no limit
    uint32_t
        to_of[SLC_PAGE_CHUNK_LAYERS]; ///< while a frame is recorded: by layer of the image
                                      ///< that runs empty, 1 + the new page; 0: it is not moved
};

/** Frames up to `completed_frame` are complete: their old pages are given back. */
void slc_page_moves_complete(struct slc_page_moves *moves, uint64_t completed_frame);
/** Moves tiles out of the image that is to run empty, if there is one. Record it after a barrier
 *  that waits for all earlier frames, and before the other copies of the frame. */
void slc_page_moves_record(struct slc_page_moves *moves, uint64_t frame, VkCommandBuffer commands);
/** Undoes the moves of `frame` and later frames. Call it after slc_page_pool_abandon, and before
 *  slc_page_table_abandon. */
void slc_page_moves_abandon(struct slc_page_moves *moves, uint64_t frame);

#endif /* SLC_VULKAN_PAGE_MOVES_H */
