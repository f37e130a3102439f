/** A producer of PATTERN_HASH: by a compute shader, or by copies where shaders cannot store. */
#ifndef TESTS_DEVICE_MAKER_H
#define TESTS_DEVICE_MAKER_H

#include "device/harness.h"

#define MAKER_SETS 256u
#define MAKER_TILES 4096u
#define MAKER_VERSION 32u /* added to the level that texels are hashes of */

struct maker {
    struct harness *h;
    SluiceImageSource *source; ///< borrowed; texels for copies; NULL: the shader makes them
    struct harness_buffer tiles, texels;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet sets[MAKER_SETS]; ///< used in turn, as the places in the buffers
    uint32_t next_set, next_tile;
    uint32_t tile_count, batch_count;
    uint32_t version; ///< texels are those of the pattern's level + version * MAKER_VERSION
    /** share of tiles that are not ready, or fail: one in so many; 0: none */
    uint32_t unready_one_in, failing_one_in, turn;
};

/** Creates a maker. `source`: see struct maker. At most MAKER_SETS batches and MAKER_TILES tiles
 * may be in flight. */
void maker_init(struct maker *maker, struct harness *h, SluiceImageSource *source);
/** Call only while the device is idle. */
void maker_finish(struct maker *maker);

SluiceTileProducer maker_producer(struct maker *maker, const SluiceImageInfo *image);

#endif /* TESTS_DEVICE_MAKER_H */
