/** Loaders of one SluiceReadPool, with sources that hold their reads and fail. */
#ifndef TEST_IMAGE_POOL_RIG_H
#define TEST_IMAGE_POOL_RIG_H

#include <sluice/loader.h>

#include "support/fault_source.h"

enum { SIZE = 64, LOADERS = 3, MOST = 256 };

struct pool_rig {
    SluiceReadPool *pool;
    SluiceTileLoader *loaders[LOADERS];
    SluiceImageSource *inner;
    float added; ///< to the texels of `inner`
    struct fault_source source, other;
    float texels[LOADERS][MOST];
    uint64_t tickets[LOADERS][MOST];
};

static const SluiceReadPoolCreateInfo two_threads = {.threadCount = 2, .maxReadsPerSource = 2};

SluiceImageSource *create_image_of(SluiceFormat format, float *added);
SluiceImageSource *create_image(float *added);
/** Zeros: the defaults, but for one attempt. */
void add_loader_of(struct pool_rig *r, uint32_t i, SluiceTileLoaderCreateInfo create);
void add_loader(struct pool_rig *r, uint32_t i);
void pool_rig_init(struct pool_rig *r, uint32_t loaders, SluiceReadPoolCreateInfo create);
void pool_rig_finish(struct pool_rig *r);
SluiceReadPoolStatistics statistics_of(const struct pool_rig *r);
/** Texel `x`, counted row by row. */
SluiceImageRegion region_at(uint32_t x);
void submit_regions(struct pool_rig *r, uint32_t loader, SluiceImageSource *source, uint32_t first,
                    uint32_t count, uint32_t priority);
void submit(struct pool_rig *r, uint32_t loader, struct fault_source *source, uint32_t x);
/** Waits, and expects `count` reads with the result. */
void expect(struct pool_rig *r, uint32_t loader, uint32_t count, SluiceResult result);
void expect_texel(const struct pool_rig *r, uint32_t loader, uint32_t x);
/** Waits until all more urgent reads of the loader are put aside. Needs two threads and a held
 * read. */
void settle(struct pool_rig *r, uint32_t loader);
/** Loader 0 reads x and is held. Loader 1 has joined it: with both threads, a later read of another
 * source has ended. */
void join(struct pool_rig *r, uint32_t x);

#endif /* TEST_IMAGE_POOL_RIG_H */
