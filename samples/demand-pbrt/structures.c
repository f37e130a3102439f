#include "structures.h"

#include "../common/one_time.h"
#include "../common/ray_table.h"

/* Scratch memory for builds that run in parallel. A single build may use more. */
#define SCRATCH_SIZE ((VkDeviceSize)64 << 20)

static PFN_vkVoidFunction function(const struct gpu *gpu, const char *name)
{
    return vkGetDeviceProcAddr(gpu->device, name);
}

bool structures_create(const struct gpu *gpu, struct structures *s)
{
    *s = (struct structures){0};
    if (!gpu->ray_tracing)
        return true;
    VkPhysicalDeviceAccelerationStructurePropertiesKHR properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    VkPhysicalDeviceProperties2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                       .pNext = &properties};
    vkGetPhysicalDeviceProperties2(gpu->physical_device, &all);
    *s = (struct structures){
        .arena.usage = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
                       VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
        .scratch_alignment = properties.minAccelerationStructureScratchOffsetAlignment,
        .create =
            (PFN_vkCreateAccelerationStructureKHR)function(gpu, "vkCreateAccelerationStructureKHR"),
        .destroy = (PFN_vkDestroyAccelerationStructureKHR)function(
            gpu, "vkDestroyAccelerationStructureKHR"),
        .get_sizes = (PFN_vkGetAccelerationStructureBuildSizesKHR)function(
            gpu, "vkGetAccelerationStructureBuildSizesKHR"),
        .get_address = (PFN_vkGetAccelerationStructureDeviceAddressKHR)function(
            gpu, "vkGetAccelerationStructureDeviceAddressKHR"),
        .record = (PFN_vkCmdBuildAccelerationStructuresKHR)function(
            gpu, "vkCmdBuildAccelerationStructuresKHR"),
    };
    const VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                            .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    const VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                        .pNext = &type};
    return gpu_check(vkCreateSemaphore(gpu->device, &info, NULL, &s->ready), "vkCreateSemaphore");
}

void structures_finish(const struct gpu *gpu, struct structures *s)
{
    vkDestroySemaphore(gpu->device, s->ready, NULL);
    gpu_destroy_buffer(gpu, &s->scratch);
    arena_finish(gpu, &s->arena);
}

void structures_give(const struct gpu *gpu, struct structures *s, struct structure *structure)
{
    if (structure->handle)
        s->destroy(gpu->device, structure->handle, NULL);
    arena_give(gpu, &s->arena, &structure->storage);
    *structure = (struct structure){0};
}

static VkAccelerationStructureBuildGeometryInfoKHR build_info(const struct structure_build *build)
{
    return (VkAccelerationStructureBuildGeometryInfoKHR){
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
        .type = build->type,
        .flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR |
                 (build->compact ? VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR : 0),
        .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
        .geometryCount = 1,
        .pGeometries = &build->geometry,
        .dstAccelerationStructure = build->target->handle};
}

bool structures_take(const struct gpu *gpu, struct structures *s,
                     VkAccelerationStructureTypeKHR type, VkDeviceSize size,
                     struct structure *structure)
{
    if (!arena_take(gpu, &s->arena, size, &structure->storage))
        return false;
    const VkAccelerationStructureCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
        .buffer = structure->storage.buffer,
        .offset = structure->storage.offset,
        .size = size,
        .type = type};
    if (!gpu_check(s->create(gpu->device, &info, NULL, &structure->handle),
                   "vkCreateAccelerationStructureKHR"))
        return false;
    const VkAccelerationStructureDeviceAddressInfoKHR address = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
        .accelerationStructure = structure->handle};
    structure->address = s->get_address(gpu->device, &address);
    return true;
}

static bool create_target(const struct gpu *gpu, struct structures *s, struct structure_build *b)
{
    const VkAccelerationStructureBuildGeometryInfoKHR build = build_info(b);
    VkAccelerationStructureBuildSizesInfoKHR sizes = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    s->get_sizes(gpu->device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &build,
                 &b->primitive_count, &sizes);
    const VkDeviceSize mask = s->scratch_alignment - 1;
    b->scratch_size = (sizes.buildScratchSize + mask) & ~mask;
    return structures_take(gpu, s, b->type, sizes.accelerationStructureSize, b->target);
}

/** Places builds in scratch memory. A build at offset 0 begins a group that waits for the previous
 * one. */
static VkDeviceSize place_scratch(struct structure_build *builds, uint32_t count)
{
    VkDeviceSize at = 0, most = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (at + builds[i].scratch_size > SCRATCH_SIZE)
            at = 0;
        builds[i].scratch_at = at;
        at += builds[i].scratch_size;
        most = at > most ? at : most;
    }
    return most;
}

static bool reserve_scratch(const struct gpu *gpu, const struct structures *s, VkDeviceSize size,
                            struct gpu_buffer *scratch)
{
    size += s->scratch_alignment;
    if (scratch->size >= size)
        return true;
    gpu_destroy_buffer(gpu, scratch);
    return gpu_create_device_buffer(
        gpu, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
        scratch);
}

bool structures_prepare(const struct gpu *gpu, struct structures *s, struct structure_build *builds,
                        uint32_t count, struct gpu_buffer *scratch)
{
    bool done = true;
    for (uint32_t i = 0; i < count && done; i++)
        done = create_target(gpu, s, &builds[i]);
    return done && reserve_scratch(gpu, s, place_scratch(builds, count), scratch);
}

static void wait_for_builds(VkCommandBuffer commands)
{
    gpu_barrier(commands, VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR |
                    VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR,
                VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR |
                    VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR);
}

void structures_record(const struct gpu *gpu, const struct structures *s,
                       const struct structure_build *builds, uint32_t count,
                       const struct gpu_buffer *scratch, VkCommandBuffer commands)
{
    const VkDeviceSize mask = s->scratch_alignment - 1;
    const VkDeviceAddress first = (ray_buffer_address(gpu, scratch->buffer) + mask) & ~mask;
    for (uint32_t i = 0; i < count; i++) {
        const struct structure_build *build = &builds[i];
        if (build->scratch_at == 0 && i > 0)
            wait_for_builds(commands);
        VkAccelerationStructureBuildGeometryInfoKHR info = build_info(build);
        const VkAccelerationStructureBuildRangeInfoKHR range = {.primitiveCount =
                                                                    build->primitive_count};
        const VkAccelerationStructureBuildRangeInfoKHR *ranges = &range;
        info.scratchData.deviceAddress = first + build->scratch_at;
        s->record(commands, 1, &info, &ranges);
    }
    gpu_barrier(commands, VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR);
}

struct batch {
    const struct gpu *gpu;
    const struct structures *structures;
    const struct structure_build *builds;
    uint32_t count;
};

static void record_batch(void *user_data, VkCommandBuffer commands)
{
    const struct batch *batch = user_data;
    structures_record(batch->gpu, batch->structures, batch->builds, batch->count,
                      &batch->structures->scratch, commands);
}

bool structures_build(const struct gpu *gpu, struct structures *s, struct structure_build *builds,
                      uint32_t count)
{
    struct batch batch = {gpu, s, builds, count};
    if (!gpu->ray_tracing || count == 0)
        return true;
    /* Waits for structures that another queue has built, because this queue and later launches read
     * them. */
    const bool done = structures_prepare(gpu, s, builds, count, &s->scratch) &&
                      one_time_run_after(gpu, s->ready, s->ready_value, record_batch, &batch);
    for (uint32_t i = 0; i < count && !done; i++)
        structures_give(gpu, s, builds[i].target);
    return done;
}
