#include "device/ray_tracer.h"

#include "support/test.h"

#include <string.h>

#include "rays_rchit.h"
#include "rays_rgen.h"
#include "rays_rmiss.h"

#define BUFFERS 5u
#define STAGES                                                                                     \
    (VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR |                               \
     VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR)

static void build_floor(struct ray_tracer *r)
{
    const float corners[6][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    ray_buffer_init(&r->device, &r->vertices, sizeof corners,
                    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
    memcpy(r->vertices.mapped, corners, sizeof corners);
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR,
        .flags = VK_GEOMETRY_OPAQUE_BIT_KHR,
        .geometry.triangles = {
            .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR,
            .vertexFormat = VK_FORMAT_R32G32B32_SFLOAT,
            .vertexData.deviceAddress = r->vertices.address,
            .vertexStride = sizeof corners[0],
            .maxVertex = 5,
            .indexType = VK_INDEX_TYPE_NONE_KHR}};
    ray_structure_build(&r->device, &r->floor, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
                        &geometry, 2);
}

static void build_scene(struct ray_tracer *r)
{
    VkAccelerationStructureDeviceAddressInfoKHR address = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
        .accelerationStructure = r->floor.handle};
    VkAccelerationStructureInstanceKHR instance = {
        .transform = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}},
        .mask = 0xFF,
        .flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR,
        .accelerationStructureReference =
            r->device.GetAccelerationStructureDeviceAddressKHR(r->h->device, &address)};
    ray_buffer_init(&r->device, &r->instances, sizeof instance,
                    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
    memcpy(r->instances.mapped, &instance, sizeof instance);
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR,
        .flags = VK_GEOMETRY_OPAQUE_BIT_KHR,
        .geometry.instances = {
            .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
            .data.deviceAddress = r->instances.address}};
    ray_structure_build(&r->device, &r->scene, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
                        &geometry, 1);
}

static void create_layouts(struct ray_tracer *r)
{
    struct harness *h = r->h;
    VkDescriptorSetLayoutBinding bindings[BUFFERS + 1];
    for (uint32_t i = 0; i <= BUFFERS; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i < BUFFERS ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                          : VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR,
            .descriptorCount = 1,
            .stageFlags = STAGES};
    VkDescriptorSetLayoutCreateInfo set = {.sType =
                                               VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                           .bindingCount = BUFFERS + 1,
                                           .pBindings = bindings};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &set, NULL, &r->set_layout),
                     VK_SUCCESS);
    VkPushConstantRange push = {STAGES, 0, sizeof(struct WriterParams)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &r->set_layout,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &r->layout), VK_SUCCESS);
}

static void create_pipeline(struct ray_tracer *r)
{
    const struct {
        const uint32_t *code;
        size_t size;
        VkShaderStageFlagBits stage;
    } codes[3] = {{rays_rgen, sizeof rays_rgen, VK_SHADER_STAGE_RAYGEN_BIT_KHR},
                  {rays_rmiss, sizeof rays_rmiss, VK_SHADER_STAGE_MISS_BIT_KHR},
                  {rays_rchit, sizeof rays_rchit, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR}};
    struct harness *h = r->h;
    VkPipelineShaderStageCreateInfo stages[3];
    VkRayTracingShaderGroupCreateInfoKHR groups[3];
    for (uint32_t i = 0; i < 3; i++) {
        VkShaderModuleCreateInfo module = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                           .codeSize = codes[i].size,
                                           .pCode = codes[i].code};
        stages[i] = (VkPipelineShaderStageCreateInfo){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = codes[i].stage,
            .pName = "main"};
        assert_int_equal(h->CreateShaderModule(h->device, &module, NULL, &stages[i].module),
                         VK_SUCCESS);
        groups[i] = (VkRayTracingShaderGroupCreateInfoKHR){
            .sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
            .type = i == 2 ? VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR
                           : VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR,
            .generalShader = i == 2 ? VK_SHADER_UNUSED_KHR : i,
            .closestHitShader = i == 2 ? i : VK_SHADER_UNUSED_KHR,
            .anyHitShader = VK_SHADER_UNUSED_KHR,
            .intersectionShader = VK_SHADER_UNUSED_KHR};
    }
    VkRayTracingPipelineCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR,
        .stageCount = 3,
        .pStages = stages,
        .groupCount = 3,
        .pGroups = groups,
        .maxPipelineRayRecursionDepth = 1,
        .layout = r->layout};
    assert_int_equal(r->device.CreateRayTracingPipelinesKHR(
                         h->device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1, &info, NULL, &r->pipeline),
                     VK_SUCCESS);
    for (uint32_t i = 0; i < 3; i++)
        h->DestroyShaderModule(h->device, stages[i].module, NULL);
}

