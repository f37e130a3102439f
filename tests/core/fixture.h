/** A manager with counted memory and fake heaps, and short forms of frequent calls. */
#ifndef TESTS_CORE_FIXTURE_H
#define TESTS_CORE_FIXTURE_H

#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/manager.h>

#define FIXTURE_HEAPS 256
#define FIXTURE_ROOM 2048

/** Hands out the lowest free id, from 0. Checks released ids. */
struct fake_heaps {
    uint32_t limit; ///< limit of living heaps
    uint32_t living_count;
    uint32_t asked, refused, released; ///< number of calls so far
    uint64_t size;                     ///< bytes of the last heap
    bool answers_duplicate;            ///< true: succeeds with the id of a living heap
    bool living[FIXTURE_HEAPS];
};

struct fixture {
    SluiceStreamedTextureManager *manager;
    struct failing_allocator memory;
    struct fake_heaps heaps;
    uint32_t count; ///< length of the last list
    SluiceTile tiles[FIXTURE_ROOM];
};

/** Creates a manager without a limit of heaps. Set heaps.limit for a budget. */
void fixture_open(struct fixture *f, uint32_t heap_capacity, bool always_map_packed);

/** Destroys the manager. All bytes and heaps must have been returned. */
void fixture_close(struct fixture *f);

/** Describes a full chain. Levels of at least one tile in both directions are regular; the others
 * share one packed tile. */
SluiceStreamedTextureDesc full_chain(uint32_t width, uint32_t height, uint32_t tile_width,
                                     uint32_t tile_height);

/** 256x256 in 128x128 tiles: 0 to 3 are level 0, 4 is level 1, 5 is packed. Regions are 2x2. */
SluiceStreamedTextureDesc small_texture(void);

SluiceTextureId fixture_add(struct fixture *f, const SluiceStreamedTextureDesc *desc);
SluiceTextureId fixture_add_small(struct fixture *f);
/** Sets the configuration, with missesToExpire 1 like the fixture's default. */
void fixture_configure(struct fixture *f, uint32_t standby, uint32_t max_heaps, uint32_t attempts,
                       uint64_t retry_delay);

/** Feeds one level for all regions; a whole map; or one region with the others untouched. */
void fixture_feed(struct fixture *f, SluiceTextureId id, uint8_t level, uint64_t time,
                  uint64_t timeout);
void fixture_feed_map(struct fixture *f, SluiceTextureId id, const uint8_t *map, uint64_t time,
                      uint64_t timeout);
void fixture_feed_region(struct fixture *f, SluiceTextureId id, uint32_t region, uint8_t level,
                         uint64_t time, uint64_t timeout);

/** Fill tiles and count. Return the call's result. */
SluiceResult fixture_to_map(struct fixture *f, SluiceTextureId id);
SluiceResult fixture_to_map_at_most(struct fixture *f, SluiceTextureId id, uint32_t room);
SluiceResult fixture_to_unmap(struct fixture *f, SluiceTextureId id, uint64_t retire_value);
SluiceResult fixture_to_cancel(struct fixture *f, SluiceTextureId id);

/** Reports all tiles of the last list as mapped, one call per tile. */
void fixture_answer_mapped(struct fixture *f);

/** Lists and maps tiles until none is handed out. */
void fixture_load(struct fixture *f);

/** Returns whether the last list held exactly these tiles of `id`, in this order. */
bool fixture_listed(const struct fixture *f, SluiceTextureId id, uint32_t count,
                    const uint32_t *tiles);

#define LISTED(f, id, ...)                                                                         \
    fixture_listed(f, id, sizeof((uint32_t[]){__VA_ARGS__}) / sizeof(uint32_t),                    \
                   (uint32_t[]){__VA_ARGS__})

SluiceTileState fixture_state(const struct fixture *f, SluiceTextureId id, uint32_t tile);
SluiceTile fixture_tile(const struct fixture *f, SluiceTextureId id, uint32_t tile);
SluiceStreamedTextureStatistics fixture_statistics(const struct fixture *f);
SluiceStreamedTextureLayout fixture_layout(const struct fixture *f, SluiceTextureId id);

/** Prints the tile and both states if they differ. */
void check_state(const struct fixture *f, SluiceTextureId id, uint32_t tile,
                 SluiceTileState expected, int line);

#define CHECK_STATE(f, id, tile, state)                                                            \
    check_state(f, id, tile, SLUICE_TILE_STATE_##state, __LINE__)

/** Hashes all visible state except host memory. */
uint64_t fixture_digest(const struct fixture *f, uint32_t id_count, const SluiceTextureId *ids);

/** Returns pseudo-random numbers, equal in each run. */
uint32_t next_random(uint64_t *state);

#endif /* TESTS_CORE_FIXTURE_H */
