/** What the files of the core share. See docs/manager.md for the rules they carry out. */
#ifndef SLC_CORE_INTERNAL_H
#define SLC_CORE_INTERNAL_H

#include <sluice/manager.h>

#include "base/map.h"
#include "core/observer.h"
#include "core/tile_heap.h"

#include <assert.h>

#define SLC_NONE UINT32_MAX
#define SLC_UNALIGNED 255
/** In state->nodes: the tile is MAPPED or STANDBY. */
#define SLC_RESIDENT 0x80000000u

/** One regular level, in tiles. */
struct slc_level {
    uint32_t width, height;
    uint32_t first_tile;
};

enum slc_node_flags {
    SLC_NODE_LISTED = 1, ///< CANCELLED: handed out as such; STANDBY: listed for unmapping
    SLC_NODE_WANTED = 2, ///< CANCELLED and handed out: wanted again; STANDBY and listed: displaced
};

/** A slot whose tile was unmapped and that the GPU may still read; beside SluiceTileState. */
#define SLC_NODE_RETIRING 255

/** One per tile that is not FREE, and per retiring slot. Index 0 is none. */
struct slc_node {
    uint32_t texture; ///< index; SLC_NONE for retiring slots
    uint32_t tile;
    uint32_t prev, next; ///< in the list of its state
    uint32_t heap, slot; ///< heap is an index, SLC_NONE without memory
    uint32_t failures;
    uint8_t state, level, need, flags; ///< need: log2 of the tiles of level 0 that want it
    uint64_t order;                    ///< REQUESTED: sequence; FAILED: due; retiring: retire value
};

struct slc_list {
    uint32_t head, tail; ///< 0: empty
    uint32_t count;
};

#define SLC_REQUEST_CLASSES (SLUICE_MAX_MIP_LEVELS + 1) ///< a class per level and one for packed
#define SLC_PACKED_CLASS SLUICE_MAX_MIP_LEVELS
/** What a tile of level 0 to 20 can be needed by is 2^0 to 2^40 tiles of level 0, 2^30 at most. */
#define SLC_REQUEST_NEEDS 31

/** REQUESTED tiles by class and need. */
struct slc_requests {
    struct slc_list lists[SLC_REQUEST_CLASSES][SLC_REQUEST_NEEDS];
    uint32_t needs[SLC_REQUEST_CLASSES]; ///< bit n: lists[class][n] is not empty
    uint32_t counts[SLC_REQUEST_CLASSES];
    uint32_t classes; ///< bit c: needs[c] is not 0
    uint32_t count;
    uint64_t next_sequence;
};

#define SLC_MAX_SPANS 6

/** Maps that count as one: the least level that any of them asked for. See history.c. */
struct slc_span {
    uint64_t begin, end; ///< times of the first and of the last map
    uint32_t weight;     ///< in maps
    uint8_t below;       ///< only levels below this are still in the map
    bool empty;          ///< nothing is left of it, as far as was looked
    uint8_t *map;        ///< [padded regions], owned; stays for reuse when the span is dropped
};

/**
 * What the maps of a texture asked for. One allocation, but for the spans' maps. Textures of a set
 * that have the same shape and have always got the same maps have one together.
 */
struct slc_history {
    uint32_t users;                       ///< textures
    struct slc_span spans[SLC_MAX_SPANS]; ///< [0, span_count) live, oldest first
    uint32_t span_count;
    uint32_t bias;       ///< of the manager when `under` was computed
    uint32_t absence;    ///< misses that the last maps stand for, as none saw anything
    uint8_t asked_least; ///< of `asked`
    uint8_t *under; ///< [regular tiles + a block]: the least level held in a region under the tile
    uint8_t *asked; ///< [padded regions]: what the last map asked for (a, not w)
    uint8_t *known; ///< [padded regions]: the least of many maps, lapsed ones too; for learning
    uint8_t *least; ///< [padded regions]: the least over all spans
    bool has_same_hits;
    uint32_t same_hits; ///< of a map like the last one, if they were counted
    /* The map being merged: */
    const uint8_t *next;    ///< in the manager's scratch, NULL: as `asked`
    uint32_t hits, returns; ///< what slc_texture's will grow by
};

/** Blocks of one size class for the arrays of textures. */
struct slc_spares {
    void *first;   ///< free ones, in each of which the next one stands
    void *chunks;  ///< owned memory of all
    uint32_t used; ///< that textures have
};

