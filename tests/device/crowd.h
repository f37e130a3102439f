/** Many textures in a streamer's array. A shader samples some of them by their numbers. */
#ifndef TESTS_DEVICE_CROWD_H
#define TESTS_DEVICE_CROWD_H

#include "device/harness.h"

#include "crowd_shared.h"

struct crowd_member {
    uint32_t number, size;     ///< size: of the square texture
    SluiceImageSource *source; ///< owned; procedural
    SluiceVulkanTexture texture;
};

/** Members that one dispatch samples: [first, first + count). */
struct crowd_range {
    uint32_t first, count;
};

struct crowd {
    struct harness *h;
    SluiceVulkanStreamer *streamer;
    uint32_t count;
    struct crowd_member *members;
    uint64_t budget; ///< limit of tile memory in each frame, in bytes; 0: none
    struct harness_buffer outputs;
    VkDescriptorSetLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipelineLayout pipeline_layout;
    VkPipeline pipeline;
    struct crowd_range ranges[2]; ///< ranges of the next frames; count 0: none
};

/** Set at least maxTextureCount in `info`. Sets a texture array, and frames as the unit of time. */
void crowd_init(struct crowd *c, struct harness *h, SluiceVulkanStreamerCreateInfo info);
void crowd_finish(struct crowd *c);

/** Adds a square texture of RGBA8 at the end. `wrapped`: source to use instead, borrowed; or
 * NULL. */
SluiceResult crowd_add(struct crowd *c, uint32_t size, SluiceImageSource *wrapped);
SluiceImageSource *crowd_source(struct crowd_member *member, uint32_t number, uint32_t size);

/**
 * Runs a frame that samples `ranges`. Every sample must have the source's color at level 0 or a
 * coarser level, or SLUICE_FALLBACK_COLOR if nothing is resident. Returns the number of samples
 * that were not of level 0.
 */
uint32_t crowd_frame(struct crowd *c);
/** Runs at most `most` frames, until all samples are of level 0. Returns the number of other
 * samples. */
uint32_t crowd_sharpen(struct crowd *c, uint32_t most);
/** Runs frames that sample nothing. */
void crowd_rest(struct crowd *c, uint32_t frames);

SluiceVulkanStreamerStatistics crowd_statistics(const struct crowd *c);

#endif /* TESTS_DEVICE_CROWD_H */
