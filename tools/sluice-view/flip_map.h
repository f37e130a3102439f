/**
 * FLIP between the two pictures of a comparison: the difference that an observer perceives. A
 * thread computes FLIP from copies of the pictures, repeatedly, for at most a quarter of the time.
 */
#ifndef SLUICE_VIEW_FLIP_MAP_H
#define SLUICE_VIEW_FLIP_MAP_H

#include "ui_texels.h"

#include <pthread.h>
#include <stdatomic.h>

enum flip_state { FLIP_IDLE, FLIP_COPYING, FLIP_RUNNING, FLIP_FAILED };

struct flip_map {
    const struct gpu *gpu; ///< borrowed; NULL: nothing was created yet
    enum flip_state state;
    struct gpu_buffer pictures[2]; ///< copies that a frame records
    uint32_t width, height;        ///< pixels of each picture
    uint64_t frame;                ///< frame of the copies
    uint64_t next_frame;           ///< first frame that may be copied again
    double next_seconds;
    pthread_t thread;
    atomic_bool done;
    bool good;
    float *values;  ///< owned; [height][width]
    double mean;    ///< mean of `values`
    double seconds; ///< duration of the last computation

    bool known; ///< the fields below are valid
    struct ui_texels texels;
    float *shown; ///< owned; [height][width] of `texels`
    double shown_mean;
    uint64_t shown_frame;
};

/** Waits for the thread, and frees the map. No frame may be in flight. A zeroed struct is allowed.
 */
void flip_map_destroy(struct flip_map *map);
/**
 * Begins the thread once the copies are complete, and takes the map once the thread is done. Call
 * once per frame, after frames_begin. True if this frame must copy its pictures to `pictures`.
 * `wanted` false: drops the map.
 */
bool flip_map_begin_frame(struct flip_map *map, const struct gpu *gpu, uint64_t frame, bool wanted,
                          uint32_t width, uint32_t height);
/** Computes FLIP of the copies at once. Makes pictures equal in every run. The frame of the copies
 *  must be complete. */
void flip_map_settle(struct flip_map *map);
/** Returns FLIP at x, y, 0 to 1 from the left and the top. Negative if it is not known. */
float flip_map_at(const struct flip_map *map, float x, float y);

#endif /* SLUICE_VIEW_FLIP_MAP_H */
