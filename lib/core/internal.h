/** What the files of the core share. See docs/manager.md for the rules they carry out. */
#ifndef SLC_CORE_INTERNAL_H
#define SLC_CORE_INTERNAL_H

#include <sluice/manager.h>

#include "core/observer.h"
#include "core/tile_heap.h"

#include <assert.h>

#define SLC_NONE UINT32_MAX

/** One regular level, in tiles. */
struct slc_level {
    uint32_t width, height;
    uint32_t first_tile;
};

enum slc_node_flags {
    SLC_NODE_LISTED = 1, ///< CANCELLED: handed out as such; STANDBY: listed for unmapping
    SLC_NODE_WANTED = 2, ///< CANCELLED and handed out: wanted again
};

/** A slot whose tile was unmapped and that the GPU may still read; beside SluiceTileState. */
#define SLC_NODE_RETIRING 255

/** One per tile that is not FREE, and per retiring slot. Index 0 is none. */
struct slc_node {
    uint32_t texture; ///< index; SLC_NONE for retiring slots
    uint32_t tile;
    uint32_t prev, next;                 ///< in the list of its state
    uint32_t texture_prev, texture_next; ///< among the nodes of its texture
    uint32_t heap, slot;                 ///< heap is an index, SLC_NONE without memory
    uint32_t failures;
    uint8_t state, level, deficit, flags;
    uint64_t order; ///< REQUESTED: sequence; FAILED: due; retiring: retire value
};

struct slc_list {
    uint32_t head, tail; ///< 0: empty
    uint32_t count;
};

#define SLC_REQUEST_CLASSES (SLUICE_MAX_MIP_LEVELS + 1) ///< a class per level and one for packed
#define SLC_PACKED_CLASS SLUICE_MAX_MIP_LEVELS

/** REQUESTED tiles by class and deficit. */
struct slc_requests {
    struct slc_list lists[SLC_REQUEST_CLASSES][SLUICE_MAX_MIP_LEVELS + 1];
    uint32_t deficits[SLC_REQUEST_CLASSES]; ///< bit d: lists[class][d] is not empty
    uint32_t classes;                       ///< bit c: deficits[c] is not 0
    uint32_t count;
    uint64_t next_sequence;
};

/** A region's finer level that newer maps miss; see wants.c. */
struct slc_decay {
    uint64_t time; ///< of the last map that asked for the level
    uint32_t region;
    uint32_t older;      ///< of the same region: a finer level; 0: none
    uint32_t prev, next; ///< in the texture, by time
    uint8_t level;
};

/** Per-tile and per-region memory, made when a texture is first sampled. */
struct slc_texture_state {
    uint32_t *want_counts; ///< [regular tiles]: regions that want it and children that are wanted
    uint32_t *nodes;       ///< [regular tiles]: node index, 0: FREE
    uint32_t *decays;      ///< [regions]: newest slc_decay, 0: none
    uint8_t *asked;        ///< [regions]: what the last map asked for (a, not w)
    uint8_t *next_asked;   ///< [regions]: the map being merged
    uint8_t *held;         ///< [regions]: w, SLUICE_MIP_UNTOUCHED for nothing
    uint8_t *min_mip;      ///< [minMipHeight][minMipWidth]
    struct slc_list decay_list; ///< oldest first
};

struct slc_texture {
    uint32_t generation;
    bool live;
    bool has_map; ///< a map was merged; without a state it was empty
    bool dirty;   ///< in the manager's list of MinMip updates
    uint32_t index;
    SluiceStreamedTextureDesc desc;
    uint32_t regular_tile_count, tile_count;
    uint32_t feedback_width, feedback_height;
    uint32_t min_mip_width, min_mip_height;
    struct slc_level levels[SLUICE_MAX_MIP_LEVELS];
    struct slc_texture_state *state; ///< owned, NULL until sampled
    uint32_t *packed_nodes;          ///< owned, [packedTileCount], NULL if there are none
    uint32_t packed_resident;        ///< packed tiles MAPPED or STANDBY
    uint32_t first_node;             ///< of all nodes of the texture
    uint32_t regular_nodes;          ///< nodes of regular tiles
    uint32_t requested_count;
    uint32_t held_regions;                                 ///< that hold anything
    uint64_t map_time;                                     ///< of the last map
    uint32_t primary;                                      ///< index, SLC_NONE
    uint32_t first_follower, last_follower, next_follower; ///< indices, SLC_NONE
    uint32_t dirty_x0, dirty_y0, dirty_x1, dirty_y1;       ///< exclusive ends
    uint32_t dirty_prev, dirty_next;                       ///< indices, SLC_NONE
};

