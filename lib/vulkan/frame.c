/* The frame loop. The order of the steps is explained in docs/frame-loop.md. */
#include "base/struct_size.h"
#include "vulkan/streamer.h"

#include "base/log.h"
#include "vulkan/load_arrivals.h"
#include "vulkan/load_binds.h"
#include "vulkan/load_cancels.h"
#include "vulkan/load_deferred.h"
#include "vulkan/load_productions.h"
#include "vulkan/load_reloads.h"
#include "vulkan/load_stages.h"
#include "vulkan/load_starts.h"
#include "vulkan/residencies.h"
#include "vulkan/shrink.h"
#include "vulkan/strict_mode.h"
#include "vulkan/texture_forgetting.h"
#include "vulkan/tile_upload.h"
#include "vulkan/unmet_budget.h"

#define MAX_BARRIERS 64u
#define GRACE 5000000ull /* nanoseconds */

static SluiceResult poll_frames(SluiceVulkanStreamer *s)
{
    uint64_t value = 0;
    SluiceResult result =
        slc_vk_result(&s->vk, s->vk.GetSemaphoreCounterValue(s->vk.device, s->semaphore, &value),
                      "vkGetSemaphoreCounterValue");
    if (result == SLUICE_SUCCESS && value > s->completed_frame)
        s->completed_frame = value;
    return result;
}

/* Waits a moment for a frame. A fence may be signaled before the semaphore of its submission, as in
 * lavapipe. So callers that waited for the fence need no second wait. */
static SluiceResult await_frame(SluiceVulkanStreamer *s, uint64_t value)
{
    if (value <= s->completed_frame)
        return SLUICE_SUCCESS;
    const VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &s->semaphore,
                                      .pValues = &value};
    VkResult waited = s->vk.WaitSemaphores(s->vk.device, &info, GRACE);
    SluiceResult result =
        slc_vk_result(&s->vk, waited == VK_TIMEOUT ? VK_SUCCESS : waited, "vkWaitSemaphores");
    if (result == SLUICE_SUCCESS)
        result = poll_frames(s);
    return result == SLUICE_SUCCESS && value > s->completed_frame ? SLUICE_NOT_READY : result;
}

/* Collects completed frames: releases slots, images and staging memory. */
static SluiceResult retire(SluiceVulkanStreamer *s)
{
    SluiceResult result = slc_residencies_update(s);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_loads_recycle(s);
    uint64_t limit = s->residency->interface->retire_limit(s->residency, s->completed_frame);
    limit = slc_forgetting_retire(s, limit);
    limit = slc_textures_retire(s, limit);
    if (limit < s->retired)
        return SLUICE_SUCCESS;
    s->retired = limit;
    return slc_streamer_check(s, sluiceCompleteRetireValue(s->manager, limit),
                              "sluiceCompleteRetireValue");
}

/* Unmaps tiles. MinMip maps hide them from this frame on; pages are free after older frames. */
static SluiceResult unmap_tiles(SluiceVulkanStreamer *s)
{
    for (;;) {
        uint32_t room = slc_residencies_room_to_unmap(s);
        uint32_t count = room < s->info.tilesPerFrame ? room : s->info.tilesPerFrame;
        if (count == 0)
            return SLUICE_SUCCESS;
        uint32_t asked = count;
        SluiceResult result =
            sluiceGetTilesToUnmap(s->manager, SLUICE_ALL_TEXTURES, s->frame, &count, s->tiles);
        if (result < 0)
            return slc_streamer_check(s, result, "sluiceGetTilesToUnmap");
        for (uint32_t i = 0; i < count; i++) {
            uint32_t index = s->by_manager_index[(uint32_t)s->tiles[i].textureId];
            bool filled = slc_loads_unmap(s, index, &s->tiles[i]);
            struct slc_residency *residency = slc_residency_of(s, index);
            residency->interface->unmap(residency, index, &s->tiles[i], s->frame, filled);
        }
        s->counts.tilesUnmapped += count;
        if (count < asked)
            return SLUICE_SUCCESS;
    }
}

static SluiceResult bind(SluiceVulkanStreamer *s)
{
    slc_loads_bind(s);
    uint64_t value;
    SluiceResult result = s->residency->interface->submit(s->residency, &value);
    if (result == SLUICE_SUCCESS)
        slc_loads_bound(s, value);
    return result;
}

