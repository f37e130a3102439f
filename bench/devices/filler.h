/** A device with a context and a streamer that loads all tiles of some sources, on a thread. */
#ifndef BENCH_DEVICES_FILLER_H
#define BENCH_DEVICES_FILLER_H

#include "../../tools/common/gpu.h"

#include <sluice/vulkan_control.h>

#include <pthread.h>

#define FILLER_FRAMES 3u

struct filler_info {
    struct gpu *gpu;
    SluiceReadPool *pool; ///< NULL: the context has threads of its own
    uint32_t threads;     ///< of its own; 0: the default
    SluiceImageSource *const *sources;
    uint32_t source_count;
};

struct filler {
    struct filler_info info;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceTextureRequestId *requests; ///< owned; one per source
    VkCommandBuffer commands[FILLER_FRAMES];
    uint64_t values[FILLER_FRAMES]; ///< that the last frame of each signals
    VkSemaphore semaphore;
    uint64_t frame;
    uint64_t tile_count; ///< that the requests have
    pthread_t thread;
    bool runs;
    bool failed;
    double end; ///< clock_seconds() when the last tile was resident
};

/** Prints what failed to stderr. A filler that was not created can be destroyed. */
bool filler_create(struct filler *filler, const struct filler_info *info);
/** Begins to load, on a thread of its own. */
bool filler_start(struct filler *filler);
/** Waits until all is loaded. */
bool filler_wait(struct filler *filler);
void filler_destroy(struct filler *filler);

#endif /* BENCH_DEVICES_FILLER_H */
