#include "vulkan/resolve.h"

#include "base/checked.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>

#include "resolve_count_comp.h"
#include "resolve_scan_comp.h"
#include "resolve_write_comp.h"

#define BINDINGS 5u /* feedback, last, table, scratch, readback */
#define RECORD 16u  /* bytes of a segment and of an item */

static uint32_t max_segments(const struct slc_resolve_create_info *info)
{
    return info->max_items + info->region_capacity / SLUICE_RESOLVE_SEGMENT_SIZE;
}

uint64_t slc_resolve_table_size(const struct slc_resolve_create_info *info)
{
    return (uint64_t)info->slot_count * (max_segments(info) + info->max_items) * RECORD;
}

uint64_t slc_resolve_scratch_size(const struct slc_resolve_create_info *info)
{
    return ((uint64_t)max_segments(info) + 1 + info->max_items) * 8;
}

static SluiceResult create_layouts(struct slc_resolve *r, const struct slc_vk *vk)
{
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){.binding = i,
                                           .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                           .descriptorCount = 1,
                                           .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    VkDescriptorSetLayoutCreateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = BINDINGS,
        .pBindings = bindings};
    SluiceResult result = slc_vk_result(
        vk, vk->CreateDescriptorSetLayout(vk->device, &set_info, NULL, &r->set_layout),
        "vkCreateDescriptorSetLayout");
    if (result != SLUICE_SUCCESS)
        return result;
    VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct SluiceResolveParams)};
    VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                       .setLayoutCount = 1,
                                       .pSetLayouts = &r->set_layout,
                                       .pushConstantRangeCount = 1,
                                       .pPushConstantRanges = &push};
    return slc_vk_result(vk, vk->CreatePipelineLayout(vk->device, &info, NULL, &r->layout),
                         "vkCreatePipelineLayout");
}

static SluiceResult create_pipeline(const struct slc_resolve *r, const struct slc_vk *vk,
                                    const uint32_t *code, size_t size, const uint32_t constants[2],
                                    VkPipeline *pipeline)
{
    VkShaderModuleCreateInfo module_info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
    VkShaderModule module;
    SluiceResult result =
        slc_vk_result(vk, vk->CreateShaderModule(vk->device, &module_info, NULL, &module),
                      "vkCreateShaderModule");
    if (result != SLUICE_SUCCESS)
        return result;
    const VkSpecializationMapEntry entries[2] = {{0, 0, sizeof *constants},
                                                 {1, sizeof *constants, sizeof *constants}};
    VkSpecializationInfo specialization = {2, entries, 2 * sizeof *constants, constants};
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = r->layout};
    result = slc_vk_result(
        vk, vk->CreateComputePipelines(vk->device, VK_NULL_HANDLE, 1, &info, NULL, pipeline),
        "vkCreateComputePipelines");
    vk->DestroyShaderModule(vk->device, module, NULL);
    return result;
}

static uint32_t scan_group_size(const struct slc_vk *vk)
{
    VkPhysicalDeviceProperties2 properties = {.sType =
                                                  VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk->GetPhysicalDeviceProperties2(vk->physical_device, &properties);
    const VkPhysicalDeviceLimits *limits = &properties.properties.limits;
    uint32_t size = SLUICE_RESOLVE_SCAN_GROUP_SIZE;
    while (size > 128 && /* which each device has */
           (size > limits->maxComputeWorkGroupInvocations ||
            size > limits->maxComputeWorkGroupSize[0]))
        size /= 2;
    return size;
}

static SluiceResult create_pipelines(struct slc_resolve *r, const struct slc_vk *vk,
                                     uint32_t encoding)
{
    const struct {
        const uint32_t *code;
        size_t size;
    } passes[3] = {{resolve_count_comp, sizeof resolve_count_comp},
                   {resolve_scan_comp, sizeof resolve_scan_comp},
                   {resolve_write_comp, sizeof resolve_write_comp}};
    const uint32_t constants[2] = {encoding, scan_group_size(vk)};
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < 3 && result == SLUICE_SUCCESS; i++)
        result =
            create_pipeline(r, vk, passes[i].code, passes[i].size, constants, &r->pipelines[i]);
    return result;
}

