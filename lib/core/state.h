/** The state of a manager. Each file of the core works on a part; docs/manager-specification.md has
 * the rules. */
#ifndef SLC_CORE_STATE_H
#define SLC_CORE_STATE_H

#include <sluice/manager.h>

#include "base/map.h"
#include "base/none.h"
#include "core/calls.h"
#include "residency/machine.h"

#include <assert.h>

#define SLC_UNALIGNED 255
/** In state->nodes: the tile is MAPPED or STANDBY. */
#define SLC_RESIDENT 0x80000000u

/** One regular level, in tiles. */
struct slc_level {
    uint32_t width, height;
    uint32_t first_tile;
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

/** What is done about the GIVEN_UP tiles of a texture. See given_up.c. */
enum slc_trouble {
    SLC_TROUBLE_NONE = 0,
    SLC_TROUBLE_RESTING, ///< until the interval is over
    SLC_TROUBLE_DUE,     ///< to be probed as soon as fewer others are
    SLC_TROUBLE_PROBED,  ///< some of its tiles are being tried
    SLC_TROUBLE_COUNT
};

/** Indices; unspecified while it is empty. */
struct slc_texture_list {
    uint32_t first, last, count;
};

struct slc_managed_texture {
    /* What every answer and every map touches comes first: it is one cache line. */
    uint32_t *nodes;  ///< [regular tiles]: node index, 0: FREE; owned, NULL until sampled. Behind
                      ///< them: tiles resident, then wanted, by regular level
    uint8_t *min_mip; ///< [minMipHeight][minMipWidth], behind these
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
    uint32_t wanted_tiles;   ///< regular ones
    uint32_t first_follower; ///< index, SLC_NONE, as those below

    /* What every map touches */
    uint32_t visit_prev, visit_next;
    uint32_t hits, returns;     ///< how reliable maps are; see history.c
    uint32_t bias_epoch;        ///< of the global bias that the last map was merged with
    uint32_t next_follower;     ///< index, SLC_NONE
    uint32_t failed_total;      ///< fills what would be padding, as unmapped_total below
    uint64_t map_time;          ///< of the last map
    uint64_t interval, timeout; ///< between the last two maps; of the last one
    uint32_t *packed_nodes;     ///< owned, [packedTileCount], NULL if there are none

    /* What every answer touches */
    uint32_t given_up_first; ///< node; 0: none
    uint32_t resident_tiles; ///< regular ones, MAPPED or STANDBY
    uint32_t hidden_tiles;   ///< of these: some coarser tile over it is not resident
    uint32_t dirty_x0, dirty_y0, dirty_x1, dirty_y1; ///< exclusive ends
    uint32_t dirty_prev, dirty_next;

    uint32_t last_follower, prev_follower, primary;   ///< indices, SLC_NONE
    uint32_t given_up_last;                           ///< node; 0: none
    uint32_t report_count, first_report, last_report; ///< numbers; see reports.c
    uint8_t trouble;                                  ///< enum slc_trouble
    bool retried_all;                                 ///< since the last probe
    bool seen;                                        ///< some map asked for something
    int8_t priority;                                  ///< its followers have it, too
    uint32_t trouble_prev, trouble_next; ///< indices, SLC_NONE; in the list of its trouble
    uint32_t unmapped_total;
    uint64_t trouble_time; ///< when it entered that

    uint64_t seen_time;          ///< of the last map that did
    struct slc_uv_transform *uv; ///< owned; NULL: none, it is sampled where its primary is
    uint32_t mapped_total;
};

#define SLC_TEXTURES_PER_CHUNK 64
#define SLC_SHAPE_BUCKETS 256
#define SLC_SPARE_CLASSES 160 /* to 2^45 bytes */

/** A tile that was given up and not asked for yet. See reports.c. */
struct slc_report {
    SluiceTextureId texture_id; ///< SLUICE_NO_TEXTURE: removed since
    uint32_t tile;
    uint32_t next; ///< number of the texture's next one, if there is one
};

struct slc_reports {
    struct slc_report *list; ///< owned queue: [first, end)
    uint32_t first, end, room;
    uint32_t base;        ///< number of list[0]
    uint32_t dropped;     ///< without a texture
    struct slc_map tiles; ///< (texture, tile) of all others; room for `room`
};

/** See mip_bias.c. */
struct slc_global_bias {
    uint32_t value;  ///< sixteenths of a level
    uint32_t maps;   ///< merged since it was looked at last
    uint32_t epoch;  ///< changes so far
    uint32_t behind; ///< visited textures that got no map since the last change
    uint32_t rounds; ///< looks since the last change
    bool raised;     ///< the last change was a raise
    /* What did not fit: */
    uint32_t floor;        ///< below this value too much was wanted; 0: nothing failed yet
    uint64_t failed_limit; ///< for so many slots
    uint64_t demand;       ///< tiles wanted once it had been raised; 0: not known yet
    bool changed;          ///< since then some texture holds something else, not by the bias
    uint32_t trials;       ///< values below the floor that failed again, one after the other
    uint32_t waited;       ///< looks since the last raise
};

/** A round of maps of all textures. Sequences are those of requests. */
struct slc_round {
    uint32_t maps;   ///< merged in it
    uint64_t began;  ///< the next sequence when it began
    uint64_t waited; ///< requests before this one have waited for a whole round
    uint32_t count;
    uint64_t began_long, waited_long; ///< the same, for some rounds
};

/** See tile_events.h. */
struct slc_tile_events {
    SluiceTileEvent *ring;        ///< owned; `capacity`, NULL: none
    uint64_t count;               ///< events so far, which wrote ring[count % capacity]
    uint64_t first;               ///< number of the oldest one since the ring was made
    uint64_t mark;                ///< of the application
    uint32_t capacity;            ///< of the ring
    SluiceTileEventReason reason; ///< of what changes from now on
};

struct SluiceStreamedTextureManager {
    SluiceStreamedTextureManagerCreateInfo info; ///< pAllocator points to `given` or is NULL
    SluiceAllocationCallbacks given;
    SluiceAllocationCallbacks cb; ///< counts into host_memory_size, hands on to `given`
    uint64_t host_memory_size;
    SluiceStreamedTextureManagerConfig config;
    uint64_t config_count; ///< calls of sluiceSetConfig that succeeded
    struct slc_observer observer;
    bool used; ///< a call was made that changed something

