/**
 * Release of page memory: chooses a chunk to empty, moves its tiles, and computes how much memory
 * is beyond the limits.
 *
 * No page of a chosen chunk can be taken. Its tiles move to pages of other chunks (page_moves.h),
 * or are evicted.
 */
#ifndef SLC_VULKAN_PAGE_LEAVING_H
#define SLC_VULKAN_PAGE_LEAVING_H

#include "vulkan/page_pool.h"

/**
 * Chooses the next chunk to empty, if none is chosen yet, among chunks whose pages only this user
 * holds: the one that frees most of `size` bytes for the fewest evictions. Its pages cannot be
 * taken afterwards. Returns how many pages of its format the user must give back until other chunks
 * have room for its pages. SLC_NONE if no chunk can be emptied. `*held`: pages held in the chunk.
 */
uint32_t slc_page_pool_choose_leaving(struct slc_page_pool *pool, uint32_t user, uint64_t size,
                                      uint32_t *held);
/** Stops emptying the chunk that the user chose, if any. */
void slc_page_pool_stay(struct slc_page_pool *pool, uint32_t user);
/** Returns the chunk that the user empties; SLC_NONE if there is none. */
uint32_t slc_page_pool_leaving(struct slc_page_pool *pool, uint32_t user);
/** Returns the number of tiles on a chunk's pages; SLC_NONE if another user holds any of the pages.
 */
uint32_t slc_page_pool_held_in(struct slc_page_pool *pool, uint32_t user, uint32_t chunk);
/** Returns the bytes that the user should free because limits were lowered: bytes of its chunks
 * beyond its own limit, and bytes beyond the pool's limit that are beyond no user's limit. */
uint64_t slc_page_pool_excess(struct slc_page_pool *pool, uint32_t user);
/** Returns the bytes of chunks that are empty or retiring, and will be freed. */
uint64_t slc_page_pool_going_size(struct slc_page_pool *pool);

/** Users that have held a page, and the tick up to which their frames may read it. */
struct slc_page_readers {
    uint32_t users; ///< bits: users
    uint64_t tick;
};

/** Returns the number of the user's tiles on the page; 0 if another user holds it, too. */
uint32_t slc_page_pool_tiles_on(struct slc_page_pool *pool, uint32_t user, uint32_t page);
/** Takes a page `*to` for all tiles on `from`; `frame` copies it. The user holds both pages until
 *  slc_page_pool_end_move. Returns false if there is no page, or the texels are not complete. */
bool slc_page_pool_move(struct slc_page_pool *pool, uint32_t user, uint32_t from, uint64_t frame,
                        uint32_t *to, struct slc_page_readers *readers);
/** Ends a move whose copy is complete: gives `from` back. False: frames of other readers still run.
 */
bool slc_page_pool_end_move(struct slc_page_pool *pool, uint32_t user, uint32_t from,
                            const struct slc_page_readers *readers);
/** Undoes a move whose copy was abandoned. Returns true if the tiles are on `from` again, false if
 *  no tile is left. Undo the last move first. */
bool slc_page_pool_move_back(struct slc_page_pool *pool, uint32_t user, uint32_t from, uint32_t to);

#endif /* SLC_VULKAN_PAGE_LEAVING_H */
