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

const char *const ray_tracer_extensions[RAY_TRACER_EXTENSION_COUNT] = {
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

void *ray_tracer_features(void)
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

static void buffer_init(struct ray_tracer *r, struct ray_buffer *buffer, uint64_t size,
                        VkBufferUsageFlags usage)
{
    struct harness *h = r->h;
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
    buffer->address = r->GetBufferDeviceAddress(h->device, &address);
}

static void buffer_finish(struct ray_tracer *r, struct ray_buffer *buffer)
{
    r->h->DestroyBuffer(r->h->device, buffer->buffer, NULL);
    r->h->FreeMemory(r->h->device, buffer->memory, NULL);
}

struct build {
    struct ray_tracer *r;
    VkAccelerationStructureBuildGeometryInfoKHR info;
    VkAccelerationStructureBuildRangeInfoKHR range;
};

static void record_build(void *user, VkCommandBuffer commands)
{
    struct build *build = user;
    const VkAccelerationStructureBuildRangeInfoKHR *range = &build->range;
    build->r->CmdBuildAccelerationStructuresKHR(commands, 1, &build->info, &range);
}

static void build_structure(struct ray_tracer *r, struct ray_structure *structure,
                            VkAccelerationStructureTypeKHR type,
                            const VkAccelerationStructureGeometryKHR *geometry, uint32_t count)
{
    struct build build = {
        r,
        {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
         .type = type,
         .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
         .geometryCount = 1,
         .pGeometries = geometry},
        {.primitiveCount = count}};
    VkAccelerationStructureBuildSizesInfoKHR sizes = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    r->GetAccelerationStructureBuildSizesKHR(
        r->h->device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &build.info, &count, &sizes);
    buffer_init(r, &structure->storage, sizes.accelerationStructureSize,
                VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
    buffer_init(r, &structure->scratch, sizes.buildScratchSize + 256,
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    VkAccelerationStructureCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
        .buffer = structure->storage.buffer,
        .size = sizes.accelerationStructureSize,
        .type = type};
    assert_int_equal(
        r->CreateAccelerationStructureKHR(r->h->device, &info, NULL, &structure->handle),
        VK_SUCCESS);
    build.info.dstAccelerationStructure = structure->handle;
    /* as aligned as any device asks for */
    build.info.scratchData.deviceAddress = (structure->scratch.address + 255) & ~(uint64_t)255;
    harness_run(r->h, record_build, &build);
}

static void structure_finish(struct ray_tracer *r, struct ray_structure *structure)
{
    r->DestroyAccelerationStructureKHR(r->h->device, structure->handle, NULL);
    buffer_finish(r, &structure->storage);
    buffer_finish(r, &structure->scratch);
}

static void build_floor(struct ray_tracer *r)
{
    const float corners[6][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    buffer_init(r, &r->vertices, sizeof corners,
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
    build_structure(r, &r->floor, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, &geometry, 2);
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
            r->GetAccelerationStructureDeviceAddressKHR(r->h->device, &address)};
    buffer_init(r, &r->instances, sizeof instance,
                VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
    memcpy(r->instances.mapped, &instance, sizeof instance);
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR,
        .flags = VK_GEOMETRY_OPAQUE_BIT_KHR,
        .geometry.instances = {
            .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
            .data.deviceAddress = r->instances.address}};
    build_structure(r, &r->scene, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, &geometry, 1);
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
    assert_int_equal(r->CreateRayTracingPipelinesKHR(h->device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1,
                                                     &info, NULL, &r->pipeline),
                     VK_SUCCESS);
    for (uint32_t i = 0; i < 3; i++)
        h->DestroyShaderModule(h->device, stages[i].module, NULL);
}

/* Handles are 32 bytes everywhere; groups begin at multiples of 64, which no device exceeds. */
static void create_groups(struct ray_tracer *r)
{
    uint8_t handles[3][32];
    assert_int_equal(r->GetRayTracingShaderGroupHandlesKHR(r->h->device, r->pipeline, 0, 3,
                                                           sizeof handles, handles),
                     VK_SUCCESS);
    buffer_init(r, &r->shaders, 4 * 64, VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR);
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
#define LOAD(name)                                                                                 \
    r->name = (PFN_vk##name)h->GetDeviceProcAddr(h->device, "vk" #name);                           \
    assert_true(r->name != NULL);
    RAY_TRACER_FUNCTIONS(LOAD)
#undef LOAD
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
    structure_finish(r, &r->scene);
    structure_finish(r, &r->floor);
    buffer_finish(r, &r->shaders);
    buffer_finish(r, &r->instances);
    buffer_finish(r, &r->vertices);
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
    r->CmdTraceRaysKHR(commands, &r->groups[0], &r->groups[1], &r->groups[2], &none, params.count,
                       1, 1);
}