    struct slc_shape *shapes[SLC_SHAPE_BUCKETS]; ///< by hash, owned lists
    struct slc_spares spares[SLC_SPARE_CLASSES]; ///< owned blocks
    struct slc_managed_texture **chunks;         ///< owned, [chunk_count], owned chunks
    uint32_t chunk_count, chunk_room;
    uint32_t texture_end;   ///< indices ever used
    uint32_t texture_count; ///< live
    uint32_t *free_indices; ///< owned min-heap, room for every texture of the chunks
    uint32_t free_index_count, free_index_room;
    uint64_t tile_count;

    struct slc_machine residency;
    struct slc_tile_events events;

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

    struct slc_reports reports;

    struct slc_texture_list troubles[SLC_TROUBLE_COUNT]; ///< that of NONE is not kept
    uint32_t trouble_count;                              ///< in all of them

    uint32_t prefetch_level, prefetch_texture; ///< what to look at next; levels from the coarsest

    uint32_t dirty_first, dirty_last; ///< indices, SLC_NONE
    uint32_t dirty_count;

    bool has_time;
    uint64_t time;
    uint64_t last_retire;
    uint64_t handed_out_total, mapped_total, unmapped_total, canceled_total, failed_total;
    uint64_t moved_total, given_up_retried_total;
};

/** Calls that hand out or answer are refused: whoever created the manager makes them alone. */
static inline bool slc_is_locked(const SluiceStreamedTextureManager *manager)
{
    return manager->info.pLocked && *manager->info.pLocked;
}

typedef SluiceStreamedTextureManager slc_manager;

static inline struct slc_managed_texture *slc_texture_at(const slc_manager *m, uint32_t index)
{
    return &m->chunks[index / SLC_TEXTURES_PER_CHUNK][index % SLC_TEXTURES_PER_CHUNK];
}
static inline SluiceTextureId slc_texture_id(const struct slc_managed_texture *t)
{
    return (uint64_t)t->generation << 32 | t->index;
}
struct slc_place {
    uint32_t level, x, y;
};
static inline uint32_t slc_tile_index(const struct slc_managed_texture *t, struct slc_place p)
{
    return t->shape->levels[p.level].first_tile + p.y * t->shape->levels[p.level].width + p.x;
}
/** The place of a tile whose level is known; regularMipCount for packed ones. */
static inline struct slc_place slc_place_at(const struct slc_managed_texture *t, uint32_t tile,
                                            uint32_t level)
{
    if (tile >= t->shape->regular_tile_count)
        return (struct slc_place){t->shape->desc.regularMipCount,
                                  tile - t->shape->regular_tile_count, 0};
    const struct slc_level *grid = &t->shape->levels[level];
    uint32_t i = tile - grid->first_tile;
    return (struct slc_place){level, i % grid->width, i / grid->width};
}
static inline struct slc_place slc_node_place(const struct slc_managed_texture *t,
                                              const struct slc_node *n)
{
    return slc_place_at(t, n->tile, n->level);
}
struct slc_tile_range {
    uint32_t x0, y0, x1, y1; ///< inclusive
};

/** How many tiles of a regular level are resident. The texture has a state. */
static inline uint32_t *slc_resident_in_level(const struct slc_managed_texture *t, uint32_t level)
{
    return &t->nodes[t->shape->regular_tile_count + level];
}
/** How many are wanted. */
static inline uint32_t *slc_wanted_in_level(const struct slc_managed_texture *t, uint32_t level)
{
    return slc_resident_in_level(t, t->shape->desc.regularMipCount + level);
}
/** Where a tile keeps its node; NULL for a regular one without a state. */
static inline uint32_t *slc_node_cell(const struct slc_managed_texture *t, uint32_t tile)
{
    if (tile >= t->shape->regular_tile_count)
        return &t->packed_nodes[tile - t->shape->regular_tile_count];
    return t->nodes ? &t->nodes[tile] : NULL;
}
static inline uint32_t slc_find_node(const struct slc_managed_texture *t, uint32_t tile)
{
    const uint32_t *cell = slc_node_cell(t, tile);
    return cell ? *cell & ~SLC_RESIDENT : 0;
}

#endif /* SLC_CORE_STATE_H */
