/** Log of tiles: how often and when each was loaded, and which loads nobody used. Fed by events. */
#ifndef SLUICE_VIEW_TILE_LOG_H
#define SLUICE_VIEW_TILE_LOG_H

#include <sluice/manager.h>

#include <stdbool.h>
#include <stdint.h>

/** Waits of more frames than that count as so many. */
#define TILE_LOG_MOST_WAIT 4095u

/** 16 bytes, since a scene can have millions. Counts stay at their largest value. */
struct tile_log_tile {
    uint64_t loaded_time; ///< time stamp of its last load; 0 with no load
    uint32_t requested; ///< 1 + frame in which it was requested, modulo 2^32; 0: waits for no load
    uint16_t loads, failures;
};

struct tile_log_texture {
    SluiceTextureId id;
    uint32_t tile_count, index;
    size_t first_tile;
};

/** The way of a load in two parts: in the queue, and from the hand-out to the answer. */
struct tile_log_stages {
    uint32_t
        *listed; ///< owned; per tile 1 + frame in which it was handed out; 0: it is not loading
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
    uint64_t stale; ///< loads of tiles that nothing requested after they had arrived
    /** Frames from the request of a tile until it is resident. */
    uint64_t waits[TILE_LOG_MOST_WAIT + 1];
    uint64_t wait_count;
};

/** Of textures with so many tiles. False without memory: the log is zeroed then. */
bool tile_log_create(const SluiceTextureId *ids, const uint32_t *tile_counts, uint32_t count,
                     struct tile_log *log);
/** Keeps stages from now on. False without memory. */
bool tile_log_keep_stages(struct tile_log *log);
/** Adds a texture with the next index, to a log that may be zeroed. False without memory. */
bool tile_log_add(struct tile_log *log, SluiceTextureId id, uint32_t tile_count);
/** A zeroed struct is fine. */
void tile_log_destroy(struct tile_log *log);
/** Takes in the next event. A tile that expires within `timeout` ticks of its load was not seen
 *  after the load. */
void tile_log_take(struct tile_log *log, const SluiceTileEvent *event, uint64_t timeout);
/** NULL: unknown. */
const struct tile_log_tile *tile_log_get(const struct tile_log *log, SluiceTextureId id,
                                         uint32_t tile);
/** Writes which of the textures it is, as they were given. False: none. */
bool tile_log_index(const struct tile_log *log, SluiceTextureId id, uint32_t *index);
/** Frames that this part of all waits does not exceed. 0 with no wait. */
uint32_t tile_log_wait(const struct tile_log *log, double part);
/** Returns the same of counts by frames, [TILE_LOG_MOST_WAIT + 1]. */
uint32_t tile_log_wait_of(const uint64_t *counts, double part);

/** What a log holds but for its textures: tiles and waits that are not 0. */
struct tile_log_kept {
    void *bytes; ///< owned
    size_t size;
};

/** Keeps the contents of a log with stages. False without memory. */
bool tile_log_keep(const struct tile_log *log, struct tile_log_kept *kept);
/** Goes back to contents of this log. Textures that were added since stay, without loads. */
void tile_log_restore(struct tile_log *log, const struct tile_log_kept *kept);
void tile_log_kept_finish(struct tile_log_kept *kept);

#endif /* SLUICE_VIEW_TILE_LOG_H */
