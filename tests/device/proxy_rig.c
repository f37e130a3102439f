#include "device/proxy_rig.h"

#include "device/conform.h"
#include "support/test.h"

#include <string.h>

#include "proxy_rays_comp.h"
#include "proxy_rays_rahit.h"
#include "proxy_rays_rchit.h"
#include "proxy_rays_rgen.h"
#include "proxy_rays_rint.h"
#include "proxy_rays_rmiss.h"

#define BUFFERS 3u
#define STAGES 6u
#define BOXES_SIZE (PROXY_RIG_BOXES * sizeof(SluiceProxyBox))
#define RAY_STAGES                                                                                 \
    (VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR |                               \
     VK_SHADER_STAGE_INTERSECTION_BIT_KHR | VK_SHADER_STAGE_ANY_HIT_BIT_KHR |                      \
     VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR)

static VkShaderStageFlags stages_of(const struct proxy_rig *rig)
{
    return VK_SHADER_STAGE_COMPUTE_BIT | (rig->traces ? RAY_STAGES : 0);
}

static void create_sets_of_proxies(struct proxy_rig *rig)
{
    const SluiceDemandLoaderCreateInfo loader = {.structSize = sizeof loader,
                                                 .context = rig->h->context,
                                                 .memoryBudget = 8u << 20,
                                                 .maxTextureCount = 16,
                                                 .pageCapacity = 1u << 16};
    SluiceProxySetCreateInfo info = {.structSize = sizeof info,
                                     .kind = SLUICE_PROXY_KIND_GEOMETRY,
                                     .maxProxyCount = PROXY_RIG_BOXES};
    CHECK_OK(sluiceCreateDemandLoader(&loader, &rig->loader));
    CHECK_OK(sluiceCreateProxySet(&info, &rig->geometry));
    info.kind = SLUICE_PROXY_KIND_MATERIAL;
    CHECK_OK(sluiceCreateProxySet(&info, &rig->materials));
    const SluiceProxySet *sets[2] = {rig->geometry, rig->materials};
    for (uint32_t i = 0; i < 2; i++)
        CHECK_OK(sluiceAddDemandProxies(rig->loader, sets[i], i, &rig->resources[i],
                                        &rig->first_pages[i]));
}

static void create_layouts(struct proxy_rig *rig)
{
    struct harness *h = rig->h;
    VkDescriptorSetLayoutBinding bindings[BUFFERS + 1];
    for (uint32_t i = 0; i <= BUFFERS; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i < BUFFERS ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                          : VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR,
            .descriptorCount = 1,
            .stageFlags = stages_of(rig)};
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = BUFFERS + rig->traces,
        .pBindings = bindings};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &info, NULL, &rig->set_layout),
                     VK_SUCCESS);
    VkDescriptorSetLayout sets[2] = {VK_NULL_HANDLE, rig->set_layout};
    CHECK_OK(sluiceGetDemandDescriptorSetLayout(rig->loader, &sets[0]));
    const VkPushConstantRange push = {stages_of(rig), 0, sizeof(struct ProxyRayParams)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 2,
                                               .pSetLayouts = sets,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &push};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &rig->layout), VK_SUCCESS);
}

static void create_set(struct proxy_rig *rig)
{
    struct harness *h = rig->h;
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BUFFERS},
                                           {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1 + rig->traces,
                                             .pPoolSizes = sizes};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &rig->pool), VK_SUCCESS);
    const VkDescriptorSetAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = rig->pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &rig->set_layout};
    assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &rig->set), VK_SUCCESS);
    const VkBuffer boxes = rig->traces ? rig->boxes.buffer : rig->plain_boxes.buffer;
    const VkDescriptorBufferInfo infos[BUFFERS] = {{boxes, 0, VK_WHOLE_SIZE},
                                                   {rig->rays.buffer, 0, VK_WHOLE_SIZE},
                                                   {rig->hits.buffer, 0, VK_WHOLE_SIZE}};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = rig->set,
                                        .descriptorCount = BUFFERS,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = infos};
    h->UpdateDescriptorSets(h->device, 1, &write, 0, NULL);
}