static SluiceResult decide(SluiceVulkanStreamer *s)
{
    SluiceResult result = retire(s);
    s->memory_pressure = slc_memory_client_begin(&s->memory); /* after the releases above */
    slc_unmet_budget_step(s);
    if (result >= 0)
        result = slc_productions_publish(s);
    if (result >= 0)
        result = slc_loads_collect(s);
    if (result >= 0)
        result = slc_feedback_read(s);
    if (result >= 0)
        result = slc_loads_cancel(s);
    if (result >= 0)
        result = slc_loads_make_room(s);
    if (result >= 0)
        result = slc_forgetting_step(s);
    if (result >= 0)
        result = slc_shrink_step(s);
    if (result >= 0)
        result = unmap_tiles(s);
    if (result >= 0)
        result = bind(s);
    if (result >= 0)
        result = slc_reloads_start(s);
    if (result >= 0)
        result = slc_loads_start(s);
    return result;
}

/* Records a barrier from shaders of earlier frames to copies, and layouts of new images. */
static void barrier_before(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    VkImageMemoryBarrier images[MAX_BARRIERS];
    VkMemoryBarrier memory = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT};
    uint32_t done = 0;
    do {
        uint32_t count = 0;
        for (; count < MAX_BARRIERS && done < s->new_texture_count; done++) {
            const struct slc_texture *texture = &s->textures[s->new_textures[done]];
            if (texture->presence != SLC_PRESENT)
                continue;
            images[count++] = (VkImageMemoryBarrier){
                .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_READ_BIT,
                .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                .newLayout = VK_IMAGE_LAYOUT_GENERAL,
                .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                .image = texture->image.image,
                .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS,
                                     texture->layer, 1}};
        }
        s->vk.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                 VK_PIPELINE_STAGE_TRANSFER_BIT |
                                     VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                 0, 1, &memory, 0, NULL, count, images);
    } while (done < s->new_texture_count);
}

static void barrier_after(SluiceVulkanStreamer *s, VkCommandBuffer commands,
                          VkPipelineStageFlags stages, VkAccessFlags accesses)
{
    VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                              .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                              .dstAccessMask = accesses};
    s->vk.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, stages, 0, 1, &memory, 0,
                             NULL, 0, NULL);
}

