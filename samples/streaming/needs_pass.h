/**
 * Draws the room again after the frame, outside the measured time. Reads back the requests of all
 * samples, and the levels that the streamer shows.
 */
#ifndef SAMPLES_STREAMING_NEEDS_PASS_H
#define SAMPLES_STREAMING_NEEDS_PASS_H

#include "needs.h"
#include "renderer.h"

/** Resources of one frame in flight. */
struct needs_slot {
    VkDescriptorSet frame_set;
    struct gpu_buffer host; ///< counts, texture table, feedback and MinMip, one after the other
    uint32_t word_count;    ///< words of the feedback and of the MinMip buffer
};

struct needs_pass {
    const struct gpu *gpu;           ///< borrowed; NULL: the pass is off
    const struct renderer *renderer; ///< borrowed
    SluiceVulkanBuffers buffers;     ///< the streamer's
    uint32_t texture_count;
    uint32_t word_count; ///< used words of the feedback and MinMip buffers, as far as known
    struct gpu_buffer feedback, counts;
};

/** `region_count`: the streamer's limit. `texture_count`: textures of the streamer. */
bool needs_pass_create(const struct gpu *gpu, const struct renderer *renderer,
                       const SluiceVulkanBuffers *buffers, uint32_t region_count,
                       uint32_t texture_count, struct needs_pass *pass);
/** Accepts a zeroed struct. */
void needs_pass_destroy(struct needs_pass *pass);

/** `frame_set`: unwritten set of the frame layout. `frame`: buffer for its binding 0. */
bool needs_slot_create(const struct needs_pass *pass, VkDescriptorSet frame_set, VkBuffer frame,
                       struct needs_slot *slot);
void needs_slot_destroy(const struct needs_pass *pass, struct needs_slot *slot);

/** Records between sluiceEndStreamingFrame and submission. Overwrites the target. `streamer_set`:
 * set of the frame. */
void needs_pass_record(const struct needs_pass *pass, const struct target *target,
                       const struct renderer_surface *surfaces, VkDescriptorSet streamer_set,
                       struct needs_slot *slot, VkCommandBuffer commands);

/** Returns the results of a slot whose frame has finished. Valid until the slot's next frame. */
struct needs_words needs_pass_words(struct needs_pass *pass, const struct needs_slot *slot,
                                    struct GalleryCounts *counts);

#endif /* SAMPLES_STREAMING_NEEDS_PASS_H */
