/**
 * FLIP between the two pictures of a comparison: how large a viewer sees the differences. A thread
 * computes it from copies of the pictures, again and again, at most a quarter of the time.
 */
#ifndef SLUICE_VIEW_FLIP_MAP_H
#define SLUICE_VIEW_FLIP_MAP_H

#include "ui_texels.h"

#include <pthread.h>
#include <stdatomic.h>

enum flip_state { FLIP_IDLE, FLIP_COPYING, FLIP_RUNNING, FLIP_FAILED };

struct flip_map {
    const struct gpu *gpu; ///< borrowed; NULL: nothing was created so far
    enum flip_state state;
    struct gpu_buffer pictures[2]; ///< copies that a frame records
    uint32_t width, height;        ///< of both
    uint64_t frame;                ///< that the copies are of
    uint64_t next_frame;           ///< the earliest that may be copied
    double next_seconds;
    pthread_t thread;
    atomic_bool done;
    bool good;
    float *values;  ///< owned; [height][width]
    double mean;    ///< of `values`
    double seconds; ///< that the thread took

    bool known; ///< the following are valid
    struct ui_texels texels;
    float *shown; ///< owned; [height][width] of `texels`
    double shown_mean;
    uint64_t shown_frame;
};

/** Waits for the thread. A zeroed struct is fine. No frame may be in flight. */
void flip_map_destroy(struct flip_map *map);
/**
 * Once per frame, after frames_begin: begins the thread when the copies are there, and takes the
 * map when it is done. True if this frame must copy its pictures, of this size, to `pictures`.
 * `wanted` false: what is known is forgotten.
 */
bool flip_map_begin_frame(struct flip_map *map, const struct gpu *gpu, uint64_t frame, bool wanted,
                          uint32_t width, uint32_t height);
/** Computes at once what was copied, for pictures that are the same in every run. The frame must be
 *  complete. */
void flip_map_settle(struct flip_map *map);
/** The error at x, y, 0 to 1 from the left and the top. Negative if it is not known. */
float flip_map_at(const struct flip_map *map, float x, float y);

#endif /* SLUICE_VIEW_FLIP_MAP_H */