static SluiceResult create_set(struct slc_resolve *r, const struct slc_vk *vk, VkBuffer feedback,
                               VkBuffer readback)
{
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BINDINGS};
    VkDescriptorPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                            .maxSets = 1,
                                            .poolSizeCount = 1,
                                            .pPoolSizes = &size};
    SluiceResult result =
        slc_vk_result(vk, vk->CreateDescriptorPool(vk->device, &pool_info, NULL, &r->pool),
                      "vkCreateDescriptorPool");
    if (result != SLUICE_SUCCESS)
        return result;
    VkDescriptorSetAllocateInfo set_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = r->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &r->set_layout};
    result = slc_vk_result(vk, vk->AllocateDescriptorSets(vk->device, &set_info, &r->set),
                           "vkAllocateDescriptorSets");
    if (result != SLUICE_SUCCESS)
        return result;
    VkDescriptorBufferInfo buffers[BINDINGS] = {{feedback, 0, VK_WHOLE_SIZE},
                                                {r->last.buffer, 0, VK_WHOLE_SIZE},
                                                {r->table.buffer, 0, VK_WHOLE_SIZE},
                                                {r->scratch.buffer, 0, VK_WHOLE_SIZE},
                                                {readback, 0, VK_WHOLE_SIZE}};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = r->set,
                                  .descriptorCount = BINDINGS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = buffers};
    vk->UpdateDescriptorSets(vk->device, 1, &write, 0, NULL);
    return SLUICE_SUCCESS;
}

static SluiceResult create_buffers(struct slc_resolve *r, const struct slc_vk *vk,
                                   const struct slc_caps *caps,
                                   const struct slc_resolve_create_info *info)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    SluiceResult result =
        slc_buffer_init(&r->last, vk, caps, info->region_capacity,
                        usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, SLC_BUFFER_DEVICE);
    if (result == SLUICE_SUCCESS)
        result = slc_buffer_init(&r->table, vk, caps, slc_resolve_table_size(info), usage,
                                 SLC_BUFFER_TABLE);
    if (result == SLUICE_SUCCESS)
        result = slc_buffer_init(&r->scratch, vk, caps, slc_resolve_scratch_size(info), usage,
                                 SLC_BUFFER_DEVICE);
    return result;
}

SluiceResult slc_resolve_init(struct slc_resolve *resolve, const struct slc_vk *vk,
                              const struct slc_caps *caps,
                              const struct slc_resolve_create_info *info)
{
    *resolve =
        (struct slc_resolve){.max_segments = max_segments(info), .max_items = info->max_items};
    SluiceResult result = create_buffers(resolve, vk, caps, info);
    if (result == SLUICE_SUCCESS)
        result = create_layouts(resolve, vk);
    if (result == SLUICE_SUCCESS)
        result = create_pipelines(resolve, vk, info->encoding);
    if (result == SLUICE_SUCCESS)
        result = create_set(resolve, vk, info->feedback, info->readback);
    return result;
}

void slc_resolve_finish(struct slc_resolve *resolve, const struct slc_vk *vk)
{
    if (resolve->set_layout) {
        vk->DestroyDescriptorPool(vk->device, resolve->pool, NULL);
        for (uint32_t i = 0; i < 3; i++)
            vk->DestroyPipeline(vk->device, resolve->pipelines[i], NULL);
        vk->DestroyPipelineLayout(vk->device, resolve->layout, NULL);
        vk->DestroyDescriptorSetLayout(vk->device, resolve->set_layout, NULL);
    }
    slc_buffer_finish(&resolve->scratch, vk);
    slc_buffer_finish(&resolve->table, vk);
    slc_buffer_finish(&resolve->last, vk);
    *resolve = (struct slc_resolve){0};
}