/** What textures of one description have in common; counted references. See shape.c. */
struct slc_shape {
    uint32_t users;
    uint32_t hash;
    struct slc_shape *next, **link; ///< in its bucket; `link` is what points to it
    SluiceStreamedTextureDesc desc;
    uint32_t regular_tile_count, tile_count;
    uint32_t feedback_width, feedback_height, region_count;
    uint32_t min_mip_width, min_mip_height;
    uint8_t region_shift_x, region_shift_y; ///< regions per tile, log2; SLC_UNALIGNED
    size_t work_size;                       ///< see wants.h
    struct slc_level levels[SLUICE_MAX_MIP_LEVELS];
};

struct slc_texture {
    /* What every answer and every map touches comes first: it is one cache line. */
    uint32_t *nodes;  ///< [regular tiles]: node index, 0: FREE; owned, NULL until sampled
    uint8_t *min_mip; ///< [minMipHeight][minMipWidth], behind the nodes
    struct slc_history *history; ///< may be shared; NULL: empty
    struct slc_shape *shape;
    uint32_t generation;
    uint32_t index;
    bool live;
    bool has_map;             ///< a map was merged; without a history it was empty
    bool dirty;               ///< in the manager's list of MinMip updates
    bool visited;             ///< in the list of those that hold something
    uint32_t packed_resident; ///< packed tiles MAPPED or STANDBY
    uint32_t regular_nodes;   ///< nodes of regular tiles
    uint32_t requested_count;
    uint32_t held_regions;   ///< that hold anything
    uint32_t first_follower; ///< index, SLC_NONE, as those below

    uint32_t resident_tiles; ///< regular ones, MAPPED or STANDBY
    uint32_t hidden_tiles;   ///< of these: some coarser tile over it is not resident
    uint32_t dirty_x0, dirty_y0, dirty_x1, dirty_y1; ///< exclusive ends
    uint32_t dirty_prev, dirty_next;
    uint32_t visit_prev, visit_next;
    uint32_t last_follower, next_follower, primary;
    uint32_t hits, returns;     ///< how reliable maps are; see history.c
    uint32_t *packed_nodes;     ///< owned, [packedTileCount], NULL if there are none
    uint64_t map_time;          ///< of the last map
    uint64_t interval, timeout; ///< between the last two maps; of the last one
};

#define SLC_TEXTURES_PER_CHUNK 64
#define SLC_NODES_PER_CHUNK 1024
#define SLC_SHAPE_BUCKETS 256
#define SLC_SPARE_CLASSES 160 /* to 2^45 bytes */

struct slc_given_up {
    SluiceTextureId texture_id;
    uint32_t tile;
};

/** See bias.c. */
struct slc_global_bias {
    uint32_t value;        ///< sixteenths of a level
    uint32_t maps;         ///< merged since it was looked at last
    uint32_t failed;       ///< the last value with which too much was wanted,
    uint64_t failed_limit; ///< for so many slots
    uint64_t demand;       ///< tiles wanted once it had been raised; 0: not known yet
};

/** A round of maps of all textures. Sequences are those of requests. */
struct slc_round {
    uint32_t maps;   ///< merged in it
    uint64_t began;  ///< the next sequence when it began
    uint64_t waited; ///< requests before this one have waited for a whole round
    uint32_t count;
    uint64_t began_long, waited_long; ///< the same, for some rounds
};

struct SluiceStreamedTextureManager {
    SluiceStreamedTextureManagerCreateInfo info; ///< pAllocator points to `given` or is NULL
    SluiceAllocationCallbacks given;
    SluiceAllocationCallbacks cb; ///< counts into host_memory_size, hands on to `given`
    uint64_t host_memory_size;
    SluiceStreamedTextureManagerConfig config;
    struct slc_observer observer;
    bool used; ///< a call was made that changed something

    struct slc_shape *shapes[SLC_SHAPE_BUCKETS]; ///< by hash, owned lists
    struct slc_spares spares[SLC_SPARE_CLASSES]; ///< owned blocks
    struct slc_texture **chunks;                 ///< owned, [chunk_count], owned chunks
    uint32_t chunk_count, chunk_room;
    uint32_t texture_end;   ///< indices ever used
    uint32_t texture_count; ///< live
    uint32_t *free_indices; ///< owned min-heap, room for every texture of the chunks
    uint32_t free_index_count, free_index_room;
    uint64_t tile_count;

