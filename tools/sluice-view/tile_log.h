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

struct tile_log {
    struct tile_log_texture *textures; ///< owned, by id
    struct tile_log_tile *tiles;       ///< owned
    uint32_t texture_count;
    uint64_t loads;
    uint64_t stale; ///< loads of tiles that nothing requested after they had arrived
    /** Frames from the request of a tile until it is resident. */
    uint64_t waits[TILE_LOG_MOST_WAIT + 1];
    uint64_t wait_count;
};

/** Of textures with so many tiles. False without memory: the log is zeroed then. */
bool tile_log_create(const SluiceTextureId *ids, const uint32_t *tile_counts, uint32_t count,
                     struct tile_log *log);
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

#endif /* SLUICE_VIEW_TILE_LOG_H */