/* Handles are 32 bytes everywhere; groups begin at multiples of 64, which no device exceeds. */
static void create_groups(struct ray_tracer *r)
{
    uint8_t handles[3][32];
    assert_int_equal(r->device.GetRayTracingShaderGroupHandlesKHR(r->h->device, r->pipeline, 0, 3,
                                                                  sizeof handles, handles),
                     VK_SUCCESS);
    ray_buffer_init(&r->device, &r->shaders, 4 * 64, VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR);
    VkDeviceAddress first = (r->shaders.address + 63) & ~(VkDeviceAddress)63;
    for (uint32_t i = 0; i < 3; i++) {
        r->groups[i] = (VkStridedDeviceAddressRegionKHR){first + i * 64, 64, 64};
        memcpy((uint8_t *)r->shaders.mapped + (first + i * 64 - r->shaders.address), handles[i],
               32);
    }
}

static void create_set(struct ray_tracer *r)
{
    struct harness *h = r->h;
    VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BUFFERS},
                                     {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &r->pool), VK_SUCCESS);
    VkDescriptorSetAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = r->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &r->set_layout};
    assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &r->set), VK_SUCCESS);
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    sluiceGetVulkanBuffers(r->writer->streamer, &buffers);
    VkDescriptorBufferInfo infos[BUFFERS] = {{buffers.textureTable, 0, VK_WHOLE_SIZE},
                                             {buffers.feedback, 0, VK_WHOLE_SIZE},
                                             {buffers.feedbackTurns, 0, VK_WHOLE_SIZE},
                                             {r->writer->inputs.buffer, 0, VK_WHOLE_SIZE},
                                             {r->writer->outputs.buffer, 0, VK_WHOLE_SIZE}};
    VkWriteDescriptorSetAccelerationStructureKHR structure = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR,
        .accelerationStructureCount = 1,
        .pAccelerationStructures = &r->scene.handle};
    VkWriteDescriptorSet writes[2] = {
        {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
         .dstSet = r->set,
         .descriptorCount = BUFFERS,
         .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
         .pBufferInfo = infos},
        {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
         .pNext = &structure,
         .dstSet = r->set,
         .dstBinding = BUFFERS,
         .descriptorCount = 1,
         .descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR}};
    h->UpdateDescriptorSets(h->device, 2, writes, 0, NULL);
}

void ray_tracer_init(struct ray_tracer *r, struct harness *h, struct writer *writer)
{
    *r = (struct ray_tracer){.h = h, .writer = writer};
    ray_device_init(&r->device, h);
    build_floor(r);
    build_scene(r);
    create_layouts(r);
    create_pipeline(r);
    create_groups(r);
    create_set(r);
}

void ray_tracer_finish(struct ray_tracer *r)
{
    struct harness *h = r->h;
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    h->DestroyDescriptorPool(h->device, r->pool, NULL);
    h->DestroyPipeline(h->device, r->pipeline, NULL);
    h->DestroyPipelineLayout(h->device, r->layout, NULL);
    h->DestroyDescriptorSetLayout(h->device, r->set_layout, NULL);
    ray_structure_finish(&r->device, &r->scene);
    ray_structure_finish(&r->device, &r->floor);
    ray_buffer_finish(&r->device, &r->shaders);
    ray_buffer_finish(&r->device, &r->instances);
    ray_buffer_finish(&r->device, &r->vertices);
}

void ray_tracer_record(void *user, VkCommandBuffer commands)
{
    struct ray_tracer *r = user;
    struct WriterParams params = {.count = r->writer->count, .coneAngle = r->cone_angle};
    const VkStridedDeviceAddressRegionKHR none = {0};
    r->h->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, r->pipeline);
    r->h->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, r->layout, 0, 1,
                                &r->set, 0, NULL);
    r->h->CmdPushConstants(commands, r->layout, STAGES, 0, sizeof params, &params);
    r->device.CmdTraceRaysKHR(commands, &r->groups[0], &r->groups[1], &r->groups[2], &none,
                              params.count, 1, 1);
}