    struct slc_node **node_chunks; ///< owned, [node_chunk_room]; node 0 is unused
    uint32_t node_chunk_count, node_chunk_room;
    uint32_t node_end, free_node, free_node_count;
    uint32_t state_counts[8]; ///< nodes by SluiceTileState
    struct slc_requests requests;
    struct slc_list standby, unmapping, cancelled, failed, given_up, retiring;
    struct slc_list mapped[SLUICE_MAX_MIP_LEVELS]; ///< MAPPED regular tiles by level, oldest first
    uint32_t displaced;                            ///< tiles listed for unmapping that are wanted

    uint8_t *scratch; ///< owned, for the maps of one call
    size_t scratch_room;
    uint32_t visit_first, visit_last; ///< textures that hold something, the oldest map first
    uint32_t visited_count;
    uint64_t map_interval; ///< of the texture that got a map last
    struct slc_global_bias bias;
    struct slc_round round;
    bool starved;   ///< the last hand-out stopped for lack of slots
    bool refused;   ///< the heap allocator's last answer
    bool cut_short; ///< host memory ran out while the call under way handed out tiles

    struct slc_given_up *given_up_reports; ///< owned queue: [first, end)
    uint32_t report_first, report_end, report_room;
    struct slc_map reported; ///< (texture, tile) that are in it; room for report_room

