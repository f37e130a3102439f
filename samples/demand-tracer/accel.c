#include "accel.h"

#include <stdlib.h>
#include <string.h>

#include "../common/one_time.h"
#include "../common/ray_table.h"

/* Larger than any device requires. */
#define SCRATCH_ALIGNMENT 256u

/** The recorded build of one structure. */
struct build {
    PFN_vkCmdBuildAccelerationStructuresKHR record;
    VkAccelerationStructureBuildGeometryInfoKHR info;
    VkAccelerationStructureBuildRangeInfoKHR range;
};

static PFN_vkVoidFunction device_function(const struct gpu *gpu, const char *name)
{
    return vkGetDeviceProcAddr(gpu->device, name);
}

static void record_build(void *user_data, VkCommandBuffer commands)
{
    const struct build *build = user_data;
    const VkAccelerationStructureBuildRangeInfoKHR *range = &build->range;
    build->record(commands, 1, &build->info, &range);
}

static bool create_structure(const struct gpu *gpu, VkAccelerationStructureTypeKHR type,
                             VkDeviceSize size, struct accel_structure *structure)
{
    PFN_vkCreateAccelerationStructureKHR create =
        (PFN_vkCreateAccelerationStructureKHR)device_function(gpu,
                                                              "vkCreateAccelerationStructureKHR");
    if (!gpu_create_buffer(gpu, size,
                           VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                               VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                           &structure->storage))
        return false;
    VkAccelerationStructureCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
        .buffer = structure->storage.buffer,
        .size = size,
        .type = type};
    return gpu_check(create(gpu->device, &info, NULL, &structure->handle),
                     "vkCreateAccelerationStructureKHR");
}

static VkAccelerationStructureBuildSizesInfoKHR get_sizes(const struct gpu *gpu,
                                                          const struct build *build)
{
    PFN_vkGetAccelerationStructureBuildSizesKHR get =
        (PFN_vkGetAccelerationStructureBuildSizesKHR)device_function(
            gpu, "vkGetAccelerationStructureBuildSizesKHR");
    VkAccelerationStructureBuildSizesInfoKHR sizes = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    get(gpu->device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &build->info,
        &build->range.primitiveCount, &sizes);
    return sizes;
}

static bool run_build(const struct gpu *gpu, struct build *build, const struct gpu_buffer *scratch)
{
    const VkDeviceSize mask = SCRATCH_ALIGNMENT - 1;
    VkDeviceAddress address = ray_buffer_address(gpu, scratch->buffer);
    build->info.scratchData.deviceAddress = (address + mask) & ~mask;
    return one_time_run(gpu, record_build, build);
}

static bool build_structure(const struct gpu *gpu, VkAccelerationStructureTypeKHR type,
                            const VkAccelerationStructureGeometryKHR *geometry, uint32_t count,
                            struct accel_structure *structure)
{
    struct build build = {
        .record = (PFN_vkCmdBuildAccelerationStructuresKHR)device_function(
            gpu, "vkCmdBuildAccelerationStructuresKHR"),
        .info = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
                 .type = type,
                 .flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR,
                 .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
                 .geometryCount = 1,
                 .pGeometries = geometry},
        .range = {.primitiveCount = count}};
    VkAccelerationStructureBuildSizesInfoKHR sizes = get_sizes(gpu, &build);
    struct gpu_buffer scratch = {0};
    bool done = create_structure(gpu, type, sizes.accelerationStructureSize, structure) &&
                gpu_create_buffer(gpu, sizes.buildScratchSize + SCRATCH_ALIGNMENT,
                                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                      VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                                  &scratch);
    build.info.dstAccelerationStructure = structure->handle;
    done = done && run_build(gpu, &build, &scratch);
    gpu_destroy_buffer(gpu, &scratch);
    return done;
}

static bool build_shape(const struct gpu *gpu, const struct scene *scene, enum shape_kind kind,
                        VkBuffer vertices, VkBuffer indices, struct accel_structure *structure)
{
    const struct shape *shape = &scene->shapes[kind];
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR,
        .flags = shape->cut_out ? VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR
                                : VK_GEOMETRY_OPAQUE_BIT_KHR,
        .geometry.triangles = {
            .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR,
            .vertexFormat = VK_FORMAT_R32G32B32_SFLOAT,
            .vertexData.deviceAddress = ray_buffer_address(gpu, vertices),
            .vertexStride = sizeof(struct TracerVertex),
            .maxVertex = (uint32_t)scene->mesh.vertex_count - 1,
            .indexType = VK_INDEX_TYPE_UINT32,
            .indexData.deviceAddress = ray_buffer_address(gpu, indices) +
                                       shape->first_index * sizeof *scene->mesh.indices}};
    return build_structure(gpu, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, &geometry,
                           shape->index_count / 3, structure);
}

static VkAccelerationStructureInstanceKHR place_instance(const struct gpu *gpu,
                                                         const struct accel *accel,
                                                         const struct scene *scene, uint32_t index)
{
    PFN_vkGetAccelerationStructureDeviceAddressKHR get_address =
        (PFN_vkGetAccelerationStructureDeviceAddressKHR)device_function(
            gpu, "vkGetAccelerationStructureDeviceAddressKHR");
    VkAccelerationStructureDeviceAddressInfoKHR address = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
        .accelerationStructure = accel->shapes[scene->kinds[index]].handle};
    VkAccelerationStructureInstanceKHR instance = {
        .mask = 0xFF,
        .flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR,
        .accelerationStructureReference = get_address(gpu->device, &address)};
    memcpy(instance.transform.matrix, scene->instances[index].toWorld,
           sizeof instance.transform.matrix);
    return instance;
}

static bool build_scene(const struct gpu *gpu, const struct scene *scene, struct accel *accel)
{
    VkAccelerationStructureInstanceKHR *instances;
    if (!gpu_create_buffer(gpu, scene->instance_count * sizeof *instances, ACCEL_INPUT_USAGE,
                           &accel->instances))
        return false;
    instances = accel->instances.mapped;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        instances[i] = place_instance(gpu, accel, scene, i);
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR,
        .geometry.instances = {
            .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
            .data.deviceAddress = ray_buffer_address(gpu, accel->instances.buffer)}};
    return build_structure(gpu, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, &geometry,
                           scene->instance_count, &accel->scene);
}

bool accel_build(const struct gpu *gpu, const struct scene *scene, VkBuffer vertices,
                 VkBuffer indices, struct accel *accel)
{
    memset(accel, 0, sizeof *accel);
    for (int kind = 0; kind < SHAPE_COUNT; kind++)
        if (!build_shape(gpu, scene, (enum shape_kind)kind, vertices, indices,
                         &accel->shapes[kind]))
            return false;
    return build_scene(gpu, scene, accel);
}

static void structure_finish(const struct gpu *gpu, struct accel_structure *structure)
{
    PFN_vkDestroyAccelerationStructureKHR destroy =
        (PFN_vkDestroyAccelerationStructureKHR)device_function(gpu,
                                                               "vkDestroyAccelerationStructureKHR");
    if (destroy)
        destroy(gpu->device, structure->handle, NULL);
    gpu_destroy_buffer(gpu, &structure->storage);
}

void accel_finish(const struct gpu *gpu, struct accel *accel)
{
    structure_finish(gpu, &accel->scene);
    for (int kind = 0; kind < SHAPE_COUNT; kind++)
        structure_finish(gpu, &accel->shapes[kind]);
    gpu_destroy_buffer(gpu, &accel->instances);
}
