/** Many textures in the array of a streamer, of which a shader samples some by their numbers. */
#ifndef TESTS_DEVICE_CROWD_H
#define TESTS_DEVICE_CROWD_H

#include "device/harness.h"

#include "crowd_shared.h"

struct crowd_member {
    uint32_t number, size;     ///< of a square
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
    uint64_t budget; ///< bytes of tile memory that no frame may exceed; 0: any
    struct harness_buffer outputs;
    VkDescriptorSetLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipelineLayout pipeline_layout;
    VkPipeline pipeline;
    struct crowd_range ranges[2]; ///< of the frames to come; count 0: none
};

/** `info` has at least maxTextureCount; a texture array and frames as the unit of time are set. */
void crowd_init(struct crowd *c, struct harness *h, SluiceVulkanStreamerCreateInfo info);
void crowd_finish(struct crowd *c);

/** Adds a square texture of RGBA8 at the end; `wrapped` is its source instead, borrowed, or NULL.
 */
SluiceResult crowd_add(struct crowd *c, uint32_t size, SluiceImageSource *wrapped);
SluiceImageSource *crowd_source(struct crowd_member *member, uint32_t number, uint32_t size);

/**
 * A frame that samples `ranges`. Every sample must be right: the color of level 0 or of a coarser
 * level as the source has it, or SLUICE_FALLBACK_COLOR if nothing is resident. Returns how many
 * samples were not of level 0.
 */
uint32_t crowd_frame(struct crowd *c);
/** Frames until all samples are of level 0, at most `most`; the number that still are not. */
uint32_t crowd_sharpen(struct crowd *c, uint32_t most);
/** Frames that sample nothing. */
void crowd_rest(struct crowd *c, uint32_t frames);

SluiceVulkanStreamerStatistics crowd_statistics(const struct crowd *c);

#endif /* TESTS_DEVICE_CROWD_H */
