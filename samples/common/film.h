/** The picture on the device: sums of each pixel's samples, and lists of pixels to trace. */
#ifndef SAMPLES_COMMON_FILM_H
#define SAMPLES_COMMON_FILM_H

#include "../../tools/common/gpu.h"
#include "picture.h"

/** Pixels of a film: every `count`th tile of 32 x 32 pixels in each row of tiles. Each row begins
 * one tile further to the left. Zeroed: all pixels. */
struct film_share {
    uint32_t index, count;
};

/** Zeroed is empty. */
struct film {
    uint32_t width, height;
    struct film_share share;
    uint32_t pixel_count;                            ///< pixels in the share
    struct gpu_buffer sums, latest, lists, counters; ///< see film.glsl of demand-tracer
    struct gpu_buffer readback;                      ///< copies of `sums` and `latest`
    uint32_t list_index;                             ///< the list that the next launch reads
    uint32_t missing_count;                          ///< pixels in that list
    bool has_list;                                   ///< true: list 0 holds all pixels of the share
    uint32_t *all;                                   ///< owned; list of all pixels of the share
};

/** Reports errors on stderr. */
bool film_create(const struct gpu *gpu, uint32_t width, uint32_t height, struct film_share share,
                 struct film *film);
void film_destroy(const struct gpu *gpu, struct film *film);

/** Clears all samples for another picture. Call only while no launch is running. */
void film_clear(struct film *film);
/** Lists all pixels of the share for tracing. Call only while no launch is running. */
void film_begin_sample(struct film *film);
/** Call before a launch. Clears the count of missing pixels. */
void film_begin_launch(struct film *film);
/** Call after a launch has ended. The next launch traces the pixels that were missing. */
void film_end_launch(struct film *film);
/** Records a barrier that makes a launch's counters visible to the host. */
void film_record_end(VkCommandBuffer commands);

/** Reads the mean of all complete samples into the pixels of the share. `picture` has the film's
 * size. Several threads may read different films into one picture. */
bool film_read(const struct gpu *gpu, const struct film *film, struct picture *picture);

#endif /* SAMPLES_COMMON_FILM_H */
