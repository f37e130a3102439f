#include "demand_vulkan/scan.h"

#include "base/checked.h"

#include <assert.h>
#include <string.h>

#include "demand_compact_comp.h"
#include "demand_count_comp.h"
#include "demand_list_comp.h"
#include "demand_place_comp.h"
#include "demand_whole_comp.h"

enum { COMPACT, COUNT, PLACE, LIST, WHOLE, PASSES };

/* Most sections for which one workgroup is faster than four passes that wait for each other. */
#define ONE_GROUP_SECTIONS 256u

#define RESULT_WORDS 4u
#define UPDATE_SIZE 4096u /* bytes per vkCmdUpdateBuffer */

static uint32_t section_capacity(uint64_t page_capacity)
{
    return (uint32_t)(page_capacity / SLUICE_DEMAND_SECTION_PAGES);
}

/* Returns the bytes of section flags, rounded up to uvec4, which shaders read. */
static uint64_t flags_size(uint64_t page_capacity)
{
    return slc_div_up_u32(section_capacity(page_capacity), 128) * (uint64_t)16;
}

static uint32_t first_sum(uint64_t page_capacity)
{
    return SLUICE_SCAN_LIST + section_capacity(page_capacity);
}

static uint64_t scratch_size(uint64_t page_capacity)
{
    uint32_t groups = slc_div_up_u32(section_capacity(page_capacity), SLUICE_SCAN_GROUP_SECTIONS);
    return (first_sum(page_capacity) + (uint64_t)groups * SLUICE_SCAN_SUMS) * 4;
}

static uint64_t ranks_size(uint64_t page_capacity)
{
    return (section_capacity(page_capacity) + 3u) & ~(uint64_t)3;
}

static uint32_t slot_words(uint32_t list_capacity)
{
    return RESULT_WORDS + slc_div_up_u32(list_capacity, RESULT_WORDS) * RESULT_WORDS;
}

uint64_t slc_demand_scan_device_size(const struct slc_demand_scan_create_info *info)
{
    return info->page_capacity / 8 + 2 * flags_size(info->page_capacity) +
           ranks_size(info->page_capacity) + scratch_size(info->page_capacity);
}

static SluiceResult create_buffers(struct slc_demand_scan *s, const struct slc_vk *vk,
                                   const struct slc_caps *caps)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const struct {
        struct slc_buffer *buffer;
        uint64_t size;
        VkBufferUsageFlags usage;
        enum slc_buffer_kind kind;
    } buffers[] = {{&s->requests, s->page_capacity / 8, usage, SLC_BUFFER_DEVICE},
                   {&s->sections, flags_size(s->page_capacity), usage, SLC_BUFFER_DEVICE},
                   {&s->postponed, flags_size(s->page_capacity), usage, SLC_BUFFER_DEVICE},
                   {&s->ranks, ranks_size(s->page_capacity), usage, SLC_BUFFER_DEVICE},
                   {&s->scratch, scratch_size(s->page_capacity), usage, SLC_BUFFER_DEVICE},
                   {&s->readback, (uint64_t)s->slot_count * slot_words(s->list_capacity) * 4,
                    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, SLC_BUFFER_READBACK}};
    SluiceResult result = SLUICE_SUCCESS;
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0] && result == SLUICE_SUCCESS; i++)
        result = buffers[i].size > caps->max_storage_buffer_range
                     ? SLUICE_ERROR_LIMIT_EXCEEDED
                     : slc_buffer_init(buffers[i].buffer, vk, caps, buffers[i].size,
                                       buffers[i].usage, buffers[i].kind);
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0] && result == SLUICE_SUCCESS; i++)
        slc_buffer_set_name(buffers[i].buffer, vk, "requests of launches");
    return result;
}

