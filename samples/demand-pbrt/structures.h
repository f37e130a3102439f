/** Acceleration structures, built in batches. If a compute shader traces the rays, there are no
 * structures and these functions do nothing. */
#ifndef DEMAND_PBRT_STRUCTURES_H
#define DEMAND_PBRT_STRUCTURES_H

#include "arena.h"

/** Zeroed is none. */
struct structure {
    VkAccelerationStructureKHR handle;
    VkDeviceAddress address;
    struct arena_part storage;
};

/** Owner of the memory of all structures. Zeroed is empty. */
struct structures {
    struct arena arena;
    struct gpu_buffer scratch;
    VkDeviceSize scratch_alignment;
    VkSemaphore ready;    ///< build_batch.c signals this semaphore
    uint64_t ready_value; ///< value after the last commands that have ended
    PFN_vkCreateAccelerationStructureKHR create;
    PFN_vkDestroyAccelerationStructureKHR destroy;
    PFN_vkGetAccelerationStructureBuildSizesKHR get_sizes;
    PFN_vkGetAccelerationStructureDeviceAddressKHR get_address;
    PFN_vkCmdBuildAccelerationStructuresKHR record;
};

struct structure_build {
    VkAccelerationStructureTypeKHR type;
    VkAccelerationStructureGeometryKHR geometry;
    uint32_t primitive_count;
    bool compact; ///< build_batch.c makes a compact copy; equal for all builds of a batch
    struct structure *target;  ///< zeroed before, filled by the build
    VkDeviceSize scratch_size; ///< private
    VkDeviceSize scratch_at;   ///< private
};

/** Reports errors on stderr. */
bool structures_create(const struct gpu *gpu, struct structures *structures);
void structures_finish(const struct gpu *gpu, struct structures *structures);

/** Makes an empty structure. Reports errors on stderr. */
bool structures_take(const struct gpu *gpu, struct structures *structures,
                     VkAccelerationStructureTypeKHR type, VkDeviceSize size,
                     struct structure *structure);
/** Makes the targets, and room for all builds in `scratch`. Reports errors on stderr. */
bool structures_prepare(const struct gpu *gpu, struct structures *structures,
                        struct structure_build *builds, uint32_t count, struct gpu_buffer *scratch);
/** Records the prepared builds. Later commands may read the structures. */
void structures_record(const struct gpu *gpu, const struct structures *structures,
                       const struct structure_build *builds, uint32_t count,
                       const struct gpu_buffer *scratch, VkCommandBuffer commands);
/** Builds all structures or none, and waits for them. Reports errors on stderr. */
bool structures_build(const struct gpu *gpu, struct structures *structures,
                      struct structure_build *builds, uint32_t count);
/** Destroys a structure. Call only while no launch uses it. A zeroed one is allowed. */
void structures_give(const struct gpu *gpu, struct structures *structures,
                     struct structure *structure);

/** Usage of buffers that builds and shaders read. */
static inline VkBufferUsageFlags structures_input_usage(const struct gpu *gpu)
{
    return VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
           (gpu->ray_tracing ? VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR
                             : 0);
}

#endif /* DEMAND_PBRT_STRUCTURES_H */
