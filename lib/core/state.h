/** State of a manager. Each file of the core works on a part of it. docs/manager-specification.md
 * has the rules. */
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

/** Consecutive maps merged into one: the finest level that any of them requested. See history.c. */
struct slc_span {
    uint64_t begin, end; ///< times of the first and of the last map of the span
    uint32_t weight;     ///< number of maps
    uint8_t below;       ///< levels from this one on were removed from `map`
    bool empty;          ///< `map` requests nothing, as found by the last removal of levels
    uint8_t *map;        ///< [padded regions], owned; stays for reuse when the span is dropped
};

/**
 * Requests of a texture's maps. One allocation, except for the maps of spans. Textures of a set
 * share a history if they have equal shapes and have always got the same maps.
 */
struct slc_history {
    uint32_t users;                       ///< textures that share the history
    struct slc_span spans[SLC_MAX_SPANS]; ///< [0, span_count) live, oldest first
    uint32_t span_count;
    uint32_t bias;       ///< global mip bias that `under` was computed with
    uint32_t absence;    ///< misses that the last consecutive empty maps count as
    uint8_t asked_least; ///< finest level in `asked`
    uint8_t *under; ///< [regular tiles + a block]: finest requested level under each tile, biased
    uint8_t *asked; ///< [padded regions]: requests of the last map (a in the specification, not w)
    uint8_t *known; ///< [padded regions]: finest level of many maps, expired ones too; for learning
    uint8_t *least; ///< [padded regions]: finest level of all spans
    bool has_same_hits;
    uint32_t same_hits; ///< hits of a map equal to `asked`; valid if has_same_hits
    /* The map being merged: */
    const uint8_t *next;    ///< in the manager's scratch; NULL: equal to `asked`
    uint32_t hits, returns; ///< added to the texture's hits and returns by the merge
};

/** Blocks of one size class for the arrays of textures. */
struct slc_spares {
    void *first;   ///< free blocks; each begins with the pointer to the next one
    void *chunks;  ///< owned memory of all blocks
    uint32_t used; ///< blocks that textures have
};

/** Data shared by textures of one description; reference-counted. See shape.c. */
struct slc_shape {
    uint32_t users;
    uint32_t hash;
    struct slc_shape *next, **link; ///< list of the bucket; `link` points to the pointer to this
    SluiceStreamedTextureDesc desc;
    uint32_t regular_tile_count, tile_count;
    uint32_t feedback_width, feedback_height, region_count;
    uint32_t min_mip_width, min_mip_height;
    uint8_t region_shift_x, region_shift_y; ///< log2 of regions per tile, or SLC_UNALIGNED
    size_t work_size;                       ///< bytes of scratch of a commit, see wants.h
    struct slc_level levels[SLUICE_MAX_MIP_LEVELS];
};

/** State of the retries of a texture's GIVEN_UP tiles. See given_up_retry.c. */
enum slc_trouble {
    SLC_TROUBLE_NONE = 0,
    SLC_TROUBLE_RESTING, ///< waits for the end of the interval
    SLC_TROUBLE_DUE,     ///< waits until fewer textures are probed
    SLC_TROUBLE_PROBED,  ///< some of its tiles are requested again
    SLC_TROUBLE_COUNT
};

/** List of textures. */
struct slc_texture_list {
    uint32_t first, last, count; ///< first, last: indices; unspecified while count is 0
};

struct slc_managed_texture {
    /* Fields that every answer and every map touches come first, in one cache line. */
    uint32_t *nodes;  ///< [regular tiles]: node index, 0: FREE; owned, NULL until sampled. Followed
                      ///< by counts of resident, then of wanted tiles per regular level
    uint8_t *min_mip; ///< [minMipHeight][minMipWidth], in the same allocation behind the counts
    struct slc_history *history; ///< may be shared; NULL: empty
    struct slc_shape *shape;
    uint32_t generation;
    uint32_t index;
    bool live;
    bool has_map;             ///< a map was merged; it was empty if there is no history
    bool dirty;               ///< in the manager's list of MinMip updates
    bool visited;             ///< in the manager's list of textures with requests
    uint32_t packed_resident; ///< packed tiles MAPPED or STANDBY
    uint32_t regular_nodes;   ///< nodes of regular tiles
    uint32_t requested_count;
    uint32_t held_regions;   ///< regions with a request
    uint32_t wanted_tiles;   ///< regular tiles
    uint32_t first_follower; ///< index or SLC_NONE, like next_follower and last_follower

    /* Fields that every map touches */
    uint32_t visit_prev, visit_next;
    uint32_t hits, returns;     ///< reliability of maps; see history.c
    uint32_t bias_epoch;        ///< bias.epoch when the last map was merged
    uint32_t next_follower;     ///< index or SLC_NONE
    uint32_t failed_total;      ///< placed to fill padding, like unmapped_total below
    uint64_t map_time;          ///< time of the last map
    uint64_t interval, timeout; ///< interval between the last two maps; timeout of the last map
    uint32_t *packed_nodes;     ///< owned, [packedTileCount]; NULL if there are none

    /* Fields that every answer touches */
    uint32_t given_up_first; ///< node; 0: none
    uint32_t resident_tiles; ///< regular tiles that are MAPPED or STANDBY
    uint32_t hidden_tiles;   ///< resident_tiles under a coarser tile that is not resident
    uint32_t dirty_x0, dirty_y0, dirty_x1, dirty_y1; ///< exclusive ends
    uint32_t dirty_prev, dirty_next;

