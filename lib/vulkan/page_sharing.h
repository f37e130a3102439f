/**
 * One page for tiles that are equal: a tile that several users of a pool show, and tiles that the
 * source says have equal texels, of one user or of several. A user that reads a tile announces it.
 * Whoever wants an equal one waits instead of reading it, and holds the same page once its texels
 * are there: once the frame that copies them is complete. The page is free when no tile is on it
 * and no frame can read it.
 */
#ifndef SLC_VULKAN_PAGE_SHARING_H
#define SLC_VULKAN_PAGE_SHARING_H

#include "vulkan/page_pool.h"

enum slc_share {
    SLC_SHARE_NONE,  ///< read it
    SLC_SHARE_WAIT,  ///< it is being read or copied: ask again in the next frame
    SLC_SHARE_READY, ///< its texels are there: take its page
};

/** Whether the tile, or an equal one, is on a page. WAIT for another user that begins no frames
 *  ends after a while. */
enum slc_share slc_page_share_look(struct slc_page_pool *pool, uint32_t user,
                                   const struct slc_tile_key *key);
/** Holds the page of a tile that is READY; until slc_page_pool_give. SLUICE_PAGE_NONE if it is not.
 */
uint32_t slc_page_share_take(struct slc_page_pool *pool, uint32_t user,
                             const struct slc_tile_key *key);

/** A read of the tile begins. If another user has the tile, this one is the reader's own. */
void slc_page_share_announce(struct slc_page_pool *pool, uint32_t user,
                             const struct slc_tile_key *key);
/** The read failed, before it had a page. */
void slc_page_share_withdraw(struct slc_page_pool *pool, uint32_t user,
                             const struct slc_tile_key *key);
/** The tile that the user announced goes to this page, which it has taken. */
void slc_page_share_place(struct slc_page_pool *pool, uint32_t user, const struct slc_tile_key *key,
                          uint32_t page);
/** `frame` copies the texels to the page, which nobody else may read before that. */
void slc_page_share_written(struct slc_page_pool *pool, uint32_t user, uint32_t page,
                            uint64_t frame);
/** Shares a page that the user has taken back, with its texels. Other users may read it when the
 *  frames are complete that the user had recorded when it gave the page. */
void slc_page_share_adopt(struct slc_page_pool *pool, uint32_t user, const struct slc_tile_key *key,
                          uint32_t page);

/** Whether another tile is on the page, or another user has read it. */
bool slc_page_is_shared(struct slc_page_pool *pool, uint32_t user, uint32_t page);

/** A texture of the source goes: its tiles are not found any more, but for those that others hold,
 *  for whom the source must live on. */
void slc_page_share_leave(struct slc_page_pool *pool, uint32_t user,
                          const SluiceImageSource *source);
/**
 * The texels of the source have changed: none of its tiles are found any more. Returns the
 * generation of the new texels, for the keys of the texture that was told.
 *
 * Textures of the source that were not told keep theirs: they may hold, restore or be reading old
 * texels, whose names must not be those of new ones. Calls without a name between them return the
 * same generation, so that all textures that are told of one change share pages.
 */
uint32_t slc_page_share_drop(struct slc_page_pool *pool, const SluiceImageSource *source);
/** The generation of texels that a texture reads that begins to use the source. */
uint32_t slc_page_share_generation(struct slc_page_pool *pool, const SluiceImageSource *source);

#endif /* SLC_VULKAN_PAGE_SHARING_H */
