#include "vulkan/producer_calls.h"

static void barrier(const struct slc_producer_calls *calls, bool before)
{
    const VkPipelineStageFlags writers =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkAccessFlags writes = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                              .srcAccessMask = writes,
                              .dstAccessMask = before ? VK_ACCESS_SHADER_READ_BIT | writes
                                                      : VK_ACCESS_SHADER_READ_BIT |
                                                            VK_ACCESS_TRANSFER_WRITE_BIT};
    calls->vk->CmdPipelineBarrier(
        calls->commands, before ? VK_PIPELINE_STAGE_ALL_COMMANDS_BIT : writers,
        before ? writers : VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &memory, 0, NULL, 0, NULL);
}

/* Puts a barrier before the first batch of an owner, and before a batch with the view of the last
 * one. Batches never write the same texels, but a view has all layers of a level, so validation
 * layers report two batches with one view as a hazard. */
void slc_producer_calls_order(struct slc_producer_calls *calls, uint32_t owner, uint64_t target,
                              uint32_t level)
{
    if (calls->target == 0 || calls->owner != owner ||
        (calls->target == target && calls->level == level))
        barrier(calls, true);
    calls->target = target;
    calls->level = level;
    calls->owner = owner;
}

void slc_producer_calls_end(const struct slc_producer_calls *calls)
{
    if (calls->target)
        barrier(calls, false);
}

void slc_producer_answers_init(SluiceResult *answers, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        answers[i] = SLUICE_SUCCESS;
}

void slc_producer_answers_end(SluiceResult *answers, uint32_t count, SluiceResult returned)
{
    for (uint32_t i = 0; i < count && returned != SLUICE_SUCCESS; i++)
        answers[i] = returned;
}

enum slc_producer_effect slc_producer_effect(SluiceResult answer, uint64_t *asked, uint64_t frame,
                                             uint32_t timeout, bool can_wait)
{
    if (answer == SLUICE_SUCCESS)
        return SLC_PRODUCER_WROTE;
    if (*asked == 0)
        *asked = frame;
    bool waits = answer == SLUICE_NOT_READY && frame - *asked < timeout && can_wait;
    return waits ? SLC_PRODUCER_WAITS : SLC_PRODUCER_FAILED;
}
