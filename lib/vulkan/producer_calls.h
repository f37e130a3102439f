/**
 * Calls of producers: callbacks that record commands, which write texels of tiles or bytes of pages
 * (SluiceTileProducer, SluiceDemandResourceCreateInfo). Streamers and demand loaders put the same
 * barriers around them, and draw the same consequences from their answers.
 */
#ifndef SLC_VULKAN_PRODUCER_CALLS_H
#define SLC_VULKAN_PRODUCER_CALLS_H

#include "vulkan/dispatch.h"

#define SLC_PRODUCER_BATCH 64u   /* most tiles or pages of a call */
#define SLC_PRODUCER_TIMEOUT 64u /* default timeout in frames or launches */

/** Calls in one command buffer. The last batch decides whether the next one needs a barrier. */
struct slc_producer_calls {
    const struct slc_vk *vk; ///< borrowed
    VkCommandBuffer commands;
    uint64_t target; ///< image or buffer of the last batch; 0: there was none
    uint32_t level, owner;
};

/** Records the barrier that a batch needs. `target`: the image or buffer that it writes, in level
 *  `level`. `owner`: any number of its texture or resource. */
void slc_producer_calls_order(struct slc_producer_calls *calls, uint32_t owner, uint64_t target,
                              uint32_t level);
/** Records the barrier behind all batches, if there were any. */
void slc_producer_calls_end(const struct slc_producer_calls *calls);

/** Sets all answers to SLUICE_SUCCESS before a producer is called. */
void slc_producer_answers_init(SluiceResult *answers, uint32_t count);
/** Applies the return value of a call to all answers, unless it is SLUICE_SUCCESS. */
void slc_producer_answers_end(SluiceResult *answers, uint32_t count, SluiceResult returned);

enum slc_producer_effect {
    SLC_PRODUCER_WROTE,  ///< the commands that write the tile or page are recorded
    SLC_PRODUCER_WAITS,  ///< the producer must be called again
    SLC_PRODUCER_FAILED, ///< the producer failed, or was not ready for too long
};

/** Returns what an answer means. `*asked`: frame in which the producer was asked first, 0 at first.
 *  `can_wait`: there is room for tiles that wait. */
enum slc_producer_effect slc_producer_effect(SluiceResult answer, uint64_t *asked, uint64_t frame,
                                             uint32_t timeout, bool can_wait);

#endif /* SLC_VULKAN_PRODUCER_CALLS_H */
