/**
 * Tiles that wait to be read again, in a list per texture. Textures that are ready are in one list,
 * textures that wait after a failed read in another, sorted by due time. So the cost of a frame
 * does not depend on the waiting tiles and textures. Knows no device and no clock.
 */
#ifndef SLC_VULKAN_RELOAD_LISTS_H
#define SLC_VULKAN_RELOAD_LISTS_H

#include "base/map.h"

struct slc_reload_node {
    uint32_t tile, next; ///< next: 1 + index of the texture's next node, or next free one; 0: none
};

enum slc_reload_place {
    SLC_RELOAD_NOWHERE = 0, ///< the texture has no tiles
    SLC_RELOAD_READY,
    SLC_RELOAD_WAITING,
    SLC_RELOAD_TURN, ///< between slc_reload_lists_begin and _end
};

/** Tiles of one texture that are to be read again. */
struct slc_reload_list {
    uint32_t first, last, count; ///< first, last: 1 + index of a node
    enum slc_reload_place place;
    bool waits;             ///< waits until `due`
    uint64_t due;           ///< a time stamp
    uint32_t before, after; ///< neighbors in the list `place`: 1 + index of a texture; 0: none
};

struct slc_reload_chain {
    uint32_t first, last, count; ///< first, last: 1 + index of a texture
};

struct slc_reload_lists {
    const SluiceAllocationCallbacks *cb; ///< borrowed
    struct slc_map keys;                 ///< slc_pair_key(texture, tile)
    struct slc_reload_node *nodes;       ///< owned
    uint32_t count, capacity, free_node; ///< nodes; count: tiles of all textures
    uint32_t spare;                      ///< tiles that were taken and may come back
    struct slc_reload_list *lists;       ///< owned; by texture
    uint32_t texture_count;
    struct slc_reload_chain ready, waiting;
};

/** `spare`: most tiles that are taken at a time. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_reload_lists_init(struct slc_reload_lists *r, const SluiceAllocationCallbacks *cb,
                                   uint32_t texture_count, uint32_t spare);
/** Frees the lists. They may be zeroed. */
void slc_reload_lists_finish(struct slc_reload_lists *r);
/** Makes room for `count` calls of slc_reload_lists_add. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_reload_lists_reserve(struct slc_reload_lists *r, uint32_t count);

/** Appends a tile to the list of its texture, unless it is there. Needs slc_reload_lists_reserve,
 * except for a tile that was taken. */
void slc_reload_lists_add(struct slc_reload_lists *r, uint32_t texture, uint32_t tile);
bool slc_reload_lists_has(const struct slc_reload_lists *r, uint32_t texture, uint32_t tile);
uint32_t slc_reload_lists_count(const struct slc_reload_lists *r, uint32_t texture);
/** Takes the first tile of a texture, which must have one. */
uint32_t slc_reload_lists_take(struct slc_reload_lists *r, uint32_t texture);
/** Drops all tiles of a texture, which waits no longer. */
void slc_reload_lists_drop(struct slc_reload_lists *r, uint32_t texture);

/** Lets a texture wait until the time stamp `due`. */
void slc_reload_lists_wait(struct slc_reload_lists *r, uint32_t texture, uint64_t due);
/** Makes textures ready that are due at `now`. Time stamps may wrap. */
void slc_reload_lists_wake(struct slc_reload_lists *r, uint64_t now);
/** Begins the turn of the first texture that is ready; there must be one. */
uint32_t slc_reload_lists_begin(struct slc_reload_lists *r);
/** Ends a turn. The texture becomes the last ready one if it has tiles and does not wait. */
void slc_reload_lists_end(struct slc_reload_lists *r, uint32_t texture);

#endif /* SLC_VULKAN_RELOAD_LISTS_H */
