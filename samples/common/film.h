/** The picture on the device: what was gathered for each pixel, and which are to be traced. */
#ifndef SAMPLES_COMMON_FILM_H
#define SAMPLES_COMMON_FILM_H

#include "../../tools/common/gpu.h"
#include "picture.h"

/** Pixels that a film is for: each `count`th tile of 32 x 32 in each row of tiles, beginning one
 *  further to the left with each row. Zeroed: all pixels. */
struct film_share {
    uint32_t index, count;
};

/** Zeroed is empty. */
struct film {
    uint32_t width, height;
    struct film_share share;
    uint32_t pixel_count;                            ///< of the share
    struct gpu_buffer sums, latest, lists, counters; ///< see film.glsl of demand-tracer
    struct gpu_buffer readback;                      ///< of sums and latest
    uint32_t list_index;                             ///< the list that the next launch reads
    uint32_t missing_count;                          ///< pixels in it
    bool has_list;                                   ///< the first list has all pixels of the share
    uint32_t *all;                                   ///< owned; that list
};

/** Says on stderr why it failed. */
bool film_create(const struct gpu *gpu, uint32_t width, uint32_t height, struct film_share share,
                 struct film *film);
void film_destroy(const struct gpu *gpu, struct film *film);

/** Forgets complete samples: for another picture. No launch is under way. */
void film_clear(struct film *film);
/** All pixels of the share are to be traced. No launch is under way. */
void film_begin_sample(struct film *film);
/** Before a launch: none of its pixels is missing yet. */
void film_begin_launch(struct film *film);
/** After it is over: the pixels that it missed are those of the next one. */
void film_end_launch(struct film *film);
/** Records what makes a launch's counters visible to the host. */
void film_record_end(VkCommandBuffer commands);

/** Reads the mean of all complete samples into the pixels of the share. `picture` has the film's
 *  size; threads may read several films into it at a time. */
bool film_read(const struct gpu *gpu, const struct film *film, struct picture *picture);

#endif /* SAMPLES_COMMON_FILM_H */