static void create_rays_pipeline(struct proxy_rig *rig)
{
    const struct {
        const uint32_t *code;
        size_t size;
        VkShaderStageFlagBits stage;
    } codes[] = {{proxy_rays_rgen, sizeof proxy_rays_rgen, VK_SHADER_STAGE_RAYGEN_BIT_KHR},
                 {proxy_rays_rmiss, sizeof proxy_rays_rmiss, VK_SHADER_STAGE_MISS_BIT_KHR},
                 {proxy_rays_rchit, sizeof proxy_rays_rchit, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR},
                 {proxy_rays_rahit, sizeof proxy_rays_rahit, VK_SHADER_STAGE_ANY_HIT_BIT_KHR},
                 /* twice: lavapipe of Mesa 25.0 compiles a stage for one hit group alone */
                 {proxy_rays_rint, sizeof proxy_rays_rint, VK_SHADER_STAGE_INTERSECTION_BIT_KHR},
                 {proxy_rays_rint, sizeof proxy_rays_rint, VK_SHADER_STAGE_INTERSECTION_BIT_KHR}};
    struct harness *h = rig->h;
    VkPipelineShaderStageCreateInfo stages[STAGES];
    VkRayTracingShaderGroupCreateInfoKHR groups[PROXY_RIG_GROUPS];
    for (uint32_t i = 0; i < STAGES; i++)
        stages[i] = (VkPipelineShaderStageCreateInfo){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = codes[i].stage,
            .module = conform_module(h, codes[i].code, codes[i].size),
            .pName = "main"};
    for (uint32_t i = 0; i < PROXY_RIG_GROUPS; i++)
        groups[i] = (VkRayTracingShaderGroupCreateInfoKHR){
            .sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
            .type = i >= 2 ? VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR
                           : VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR,
            .generalShader = i >= 2 ? VK_SHADER_UNUSED_KHR : i,
            .closestHitShader = i == 2 ? 2 : VK_SHADER_UNUSED_KHR,
            .anyHitShader = i == 3 ? 3 : VK_SHADER_UNUSED_KHR,
            .intersectionShader = i >= 2 ? i + 2 : VK_SHADER_UNUSED_KHR};
    const VkRayTracingPipelineCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR,
        .stageCount = STAGES,
        .pStages = stages,
        .groupCount = PROXY_RIG_GROUPS,
        .pGroups = groups,
        .maxPipelineRayRecursionDepth = 1,
        .layout = rig->layout};
    assert_int_equal(rig->device.CreateRayTracingPipelinesKHR(h->device, VK_NULL_HANDLE,
                                                              VK_NULL_HANDLE, 1, &info, NULL,
                                                              &rig->rays_pipeline),
                     VK_SUCCESS);
    for (uint32_t i = 0; i < STAGES; i++)
        h->DestroyShaderModule(h->device, stages[i].module, NULL);
}

/* Handles are 32 bytes everywhere; groups begin at multiples of 64, which no device exceeds. */
static void create_groups(struct proxy_rig *rig)
{
    uint8_t handles[PROXY_RIG_GROUPS][32];
    assert_int_equal(
        rig->device.GetRayTracingShaderGroupHandlesKHR(rig->h->device, rig->rays_pipeline, 0,
                                                       PROXY_RIG_GROUPS, sizeof handles, handles),
        VK_SUCCESS);
    ray_buffer_init(&rig->device, &rig->table, (PROXY_RIG_GROUPS + 1) * 64,
                    VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR);
    VkDeviceAddress first = (rig->table.address + 63) & ~(VkDeviceAddress)63;
    for (uint32_t i = 0; i < PROXY_RIG_GROUPS; i++) {
        rig->groups[i] = (VkStridedDeviceAddressRegionKHR){first + i * 64, 64, i == 2 ? 128 : 64};
        memcpy((uint8_t *)rig->table.mapped + (first + i * 64 - rig->table.address), handles[i],
               32);
    }
}

