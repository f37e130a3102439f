/**
 * A demand loader with some textures of one free source, and launches of samples.comp around it.
 */
#ifndef BENCH_DEMAND_RIG_H
#define BENCH_DEMAND_RIG_H

#include "../../tools/common/gpu.h"
#include "../manager/figures.h"
#include "../vulkan/source.h"

#include "demand_bench_shared.h"

#include <sluice/demand.h>

struct bench {
    struct gpu gpu;
    uint32_t edge;             ///< samples of a launch: edge x edge
    uint32_t texture_size;     ///< texels
    uint32_t columns;          ///< columns x columns textures
    SluiceDemandFilter filter; ///< of textures
    uint32_t threads;          ///< that load; 0: as the library does
    uint64_t min_staging_size, min_tile_memory_size;
    const SluiceAllocationCallbacks *allocator; ///< of the context; NULL: malloc
    bool wall;                                  ///< measures wall time: time stamps are unusable
};

/** Says on stderr what it is about, and returns false unless `result` is a success or news. */
bool check(SluiceResult result, const char *what);

#define RIG_SLOTS 3u

struct rig_slot {
    VkCommandBuffer commands;
    VkDescriptorSet pages;
    uint64_t generation;
    SluiceDemandLaunch launch;
    uint32_t kind;
    double start, submitted;
};

struct rig {
    const struct bench *bench;
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    struct free_source sources[DEMAND_BENCH_TEXTURES + 1]; ///< of the textures; of rig_warm_up
    SluiceDemandTextureId ids[DEMAND_BENCH_TEXTURES];
    uint32_t texture_count;
    struct gpu_buffer outputs, picture;
    struct gpu_image plain[DEMAND_BENCH_TEXTURES]; ///< empty unless asked for
    VkSampler sampler;
    VkDescriptorSetLayout set_layouts[2];
    VkPipelineLayout layout;
    VkDescriptorPool descriptor_pool;
    VkDescriptorSet set;
    VkPipeline pipelines[DEMAND_BENCH_KINDS]; ///< by DEMAND_BENCH_NOTHING and so on; VK_NULL_HANDLE
                                              ///< until used
    VkQueryPool queries;
    struct rig_slot slots[RIG_SLOTS];
    uint64_t begun, ended; ///< launches
    bool timed;            ///< time stamps in every launch
    struct DemandBenchParams params;
};

/** `info`: of what is not zero; the context is filled in. `plain`: with ordinary images, too. A rig
 *  that was not created can be destroyed. */
bool rig_create(struct rig *rig, const struct bench *bench,
                const SluiceDemandLoaderCreateInfo *info, bool plain);
void rig_destroy(struct rig *rig);

/* descriptors.c */
bool rig_create_descriptors(struct rig *rig);
void rig_destroy_descriptors(struct rig *rig);
void rig_write_pages(struct rig *rig, struct rig_slot *slot);
VkPipeline rig_pipeline(struct rig *rig, uint32_t kind);

/* plain.c */
bool rig_create_plain(struct rig *rig);
void rig_destroy_plain(struct rig *rig);

/** What a launch came to. */
struct rig_outcome {
    SluiceDemandRequests requests;
    SluiceDemandTicket ticket;
    double gpu_seconds;   ///< of the dispatch
    double gpu_parts[2];  ///< of prepare and of end
    double host_parts[3]; ///< from prepare to submission; wait; process
    uint32_t missing;     ///< samples; only while params.counting
};

/** A launch from prepare to submission; RIG_SLOTS of them may be under way. DEMAND_BENCH_NOTHING
 *  dispatches nothing at all. */
bool rig_begin(struct rig *rig, uint32_t kind);
/** The rest of the oldest one. */
bool rig_end(struct rig *rig, struct rig_outcome *outcome);
/** Both. */
bool rig_launch(struct rig *rig, uint32_t kind, struct rig_outcome *outcome);
/** Some samples of a texture of its own: drivers compile what is first run. */
bool rig_warm_up(struct rig *rig);
/** Launches until nothing is missing, at most `limit` times; how many it took, 0: it did not end.
 */
uint32_t rig_load(struct rig *rig, uint32_t limit);

typedef bool measurement(const struct bench *bench);
measurement measure_bytes, measure_create, measure_fill, measure_sampling, measure_trips,
    measure_budget, measure_small;

#endif /* BENCH_DEMAND_RIG_H */
