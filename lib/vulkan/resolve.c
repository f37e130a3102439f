#include "vulkan/resolve.h"

#include "base/checked.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>

#include "resolve_count_comp.h"
#include "resolve_scan_comp.h"
#include "resolve_write_comp.h"

#define RECORD 16u /* bytes of a segment and of an item */

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

static SluiceResult create_passes(struct slc_resolve *r, const struct slc_vk *vk,
                                  const struct slc_resolve_create_info *info)
{
    const uint32_t group = slc_compute_group_size(vk, SLUICE_RESOLVE_SCAN_GROUP_SIZE);
    const struct slc_compute_pass passes[3] = {
        {slc_resolve_count_comp, sizeof slc_resolve_count_comp, {info->encoding, group}},
        {slc_resolve_scan_comp, sizeof slc_resolve_scan_comp, {info->encoding, group}},
        {slc_resolve_write_comp, sizeof slc_resolve_write_comp, {info->encoding, group}}};
    struct slc_compute_create_info compute = {.binding_count = 5,
                                              .push_size = sizeof(struct SluiceResolveParams),
                                              .set_count = 1,
                                              .passes = passes,
                                              .pass_count = 3,
                                              .name = "resolve feedback"};
    SluiceResult result = slc_compute_init(&r->compute, vk, &compute);
    if (result != SLUICE_SUCCESS)
        return result;
    const VkBuffer buffers[5] = {info->feedback, r->last.buffer, r->table.buffer, r->scratch.buffer,
                                 info->readback};
    slc_compute_set_buffers(&r->compute, vk, 0, buffers);
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
        result = create_passes(resolve, vk, info);
    return result;
}

void slc_resolve_finish(struct slc_resolve *resolve, const struct slc_vk *vk)
{
    slc_compute_finish(&resolve->compute, vk);
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
    slc_compute_bind(&r->compute, vk, commands, 0, &params);
    for (uint32_t pass = 0; pass < 3; pass++) {
        slc_compute_barrier(
            vk, commands,
            pass == 0 ? VK_PIPELINE_STAGE_ALL_COMMANDS_BIT : VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
            VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, shaders);
        slc_compute_dispatch(&r->compute, vk, commands, pass, pass == 1 ? 1 : columns,
                             pass == 1 ? 1 : rows);
    }
    slc_compute_barrier(vk, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                        VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                        shaders | VK_ACCESS_HOST_READ_BIT);
}
