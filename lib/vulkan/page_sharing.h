/**
 * Sharing of pages by equal tiles: a tile that several users of a pool show, and tiles whose texels
 * the source identifies as equal, of one user or of several. A user that reads a tile announces it.
 * Users that want an equal tile wait instead of reading it. They hold the page, too, once the frame
 * that copies its texels is complete. The page is free when no tile is on it and no frame can read
 * it.
 */
#ifndef SLC_VULKAN_PAGE_SHARING_H
#define SLC_VULKAN_PAGE_SHARING_H

#include "vulkan/page_pool.h"

enum slc_share {
    SLC_SHARE_NONE,  ///< no equal tile: read it
    SLC_SHARE_WAIT,  ///< an equal tile is being read or copied: ask again in the next frame
    SLC_SHARE_READY, ///< the texels of an equal tile are on a page: take it
};

/** Returns whether the tile, or an equal one, is on a page. WAIT ends after a while if the other
 *  user begins no frames. */
enum slc_share slc_page_share_look(struct slc_page_pool *pool, uint32_t user,
                                   const struct slc_tile_key *key);
/** Takes the page of a tile that is READY, until slc_page_pool_give. SLUICE_PAGE_NONE if it is not
 * READY. */
uint32_t slc_page_share_take(struct slc_page_pool *pool, uint32_t user,
                             const struct slc_tile_key *key);

/** Announces a read of the tile. If another user has the tile, the reader's one is not shared. */
void slc_page_share_announce(struct slc_page_pool *pool, uint32_t user,
                             const struct slc_tile_key *key);
/** Withdraws an announced read that failed before it had a page. */
void slc_page_share_withdraw(struct slc_page_pool *pool, uint32_t user,
                             const struct slc_tile_key *key);
/** Sets the page of a tile that the user announced. The user must have taken the page. */
void slc_page_share_place(struct slc_page_pool *pool, uint32_t user, const struct slc_tile_key *key,
                          uint32_t page);
/** Notes that `frame` copies the texels to the page. Other users may read it after that frame. */
void slc_page_share_written(struct slc_page_pool *pool, uint32_t user, uint32_t page,
                            uint64_t frame);
/** Shares a page that the user has taken back, with its texels. Other users may read it when the
 *  frames are complete that the user had recorded when it gave the page. */
void slc_page_share_adopt(struct slc_page_pool *pool, uint32_t user, const struct slc_tile_key *key,
                          uint32_t page);

/** True if another tile is on the page, or another user has read it. */
bool slc_page_is_shared(struct slc_page_pool *pool, uint32_t user, uint32_t page);

/** Ends the use of a source by a texture of the user. Tiles of the source are not found any more,
 *  except tiles that others hold, for whom the source must live on. */
void slc_page_share_leave(struct slc_page_pool *pool, uint32_t user,
                          const SluiceImageSource *source);
/**
 * Begins a new generation of a source whose texels have changed. Tiles of the source are not found
 * any more. Returns the generation of the new texels, for the keys of the texture that was told of
 * the change.
 *
 * Other textures of the source keep their generation: they may hold, restore or read old texels,
 * which must have other keys than new ones. Calls without slc_tile_key between them return one
 * generation, so that all textures that are told of one change share pages.
 */
uint32_t slc_page_share_drop(struct slc_page_pool *pool, const SluiceImageSource *source);
/** Returns the generation for a texture that begins to use the source. */
uint32_t slc_page_share_generation(struct slc_page_pool *pool, const SluiceImageSource *source);

#endif /* SLC_VULKAN_PAGE_SHARING_H */