void slc_resolve_record_new(const struct slc_resolve *resolve, const struct slc_vk *vk,
                            VkCommandBuffer commands, uint32_t first_region, uint32_t region_count)
{
    vk->CmdFillBuffer(commands, resolve->last.buffer, first_region,
                      (region_count + 3u) & ~(VkDeviceSize)3, 0xFFFFFFFFu);
}

static uint32_t first_record(const struct slc_resolve *r)
{
    return r->slot * (r->max_segments + r->max_items);
}

void slc_resolve_begin(struct slc_resolve *resolve, uint32_t slot)
{
    slc_resolve_resume(resolve, slot, 0, 0);
}

void slc_resolve_resume(struct slc_resolve *resolve, uint32_t slot, uint32_t item_count,
                        uint32_t segment_count)
{
    resolve->slot = slot;
    resolve->item_count = item_count;
    resolve->segment_count = segment_count;
}

bool slc_resolve_add(struct slc_resolve *resolve, uint32_t first_region, uint32_t region_count,
                     uint32_t flags)
{
    struct slc_resolve *r = resolve;
    assert(first_region % 4 == 0);
    uint32_t count = slc_div_up_u32(region_count, SLUICE_RESOLVE_SEGMENT_SIZE);
    if (r->item_count == r->max_items || count > r->max_segments - r->segment_count)
        return false;
    struct SluiceResolveSegment *segments = r->table.mapped;
    struct SluiceResolveItem *items = r->table.mapped;
    segments += first_record(r);
    items += first_record(r) + r->max_segments;
    items[r->item_count] = (struct SluiceResolveItem){r->segment_count, count, region_count, flags};
    for (uint32_t i = 0, done = 0; i < count; i++, done += SLUICE_RESOLVE_SEGMENT_SIZE)
        segments[r->segment_count++] = (struct SluiceResolveSegment){
            first_region + done, slc_min_u32(region_count - done, SLUICE_RESOLVE_SEGMENT_SIZE),
            r->item_count, done};
    r->item_count++;
    return true;
}

static void barrier(const struct slc_vk *vk, VkCommandBuffer commands, VkPipelineStageFlags from,
                    VkPipelineStageFlags to, VkAccessFlags used)
{
    VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                              .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                              .dstAccessMask = used};
    vk->CmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, NULL, 0, NULL);
}

void slc_resolve_record(const struct slc_resolve *resolve, const struct slc_vk *vk,
                        VkCommandBuffer commands, uint32_t result_offset, uint32_t data_offset,
                        uint32_t capacity)
{
    const struct slc_resolve *r = resolve;
    const VkAccessFlags shaders = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    const uint32_t rows = slc_div_up_u32(r->segment_count, SLUICE_RESOLVE_ROW);
    const uint32_t columns = slc_min_u32(r->segment_count, SLUICE_RESOLVE_ROW);
    struct SluiceResolveParams params = {.segmentCount = r->segment_count,
                                         .itemCount = r->item_count,
                                         .firstSegment = first_record(r),
                                         .firstItem = first_record(r) + r->max_segments,
                                         .resultOffset = result_offset,
                                         .dataOffset = data_offset,
                                         .capacity = capacity,
                                         .scratchItem = r->max_segments + 1};
    vk->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, r->layout, 0, 1, &r->set, 0,
                              NULL);
    vk->CmdPushConstants(commands, r->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof params,
                         &params);
    for (uint32_t pass = 0; pass < 3; pass++) {
        barrier(vk, commands,
                pass == 0 ? VK_PIPELINE_STAGE_ALL_COMMANDS_BIT
                          : VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, shaders);
        vk->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, r->pipelines[pass]);
        vk->CmdDispatch(commands, pass == 1 ? 1 : columns, pass == 1 ? 1 : rows, 1);
    }
    barrier(vk, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
            VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
            shaders | VK_ACCESS_HOST_READ_BIT);
}
