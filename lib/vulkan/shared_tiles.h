/**
 * Directory of tiles that several users of a page pool may show from one page: which tile of which
 * source is on which page, who uses it, and since when its texels are there. Knows no device.
 */
#ifndef SLC_VULKAN_SHARED_TILES_H
#define SLC_VULKAN_SHARED_TILES_H

#include "base/map.h"
#include "base/none.h"
#include "vulkan/page_timelines.h"

#include <sluice/image.h>

/** Names a tile of a source. Equal tiles that the source knows of have equal keys. */
struct slc_tile_key {
    const SluiceImageSource *source;
    uint32_t layer, level, x, y; ///< see slc_tile_key
    uint32_t generation;         ///< of the texels; see slc_page_share_drop
};

/** The key of the tile that is this region, of `generation`. Its parts are layer, level, x, y in
 * texels; or the number that the source gives to the texels, with width and height of the region. A
 * `source` of NULL is allowed. */
struct slc_tile_key slc_tile_key(SluiceImageSource *source, const SluiceImageRegion *region,
                                 uint32_t generation);

struct slc_shared_tile {
    struct slc_tile_key key;
    uint32_t page;          ///< SLC_NONE: it is being read
    uint32_t next;          ///< of equal hash, or of free entries
    uint32_t before, after; ///< `listed`: of the same source; SLC_NONE: none
    uint64_t value;         ///< `written`: the writer's frame that copies it; `going`: a tick
    uint32_t users;         ///< bits: hold the page
    uint32_t holds[SLC_MAX_PAGE_USERS]; ///< by user: how many of its tiles are on the page
    uint32_t readers;                   ///< bits: have held it
    uint8_t writer;    ///< user that reads and copies it; SLC_MAX_PAGE_USERS: its texels are there
    uint8_t last_user; ///< `going`: that held it last
    bool listed;       ///< it can be found by its key
    bool written;      ///< a frame copies its texels
    bool adopted;      ///< texels of an earlier use; `value`: the last frame that can copy them
    bool going;        ///< nobody holds it; frames may still read it
};

struct slc_shared_tiles {
    struct slc_shared_tile *entries; ///< owned
    uint32_t high, capacity, free;   ///< `free`: the first free entry, SLC_NONE for none
    uint32_t going_count;
    struct slc_map by_hash;   ///< hash of a key -> the first entry
    struct slc_map by_source; ///< source -> its first entry that is listed
};

/** A zeroed struct is empty but for `free`: SLC_NONE. */
void slc_shared_tiles_finish(struct slc_shared_tiles *tiles, const SluiceAllocationCallbacks *cb);

/** SLC_NONE if it is not listed. */
uint32_t slc_shared_tiles_find(const struct slc_shared_tiles *tiles,
                               const struct slc_tile_key *key);
/** An entry of the source that is listed; others by `after`. SLC_NONE if there is none. */
uint32_t slc_shared_tiles_first_of(const struct slc_shared_tiles *tiles,
                                   const SluiceImageSource *source);
/** A new entry, listed; the key is not. SLC_NONE without host memory. */
uint32_t slc_shared_tiles_add(struct slc_shared_tiles *tiles, const SluiceAllocationCallbacks *cb,
                              const struct slc_tile_key *key);
/** The entry stays, but is not found any more. */
void slc_shared_tiles_unlist(struct slc_shared_tiles *tiles, uint32_t index);
void slc_shared_tiles_remove(struct slc_shared_tiles *tiles, uint32_t index);

#endif /* SLC_VULKAN_SHARED_TILES_H */
