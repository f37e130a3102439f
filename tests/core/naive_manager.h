/**
 * A second manager, written from docs/manager-specification.md with plain arrays and loops over
 * everything. Lists are made by sorting all tiles. Shares no code with lib/core. Exits when out of
 * memory.
 *
 * The rules leave two choices open: the slot of a tile among equally full heaps, and the moves of
 * defragmentation. These choices, new texture ids and the heap allocator's answers are copied from
 * the other manager, after a check that they are allowed.
 */
#ifndef TESTS_CORE_NAIVE_MANAGER_H
#define TESTS_CORE_NAIVE_MANAGER_H

#include "core/call.h"

struct naive_tile {
    uint32_t level, x, y;
    bool packed;
    bool outside; ///< true: takes no slot
    SluiceTileState state;
    bool wanted;
    bool cancel_handed_out;
    bool listed; ///< STANDBY and listed for unmapping; if wanted, too: evicted
    uint32_t failures;
    uint32_t need;
    uint32_t heap, slot;
    uint64_t due;
    /* Stamps of one counter, which order events. */
    uint64_t requested_at, canceled_at, mapped_at, standby_at, listed_at, failed_at, given_up_at;
};

#define NAIVE_MAX_SPANS 6

struct naive_span {
    uint64_t begin, end; ///< times of its first and last map
    uint64_t weight;     ///< number of maps
    uint8_t *asked;      ///< by region: least `a`, or 255
};

enum naive_trouble {
    NAIVE_TROUBLE_NONE = 0,
    NAIVE_TROUBLE_RESTING,
    NAIVE_TROUBLE_DUE,
    NAIVE_TROUBLE_PROBED
};

struct naive_texture {
    SluiceTextureId id;
    SluiceStreamedTextureLayout layout;
    struct naive_tile *tiles;
    uint32_t span_count;
    struct naive_span spans[NAIVE_MAX_SPANS]; ///< oldest first
    uint8_t *known;   ///< by region: least `a` over many maps, or 255; NULL: none
    uint64_t absence; ///< number of misses by recent maps that requested nothing
    uint32_t hits, returns;
    uint8_t *held;        ///< by region; 255: nothing
    uint8_t *last_asked;  ///< `a` of the last map; 255: nothing; NULL: no map yet
    uint8_t *last_wishes; ///< finest requested level of the regular tiles, by last_asked
    uint64_t map_stamp;   ///< stamp of the last map; 0: no map yet
    uint64_t map_time, map_timeout, interval;
    uint32_t merged_bias;         ///< mip bias of the last map
    uint64_t merged_bias_changes; ///< bias.changes at the last map
    SluiceTextureId primary;
    uint64_t follower_since;
    uint8_t *minmip;
    bool minmip_stale;
    uint64_t dirty_since; ///< 0: clean
    uint8_t *changed;     ///< by MinMip texel: changed since last listed
    enum naive_trouble trouble;
    uint64_t trouble_since, trouble_time; ///< stamp and time
    bool retried_all;                     ///< true: since the last probe
};

enum naive_slot_use { NAIVE_SLOT_FREE = 0, NAIVE_SLOT_USED, NAIVE_SLOT_RETIRING };

struct naive_slot {
    enum naive_slot_use use;
    uint64_t retire;
};

struct naive_heap {
    uint32_t id, number;
    struct naive_slot *slots;
    bool packed; ///< true: for packed tiles, until the heap is empty
};

struct naive_given_up {
    SluiceTextureId texture;
    uint32_t tile;
};

/** Events that random calls should reach. */
enum naive_event {
    NAIVE_BIAS_ABOVE_0, ///< after a call that hands out tiles
    NAIVE_BIAS_LOWERED,
    NAIVE_BIAS_WAITED,       ///< for due maps
    NAIVE_BIAS_TRIED_AGAIN,  ///< with a value that failed before
    NAIVE_BIAS_FAILED_AGAIN, ///< below the floor
    NAIVE_STARVED,           ///< the bias began to starve
    NAIVE_PASSED_OVER,
    NAIVE_FORGOTTEN,
    NAIVE_PREFETCHED,
    NAIVE_SPAN_THINNED, ///< some levels were deleted, others kept
    NAIVE_SPANS_FULL,
    NAIVE_SEPARATED,    ///< a heap became one for packed tiles
    NAIVE_MIXED,        ///< a tile got a slot in a heap of the other kind
    NAIVE_RESERVE_KEPT, ///< a regular tile got no slot though some were free
    NAIVE_SLOT_OWED,    ///< more than the reserve was free, but coarser tiles are requested
    NAIVE_RETURNS,      ///< maps with hits after misses, while misses are learned
    NAIVE_EVICTED,
    NAIVE_UNSEEN_EVICTED,
    NAIVE_SEEN_EVICTED,
    NAIVE_LONG_WAITED,
    NAIVE_EVICTED_UNMAPPED,
    NAIVE_EVICTED_UNWANTED, ///< before they were unmapped
    NAIVE_PROBED,           ///< a texture, for its given-up tiles
    NAIVE_PROBED_EARLY,
    NAIVE_RETRIED_ALL,
    NAIVE_EVACUATED,         ///< tiles
    NAIVE_TEXTURE_FORGOTTEN, ///< tiles
    NAIVE_TEXTURE_EVICTED,   ///< a texture that held anything
    NAIVE_TEXTURE_LISTED,    ///< its tiles were listed for unmapping
    NAIVE_FOLLOWER_EVICTED,  ///< with its primary
    NAIVE_EVENT_COUNT
};

