/**
 * Draws the room once more, after the frame and outside its time, and brings to the host what all
 * samples ask for and what the streamer shows.
 */
#ifndef SAMPLES_STREAMING_NEEDS_PASS_H
#define SAMPLES_STREAMING_NEEDS_PASS_H

#include "needs.h"
#include "renderer.h"

/** For one frame that may be on its way. */
struct needs_slot {
    VkDescriptorSet frame_set;
    struct gpu_buffer host; ///< counts, texture table, feedback, MinMip, one behind the other
    uint32_t word_count;    ///< of the last two
};

struct needs_pass {
    const struct gpu *gpu;           ///< borrowed; NULL: there is no such pass
    const struct renderer *renderer; ///< borrowed
    SluiceVulkanBuffers buffers;     ///< the streamer's
    uint32_t texture_count;
    uint32_t word_count; ///< of the feedback and MinMip buffers that are in use, as far as known
    struct gpu_buffer feedback, counts;
};

/** `region_count`: of the streamer at most; `texture_count`: that it has. */
bool needs_pass_create(const struct gpu *gpu, const struct renderer *renderer,
                       const SluiceVulkanBuffers *buffers, uint32_t region_count,
                       uint32_t texture_count, struct needs_pass *pass);
/** A zeroed struct is fine. */
void needs_pass_destroy(struct needs_pass *pass);

/** `frame_set` is a set of the frame layout that nothing was written to; `frame` its binding 0. */
bool needs_slot_create(const struct needs_pass *pass, VkDescriptorSet frame_set, VkBuffer frame,
                       struct needs_slot *slot);
void needs_slot_destroy(const struct needs_pass *pass, struct needs_slot *slot);

/** Between sluiceEndStreamingFrame and submission. The target is drawn over. `streamer_set` is the
 *  frame's. */
void needs_pass_record(const struct needs_pass *pass, const struct target *target,
                       const struct renderer_surface *surfaces, VkDescriptorSet streamer_set,
                       struct needs_slot *slot, VkCommandBuffer commands);

/** Of a slot whose frame was waited for; valid until the slot's next frame. */
struct needs_words needs_pass_words(struct needs_pass *pass, const struct needs_slot *slot,
                                    struct GalleryCounts *counts);

#endif /* SAMPLES_STREAMING_NEEDS_PASS_H */