static SluiceResult create_passes(struct slc_demand_scan *s, const struct slc_vk *vk)
{
    const struct slc_compute_pass passes[PASSES] = {
        [COMPACT] = {slc_demand_compact_comp,
                     sizeof slc_demand_compact_comp,
                     {slc_compute_group_size(vk, SLUICE_SCAN_COMPACT_SIZE)}},
        [COUNT] = {slc_demand_count_comp, sizeof slc_demand_count_comp, {0}},
        [PLACE] = {slc_demand_place_comp,
                   sizeof slc_demand_place_comp,
                   {slc_compute_group_size(vk, SLUICE_SCAN_PLACE_SIZE)}},
        [LIST] = {slc_demand_list_comp, sizeof slc_demand_list_comp, {0}},
        [WHOLE] = {slc_demand_whole_comp, sizeof slc_demand_whole_comp, {0}}};
    struct slc_compute_create_info info = {.binding_count = 6,
                                           .push_size = sizeof(struct SluiceDemandScanParams),
                                           .set_count = 1,
                                           .passes = passes,
                                           .pass_count = PASSES,
                                           .name = "scan requests"};
    SluiceResult result = slc_compute_init(&s->compute, vk, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    const VkBuffer buffers[6] = {s->requests.buffer, s->sections.buffer, s->postponed.buffer,
                                 s->ranks.buffer,    s->scratch.buffer,  s->readback.buffer};
    slc_compute_set_buffers(&s->compute, vk, 0, buffers);
    return SLUICE_SUCCESS;
}

/* Returns the workgroups of a pass. Software devices have few threads, so few workgroups. */
static uint32_t workgroup_count(const struct slc_caps *caps)
{
    bool software = caps->public.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    return software ? 2 : SLUICE_SCAN_WORKGROUPS;
}

SluiceResult slc_demand_scan_init(struct slc_demand_scan *scan, const struct slc_vk *vk,
                                  const struct slc_caps *caps,
                                  const struct slc_demand_scan_create_info *info)
{
    assert(info->page_capacity > 0 && info->page_capacity <= (uint64_t)1 << 31);
    assert(info->page_capacity % SLUICE_DEMAND_SECTION_PAGES == 0 && info->slot_count > 0);
    *scan = (struct slc_demand_scan){.page_capacity = info->page_capacity,
                                     .slot_count = info->slot_count,
                                     .list_capacity = info->list_capacity,
                                     .workgroup_count = workgroup_count(caps),
                                     .one_group_sections = ONE_GROUP_SECTIONS};
    SluiceResult result = create_buffers(scan, vk, caps);
    if (result == SLUICE_SUCCESS)
        result = create_passes(scan, vk);
    if (result != SLUICE_SUCCESS)
        slc_demand_scan_finish(scan, vk);
    return result;
}

void slc_demand_scan_finish(struct slc_demand_scan *scan, const struct slc_vk *vk)
{
    slc_compute_finish(&scan->compute, vk);
    slc_buffer_finish(&scan->requests, vk);
    slc_buffer_finish(&scan->sections, vk);
    slc_buffer_finish(&scan->postponed, vk);
    slc_buffer_finish(&scan->ranks, vk);
    slc_buffer_finish(&scan->scratch, vk);
    slc_buffer_finish(&scan->readback, vk);
    *scan = (struct slc_demand_scan){0};
}

void slc_demand_scan_record_clear(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                                  VkCommandBuffer commands)
{
    const VkBuffer buffers[] = {scan->requests.buffer, scan->sections.buffer,
                                scan->postponed.buffer, scan->ranks.buffer};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        vk->CmdFillBuffer(commands, buffers[i], 0, VK_WHOLE_SIZE, 0);
    slc_compute_barrier(vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
}

/* Records updates of ranks in whole words. The last word may have fewer sections. */
static void update_ranks(const struct slc_demand_scan *s, const struct slc_vk *vk,
                         VkCommandBuffer commands, const uint8_t *ranks, uint32_t first,
                         uint32_t count)
{
    uint32_t words[UPDATE_SIZE / 4] = {0};
    uint32_t there = slc_min_u32(count, section_capacity(s->page_capacity) - first);
    memcpy(words, ranks + first, there);
    vk->CmdUpdateBuffer(commands, s->ranks.buffer, first, count, words);
}

void slc_demand_scan_record_ranks(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                                  VkCommandBuffer commands, const uint8_t *ranks, uint32_t first,
                                  uint32_t count)
{
    assert(first <= section_capacity(scan->page_capacity) &&
           count <= section_capacity(scan->page_capacity) - first);
    uint32_t end = (first + count + 3u) & ~3u, step;
    for (uint32_t at = first & ~3u; count && at < end; at += step) {
        step = slc_min_u32(end - at, UPDATE_SIZE);
        update_ranks(scan, vk, commands, ranks, at, step);
    }
}

void slc_demand_scan_record_forget(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                                   VkCommandBuffer commands, uint32_t first_page, uint64_t count)
{
    assert(first_page % SLUICE_DEMAND_BLOCK_PAGES == 0);
    uint64_t words = (count + SLUICE_DEMAND_BLOCK_PAGES - 1) / SLUICE_DEMAND_BLOCK_PAGES;
    assert(first_page / 32u + words <= scan->page_capacity / 32);
    if (words)
        vk->CmdFillBuffer(commands, scan->requests.buffer, first_page / 8u, words * 4, 0);
}

static void record_pass(const struct slc_demand_scan *s, const struct slc_vk *vk,
                        VkCommandBuffer commands, uint32_t pass, uint32_t group_count)
{
    slc_compute_dispatch(&s->compute, vk, commands, pass, group_count, 1);
    if (pass < LIST)
        slc_compute_barrier(vk, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                            VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

void slc_demand_scan_record(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                            VkCommandBuffer commands, uint32_t slot, uint64_t page_end,
                            uint32_t capacity)
{
    assert(slot < scan->slot_count && capacity <= scan->list_capacity);
    assert(page_end <= scan->page_capacity);
    const VkAccessFlags shaders = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    struct SluiceDemandScanParams params = {
        .sectionEnd =
            (uint32_t)((page_end + SLUICE_DEMAND_SECTION_PAGES - 1) / SLUICE_DEMAND_SECTION_PAGES),
        .firstSum = first_sum(scan->page_capacity),
        .resultOffset = slot * slot_words(scan->list_capacity),
        .capacity = capacity};
    slc_compute_bind(&scan->compute, vk, commands, 0, &params);
    slc_compute_barrier(vk, commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                        VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, shaders);
    if (scan->section_count <= scan->one_group_sections) {
        record_pass(scan, vk, commands, WHOLE, 1);
    } else {
        record_pass(scan, vk, commands, COMPACT, 1);
        record_pass(scan, vk, commands, COUNT, scan->workgroup_count);
        record_pass(scan, vk, commands, PLACE, 1);
        record_pass(scan, vk, commands, LIST, scan->workgroup_count);
    }
    slc_compute_barrier(vk, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                        VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                        shaders | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                            VK_ACCESS_HOST_READ_BIT);
}

struct SluiceDemandScanResult slc_demand_scan_result(struct slc_demand_scan *scan, uint32_t slot,
                                                     const uint32_t **pages)
{
    const uint32_t *words = scan->readback.mapped;
    words += (size_t)slot * slot_words(scan->list_capacity);
    *pages = words + RESULT_WORDS;
    struct SluiceDemandScanResult result = {words[0], words[1], words[2], words[3]};
    result.listedCount = slc_min_u32(result.listedCount, scan->list_capacity);
    scan->section_count = result.sectionCount;
    return result;
}
