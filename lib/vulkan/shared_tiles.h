/**
 * Directory of tiles that several users of a page pool can show from one page. Maps a tile of a
 * source to its page, the users of the page, and the frame that writes its texels. Knows no device.
 */
#ifndef SLC_VULKAN_SHARED_TILES_H
#define SLC_VULKAN_SHARED_TILES_H

#include "base/map.h"
#include "base/none.h"
#include "vulkan/page_timelines.h"

#include <sluice/image.h>

/** Name of a tile of a source. Tiles that the source identifies as equal have equal keys. */
struct slc_tile_key {
    const SluiceImageSource *source;
    uint32_t layer, level, x, y; ///< see function slc_tile_key
    uint32_t generation;         ///< generation of the texels; see slc_page_share_drop
};

/** Returns the key of the tile with this region. It holds layer, level, x and y in texels; or, if
 * the source identifies the texels by a number, that number and the region's width and height.
 * `source` may be NULL. */
struct slc_tile_key slc_tile_key(SluiceImageSource *source, const SluiceImageRegion *region,
                                 uint32_t generation);

struct slc_shared_tile {
    struct slc_tile_key key;
    uint32_t page;          ///< SLC_NONE: the tile is being read
    uint32_t next;          ///< next entry of equal hash, or next free entry
    uint32_t before, after; ///< `listed`: entries of the same source, or SLC_NONE
    uint64_t value;         ///< `written`: the writer's frame with the copy; `going`: a tick
    uint32_t users;         ///< bits: users that hold the page
    uint32_t holds[SLC_MAX_PAGE_USERS]; ///< by user: its tiles on the page
    uint32_t readers;                   ///< bits: users that have held the page
    uint8_t writer;    ///< user that reads and copies the tile; SLC_MAX_PAGE_USERS: complete
    uint8_t last_user; ///< `going`: user that held the page last
    bool listed;       ///< can be found by key
    bool written;      ///< a frame copies the texels
    bool adopted;      ///< has texels of an earlier use; `value`: last frame that can copy them
    bool going;        ///< no user holds the page; frames may still read it
};

struct slc_shared_tiles {
    struct slc_shared_tile *entries; ///< owned
    uint32_t high, capacity, free;   ///< `free`: first free entry, or SLC_NONE
    uint32_t going_count;
    struct slc_map by_hash;   ///< hash of a key -> the first entry
    struct slc_map by_source; ///< source -> its first listed entry
};

/** A zeroed struct is empty but for `free`: SLC_NONE. */
void slc_shared_tiles_finish(struct slc_shared_tiles *tiles, const SluiceAllocationCallbacks *cb);

/** Finds a listed entry. SLC_NONE if there is none. */
uint32_t slc_shared_tiles_find(const struct slc_shared_tiles *tiles,
                               const struct slc_tile_key *key);
/** Returns the first listed entry of a source; `after` links the others. SLC_NONE: there is none.
 */
uint32_t slc_shared_tiles_first_of(const struct slc_shared_tiles *tiles,
                                   const SluiceImageSource *source);
/** Adds a listed entry. No listed entry may have the key. SLC_NONE without host memory. */
uint32_t slc_shared_tiles_add(struct slc_shared_tiles *tiles, const SluiceAllocationCallbacks *cb,
                              const struct slc_tile_key *key);
/** Unlists an entry: it stays, but is not found any more. */
void slc_shared_tiles_unlist(struct slc_shared_tiles *tiles, uint32_t index);
void slc_shared_tiles_remove(struct slc_shared_tiles *tiles, uint32_t index);

#endif /* SLC_VULKAN_SHARED_TILES_H */