#define SLC_TEXTURES_PER_CHUNK 64

/** A region whose held level changes in the call under way. */
struct slc_change {
    uint32_t region;
    uint8_t old_held;
};

struct slc_given_up {
    SluiceTextureId texture_id;
    uint32_t tile;
};

struct SluiceStreamedTextureManager {
    SluiceStreamedTextureManagerCreateInfo info; ///< pAllocator points to `given` or is NULL
    SluiceAllocationCallbacks given;
    SluiceAllocationCallbacks cb; ///< counts into host_memory_size, hands on to `given`
    uint64_t host_memory_size;
    SluiceStreamedTextureManagerConfig config;
    struct slc_observer observer;
    bool used; ///< a call was made that changed something

    struct slc_texture **chunks; ///< owned, [chunk_count], owned chunks
    uint32_t chunk_count, chunk_room;
    uint32_t texture_end;   ///< indices ever used
    uint32_t texture_count; ///< live
    uint32_t *free_indices; ///< owned min-heap, room for every texture of the chunks
    uint32_t free_index_count, free_index_room;
    uint64_t tile_count;

    struct slc_node *nodes; ///< owned, [node_room]; [0] unused
    uint32_t node_room, node_end, free_node, free_node_count;
    uint32_t state_counts[8]; ///< nodes by SluiceTileState
    struct slc_requests requests;
    struct slc_list standby, unmapping, cancelled, failed, given_up, retiring;

    struct slc_decay *decays; ///< owned, [decay_room]; [0] unused
    uint32_t decay_room, decay_end, free_decay, free_decay_count;
    struct slc_change *changes; ///< owned scratch
    uint32_t change_room;

    struct slc_given_up *given_up_reports; ///< owned queue: [first, end)
    uint32_t report_first, report_end, report_room;

    struct slc_tile_heaps heaps;
    uint32_t dirty_first, dirty_last; ///< indices, SLC_NONE
    uint32_t dirty_count;

    bool has_time;
    uint64_t time;
    uint64_t last_retire, completed_retire;
    uint64_t handed_out_total, mapped_total, unmapped_total, cancelled_total, failed_total;
    uint64_t restored_total, moved_total;
};

typedef SluiceStreamedTextureManager slc_manager;

/* manager.c */
static inline struct slc_texture *slc_texture_at(const slc_manager *m, uint32_t index)
{
    return &m->chunks[index / SLC_TEXTURES_PER_CHUNK][index % SLC_TEXTURES_PER_CHUNK];
}
static inline SluiceTextureId slc_texture_id(const struct slc_texture *t)
{
    return (uint64_t)t->generation << 32 | t->index;
}
SluiceResult slc_find_texture(const slc_manager *m, SluiceTextureId id, struct slc_texture **out);
/** The same, but SLUICE_ALL_TEXTURES gives NULL. */
SluiceResult slc_find_scope(const slc_manager *m, SluiceTextureId id, struct slc_texture **out);
void slc_notify(slc_manager *m, const struct slc_call *call);
bool slc_time_is_backwards(const slc_manager *m, uint64_t time);
bool slc_retire_is_backwards(const slc_manager *m, uint64_t retire_value);
/** Moves the clock on and makes due retries REQUESTED. */
void slc_advance_time(slc_manager *m, uint64_t time);

