#include "ray_table.h"

#include <stdlib.h>
#include <string.h>

VkRayTracingShaderGroupCreateInfoKHR ray_table_general_group(uint32_t stage)
{
    return (VkRayTracingShaderGroupCreateInfoKHR){
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
        .type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR,
        .generalShader = stage,
        .closestHitShader = VK_SHADER_UNUSED_KHR,
        .anyHitShader = VK_SHADER_UNUSED_KHR,
        .intersectionShader = VK_SHADER_UNUSED_KHR};
}

VkDeviceAddress ray_buffer_address(const struct gpu *gpu, VkBuffer buffer)
{
    VkBufferDeviceAddressInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                      .buffer = buffer};
    return vkGetBufferDeviceAddress(gpu->device, &info);
}

static uint32_t round_up(uint32_t value, uint32_t alignment)
{
    return (value + alignment - 1) / alignment * alignment;
}

static VkPhysicalDeviceRayTracingPipelinePropertiesKHR get_properties(const struct gpu *gpu)
{
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR rays = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &rays};
    vkGetPhysicalDeviceProperties2(gpu->physical_device, &properties);
    return rays;
}

/** Writes the groups one after the other, with the device's alignment of groups. */
static void write_table(const struct gpu *gpu, const uint8_t *handles, uint32_t handle_size,
                        uint32_t group_count, uint32_t alignment, struct ray_table *table)
{
    const VkDeviceSize stride = round_up(handle_size, alignment);
    VkDeviceAddress base = ray_buffer_address(gpu, table->buffer.buffer);
    VkDeviceSize first = (alignment - base % alignment) % alignment;
    for (uint32_t i = 0; i < group_count; i++)
        memcpy((uint8_t *)table->buffer.mapped + first + i * stride,
               handles + (size_t)i * handle_size, handle_size);
    base += first;
    table->begin = (VkStridedDeviceAddressRegionKHR){base, stride, stride};
    table->miss = (VkStridedDeviceAddressRegionKHR){base + stride, stride, stride};
    table->hit =
        (VkStridedDeviceAddressRegionKHR){base + 2 * stride, stride, (group_count - 2) * stride};
}

bool ray_table_create(const struct gpu *gpu, VkPipeline pipeline, uint32_t group_count,
                      struct ray_table *table)
{
    PFN_vkGetRayTracingShaderGroupHandlesKHR get_handles =
        (PFN_vkGetRayTracingShaderGroupHandlesKHR)vkGetDeviceProcAddr(
            gpu->device, "vkGetRayTracingShaderGroupHandlesKHR");
    const VkPhysicalDeviceRayTracingPipelinePropertiesKHR rays = get_properties(gpu);
    const uint32_t size = rays.shaderGroupHandleSize, alignment = rays.shaderGroupBaseAlignment;
    *table = (struct ray_table){
        .trace = (PFN_vkCmdTraceRaysKHR)vkGetDeviceProcAddr(gpu->device, "vkCmdTraceRaysKHR")};
    uint8_t *handles = malloc((size_t)group_count * size);
    bool done = handles &&
                gpu_check(get_handles(gpu->device, pipeline, 0, group_count,
                                      (size_t)group_count * size, handles),
                          "vkGetRayTracingShaderGroupHandlesKHR") &&
                gpu_create_buffer(gpu, (group_count + 1) * round_up(size, alignment),
                                  VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR |
                                      VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                                  &table->buffer);
    if (done)
        write_table(gpu, handles, size, group_count, alignment, table);
    free(handles);
    return done;
}

void ray_table_destroy(const struct gpu *gpu, struct ray_table *table)
{
    gpu_destroy_buffer(gpu, &table->buffer);
    *table = (struct ray_table){0};
}

void ray_table_record(const struct ray_table *table, VkCommandBuffer commands, uint32_t width,
                      uint32_t height)
{
    const VkStridedDeviceAddressRegionKHR none = {0};
    table->trace(commands, &table->begin, &table->miss, &table->hit, &none, width, height, 1);
}
