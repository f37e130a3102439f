#include "support/test.h"
#include "vulkan/fake_functions.h"
#include "vulkan/fake_objects.h"
#include "vulkan/feedback_map.h"

#include <sluice/shared/texture_table.h>

#include <string.h>

static VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache,
                                                       uint32_t count,
                                                       const VkComputePipelineCreateInfo *infos,
                                                       const VkAllocationCallbacks *cb,
                                                       VkPipeline *pipelines)
{
    FAKE_MAY_FAIL(device);
    (void)cache, (void)infos, (void)cb, (void)count;
    assert_true(cache != VK_NULL_HANDLE);
    pipelines[0] = fake_make_shown(fake_of(device), 0);
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_pipeline(VkDevice device, VkPipeline pipeline,
                                                   const VkAllocationCallbacks *cb)
{
    (void)cb;
    fake_drop(fake_of(device), pipeline);
}

/* Bindings leave no trace here. */
static VKAPI_ATTR void VKAPI_CALL bind_sets(VkCommandBuffer commands, VkPipelineBindPoint point,
                                            VkPipelineLayout layout, uint32_t first, uint32_t count,
                                            const VkDescriptorSet *sets, uint32_t offset_count,
                                            const uint32_t *offsets)
{
    (void)commands, (void)point, (void)layout, (void)first, (void)count, (void)sets;
    (void)offset_count, (void)offsets;
}

static VKAPI_ATTR void VKAPI_CALL bind_pipeline(VkCommandBuffer commands, VkPipelineBindPoint point,
                                                VkPipeline pipeline)
{
    (void)commands, (void)point, (void)pipeline;
}

static VKAPI_ATTR void VKAPI_CALL push_constants(VkCommandBuffer commands, VkPipelineLayout layout,
                                                 VkShaderStageFlags stages, uint32_t offset,
                                                 uint32_t size, const void *values)
{
    (void)layout, (void)stages, (void)offset;
    if (fake_of(commands)->no_resolve)
        return;
    assert_int_equal(size, sizeof fake_of(commands)->push);
    memcpy(&fake_of(commands)->push, values, size);
}

/* Buffers that are mapped, and only those, have memory. */
static void *words_of(const struct fake_object *buffer)
{
    return FAKE_OBJECT(buffer->memory)->memory;
}

static void resolve_item(struct fake_vulkan *fake, uint32_t index, uint32_t *at)
{
    const struct SluiceResolveSegment *segments = words_of(fake->table);
    const struct SluiceResolveItem *item =
        (const struct SluiceResolveItem *)words_of(fake->table) + fake->push.firstItem + index;
    uint32_t first = segments[fake->push.firstSegment + item->firstSegment].firstRegion;
    uint32_t *words = words_of(fake->readback);
    struct SluiceResolveResult result = {SLUICE_RESOLVED_MAP, (item->regionCount + 3) / 4, *at, 0};
    if (result.count > fake->push.capacity - *at)
        result = (struct SluiceResolveResult){SLUICE_RESOLVED_NOTHING, 0, 0, 0};
    *at += result.count;
    uint8_t *levels = (uint8_t *)&words[fake->push.dataOffset + result.offset];
    for (uint32_t i = 0; i < item->regionCount && result.count; i++) {
        levels[i] = fake->want(fake->user, first + i);
        result.checksum += slc_resolve_weight(i) * (SLUICE_MIP_UNTOUCHED - (uint32_t)levels[i]);
    }
    if (fake->damage_count && fake->damage_count--)
        result.checksum ^= 1;
    fake->whole_count += (item->flags & SLUICE_RESOLVE_WHOLE) != 0;
    memcpy(&words[fake->push.resultOffset + 4 * index], &result, sizeof result);
}

/* Resolve passes take the feedback that the test wants: whole maps, which are always allowed. */
static VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y,
                                           uint32_t z)
{
    (void)x, (void)y, (void)z;
    struct fake_vulkan *fake = fake_of(commands);
    if (fake->no_resolve || ++fake->dispatch_count % 3 != 0)
        return;
    for (uint32_t i = 0, at = 0; i < fake->push.itemCount; i++)
        resolve_item(fake, i, &at);
}

const struct fake_function fake_pass_functions[] = {
    FAKE_FUNCTION(CmdBindDescriptorSets, bind_sets),
    FAKE_FUNCTION(CmdBindPipeline, bind_pipeline),
    FAKE_FUNCTION(CmdDispatch, dispatch),
    FAKE_FUNCTION(CmdPushConstants, push_constants),
    FAKE_FUNCTION(CreateComputePipelines, create_pipelines),
    FAKE_FUNCTION(DestroyPipeline, destroy_pipeline),
    {NULL, NULL},
};
