/** Queue for the library's own copies: command buffers and progress. */
#ifndef SLC_VULKAN_UPLOAD_QUEUE_H
#define SLC_VULKAN_UPLOAD_QUEUE_H

#include "vulkan/dispatch.h"

#define SLC_UPLOAD_BATCHES 8u

/** Upload queue. Zeroed: none. */
struct slc_upload_queue {
    VkQueue queue; ///< the application's
    VkCommandPool pool;
    VkCommandBuffer commands[SLC_UPLOAD_BATCHES];
    VkSemaphore semaphore; ///< timeline: a value per batch
    uint64_t submitted, completed;
};

/** Creates pool and semaphore. Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_upload_queue_init(struct slc_upload_queue *q, const struct slc_vk *vk,
                                   VkQueue queue, uint32_t family);
/** Destroys pool and semaphore. All batches must be complete. `q` may be zeroed. */
void slc_upload_queue_finish(struct slc_upload_queue *q, const struct slc_vk *vk);

/** Updates `completed`. */
SluiceResult slc_upload_queue_poll(struct slc_upload_queue *q, const struct slc_vk *vk);
/** Waits until all batches are complete. */
SluiceResult slc_upload_queue_wait(struct slc_upload_queue *q, const struct slc_vk *vk);
/** Waits for all batches before destruction; after 5 seconds without progress, for the device. */
void slc_upload_queue_drain(const struct slc_upload_queue *q, const struct slc_vk *vk);

/** True if a batch can begin. */
static inline bool slc_upload_queue_is_free(const struct slc_upload_queue *q)
{
    return q->queue && q->submitted - q->completed < SLC_UPLOAD_BATCHES;
}

/** Begins a batch. Its transfers come after all transfers of earlier batches. */
SluiceResult slc_upload_queue_begin(const struct slc_upload_queue *q, const struct slc_vk *vk,
                                    VkCommandBuffer *commands);
/** Submits a batch that waits until `after` reaches `value`. Work before that is visible to it. */
SluiceResult slc_upload_queue_submit(struct slc_upload_queue *q, const struct slc_vk *vk,
                                     VkSemaphore after, uint64_t value);

/** Records a barrier between earlier and later transfers. */
void slc_record_transfer_barrier(const struct slc_vk *vk, VkCommandBuffer commands);

#endif /* SLC_VULKAN_UPLOAD_QUEUE_H */