static void clear_buffers(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    slc_page_pool_record_empty(s->pages, s->page_user, s->frame, commands);
    s->vk.CmdFillBuffer(commands, s->feedback.buffer, 0, VK_WHOLE_SIZE,
                        slc_feedback_clear_value(s));
    s->vk.CmdFillBuffer(commands, s->min_mip.buffer, 0, VK_WHOLE_SIZE, 0xFFFFFFFFu);
    s->vk.CmdFillBuffer(commands, s->texture_table.buffer, 0, VK_WHOLE_SIZE, 0);
    barrier_after(s, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
}

static SluiceResult record(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    bool written_twice = s->new_texture_count || s->has_put_back;
    barrier_before(s, commands);
    if (!s->buffers_cleared) {
        clear_buffers(s, commands);
        s->cleared_frame = s->frame;
    }
    slc_page_pool_record(s->pages, s->page_user, s->frame, s->completed_frame, commands);
    slc_residencies_record_begin(s, commands);
    slc_textures_record_new(s, commands);
    slc_feedback_record_turns(s, commands);
    s->buffers_cleared = true;
    s->has_put_back = false;
    if (written_twice) /* later commands change the same entries and words of the page table */
        barrier_after(s, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    SluiceResult result = slc_tile_uploads_record(s, commands);
    if (result >= 0)
        result = slc_productions_record(s, commands);
    if (result >= 0)
        slc_residencies_record_publish(s, commands);
    if (result >= 0)
        result = slc_min_mip_record(s, commands); /* after the copies of texels that it shows */
    barrier_after(s, commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                  VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    return result;
}

static uint32_t slot_of(const SluiceVulkanStreamer *s, uint64_t turn)
{
    return (uint32_t)(turn % s->info.framesInFlight);
}

SluiceResult sluiceBeginStreamingFrame(SluiceVulkanStreamer *streamer,
                                       VkCommandBuffer commandBuffer, uint64_t timeStamp,
                                       SluiceStreamingFrame *pFrame)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s || !commandBuffer || !pFrame)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked = slc_struct_check(SLC_STRUCT(SluiceStreamingFrame), pFrame, &s->vk.log);
    if (checked != SLUICE_SUCCESS)
        return checked;
    if (s->frame && timeStamp - s->time_stamp > UINT64_MAX / 2) {
        slc_log(&s->vk.log, SLUICE_LOG_ERROR,
                "timeStamp is %llu; it must not be below the last frame's, %llu",
                (unsigned long long)timeStamp, (unsigned long long)s->time_stamp);
        return SLUICE_ERROR_TIME_BACKWARDS;
    }
    if (s->ended_frame != s->frame) {
        slc_strict_not_ended(s);
        return slc_log_refusal(
            &s->vk.log, "frame %llu was neither ended nor abandoned: no other one can be begun",
            (unsigned long long)s->frame);
    }
    SluiceResult result = poll_frames(s);
    if (result != SLUICE_SUCCESS)
        return result;
    s->slot = slot_of(s, s->slot_turn);
    result = await_frame(s, s->in_flight[s->slot]);
    if (result == SLUICE_NOT_READY)
        slc_strict_not_ready(s, s->in_flight[s->slot]);
    if (result != SLUICE_SUCCESS)
        return result;
    s->in_flight[s->slot] = ++s->frame;
    s->submittable[s->slot] = false;
    s->slot_turn++;
    s->time_stamp = timeStamp;
    slc_settings_apply(s);
    slc_feedback_choose_share(s);
    slc_time_check_frame(&s->time_check, &s->vk.log, timeStamp);
    SluiceStreamingFrame frame = {.structSize = sizeof frame,
                                  .frameIndex = s->frame,
                                  .semaphore = s->semaphore,
                                  .signalValue = s->frame};
    frame.uploadSemaphore = s->uploads.semaphore;
    slc_device_budget_turn(&s->context->device_budget, &s->context->budget);
    sluiceMarkTileEvents(s->manager, s->frame);
    slc_load_stages_begin(s);
    s->manager_locked = false;
    result = decide(s);
    if (result >= 0)
        result = record(s, commandBuffer);
    s->manager_locked = true;
    slc_strict_begun(s);
    if (result < 0) {
        s->ended_frame = s->frame;
        return result;
    }
    frame.uploadValue = s->uploads.completed;
    frame.descriptorSet =
        slc_descriptors_update(&s->descriptors, &s->vk, s->slot,
                               slc_page_pool_views(s->pages, s->page_user), &s->texture_array);
    slc_struct_write(SLC_STRUCT(SluiceStreamingFrame), pFrame, &frame);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceEndStreamingFrame(SluiceVulkanStreamer *streamer, VkCommandBuffer commandBuffer)
{
    if (!streamer || !commandBuffer)
        return SLUICE_ERROR_NULL_POINTER;
    if (streamer->ended_frame == streamer->frame) {
        slc_strict_not_begun(streamer);
        return slc_log_refusal(
            &streamer->vk.log,
            "no frame can be ended: none was begun since the last one was ended or abandoned");
    }
    streamer->ended_frame = streamer->frame;
    streamer->submittable[streamer->slot] = true;
    slc_feedback_record(streamer, commandBuffer);
    return SLUICE_SUCCESS;
}

static bool is_in_flight(const SluiceVulkanStreamer *s, uint64_t frame)
{
    for (uint32_t i = 0; i < s->info.framesInFlight; i++)
        if (frame && s->in_flight[i] == frame)
            return frame > s->completed_frame;
    return false;
}

uint64_t slc_streamer_last_submittable(const SluiceVulkanStreamer *s)
{
    uint64_t last = 0;
    for (uint32_t i = 0; i < s->info.framesInFlight; i++)
        if (s->submittable[i] && s->in_flight[i] > last)
            last = s->in_flight[i];
    return last;
}

static void give_slots_back(SluiceVulkanStreamer *s, uint64_t frame)
{
    while (s->slot_turn && s->in_flight[slot_of(s, s->slot_turn - 1)] >= frame)
        s->in_flight[slot_of(s, --s->slot_turn)] = 0;
}

SluiceResult sluiceAbandonStreamingFrame(SluiceVulkanStreamer *streamer,
                                         const SluiceStreamingFrame *pFrame)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s || !pFrame)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceStreamingFrame given = {.structSize = sizeof given};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceStreamingFrame), &given, pFrame, &s->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    result = poll_frames(s);
    if (result != SLUICE_SUCCESS)
        return result;
    uint64_t frame = given.frameIndex;
    if (!is_in_flight(s, frame))
        return slc_log_refusal(
            &s->vk.log, "frame %llu cannot be abandoned: it is over, was abandoned or never begun",
            (unsigned long long)frame);
    give_slots_back(s, frame);
    s->ended_frame = s->frame;
    s->buffers_cleared &= s->cleared_frame < frame;
    s->has_put_back = true;
    slc_textures_abandon(s, frame);
    slc_loads_abandon(s, frame);
    slc_min_mip_abandon(s, frame);
    slc_feedback_abandon(s, frame);
    slc_page_pool_abandon(s->pages, s->page_user, frame);
    slc_residencies_abandon(s, frame);
    return SLUICE_SUCCESS;
}

SluiceResult slc_streamer_check(const SluiceVulkanStreamer *s, SluiceResult result,
                                const char *what)
{
    if (result < 0)
        slc_log(&s->vk.log, SLUICE_LOG_ERROR, "%s refused with %s", what,
                sluiceGetResultName(result));
    return result;
}