struct naive_bias {
    uint32_t value;   ///< sixteenths of a level
    uint64_t maps;    ///< maps merged since the last look at the bias
    uint64_t changes; ///< changes of `value` so far
    uint64_t looks_since_change, looks_since_raise;
    bool went_up;   ///< direction of the last change
    uint32_t floor; ///< values below this one have failed; 0: none
    uint64_t failed_limit;
    uint64_t demand; ///< 0: unknown
    bool scene_changed;
    uint32_t failed_trials;
};

struct naive_round {
    uint64_t maps;          ///< maps merged in the round
    uint64_t began, waited; ///< stamps; requests up to `waited` have waited
    uint32_t count;
    uint64_t began_long, waited_long; ///< stamps over four rounds
};

struct naive_manager {
    uint32_t capacity; ///< slots per heap
    bool always_packed;
    SluiceStreamedTextureManagerConfig config;
    uint32_t texture_room; ///< number of indices ever used
    struct naive_texture **textures;
    uint32_t removed_count;
    SluiceTextureId *removed;
    uint32_t heap_count;
    struct naive_heap *heaps;
    uint32_t given_up_count;
    struct naive_given_up *given_up;
    uint64_t stamp;
    struct naive_bias bias;
    struct naive_round round;
    bool starved;
    bool heap_refused;       ///< last answer of the heap allocator
    uint64_t usual;          ///< last noted interval between maps
    uint32_t prefetch_level; ///< 0: the coarsest
    uint32_t prefetch_index;
    bool has_time;
    uint64_t time, last_retire, completed;
    SluiceStreamedTextureStatistics totals; ///< only the ...Total fields are used
    uint64_t events[NAIVE_EVENT_COUNT];
    char complaint[256]; ///< "": all choices copied from the other manager are allowed
};

void naive_init(struct naive_manager *n, uint32_t capacity, bool always_packed);
void naive_finish(struct naive_manager *n);

/** Makes the call. `seen`: outcome of the other manager. Fills in `expected`. */
void naive_call(struct naive_manager *n, const struct call *call, const struct outcome *seen,
                struct outcome *expected);

/** Returns NULL if the id is not a living texture; `result` then holds the error. */
struct naive_texture *naive_find(struct naive_manager *n, SluiceTextureId id, SluiceResult *result);
bool naive_has_slot(const struct naive_tile *tile);
SluiceTile naive_tile_info(const struct naive_texture *t, uint32_t index);
void naive_statistics(const struct naive_manager *n, SluiceStreamedTextureStatistics *out);
struct naive_heap *naive_find_heap(struct naive_manager *n, uint32_t id);
uint32_t naive_count_slots(const struct naive_manager *n, const struct naive_heap *heap,
                           enum naive_slot_use use);

/* Shared by the naive manager's files. */
SluiceResult naive_layout(const SluiceStreamedTextureDesc *desc, SluiceStreamedTextureLayout *out);
SluiceResult naive_add_texture(struct naive_manager *n, const struct call *call,
                               const struct outcome *seen, struct outcome *out);
void naive_free_texture(struct naive_texture *t);
void naive_update_minmip(struct naive_manager *n, struct naive_texture *t);
void naive_request(struct naive_manager *n, struct naive_tile *tile, uint32_t need);
void naive_become_mapped(struct naive_manager *n, struct naive_tile *tile);
void naive_become_wanted(struct naive_manager *n, struct naive_tile *tile, uint32_t need);
void naive_become_unwanted(struct naive_manager *n, struct naive_tile *tile);
/** Makes a tile STANDBY, and lists tiles beyond the limit. */
void naive_stand_by(struct naive_manager *n, struct naive_tile *tile);
/** Evicts a MAPPED tile: it becomes STANDBY and listed, but stays wanted. */
void naive_evict(struct naive_manager *n, struct naive_tile *tile);
/** Lists the oldest unlisted STANDBY tiles with slots, until at most `keep` remain. */
void naive_list_standby(struct naive_manager *n, uint64_t keep);
/** Lists the oldest STANDBY tiles beyond numExtraStandbyTiles, with and without slots. */
void naive_limit_standby(struct naive_manager *n);
/** Merges a map into the texture's spans, and recomputes `held`. `asked`: as in last_asked. */
void naive_remember(struct naive_manager *n, struct naive_texture *t, const uint8_t *asked,
                    uint64_t time, uint64_t timeout);
