/** Queue of the library's own copies: its command buffers, and how far it is. */
#ifndef SLC_VULKAN_UPLOAD_QUEUE_H
#define SLC_VULKAN_UPLOAD_QUEUE_H

#include "vulkan/dispatch.h"

#define SLC_UPLOAD_BATCHES 8u

/** Zeroed: there is none. */
struct slc_upload_queue {
    VkQueue queue; ///< of the application
    VkCommandPool pool;
    VkCommandBuffer commands[SLC_UPLOAD_BATCHES];
    VkSemaphore semaphore; ///< timeline: a value per batch
    uint64_t submitted, completed;
};

/** Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_upload_queue_init(struct slc_upload_queue *q, const struct slc_vk *vk,
                                   VkQueue queue, uint32_t family);
/** Nothing is under way. A zeroed one is allowed. */
void slc_upload_queue_finish(struct slc_upload_queue *q, const struct slc_vk *vk);

/** Updates `completed`. */
SluiceResult slc_upload_queue_poll(struct slc_upload_queue *q, const struct slc_vk *vk);
/** Waits until all batches are complete. */
SluiceResult slc_upload_queue_wait(struct slc_upload_queue *q, const struct slc_vk *vk);
/** Waits for them before destruction; after 5 seconds without any progress, for the device. */
void slc_upload_queue_drain(const struct slc_upload_queue *q, const struct slc_vk *vk);

/** True if a batch can begin. */
static inline bool slc_upload_queue_is_free(const struct slc_upload_queue *q)
{
    return q->queue && q->submitted - q->completed < SLC_UPLOAD_BATCHES;
}

/** Begins a batch, behind all transfers of earlier ones. */
SluiceResult slc_upload_queue_begin(const struct slc_upload_queue *q, const struct slc_vk *vk,
                                    VkCommandBuffer *commands);
/** Submits it. `after` has reached `value`: what was done until then is visible to the batch. */
SluiceResult slc_upload_queue_submit(struct slc_upload_queue *q, const struct slc_vk *vk,
                                     VkSemaphore after, uint64_t value);

/** Transfers that are recorded next come after earlier ones. */
void slc_record_transfer_barrier(const struct slc_vk *vk, VkCommandBuffer commands);

#endif /* SLC_VULKAN_UPLOAD_QUEUE_H */