    uint32_t prefetch_level, prefetch_texture; ///< what to look at next; levels from the coarsest

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
static inline struct slc_node *slc_node_at(const slc_manager *m, uint32_t node)
{
    return &m->node_chunks[node / SLC_NODES_PER_CHUNK][node % SLC_NODES_PER_CHUNK];
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

/** Puts the texture at the end of the list of those that hold something, or takes it out. */
void slc_visit(slc_manager *m, struct slc_texture *t, bool holds);

/* node.c */
/** Lists a MAPPED tile for unmapping though it is wanted. */
void slc_node_displace(slc_manager *m, uint32_t node);
/** It is unmapped and REQUESTED; false without memory. */
bool slc_node_unmap_displaced(slc_manager *m, uint32_t node, uint64_t retire_value);

/* lists.c */
/** Slots that only packed tiles may take. */
uint32_t slc_reserved_slots(const slc_manager *m);

/* history.c */
/** Whether the texture's last map asks for the tile; packed tiles always are. */
bool slc_is_asked_for(const slc_manager *m, uint32_t node);
/** The same for a regular tile or one of its neighbours: chance hides one, not all of them. */
bool slc_is_seen(const slc_manager *m, uint32_t node);

/* bias.c */
/** How many tiles may be wanted: a multiple of the slots that there can be, as far as is known. */
uint64_t slc_slot_limit(const slc_manager *m);
/**
 * Once per hand-out: raises the bias if too much is wanted, lowers it if there is room. `limit` is
 * the slot limit before heaps were asked for.
 */
void slc_update_bias(slc_manager *m, uint64_t limit);
/** Writes what the global bias adds in each region. */
void slc_bias_map(const slc_manager *m, const struct slc_texture *t, uint8_t *map);

/* shape.c */
SluiceResult slc_shape_take(slc_manager *m, const SluiceStreamedTextureDesc *desc,
                            struct slc_shape **shape);
void slc_shape_give(slc_manager *m, struct slc_shape *shape);

/* spares.c: memory of textures */
/** Bytes for a while; not cleared. NULL: there are none. All are given back before the end. */
void *slc_spares_take(slc_manager *m, size_t size);
/** Of the size that was taken. NULL is allowed. */
void slc_spares_give(slc_manager *m, void *memory, size_t size);

/* layout.c */
SluiceResult slc_layout_texture(const SluiceStreamedTextureDesc *desc, struct slc_shape *s);
void slc_write_layout(const struct slc_shape *s, SluiceStreamedTextureLayout *layout);
struct slc_place {
    uint32_t level, x, y;
};
/** `level` is regularMipCount for packed tiles. */
struct slc_place slc_tile_place(const struct slc_texture *t, uint32_t tile);
static inline uint32_t slc_tile_index(const struct slc_texture *t, struct slc_place p)
{
    return t->shape->levels[p.level].first_tile + p.y * t->shape->levels[p.level].width + p.x;
}
/** The place of a tile whose level is known; regularMipCount for packed ones. */
static inline struct slc_place slc_place_at(const struct slc_texture *t, uint32_t tile,
                                            uint32_t level)
{
    if (tile >= t->shape->regular_tile_count)
        return (struct slc_place){t->shape->desc.regularMipCount,
                                  tile - t->shape->regular_tile_count, 0};
    const struct slc_level *grid = &t->shape->levels[level];
    uint32_t i = tile - grid->first_tile;
    return (struct slc_place){level, i % grid->width, i / grid->width};
}
static inline struct slc_place slc_node_place(const struct slc_texture *t, const struct slc_node *n)
{
    return slc_place_at(t, n->tile, n->level);
}
struct slc_tile_range {
    uint32_t x0, y0, x1, y1; ///< inclusive
};

/** Where a tile keeps its node; NULL for a regular one without a state. */
static inline uint32_t *slc_node_cell(const struct slc_texture *t, uint32_t tile)
{
    if (tile >= t->shape->regular_tile_count)
        return &t->packed_nodes[tile - t->shape->regular_tile_count];
    return t->nodes ? &t->nodes[tile] : NULL;
}
static inline uint32_t slc_find_node(const struct slc_texture *t, uint32_t tile)
{
    const uint32_t *cell = slc_node_cell(t, tile);
    return cell ? *cell & ~SLC_RESIDENT : 0;
}

/* node.c: nodes, lists, the moves between states */
/** Makes sure that `count` nodes can be taken. */
bool slc_reserve_nodes(slc_manager *m, uint64_t count);
/** `cell` is where the tile keeps its node. */
void slc_tile_wanted(slc_manager *m, struct slc_texture *t, uint32_t *cell, uint32_t tile,
                     uint32_t level);
/** The same for a FREE tile, with a need. */
void slc_tile_requested(slc_manager *m, struct slc_texture *t, uint32_t *cell, uint32_t tile,
                        uint32_t level, uint32_t need);
void slc_tile_unwanted(slc_manager *m, uint32_t node);
/** A REQUESTED tile, which has got a slot, becomes ALLOCATED. */
void slc_tile_handed_out(slc_manager *m, uint32_t node);
/** An ALLOCATED tile becomes MAPPED. */
void slc_tile_mapped(slc_manager *m, struct slc_texture *t, uint32_t node);
/** Regular tiles of one level on their way between MAPPED and STANDBY. */
struct slc_run {
    uint32_t first, last, next; ///< nodes; `next` followed the last one
    uint32_t count, level;
    bool wanted;
};
/** The tile's move joins the run or begins the next one; false, and nothing, if it is another. */
bool slc_run_add(slc_manager *m, struct slc_run *run, uint32_t node, uint32_t level, bool wanted);
/** The moves of the run are made. */
void slc_run_end(slc_manager *m, struct slc_run *run);
/** A FREE tile gets a node as if it had been handed out and then no longer wanted. */
uint32_t slc_node_prefetch(slc_manager *m, struct slc_texture *t, uint32_t tile, uint32_t level);
/** Changes the state and moves the node to the end of that state's list. */
void slc_node_set_state(slc_manager *m, uint32_t node, SluiceTileState state);
/** REQUESTED again with need 0. */
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
/** The one after it, 0 at the end. */
uint32_t slc_next_request(const slc_manager *m, uint32_t node);
SluiceTile slc_node_tile(const slc_manager *m, uint32_t node);
void slc_list_append(slc_manager *m, struct slc_list *list, uint32_t node);
void slc_list_remove(slc_manager *m, struct slc_list *list, uint32_t node);

/* history.c */
/** Destroys the state if it says no more than none does. */
void slc_state_release(slc_manager *m, struct slc_texture *t);
void slc_state_destroy(slc_manager *m, struct slc_texture *t);

/* minmip.c */
/** The tile of a node became resident (MAPPED or STANDBY) or stopped to be. */
void slc_min_mip_changed(slc_manager *m, struct slc_texture *t, const struct slc_node *n,
                         bool resident);
/** The tiles of level 0 under a tile, which are the texels of the map. */
struct slc_tile_range slc_area(const struct slc_texture *t, struct slc_place p);
/** That is going to be called for a tile. */
void slc_min_mip_prefetch(const struct slc_texture *t, const struct slc_node *n);
void slc_min_mip_dirty_all(slc_manager *m, struct slc_texture *t);
void slc_min_mip_forget(slc_manager *m, struct slc_texture *t);
/** What the map is where no regular tile is resident. */
uint8_t slc_min_mip_floor(const struct slc_texture *t);

#endif /* SLC_CORE_INTERNAL_H */
