/**
 * A streamer with textures of one source that takes no time, and a loop of timed frames.
 * Measurements define the work between begin and end.
 */
#ifndef BENCH_VULKAN_RIG_H
#define BENCH_VULKAN_RIG_H

#include "bench.h"
#include "source.h"

#include "bench_shared.h"

#define RIG_FRAMES 3u
#define RIG_MAX_PIPELINES 64u

struct rig_info {
    const struct bench *bench;
    /** Handles are filled in; pfnGetInstanceProcAddr, too, if NULL. */
    SluiceVulkanContextCreateInfo context;
    /** Set fields that differ from their defaults. The rig sets `context`. */
    SluiceVulkanStreamerCreateInfo streamer;
    bool chooses_modes; ///< true: AUTO instead of the bench's mode
    SluiceFormat format;
    uint32_t texture_size, texture_count;
    uint32_t output_words;              ///< words of a buffer that shaders write and the host reads
    uint32_t picture_words;             ///< words of a buffer in device memory that shaders write
    float anisotropy;                   ///< anisotropy of the samplers; 1: none
    const SluiceTileProducer *producer; ///< writes the tiles of all textures; NULL: tiles are read
    VkImageView plain_view;             ///< VK_NULL_HANDLE: the view of the first texture
};

/** Seconds of a frame's three parts. NULL: not timed. */
struct rig_samples {
    struct samples *begin, *work, *end;
};

struct rig_slot {
    VkCommandBuffer commands[3]; ///< begin, work, end
    VkDescriptorSet pages;
    uint64_t page_generation;
    uint64_t signal_value;
    struct rig_samples samples;
};

struct rig {
    const struct bench *bench;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceStreamedTextureManager *manager; ///< the streamer's
    struct free_source *sources;           ///< owned; one per texture
    SluiceVulkanTexture *textures;         ///< owned
    uint32_t texture_count;
    uint32_t map_width, map_height; ///< feedback regions of each texture
    uint64_t frame;                 ///< last frame
    double host_seconds;            ///< host time of begin and end in the last frame
    double host_cpu_seconds;        ///< processor time of the thread in begin and end

    struct gpu_buffer outputs, indices, picture;
    VkSampler sampler;
    VkDescriptorSetLayout set_layouts[2];
    VkPipelineLayout layout;
    VkDescriptorPool descriptor_pool;
    VkDescriptorSet set;
    VkQueryPool queries;
    VkSemaphore semaphore;
    struct rig_slot slots[RIG_FRAMES];
    VkPipeline pipelines[RIG_MAX_PIPELINES]; ///< destroyed with the rig
    uint32_t pipeline_count;
};

typedef void rig_record(struct rig *rig, VkCommandBuffer commands, void *user);

struct rig_work {
    rig_record *warm_up; ///< runs before, untimed; may be NULL
    rig_record *record;
    void *user;
    struct rig_samples samples;
};

/** Creates a rig. Reports errors on stderr. rig_destroy accepts a failed rig. */
bool rig_create(struct rig *rig, const struct rig_info *info);
void rig_destroy(struct rig *rig);

/* rig_shaders.c */
bool rig_create_descriptors(struct rig *rig, const struct rig_info *info);
void rig_destroy_descriptors(struct rig *rig);
void rig_write_pages(struct rig *rig, struct rig_slot *slot);

/** Values of the constants in bench_shared.h, in their order; floats as bits. */
struct rig_constants {
    uint32_t values[BENCH_CONSTANT_COUNT];
};

/** Returns VK_NULL_HANDLE on failure. */
VkPipeline rig_compute_pipeline(struct rig *rig, const uint32_t *words, size_t size,
                                const struct rig_constants *constants);
VkPipeline rig_screen_pipeline(struct rig *rig, const uint32_t *words, size_t size,
                               const struct rig_constants *constants, VkRenderPass pass);

/** Binds pipeline, descriptors and parameters for a frame's work. */
void rig_bind(struct rig *rig, VkCommandBuffer commands, VkPipelineBindPoint point,
              VkPipeline pipeline, const struct BenchParams *params);

/** Runs a frame. At most RIG_FRAMES are in flight. Adds samples when it has completed. */
bool rig_frame(struct rig *rig, const struct rig_work *work);
/** Waits for all frames, and adds their samples. */
bool rig_finish(struct rig *rig);
/** Waits for frames, reads and bindings. */
bool rig_settle(struct rig *rig);

/** A dispatch of wants.comp for all textures. `user` of rig_work is a struct rig_wants. */
struct rig_wants {
    VkPipeline pipeline;
    struct BenchParams params; ///< width, height and textureCount are filled in
};
rig_record rig_record_wants;
VkPipeline rig_wants_pipeline(struct rig *rig);

/** Runs frames with the requests of `wants` until all their tiles are mapped. */
bool rig_load(struct rig *rig, struct rig_wants *wants);

SluiceVulkanStreamerStatistics rig_statistics(const struct rig *rig);

#endif /* BENCH_VULKAN_RIG_H */