/* Returns whether this many misses let a level expire. */
bool naive_would_believe(const struct naive_manager *n, const struct naive_texture *t,
                         uint64_t misses, uint32_t level);
/** Drops the requests of the texture's maps. None of its tiles stays wanted. */
void naive_drop_wants(struct naive_manager *n, struct naive_texture *t);
void naive_forget_history(struct naive_texture *t);
bool naive_has_state(const struct naive_texture *t);
bool naive_holds_anything(const struct naive_texture *t);
/** Returns whether no tile is wanted, and all are FREE or STANDBY. */
bool naive_is_idle(const struct naive_texture *t);
/** Computes the finest requested level of each regular tile, if the regions hold `levels`. */
void naive_wishes(const struct naive_texture *t, const uint8_t *levels, uint8_t *wishes);
/** Makes tiles wanted or unwanted by the levels that the regions hold. */
void naive_apply_held(struct naive_manager *n, struct naive_texture *t);
uint32_t naive_region_bias(const struct naive_manager *n, const struct naive_texture *t,
                           uint32_t rx, uint32_t ry);
/** Textures that hold anything. */
uint64_t naive_count_holding(const struct naive_manager *n);
void naive_look_at_bias(struct naive_manager *n);
/** Call after a map was merged or the history forgotten. `before`: former finest levels by tile.
 * `held_before`: whether the texture held anything. */
void naive_note_change(struct naive_manager *n, struct naive_texture *t, const uint8_t *before,
                       bool held_before);
/** Number of reserved slots over all slots of living heaps. */
uint32_t naive_reserved(const struct naive_manager *n);
/** Number of slots in heaps beyond targetHeapCount. */
uint32_t naive_surplus(const struct naive_manager *n);
/** Sum of naive_reserved and naive_surplus. */
uint32_t naive_kept(const struct naive_manager *n);
/** A tile with its texture and sort key. */
struct naive_ref {
    struct naive_texture *texture;
    struct naive_tile *tile;
    uint64_t key[4]; ///< compared in this order
};

/* Number of requests that one call may pass over. */
#define NAIVE_MAX_PASSED_OVER 4096u
bool naive_is_passed_over(const struct naive_manager *n, const struct naive_ref *ref);
void naive_count_standby(const struct naive_manager *n, uint32_t *listed, uint32_t *unlisted);

/* naive_evict.c */
/* Evicts tiles for `unserved` of the requests. refs[0] is the request that got no slot. */
void naive_evict_for(struct naive_manager *n, const struct naive_ref *refs, uint32_t count,
                     uint32_t unserved);
uint32_t naive_count_all(const struct naive_manager *n, enum naive_slot_use use);
void naive_retry_due(struct naive_manager *n, uint64_t now);
/** Checks the arguments that all list calls share. *only is NULL for all textures. */
SluiceResult naive_check_list(struct naive_manager *n, const struct call *call,
                              struct naive_texture **only);
SluiceResult naive_feedback(struct naive_manager *n, const struct call *call);
SluiceResult naive_match(struct naive_manager *n, const struct call *call);
SluiceResult naive_answer(struct naive_manager *n, const struct call *call);
SluiceResult naive_tiles_to_map(struct naive_manager *n, const struct call *call,
                                const struct outcome *seen, struct outcome *out);
SluiceResult naive_given_up_tiles(struct naive_manager *n, const struct call *call,
                                  struct outcome *out);
SluiceResult naive_tiles_to_cancel(struct naive_manager *n, const struct call *call,
                                   struct outcome *out);
SluiceResult naive_tiles_to_unmap(struct naive_manager *n, const struct call *call,
                                  struct outcome *out);
/** Requests due tiles among the given-up ones. */
void naive_probe_given_up(struct naive_manager *n);
void naive_note_given_up(struct naive_manager *n, struct naive_texture *t);
void naive_note_success(struct naive_manager *n, struct naive_texture *t, bool had_failed);
SluiceResult naive_retry(struct naive_manager *n, const struct call *call);
SluiceResult naive_defragment(struct naive_manager *n, const struct call *call,
                              const struct outcome *seen, struct outcome *out);
SluiceResult naive_evacuate(struct naive_manager *n, const struct call *call);
void naive_retire_slot(struct naive_manager *n, struct naive_tile *tile, uint64_t retire);
void naive_free_slot(struct naive_manager *n, struct naive_tile *tile);
void *naive_alloc(size_t count, size_t size);
void naive_complain(struct naive_manager *n, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/** Lists all tiles in a state, of one texture or of all (NULL). The caller sets keys and frees the
 * list. */
struct naive_ref *naive_collect(const struct naive_manager *n, const struct naive_texture *only,
                                SluiceTileState state, uint32_t *count);
void naive_sort(struct naive_ref *refs, uint32_t count);

#endif /* TESTS_CORE_NAIVE_MANAGER_H */
