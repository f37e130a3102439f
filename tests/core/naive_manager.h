/**
 * The manager once more, written from docs/manager.md with loops over everything and no structure
 * that could go wrong: whole map histories, plain arrays, lists made by sorting all tiles. It
 * shares no code with lib/core. Memory that runs out ends the program.
 *
 * Two choices are not in the rules: which slot of which of several equally full heaps a tile gets,
 * and which moves defragmentation makes. These, new texture ids and the heap allocator's answers
 * are taken over from what the other manager did, after a check that they are allowed.
 */
#ifndef TESTS_CORE_NAIVE_MANAGER_H
#define TESTS_CORE_NAIVE_MANAGER_H

#include "core/call.h"

struct naive_tile {
    uint32_t level, x, y;
    bool packed;
    SluiceTileState state;
    bool wanted;
    bool cancel_handed_out;
    bool listed; ///< STANDBY and in the list for unmapping
    uint32_t failures;
    uint32_t deficit;
    uint32_t heap, slot;
    uint64_t due;
    /* Stamps of one counter say who came first. */
    uint64_t requested_at, cancelled_at, standby_at, listed_at, failed_at, given_up_at;
};

struct naive_map {
    uint64_t time;
    uint8_t *wanted; ///< per region: level, regularMipCount, or 255
};

struct naive_texture {
    SluiceTextureId id;
    SluiceStreamedTextureLayout layout;
    struct naive_tile *tiles;
    uint32_t map_count;
    struct naive_map *maps;
    uint8_t *held;       ///< per region, 255: nothing
    uint8_t *last_asked; ///< `a` of the last map, 255: nothing; NULL: never had one
    SluiceTextureId primary;
    uint64_t follower_since;
    uint8_t *minmip;
    bool minmip_stale;
    uint64_t dirty_since; ///< 0: clean
    uint8_t *changed;     ///< per MinMip texel, since last listed
};

enum naive_slot_use { NAIVE_SLOT_FREE = 0, NAIVE_SLOT_USED, NAIVE_SLOT_RETIRING };

struct naive_slot {
    enum naive_slot_use use;
    uint64_t retire;
};

struct naive_heap {
    uint32_t id;
    struct naive_slot *slots;
};

struct naive_given_up {
    SluiceTextureId texture;
    uint32_t tile;
};

struct naive_manager {
    uint32_t capacity; ///< slots per heap
    bool always_packed;
    SluiceStreamedTextureManagerConfig config;
    uint32_t texture_room; ///< indices ever used
    struct naive_texture **textures;
    uint32_t removed_count;
    SluiceTextureId *removed;
    uint32_t heap_count;
    struct naive_heap *heaps;
    uint32_t given_up_count;
    struct naive_given_up *given_up;
    uint64_t stamp;
    bool has_time;
    uint64_t time, last_retire, completed;
    SluiceStreamedTextureStatistics totals; ///< only the ...Total fields
    char complaint[256]; ///< "": all that was taken over from the other manager is allowed
};

void naive_init(struct naive_manager *n, uint32_t capacity, bool always_packed);
void naive_finish(struct naive_manager *n);

/** Makes the call; `seen` is what the other manager answered. Fills in `expected`. */
void naive_call(struct naive_manager *n, const struct call *call, const struct outcome *seen,
                struct outcome *expected);

/** NULL: not a living texture; then `result` says which error. */
struct naive_texture *naive_find(struct naive_manager *n, SluiceTextureId id, SluiceResult *result);
bool naive_has_slot(const struct naive_tile *tile);
SluiceTile naive_tile_info(const struct naive_texture *t, uint32_t index);
void naive_statistics(const struct naive_manager *n, SluiceStreamedTextureStatistics *out);
struct naive_heap *naive_find_heap(struct naive_manager *n, uint32_t id);
uint32_t naive_count_slots(const struct naive_manager *n, const struct naive_heap *heap,
                           enum naive_slot_use use);

/* Between the files of the naive manager. */
SluiceResult naive_layout(const SluiceStreamedTextureDesc *desc, SluiceStreamedTextureLayout *out);
SluiceResult naive_add_texture(struct naive_manager *n, const struct call *call,
                               const struct outcome *seen, struct outcome *out);
void naive_free_texture(struct naive_texture *t);
void naive_update_minmip(struct naive_manager *n, struct naive_texture *t);
void naive_request(struct naive_manager *n, struct naive_tile *tile, uint32_t deficit);
void naive_become_wanted(struct naive_manager *n, struct naive_tile *tile, uint32_t deficit);
void naive_become_unwanted(struct naive_manager *n, struct naive_tile *tile);
/** Lists the oldest STANDBY tiles that are not listed yet, until at most `keep` are left. */
void naive_list_standby(struct naive_manager *n, uint64_t keep);
void naive_retry_due(struct naive_manager *n, uint64_t now);
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
SluiceResult naive_retry(struct naive_manager *n, const struct call *call);
SluiceResult naive_defragment(struct naive_manager *n, const struct call *call,
                              const struct outcome *seen, struct outcome *out);
void naive_retire_slot(struct naive_manager *n, struct naive_tile *tile, uint64_t retire);
void naive_free_slot(struct naive_manager *n, struct naive_tile *tile);
void *naive_alloc(size_t count, size_t size);
void naive_complain(struct naive_manager *n, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/** A tile with its texture, to be sorted. */
struct naive_ref {
    struct naive_texture *texture;
    struct naive_tile *tile;
    uint64_t key[4]; ///< compared in this order
};
/** All tiles in a state, of one texture or of all (NULL); the caller sets keys and frees it. */
struct naive_ref *naive_collect(const struct naive_manager *n, const struct naive_texture *only,
                                SluiceTileState state, uint32_t *count);
void naive_sort(struct naive_ref *refs, uint32_t count);

#endif /* TESTS_CORE_NAIVE_MANAGER_H */
