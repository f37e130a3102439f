/** Producer of the texture: a compute shader writes the tiles that the streamer requests. */
#ifndef SAMPLES_VIRTUAL_TEXTURE_MAKER_H
#define SAMPLES_VIRTUAL_TEXTURE_MAKER_H

#include "../../tools/common/gpu.h"

#define MAKER_SETS 64u    /* batches per frame; further ones wait for the next frame */
#define MAKER_TILES 4096u /* tiles per frame */

struct maker {
    const struct gpu *gpu; ///< NULL: not created
    uint32_t size_log2;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet sets[MAKER_SETS];
    struct gpu_buffer tiles;
    uint32_t set_count, tile_count; ///< used by the frame that begins
};

bool maker_create(struct maker *maker, const struct gpu *gpu, uint32_t size_log2);
void maker_destroy(struct maker *maker);

/** Reuses sets and tile records. Call it when the previous frame is complete. */
void maker_begin_frame(struct maker *maker);

/** SluiceTileProducer.pfnRecordTiles; the user data is the maker. */
SluiceResult maker_record_tiles(void *pUserData, const SluiceTileBatch *pBatch,
                                SluiceResult *pResults);

#endif /* SAMPLES_VIRTUAL_TEXTURE_MAKER_H */
