/**
 * A demand loader with textures of one source that takes no time, and launches of samples.comp.
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
    uint32_t edge;             ///< samples per launch: edge x edge
    uint32_t texture_size;     ///< texels
    uint32_t columns;          ///< columns x columns textures
    SluiceDemandFilter filter; ///< filter of the textures
    uint32_t threads;          ///< loader threads; 0: the library's default
    uint64_t min_staging_size, min_tile_memory_size;
    const SluiceAllocationCallbacks *allocator; ///< allocator of the context; NULL: malloc
    bool wall; ///< measure wall time, because time stamps are unusable
};

/** Returns whether `result` is SLUICE_SUCCESS or a positive code. Otherwise reports it on
 * stderr. */
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
    struct free_source sources[DEMAND_BENCH_TEXTURES + 1]; ///< by texture; last: of rig_warm_up
    SluiceDemandTextureId ids[DEMAND_BENCH_TEXTURES];
    uint32_t texture_count;
    struct gpu_buffer outputs, picture;
    struct gpu_image plain[DEMAND_BENCH_TEXTURES]; ///< empty unless requested
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
    bool timed;            ///< true: time stamps in every launch
    struct DemandBenchParams params;
};

/** Creates a rig. Fields of `info` that are 0 keep their defaults; the context is filled in.
 * `plain`: also creates ordinary images. rig_destroy accepts a failed rig. */
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

/** Result of a launch. */
struct rig_outcome {
    SluiceDemandRequests requests;
    SluiceDemandTicket ticket;
    double gpu_seconds;   ///< GPU time of the dispatch
    double gpu_parts[2];  ///< GPU time of prepare and of end
    double host_parts[3]; ///< host time from prepare to submission, of the wait, and of process
    uint32_t missing;     ///< samples; only if params.counting
};

/** Runs a launch from prepare to submission. At most RIG_SLOTS may be in flight.
 * DEMAND_BENCH_NOTHING dispatches nothing. */
bool rig_begin(struct rig *rig, uint32_t kind);
/** Ends the oldest launch. */
bool rig_end(struct rig *rig, struct rig_outcome *outcome);
/** Begins and ends a launch. */
bool rig_launch(struct rig *rig, uint32_t kind, struct rig_outcome *outcome);
/** Samples a separate texture, so that drivers compile the shaders. */
bool rig_warm_up(struct rig *rig);
/** Launches until nothing is missing, at most `limit` times. Returns the number of launches; 0: not
 * complete. */
uint32_t rig_load(struct rig *rig, uint32_t limit);

typedef bool measurement(const struct bench *bench);
measurement measure_bytes, measure_create, measure_fill, measure_sampling, measure_trips,
    measure_budget, measure_small;

#endif /* BENCH_DEMAND_RIG_H */
