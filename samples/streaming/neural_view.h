/**
 * What a view has of a neural set: latents and weights in GPU memory, where the GPU decodes tiles,
 * and a demand loader of pages, where the shader decodes.
 */
#ifndef SAMPLES_STREAMING_NEURAL_VIEW_H
#define SAMPLES_STREAMING_NEURAL_VIEW_H

#include <sluice/demand.h>
#include <sluice/neural_pages.h>
#include <sluice/vulkan_neural.h>

#include "../../tools/common/gpu.h"
#include "neural_files.h"

#define NEURAL_VIEW_SLOTS 3 ///< frames in flight

struct neural_view {
    const struct gpu *gpu;              ///< borrowed; NULL: no set
    const struct neural_files *files;   ///< borrowed
    SluiceVulkanNeuralDecoder *decoder; ///< owned; NULL: no picture is decoded on feedback
    uint64_t decoder_size;              ///< bytes of GPU memory
    SluiceDemandLoader *loader;         ///< owned; NULL: no picture is decoded by the shader
    SluiceDemandResourceId resource;
    SluiceNeuralPages pages;
    struct gpu_buffer set_buffer, weights;
    const uint32_t *words;        ///< SPIR-V of the shader that decodes
    size_t words_size;            ///< bytes
    VkDescriptorSetLayout layout; ///< set 3 of the pipelines; VK_NULL_HANDLE without a loader
    VkDescriptorPool pool;
    VkDescriptorSet set;
    SluiceDemandLaunch launches[NEURAL_VIEW_SLOTS];
    bool under_way[NEURAL_VIEW_SLOTS]; ///< submitted and not processed
};

/** Makes what the modes of the pictures need. Says on stderr why it failed. */
bool neural_view_create(const struct gpu *gpu, SluiceVulkanContext *context,
                        const struct picture_list *pictures, const struct settings *settings,
                        struct neural_view *view);
/** After the streamer, once the device is idle. A zeroed struct is fine. */
void neural_view_destroy(struct neural_view *view);

/** The tiles of a picture that is decoded on feedback. NULL, said on stderr, if it failed. */
const SluiceTileProducer *neural_view_add_producer(struct neural_view *view,
                                                   const struct neural_picture *picture);

/** Around the draws of a frame; nothing without a loader. `slot` was waited for. */
bool neural_view_begin(struct neural_view *view, uint32_t slot, VkCommandBuffer commands);
bool neural_view_end(struct neural_view *view, VkCommandBuffer commands);
/** Loads what the frame of a slot missed. With `settle` waits for the frame, and until all is
 * there.
 */
bool neural_view_process(struct neural_view *view, uint32_t slot, bool settle);

/** Bytes of latents, weights and pages in GPU memory now. */
uint64_t neural_view_memory(const struct neural_view *view);

#endif /* SAMPLES_STREAMING_NEURAL_VIEW_H */