/* layout.c */
SluiceResult slc_layout_texture(const SluiceStreamedTextureDesc *desc, struct slc_texture *t);
void slc_write_layout(const struct slc_texture *t, SluiceStreamedTextureLayout *layout);
struct slc_place {
    uint32_t level, x, y;
};
/** `level` is regularMipCount for packed tiles. */
struct slc_place slc_tile_place(const struct slc_texture *t, uint32_t tile);
static inline uint32_t slc_tile_index(const struct slc_texture *t, struct slc_place p)
{
    return t->levels[p.level].first_tile + p.y * t->levels[p.level].width + p.x;
}
/** p.level must not be the coarsest regular one. */
static inline struct slc_place slc_parent_place(const struct slc_texture *t, struct slc_place p)
{
    const struct slc_level *up = &t->levels[p.level + 1];
    uint32_t x = p.x >> 1, y = p.y >> 1;
    return (struct slc_place){p.level + 1, x < up->width ? x : up->width - 1,
                              y < up->height ? y : up->height - 1};
}
struct slc_tile_range {
    uint32_t x0, y0, x1, y1; ///< inclusive
};
/** Tiles of `level` (regular) that a region touches. */
struct slc_tile_range slc_region_tiles(const struct slc_texture *t, uint32_t region,
                                       uint32_t level);

/* node.c: nodes, lists, the moves between states */
/** Makes sure that `count` nodes can be taken. */
bool slc_reserve_nodes(slc_manager *m, uint64_t count);
uint32_t slc_find_node(const slc_manager *m, const struct slc_texture *t, uint32_t tile);
void slc_tile_wanted(slc_manager *m, struct slc_texture *t, uint32_t tile, uint32_t level,
                     uint32_t deficit);
void slc_tile_unwanted(slc_manager *m, struct slc_texture *t, uint32_t tile);
/** Changes the state and moves the node to the end of that state's list. */
void slc_node_set_state(slc_manager *m, uint32_t node, SluiceTileState state);
/** REQUESTED again with deficit 0. */
void slc_node_request_again(slc_manager *m, uint32_t node);
/** Takes the node away from its tile, which becomes FREE. The slot must be gone. */
void slc_node_release(slc_manager *m, uint32_t node);
/** The tile becomes FREE, its slot retires (or is free at once). */
void slc_node_retire(slc_manager *m, uint32_t node, uint64_t retire_value);
/** The slot, if there is one, is free at once. */
void slc_node_free_slot(slc_manager *m, uint32_t node);
/** A slot that its tile has left retires; needs a reserved node. */
void slc_node_retire_slot(slc_manager *m, uint32_t heap, uint32_t slot, uint64_t retire_value);
/** Frees the retiring slots whose value has completed. */
void slc_collect_retired(slc_manager *m);
/** Lists STANDBY tiles for unmapping while more than `keep` are not listed. */
void slc_list_standby(slc_manager *m, uint32_t keep);
void slc_node_fail(slc_manager *m, uint32_t node, uint64_t time);
/** The most useful REQUESTED tile, 0 if there is none. */
uint32_t slc_first_request(const slc_manager *m);
SluiceTile slc_node_tile(const slc_manager *m, uint32_t node);
void slc_list_append(slc_manager *m, struct slc_list *list, uint32_t node);
void slc_list_remove(slc_manager *m, struct slc_list *list, uint32_t node);

/* wants.c */
void slc_state_destroy(slc_manager *m, struct slc_texture *t);

/* minmip.c */
/** A regular or packed tile became resident (MAPPED or STANDBY) or stopped to be. */
void slc_min_mip_changed(slc_manager *m, struct slc_texture *t, uint32_t tile, bool resident);
void slc_min_mip_dirty_all(slc_manager *m, struct slc_texture *t);
void slc_min_mip_forget(slc_manager *m, struct slc_texture *t);
/** What the map is where no regular tile is resident. */
uint8_t slc_min_mip_floor(const struct slc_texture *t);

#endif /* SLC_CORE_INTERNAL_H */
