/** GPU decoders of neural sets, and their output textures. */
#ifndef SLC_NEURAL_VULKAN_TILE_DECODER_H
#define SLC_NEURAL_VULKAN_TILE_DECODER_H

#include "vulkan/buffer.h"
#include "vulkan/compute.h"

#include <sluice/vulkan_neural.h>

#include <sluice/shared/neural_tile.h>

enum slc_neural_buffer {
    SLC_NEURAL_CONSTANTS,
    SLC_NEURAL_LATENTS,
    SLC_NEURAL_WEIGHTS,
    SLC_NEURAL_SCRATCH,
    SLC_NEURAL_BUFFER_COUNT,
};

/** Output texture of the set. Lives as long as the decoder. */
struct slc_neural_output {
    struct slc_neural_output *next;
    SluiceVulkanNeuralDecoder *decoder;
    SluiceImageInfo image;
    SluiceTileProducer producer;
    uint32_t store; ///< SLUICE_NEURAL_STORE_...
    uint32_t block; ///< texels along a side: 1 or 4
    uint32_t words; ///< 32-bit words per texel or block
    uint32_t first_channel, channel_count, spaces;
};

struct SluiceVulkanNeuralDecoder {
    SluiceAllocationCallbacks cb;
    SluiceVulkanContext *context;
    uint32_t width, height, mip_count, channel_count;
    struct slc_buffer buffers[SLC_NEURAL_BUFFER_COUNT];
    struct slc_compute compute;
    struct slc_neural_output *outputs;
};

/** Records tiles: SluiceTileProducer.pfnRecordTiles with a struct slc_neural_output. */
SluiceResult slc_neural_record_tiles(void *output, const SluiceTileBatch *batch,
                                     SluiceResult *results);

#endif /* SLC_NEURAL_VULKAN_TILE_DECODER_H */
