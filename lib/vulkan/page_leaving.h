/**
 * How the images of a page pool give memory back: which one is to run empty, where its tiles move,
 * and how much memory is beyond the limits.
 *
 * An image is chosen, and nobody takes pages of it any more. Its tiles move to pages of other
 * images (page_moves.h), or are evicted.
 */
#ifndef SLC_VULKAN_PAGE_LEAVING_H
#define SLC_VULKAN_PAGE_LEAVING_H

#include "vulkan/page_pool.h"

/**
 * Chooses the chunk to be emptied next, if none is yet, among those whose pages the user alone
 * holds: the one that frees most of `size` bytes for the fewest evictions. Nobody takes pages of it
 * any more. Returns how many pages of its format the user must give back until the others have room
 * for its pages; SLC_NONE if no chunk can be emptied. `*held`: pages that are held in it.
 */
uint32_t slc_page_pool_choose_leaving(struct slc_page_pool *pool, uint32_t user, uint64_t size,
                                      uint32_t *held);
/** Stops emptying the chunk that the user chose, if any. */
void slc_page_pool_stay(struct slc_page_pool *pool, uint32_t user);
/** The chunk that the user empties; SLC_NONE if there is none. */
uint32_t slc_page_pool_leaving(struct slc_page_pool *pool, uint32_t user);
/** Number of tiles on the pages of a chunk; SLC_NONE if another user holds any of the pages. */
uint32_t slc_page_pool_held_in(struct slc_page_pool *pool, uint32_t user, uint32_t chunk);
/** Bytes that the user should free because page memory is beyond the limits of all users: limits
 * can be lowered. They are those of its chunks beyond its own limit, and all that no user is
 * beyond. */
uint64_t slc_page_pool_excess(struct slc_page_pool *pool, uint32_t user);
/** Bytes of chunks that are empty or retiring: they will be freed. */
uint64_t slc_page_pool_going_size(struct slc_page_pool *pool);

/** Users that have held a page, and the tick up to which their frames may read it. */
struct slc_page_readers {
    uint32_t users; ///< bits
    uint64_t tick;
};

/** Number of the user's tiles on the page; 0 if another user holds it, too. */
uint32_t slc_page_pool_tiles_on(struct slc_page_pool *pool, uint32_t user, uint32_t page);
/** Takes a page `*to` for all tiles on `from`; `frame` copies it. The user holds both pages until
 *  slc_page_pool_end_move. Returns false if there is no page, or the texels are not complete. */
bool slc_page_pool_move(struct slc_page_pool *pool, uint32_t user, uint32_t from, uint64_t frame,
                        uint32_t *to, struct slc_page_readers *readers);
/** The copy is complete: gives `from` back. False: frames of other readers are under way. */
bool slc_page_pool_end_move(struct slc_page_pool *pool, uint32_t user, uint32_t from,
                            const struct slc_page_readers *readers);
/** The copy was abandoned. Returns true if the tiles are on `from` again, false if none is left.
 *  Call it for the last move first. */
bool slc_page_pool_move_back(struct slc_page_pool *pool, uint32_t user, uint32_t from, uint32_t to);

#endif /* SLC_VULKAN_PAGE_LEAVING_H */
