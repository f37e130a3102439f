/**
 * Moves of tiles from one page to another, so that an array image becomes empty and its memory can
 * be freed. Equal tiles have one page and move together.
 *
 * A frame records the copy, and its page table shows the new page. The old page stays held until
 * the frame is complete: if the frame is abandoned, the page table shows the old page again.
 */
#ifndef SLC_VULKAN_PAGE_MOVES_H
#define SLC_VULKAN_PAGE_MOVES_H

#include "vulkan/page_leaving.h"
#include "vulkan/page_table.h"

#define SLC_PAGE_MOVES 1024u         /* most moves in progress */
#define SLC_PAGE_MOVES_PER_FRAME 64u /* 4 MiB */
#define SLC_PAGE_MOVED_TILES 4096u   /* most tiles per frame, unless one page has more */

struct slc_page_move {
    uint32_t from, to;               ///< pages
    uint64_t frame;                  ///< frame that copies
    struct slc_page_readers readers; ///< other users whose frames may still read `from`
};

struct slc_page_moves {
    struct slc_page_pool *pool; ///< borrowed, like `table`
    struct slc_page_table *table;
    uint32_t user;                                  ///< user of `pool`
    uint32_t store_reserve;                         ///< stores that a frame needs besides moves
    struct slc_page_move under_way[SLC_PAGE_MOVES]; ///< oldest first
    uint32_t count;
    uint32_t next_part; ///< part of the table at which the search for tiles continues
    uint32_t left;      ///< pages that may still be moved; UINT32_MAX: no limit
    uint32_t to_of[SLC_PAGE_CHUNK_LAYERS]; ///< while a frame is recorded: 1 + the new page, by
                                           ///< layer of the emptied image; 0: not moved
};

/** Gives back the old pages of moves whose frames are complete, up to `completed_frame`. */
void slc_page_moves_complete(struct slc_page_moves *moves, uint64_t completed_frame);
/** Moves tiles out of the image that is being emptied, if any. Record it after a barrier that waits
 *  for all earlier frames, and before other copies of the frame. */
void slc_page_moves_record(struct slc_page_moves *moves, uint64_t frame, VkCommandBuffer commands);
/** Undoes the moves of `frame` and later frames. Call it after slc_page_pool_abandon, and before
 *  slc_page_table_abandon. */
void slc_page_moves_abandon(struct slc_page_moves *moves, uint64_t frame);

#endif /* SLC_VULKAN_PAGE_MOVES_H */