void proxy_rig_init(struct proxy_rig *rig, struct harness *h, bool traces)
{
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    *rig = (struct proxy_rig){.h = h, .traces = traces};
    create_sets_of_proxies(rig);
    harness_buffer_init(h, &rig->rays, PROXY_RIG_RAYS * sizeof(struct ProxyRay), storage);
    harness_buffer_init(h, &rig->hits, PROXY_RIG_RAYS * sizeof(struct ProxyHit), storage);
    if (traces) {
        ray_device_init(&rig->device, h);
        ray_buffer_init(&rig->device, &rig->boxes, BOXES_SIZE,
                        storage |
                            VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
        ray_buffer_init(&rig->device, &rig->instances, sizeof(VkAccelerationStructureInstanceKHR),
                        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
    } else {
        harness_buffer_init(h, &rig->plain_boxes, BOXES_SIZE, storage);
    }
    create_layouts(rig);
    create_set(rig);
    rig->compute_pipeline = conform_compute_pipeline(
        h, rig->layout, conform_module(h, proxy_rays_comp, sizeof proxy_rays_comp), NULL);
    if (!traces)
        return;
    create_rays_pipeline(rig);
    create_groups(rig);
}

static void finish_structures(struct proxy_rig *rig)
{
    if (!rig->has_structures)
        return;
    ray_structure_finish(&rig->device, &rig->top);
    ray_structure_finish(&rig->device, &rig->bottom);
    rig->has_structures = false;
}

void proxy_rig_finish(struct proxy_rig *rig)
{
    struct harness *h = rig->h;
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    finish_structures(rig);
    sluiceDestroyDemandLoader(rig->loader);
    sluiceDestroyProxySet(rig->geometry);
    sluiceDestroyProxySet(rig->materials);
    h->DestroyDescriptorPool(h->device, rig->pool, NULL);
    h->DestroyPipeline(h->device, rig->compute_pipeline, NULL);
    h->DestroyPipeline(h->device, rig->rays_pipeline, NULL);
    h->DestroyPipelineLayout(h->device, rig->layout, NULL);
    h->DestroyDescriptorSetLayout(h->device, rig->set_layout, NULL);
    harness_buffer_finish(h, &rig->rays);
    harness_buffer_finish(h, &rig->hits);
    if (rig->traces) {
        ray_buffer_finish(&rig->device, &rig->table);
        ray_buffer_finish(&rig->device, &rig->instances);
        ray_buffer_finish(&rig->device, &rig->boxes);
    } else {
        harness_buffer_finish(h, &rig->plain_boxes);
    }
    harness_check_silence(h);
}

SluiceProxyId proxy_rig_add(struct proxy_rig *rig, const SluiceProxyBox *box)
{
    SluiceProxyId id, material;
    CHECK_OK(sluiceAddGeometryProxy(rig->geometry, box, &id));
    CHECK_OK(sluiceAddMaterialProxy(rig->materials, &material));
    assert_true(id == material);
    return id;
}

void proxy_rig_remove(struct proxy_rig *rig, SluiceProxyId id)
{
    CHECK_OK(sluiceRemoveProxy(rig->geometry, id));
    CHECK_OK(sluiceRemoveProxy(rig->materials, id));
}

struct ProxyRay *proxy_rig_rays(struct proxy_rig *rig)
{
    return rig->rays.mapped;
}

const struct ProxyHit *proxy_rig_hits(const struct proxy_rig *rig)
{
    return rig->hits.mapped;
}

static void write_boxes(struct proxy_rig *rig)
{
    SluiceProxyRange ranges[4];
    uint32_t count;
    const SluiceProxyBoxWrite write = {.structSize = sizeof write,
                                       .capacity = PROXY_RIG_BOXES,
                                       .pBoxes = rig->traces ? rig->boxes.mapped
                                                             : rig->plain_boxes.mapped,
                                       .rangeCapacity = 4,
                                       .pRanges = ranges};
    CHECK_OK(sluiceWriteProxyBoxes(rig->geometry, &write, &rig->version, &count));
}

static void build_structures(struct proxy_rig *rig)
{
    SluiceProxyGeometry boxes = {.structSize = sizeof boxes};
    finish_structures(rig);
    CHECK_OK(sluiceGetProxyGeometry(rig->geometry, rig->boxes.address, &boxes));
    ray_structure_build(&rig->device, &rig->bottom, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
                        &boxes.geometry, boxes.range.primitiveCount);
    const VkAccelerationStructureDeviceAddressInfoKHR address = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
        .accelerationStructure = rig->bottom.handle};
    const VkAccelerationStructureInstanceKHR instance = {
        .transform = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}},
        .mask = 0xFF,
        .accelerationStructureReference =
            rig->device.GetAccelerationStructureDeviceAddressKHR(rig->h->device, &address)};
    memcpy(rig->instances.mapped, &instance, sizeof instance);
    const VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR,
        .geometry.instances = {
            .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
            .data.deviceAddress = rig->instances.address}};
    ray_structure_build(&rig->device, &rig->top, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
                        &geometry, 1);
    rig->has_structures = true;
    const VkWriteDescriptorSetAccelerationStructureKHR structure = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR,
        .accelerationStructureCount = 1,
        .pAccelerationStructures = &rig->top.handle};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .pNext = &structure,
                                        .dstSet = rig->set,
                                        .dstBinding = BUFFERS,
                                        .descriptorCount = 1,
                                        .descriptorType =
                                            VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR};
    rig->h->UpdateDescriptorSets(rig->h->device, 1, &write, 0, NULL);
}

