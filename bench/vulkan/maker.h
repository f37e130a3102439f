/** A tile producer with any number of steps per texel, and equal texels without a streamer. */
#ifndef BENCH_VULKAN_MAKER_H
#define BENCH_VULKAN_MAKER_H

#include "rig.h"

#define MAKER_SETS 1024u   /* batches per frame */
#define MAKER_TILES 16384u /* tiles and pieces of mip tails per frame */

struct maker {
    const struct bench *bench;
    uint32_t steps;
    struct gpu_buffer tiles; ///< struct BenchTile, MAKER_TILES per frame in flight
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet sets[RIG_FRAMES * MAKER_SETS];
    uint64_t frame;
    uint32_t set_count, tile_count; ///< counts in this frame
};

bool maker_create(struct maker *m, const struct bench *bench, uint32_t steps);
void maker_destroy(struct maker *m);
/** pfnRecordTiles of SluiceTileProducer. `user` is a struct maker. */
SluiceResult maker_record_tiles(void *user, const SluiceTileBatch *batch, SluiceResult *results);

/** Measures tiles per second of dispatches of 64 tiles that write to layers of an array image, in
 * one command buffer. Returns the best of three. */
bool maker_floor(struct maker *m, uint32_t tile_count, double *rate);

#endif /* BENCH_VULKAN_MAKER_H */
