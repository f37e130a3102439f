/**
 * A neural set in a view. If the GPU decodes tiles: latents and weights in GPU memory. If the
 * shader decodes: a demand loader of pages.
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
    SluiceVulkanNeuralDecoder *decoder; ///< owned; NULL: no picture uses NEURAL_FEEDBACK
    uint64_t decoder_size;              ///< bytes of GPU memory
    SluiceDemandLoader *loader;         ///< owned; NULL: no picture uses NEURAL_SAMPLE
    SluiceDemandResourceId resource;
    SluiceNeuralPages pages;
    struct gpu_buffer set_buffer, weights;
    const uint32_t *words;        ///< SPIR-V of the decoding shader
    size_t words_size;            ///< bytes
    VkDescriptorSetLayout layout; ///< set 3 of the pipelines; VK_NULL_HANDLE without a loader
    VkDescriptorPool pool;
    VkDescriptorSet set;
    SluiceDemandLaunch launches[NEURAL_VIEW_SLOTS];
    bool under_way[NEURAL_VIEW_SLOTS]; ///< true: submitted and not processed
};

/** Creates the objects that the pictures' modes require. Reports errors on stderr. */
bool neural_view_create(const struct gpu *gpu, SluiceVulkanContext *context,
                        const struct picture_list *pictures, const struct settings *settings,
                        struct neural_view *view);
/** Call after the streamer is destroyed, with an idle device. Accepts a zeroed struct. */
void neural_view_destroy(struct neural_view *view);

/** Returns the tile producer of a NEURAL_FEEDBACK picture. Returns NULL on error and reports it on
 * stderr. */
const SluiceTileProducer *neural_view_add_producer(struct neural_view *view,
                                                   const struct neural_picture *picture);

/** Begins and ends the draws of a frame. Does nothing without a loader. The slot's previous frame
 * must have finished. */
bool neural_view_begin(struct neural_view *view, uint32_t slot, VkCommandBuffer commands);
bool neural_view_end(struct neural_view *view, VkCommandBuffer commands);
/** Loads pages that the frame of a slot missed. `settle`: wait for the frame, and until all pages
 * are resident. */
bool neural_view_process(struct neural_view *view, uint32_t slot, bool settle);

/** Bytes of latents, weights and pages in GPU memory. */
uint64_t neural_view_memory(const struct neural_view *view);

#endif /* SAMPLES_STREAMING_NEURAL_VIEW_H */
