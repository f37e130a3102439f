/** A device with a context and a streamer that loads all tiles of some sources, on its own
 * thread. */
#ifndef BENCH_DEVICES_FILLER_H
#define BENCH_DEVICES_FILLER_H

#include "../../tools/common/gpu.h"

#include <sluice/vulkan_control.h>

#include <pthread.h>

#define FILLER_FRAMES 3u

struct filler_info {
    struct gpu *gpu;
    SluiceReadPool *pool; ///< NULL: the context has its own threads
    uint32_t threads;     ///< threads of the context; 0: default
    SluiceImageSource *const *sources;
    uint32_t source_count;
};

struct filler {
    struct filler_info info;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceTextureRequestId *requests; ///< owned; one per source
    VkCommandBuffer commands[FILLER_FRAMES];
    uint64_t values[FILLER_FRAMES]; ///< values that the last frame of each slot signals
    VkSemaphore semaphore;
    uint64_t frame;
    uint64_t tile_count; ///< tiles of all requests
    pthread_t thread;
    bool runs;
    bool failed;
    double end; ///< clock_seconds() when the last tile was resident
};

/** Creates a filler. Reports errors on stderr. filler_destroy accepts a failed filler. */
bool filler_create(struct filler *filler, const struct filler_info *info);
/** Begins to load, on a separate thread. */
bool filler_start(struct filler *filler);
/** Waits until all tiles are loaded. */
bool filler_wait(struct filler *filler);
void filler_destroy(struct filler *filler);

#endif /* BENCH_DEVICES_FILLER_H */
