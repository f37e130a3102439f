/** Writes feedback for given samples of any texture, without sampling, in one of several ways. */
#ifndef TESTS_DEVICE_WRITER_H
#define TESTS_DEVICE_WRITER_H

#include "device/harness.h"

#include "writer_shared.h"

#define WRITER_CAPACITY 4096u /* samples, and words that are copied */

enum writer_kind {
    WRITER_LEVELS,
    WRITER_MASKS,
    WRITER_IN_TURNS, ///< levels; asks whether it is the texture's turn
};

struct writer {
    struct harness *h;
    SluiceVulkanStreamer *streamer;
    struct harness_buffer inputs, outputs;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    uint32_t count; ///< number of samples to write
};

void writer_init(struct writer *w, struct harness *h, SluiceVulkanStreamer *streamer,
                 enum writer_kind kind);
void writer_finish(struct writer *w);

struct WriterInput *writer_inputs(struct writer *w);
/** Callback of harness_frame; `user` is the writer. */
void writer_record(void *user, VkCommandBuffer commands);
/** Copies words of the feedback buffer. Valid until the next call. Waits for the device. */
const uint32_t *writer_words(struct writer *w, uint32_t first, uint32_t count);

#endif /* TESTS_DEVICE_WRITER_H */