    uint32_t last_follower, prev_follower, primary;   ///< indices or SLC_NONE
    uint32_t given_up_last;                           ///< node; 0: none
    uint32_t report_count, first_report, last_report; ///< numbers; see reports.c
    uint8_t trouble;                                  ///< enum slc_trouble
    bool retried_all;                                 ///< since the last probe
    bool seen;                                        ///< some map requested something
    int8_t priority;                                  ///< valid for the followers, too
    uint32_t trouble_prev, trouble_next; ///< indices or SLC_NONE; links of the list `trouble`
    uint32_t unmapped_total;
    uint64_t trouble_time; ///< time at which the texture entered the list `trouble`

    uint64_t seen_time;          ///< time of the last map that requested something
    struct slc_uv_transform *uv; ///< owned; NULL: the texture has the UVs of its primary
    uint32_t mapped_total;
};

#define SLC_TEXTURES_PER_CHUNK 64
#define SLC_SHAPE_BUCKETS 256
#define SLC_SPARE_CLASSES 160 /* to 2^45 bytes */

/** GIVEN_UP tile that sluiceGetGivenUpTiles has not listed yet. See reports.c. */
struct slc_report {
    SluiceTextureId texture_id; ///< SLUICE_NO_TEXTURE: the texture was removed
    uint32_t tile;
    uint32_t next; ///< number of the texture's next report, if there is one
};

struct slc_reports {
    struct slc_report *list; ///< owned queue: [first, end)
    uint32_t first, end, room;
    uint32_t base;        ///< number of list[0]
    uint32_t dropped;     ///< reports whose texture was removed
    struct slc_map tiles; ///< (texture, tile) of all other reports; capacity `room`
};

/** Global mip bias. See mip_bias.c. */
struct slc_global_bias {
    uint32_t value;  ///< sixteenths of a level
    uint32_t maps;   ///< maps merged since the last round
    uint32_t epoch;  ///< changes so far
    uint32_t behind; ///< visited textures that got no map since the last change
    uint32_t rounds; ///< rounds since the last change
    bool raised;     ///< the last change was a raise
    /* The last value that failed, because more tiles were wanted than slots exist: */
    uint32_t floor;        ///< least value that has not failed; 0: no value failed yet
    uint64_t failed_limit; ///< slot limit at the failure
    uint64_t demand;       ///< tiles wanted after the raise; 0: not known yet
    bool changed;          ///< some texture's requests changed since the failure, bias aside
    uint32_t trials;       ///< consecutive trials of values below the floor that failed
    uint32_t waited;       ///< rounds since the last raise
};

/** Round of maps of all textures. `began` and `waited` are sequence numbers of requests. */
struct slc_round {
    uint32_t maps;   ///< maps merged in the round
    uint64_t began;  ///< next sequence number when the round began
    uint64_t waited; ///< requests before this one have waited for a whole round
    uint32_t count;
    uint64_t began_long, waited_long; ///< like began and waited, for periods of several rounds
};

/** State changes of tiles. See tile_events.h. */
struct slc_tile_events {
    SluiceTileEvent *ring;        ///< owned, [capacity]; NULL: none
    uint64_t count;               ///< events so far; event n is ring[n % capacity]
    uint64_t first;               ///< number of the first event since the ring was made
    uint64_t mark;                ///< mark that the application set
    uint32_t capacity;            ///< events that the ring holds
    SluiceTileEventReason reason; ///< reason of changes from now on
};

struct SluiceStreamedTextureManager {
    SluiceStreamedTextureManagerCreateInfo info; ///< pAllocator points to `given` or is NULL
    SluiceAllocationCallbacks given;
    SluiceAllocationCallbacks cb; ///< counts into host_memory_size, then calls `given`
    uint64_t host_memory_size;
    SluiceStreamedTextureManagerConfig config;
    uint64_t config_count; ///< calls of sluiceSetConfig that succeeded
    struct slc_observer observer;
    bool used; ///< some call other than sluiceSetConfig was made

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
    uint32_t visit_first, visit_last; ///< textures with requests, the oldest map first
    uint32_t visited_count;
    uint64_t map_interval; ///< `interval` of the texture that got a map last
    struct slc_global_bias bias;
    struct slc_round round;
    bool starved;   ///< the last hand-out stopped for lack of slots
    bool refused;   ///< the heap allocator refused the last heap
    bool cut_short; ///< host memory ran out while the call under way handed out tiles

    struct slc_reports reports;

    struct slc_texture_list troubles[SLC_TROUBLE_COUNT]; ///< by trouble; the list NONE is unused
    uint32_t trouble_count;                              ///< textures in all lists

    uint32_t prefetch_level, prefetch_texture; ///< next level (0: the coarsest) and texture to try

    uint32_t dirty_first, dirty_last; ///< indices, SLC_NONE
    uint32_t dirty_count;

    bool has_time;
    uint64_t time;
    uint64_t last_retire;
    uint64_t handed_out_total, mapped_total, unmapped_total, canceled_total, failed_total;
    uint64_t moved_total, given_up_retried_total;
};

/** True if the owner has locked the manager: calls that hand out or answer tiles are refused. */
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
/** Returns the place of a tile. `level` is regularMipCount for packed tiles. */
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

/** Returns the counter of resident tiles of a regular level. The texture must have a state. */
static inline uint32_t *slc_resident_in_level(const struct slc_managed_texture *t, uint32_t level)
{
    return &t->nodes[t->shape->regular_tile_count + level];
}
/** Returns the counter of wanted tiles of a regular level. The texture must have a state. */
static inline uint32_t *slc_wanted_in_level(const struct slc_managed_texture *t, uint32_t level)
{
    return slc_resident_in_level(t, t->shape->desc.regularMipCount + level);
}
/** Returns the cell that holds a tile's node; NULL for a regular tile of a texture without a state.
 */
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
