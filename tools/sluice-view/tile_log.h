/** Log of tiles, fed by events: number and time of loads, and loads that nothing used. */
#ifndef SLUICE_VIEW_TILE_LOG_H
#define SLUICE_VIEW_TILE_LOG_H

#include <sluice/manager.h>

#include <stdbool.h>
#include <stdint.h>

/** Longer waits count as this number of frames. */
#define TILE_LOG_MOST_WAIT 4095u

/** A tile: 16 bytes, since a scene can have millions. Counts stop at their largest value. */
struct tile_log_tile {
    uint64_t loaded_time; ///< time stamp of the last load; 0: no load
    uint32_t requested;   ///< 1 + frame of the request, modulo 2^32; 0: waits for no load
    uint16_t loads, failures;
};

struct tile_log_texture {
    SluiceTextureId id;
    uint32_t tile_count, index;
    size_t first_tile;
};

/** Stages of a load: in the queue, and from the hand-out until the load is done. */
struct tile_log_stages {
    uint32_t *listed; ///< owned; per tile 1 + frame of its hand-out; 0: not loading
    uint64_t queue[TILE_LOG_MOST_WAIT + 1], load[TILE_LOG_MOST_WAIT + 1];
};

/** Bytes per tile of a log with stages. */
#define TILE_LOG_TILE_SIZE (sizeof(struct tile_log_tile) + sizeof(uint32_t))

struct tile_log {
    struct tile_log_texture *textures; ///< owned, by id
    struct tile_log_tile *tiles;       ///< owned
    struct tile_log_stages *stages;    ///< owned; NULL: not kept
    uint32_t texture_count, texture_capacity;
    size_t tile_count, tile_capacity;
    uint64_t loads;
    uint64_t stale; ///< loads of tiles that nothing requested after the load
    /** Frames from the request of a tile until it is resident. */
    uint64_t waits[TILE_LOG_MOST_WAIT + 1];
    uint64_t wait_count;
};

/** Creates a log of `count` textures. False, with a zeroed log, without memory. */
bool tile_log_create(const SluiceTextureId *ids, const uint32_t *tile_counts, uint32_t count,
                     struct tile_log *log);
/** Begins to keep stages. False without memory. */
bool tile_log_keep_stages(struct tile_log *log);
/** Adds a texture with the next index. The log may be zeroed. False without memory. */
bool tile_log_add(struct tile_log *log, SluiceTextureId id, uint32_t tile_count);
/** Frees the log. A zeroed struct is allowed. */
void tile_log_destroy(struct tile_log *log);
/** Adds the next event. A tile that expires within `timeout` ticks of its load counts as stale. */
void tile_log_take(struct tile_log *log, const SluiceTileEvent *event, uint64_t timeout);
/** Finds a tile. NULL: unknown. */
const struct tile_log_tile *tile_log_get(const struct tile_log *log, SluiceTextureId id,
                                         uint32_t tile);
/** Writes the index of a texture, in the order of creation. False if the texture is unknown. */
bool tile_log_index(const struct tile_log *log, SluiceTextureId id, uint32_t *index);
/** Returns the quantile of all waits, in frames. `part`: 0 to 1. 0 without waits. */
uint32_t tile_log_wait(const struct tile_log *log, double part);
/** Returns the quantile of counts by frames, [TILE_LOG_MOST_WAIT + 1]. 0 if all counts are 0. */
uint32_t tile_log_wait_of(const uint64_t *counts, double part);

/** Contents of a log without its textures: tiles and waits that are not 0. */
struct tile_log_kept {
    void *bytes; ///< owned
    size_t size;
};

/** Keeps the contents of a log with stages. False without memory. */
bool tile_log_keep(const struct tile_log *log, struct tile_log_kept *kept);
/** Restores contents that this log had. Textures that were added since stay, without loads. */
void tile_log_restore(struct tile_log *log, const struct tile_log_kept *kept);
void tile_log_kept_finish(struct tile_log_kept *kept);

#endif /* SLUICE_VIEW_TILE_LOG_H */