static void record_rays(struct proxy_rig *rig, VkCommandBuffer commands, VkDescriptorSet launch_set,
                        bool by_rays, bool through)
{
    struct harness *h = rig->h;
    SluiceProxySetInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetProxySetInfo(rig->geometry, &info));
    const struct ProxyRayParams params = {.rayCount = rig->ray_count,
                                          .boxCount = info.indexCount,
                                          .firstGeometry = rig->first_pages[0],
                                          .firstMaterial = rig->first_pages[1],
                                          .through = through};
    const VkDescriptorSet sets[2] = {launch_set, rig->set};
    const VkStridedDeviceAddressRegionKHR none = {0};
    const VkPipelineBindPoint point =
        by_rays ? VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR : VK_PIPELINE_BIND_POINT_COMPUTE;
    h->CmdBindPipeline(commands, point, by_rays ? rig->rays_pipeline : rig->compute_pipeline);
    h->CmdBindDescriptorSets(commands, point, rig->layout, 0, 2, sets, 0, NULL);
    h->CmdPushConstants(commands, rig->layout, stages_of(rig), 0, sizeof params, &params);
    if (by_rays)
        rig->device.CmdTraceRaysKHR(commands, &rig->groups[0], &rig->groups[1], &rig->groups[2],
                                    &none, rig->ray_count, 1, 1);
    else
        h->CmdDispatch(commands, (rig->ray_count + 63) / 64, 1, 1);
    const VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    h->CmdPipelineBarrier(commands,
                          by_rays ? VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR
                                  : VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
}

void proxy_rig_launch(struct proxy_rig *rig, bool by_rays, bool through)
{
    struct harness *h = rig->h;
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    write_boxes(rig);
    if (by_rays)
        build_structures(rig);
    VkCommandBuffer commands = h->commands[0];
    assert_int_equal(h->ResetCommandBuffer(commands, 0), VK_SUCCESS);
    assert_int_equal(h->BeginCommandBuffer(commands, &begin), VK_SUCCESS);
    CHECK_OK(sluiceBeginDemandLaunch(rig->loader, commands, &launch));
    record_rays(rig, commands, launch.descriptorSet, by_rays, through);
    CHECK_OK(sluiceEndDemandLaunch(rig->loader, commands));
    assert_int_equal(h->EndCommandBuffer(commands), VK_SUCCESS);
    const VkTimelineSemaphoreSubmitInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &launch.signalValue};
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .pNext = &timeline,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &commands,
                                 .signalSemaphoreCount = 1,
                                 .pSignalSemaphores = &launch.semaphore};
    assert_int_equal(h->QueueSubmit(h->queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    rig->requests = (SluiceDemandRequests){.structSize = sizeof rig->requests};
    CHECK_OK(sluiceProcessDemandRequests(rig->loader, &launch, UINT64_MAX, &rig->requests, NULL));
    CHECK_OK(sluiceProcessDemandProxies(rig->loader, rig->resources[0], rig->geometry));
    CHECK_OK(sluiceProcessDemandProxies(rig->loader, rig->resources[1], rig->materials));
}
