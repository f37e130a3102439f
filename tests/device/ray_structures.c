#include "device/ray_structures.h"

#include "support/test.h"

#include <string.h>

const char *const ray_device_extensions[RAY_DEVICE_EXTENSION_COUNT] = {
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

void *ray_device_features(void)
{
    static VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline;
    static VkPhysicalDeviceAccelerationStructureFeaturesKHR structure;
    pipeline = (VkPhysicalDeviceRayTracingPipelineFeaturesKHR){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR,
        .pNext = &structure,
        .rayTracingPipeline = VK_TRUE};
    structure = (VkPhysicalDeviceAccelerationStructureFeaturesKHR){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
        .accelerationStructure = VK_TRUE};
    return &pipeline;
}

void ray_device_init(struct ray_device *device, struct harness *h)
{
    *device = (struct ray_device){.h = h};
#define LOAD(name)                                                                                 \
    device->name = (PFN_vk##name)h->GetDeviceProcAddr(h->device, "vk" #name);                      \
    assert_true(device->name != NULL);
    RAY_DEVICE_FUNCTIONS(LOAD)
#undef LOAD
}

void ray_buffer_init(struct ray_device *device, struct ray_buffer *buffer, uint64_t size,
                     VkBufferUsageFlags usage)
{
    struct harness *h = device->h;
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                               .size = size,
                               .usage = usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT};
    assert_int_equal(h->CreateBuffer(h->device, &info, NULL, &buffer->buffer), VK_SUCCESS);
    VkMemoryRequirements memory;
    h->GetBufferMemoryRequirements(h->device, buffer->buffer, &memory);
    VkMemoryAllocateFlagsInfo flags = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                       .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .pNext = &flags,
                                     .allocationSize = memory.size};
    const VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    while (!(memory.memoryTypeBits >> allocate.memoryTypeIndex & 1) ||
           (h->memory.memoryTypes[allocate.memoryTypeIndex].propertyFlags & wanted) != wanted)
        assert_true(++allocate.memoryTypeIndex < h->memory.memoryTypeCount);
    assert_int_equal(h->AllocateMemory(h->device, &allocate, NULL, &buffer->memory), VK_SUCCESS);
    assert_int_equal(h->BindBufferMemory(h->device, buffer->buffer, buffer->memory, 0), VK_SUCCESS);
    assert_int_equal(h->MapMemory(h->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->mapped),
                     VK_SUCCESS);
    VkBufferDeviceAddressInfo address = {.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                         .buffer = buffer->buffer};
    buffer->address = device->GetBufferDeviceAddress(h->device, &address);
}

void ray_buffer_finish(struct ray_device *device, struct ray_buffer *buffer)
{
    device->h->DestroyBuffer(device->h->device, buffer->buffer, NULL);
    device->h->FreeMemory(device->h->device, buffer->memory, NULL);
}

struct build {
    struct ray_device *device;
    VkAccelerationStructureBuildGeometryInfoKHR info;
    VkAccelerationStructureBuildRangeInfoKHR range;
};

static void record_build(void *user, VkCommandBuffer commands)
{
    struct build *build = user;
    const VkAccelerationStructureBuildRangeInfoKHR *range = &build->range;
    build->device->CmdBuildAccelerationStructuresKHR(commands, 1, &build->info, &range);
}

void ray_structure_build(struct ray_device *device, struct ray_structure *structure,
                         VkAccelerationStructureTypeKHR type,
                         const VkAccelerationStructureGeometryKHR *geometry, uint32_t count)
{
    struct build build = {
        device,
        {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
         .type = type,
         .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
         .geometryCount = 1,
         .pGeometries = geometry},
        {.primitiveCount = count}};
    VkAccelerationStructureBuildSizesInfoKHR sizes = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    device->GetAccelerationStructureBuildSizesKHR(device->h->device,
                                                  VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
                                                  &build.info, &count, &sizes);
    ray_buffer_init(device, &structure->storage, sizes.accelerationStructureSize,
                    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
    ray_buffer_init(device, &structure->scratch, sizes.buildScratchSize + 256,
                    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    VkAccelerationStructureCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
        .buffer = structure->storage.buffer,
        .size = sizes.accelerationStructureSize,
        .type = type};
    assert_int_equal(
        device->CreateAccelerationStructureKHR(device->h->device, &info, NULL, &structure->handle),
        VK_SUCCESS);
    build.info.dstAccelerationStructure = structure->handle;
    /* aligned for any device */
    build.info.scratchData.deviceAddress = (structure->scratch.address + 255) & ~(uint64_t)255;
    harness_run(device->h, record_build, &build);
}

void ray_structure_finish(struct ray_device *device, struct ray_structure *structure)
{
    device->DestroyAccelerationStructureKHR(device->h->device, structure->handle, NULL);
    ray_buffer_finish(device, &structure->storage);
    ray_buffer_finish(device, &structure->scratch);
}
