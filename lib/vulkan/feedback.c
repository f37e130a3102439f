/* Feedback: chooses textures to resolve, reads their maps back, and gives the maps to the manager.
 */
#include "vulkan/load_stages.h"
#include "vulkan/texture_control.h"
#include "vulkan/texture_forgetting.h"
#include "vulkan/texture_requests.h"

#include "base/checked.h"
#include "base/log.h"

#include <string.h>

/* Gives a map to the manager. All feedback enters the manager here. */
static SluiceResult give_map(SluiceVulkanStreamer *s, SluiceTextureId id, const uint8_t *map,
                             uint32_t width, uint32_t height, uint64_t time_stamp, uint64_t timeout)
{
    SluiceFeedbackDesc desc = {
        .structSize = sizeof desc, .pMinMip = map, .width = width, .height = height};
    SluiceResult result =
        sluiceUpdateWithSamplerFeedback(s->manager, id, &desc, time_stamp, timeout);
    if (result == SLUICE_ERROR_STALE_TEXTURE || result == SLUICE_ERROR_UNKNOWN_TEXTURE)
        return SLUICE_SUCCESS; /* the texture was removed before its map was read back */
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY) {
        slc_log(&s->vk.log, SLUICE_LOG_WARNING, "no memory to take in a feedback map");
        return SLUICE_NOT_READY; /* nothing has changed, and another map will come */
    }
    if (result < 0)
        return slc_streamer_check(s, result, "sluiceUpdateWithSamplerFeedback");
    s->manager_time = time_stamp;
    s->counts.feedbackMaps++;
    slc_forgetting_used(s, s->by_manager_index[(uint32_t)id]);
    return SLUICE_SUCCESS;
}

static SluiceResult give_map_of(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                                uint64_t time_stamp)
{
    return give_map(s, texture->id, slc_control_map(s, texture), texture->layout.feedbackWidth,
                    texture->layout.feedbackHeight, time_stamp, s->info.feedbackTimeoutTicks);
}

/* Returns the next primary in turn. */
static uint32_t next_primary(SluiceVulkanStreamer *s)
{
    if (s->primary_cursor >= s->primary_count)
        s->primary_cursor = 0;
    return s->primaries[s->primary_cursor++];
}

/* Returns the maps of this frame. Textures may have been removed since the frame began. */
static uint32_t share_of_frame(const SluiceVulkanStreamer *s)
{
    return slc_min_u32(s->share, s->primary_count);
}

void slc_feedback_choose_share(SluiceVulkanStreamer *s)
{
    uint32_t share = s->info.texturesPerFrame;
    if (s->info.framesPerRound)
        share = slc_max_u32(share, slc_div_up_u32(s->primary_count, s->info.framesPerRound));
    s->share_of_all = s->all_left > 0;
    share = slc_min_u32(slc_max_u32(share, s->all_left), s->most_textures_per_frame);
    s->list_version += share != s->share;
    s->share = share;
}

SluiceResult sluiceResolveAllVulkanTextures(SluiceVulkanStreamer *streamer)
{
    if (!streamer)
        return SLUICE_ERROR_NULL_POINTER;
    streamer->all_left = streamer->primary_count;
    return SLUICE_SUCCESS;
}

/* Gives the manager maps that request everything (mapEverything), without feedback. */
static SluiceResult want_everything(SluiceVulkanStreamer *s)
{
    for (uint32_t i = share_of_frame(s); i > 0; i--) {
        const struct slc_texture *texture = &s->textures[next_primary(s)];
        SluiceResult result = give_map(s, texture->id, s->zero_map, texture->layout.feedbackWidth,
                                       texture->layout.feedbackHeight, s->time_stamp, UINT64_MAX);
        if (result < 0)
            return result;
    }
    return SLUICE_SUCCESS;
}

void slc_feedback_add(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    slc_feedback_map_init(&texture->feedback, s->feedback_levels + texture->region_first,
                          texture->layout.feedbackWidth * texture->layout.feedbackHeight);
    texture->feedback_whole = s->debug.wholeFeedbackMaps;
}

void slc_feedback_join(SluiceVulkanStreamer *s, uint32_t index)
{
    s->list_version++;
    s->textures[index].primary_place = s->primary_count;
    s->primaries[s->primary_count++] = index;
}

void slc_feedback_leave(SluiceVulkanStreamer *s, uint32_t index)
{
    uint32_t place = s->textures[index].primary_place;
    if (place == SLC_NONE)
        return;
    s->list_version++;
    uint32_t last = s->primaries[--s->primary_count];
    s->primaries[place] = last;
    s->textures[last].primary_place = place;
    s->textures[index].primary_place = SLC_NONE;
}

uint64_t slc_feedback_size(const SluiceVulkanStreamer *s, uint32_t region_count)
{
    return (uint64_t)region_count *
           (s->info.feedbackEncoding == SLUICE_FEEDBACK_ENCODING_MASKS ? 2 : 4);
}

uint32_t slc_feedback_clear_value(const SluiceVulkanStreamer *s)
{
    return s->info.feedbackEncoding == SLUICE_FEEDBACK_ENCODING_MASKS ? 0 : SLUICE_MIP_UNTOUCHED;
}

void slc_feedback_record_new(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                             VkCommandBuffer commands)
{
    slc_resolve_record_new(&s->resolve, &s->vk, commands, texture->region_first,
                           texture->region_count);
    if (!s->buffers_cleared)
        return; /* the whole buffer was cleared in this frame */
    uint64_t size = slc_feedback_size(s, 4);
    s->vk.CmdFillBuffer(commands, s->feedback.buffer, texture->region_first / 4 * size,
                        (texture->region_count + 3) / 4 * size, slc_feedback_clear_value(s));
}

/* Resolves a texture again that did not fit: its marks are kept, and the next round begins with it.
 */
static void try_again(SluiceVulkanStreamer *s, const struct slc_texture *texture, bool *first)
{
    s->counts.feedbackPostponed++;
    if (*first && texture->primary_place != SLC_NONE)
        s->primary_cursor = texture->primary_place;
    *first = false;
}

static void ask_for_all(SluiceVulkanStreamer *s, struct slc_texture *texture, bool all)
{
    s->list_version += texture->feedback_whole != all;
    texture->feedback_whole = all;
}

static SluiceResult read_slot(SluiceVulkanStreamer *s, const struct slc_readback_slot *slot)
{
    bool first_without_room = true;
    for (uint32_t i = 0; i < slot->item_count; i++) {
        struct slc_texture *texture = slc_streamer_texture(s, slot->items[i]);
        if (texture->state != SLC_TEXTURE_LIVE || texture->id != slot->items[i])
            continue; /* the texture was removed before its feedback was read back */
        const uint32_t *data;
        struct SluiceResolveResult resolved = slc_readback_result(&s->readback, slot, i, &data);
        if (resolved.state == SLUICE_RESOLVED_NOTHING) {
            try_again(s, texture, &first_without_room);
            continue;
        }
        if (!data || !slc_feedback_map_update(&texture->feedback, &resolved, data)) {
            slc_log(&s->vk.log, SLUICE_LOG_WARNING, "feedback came back damaged");
            ask_for_all(s, texture, true);
            continue;
        }
        ask_for_all(s, texture, s->debug.wholeFeedbackMaps);
        s->counts.feedbackWords += resolved.count;
        if (texture->hidden || texture->primary_id != SLUICE_NO_TEXTURE)
            continue;
        slc_load_stage_left(s, SLUICE_LOAD_STAGE_FEEDBACK, slot->frame);
        SluiceResult result = give_map_of(s, texture, slot->time_stamp);
        if (result < 0)
            return result;
    }
    return SLUICE_SUCCESS;
}

static SluiceResult give_due_map(SluiceVulkanStreamer *s, struct slc_texture *texture,
                                 uint64_t time_stamp)
{
    if (texture->drop_due) {
        SluiceResult result = sluiceEvictStreamedTexture(s->manager, texture->id, UINT32_MAX);
        if (result < 0)
            return slc_streamer_check(s, result, "sluiceEvictStreamedTexture");
        texture->drop_due = false;
    }
    bool empty = texture->hidden && !texture->first_request;
    return empty ? SLUICE_SUCCESS : give_map_of(s, texture, time_stamp);
}

/* Gives maps that do not wait for feedback. Their time is not after that of feedback to come. */
static SluiceResult give_due_maps(SluiceVulkanStreamer *s)
{
    const struct slc_readback_slot *pending = slc_readback_oldest(&s->readback, UINT64_MAX);
    uint64_t time_stamp = pending ? pending->time_stamp : s->time_stamp;
    uint32_t kept = 0, count = s->due_map_count;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < count; i++) {
        struct slc_texture *texture = &s->textures[s->due_maps[i]];
        if (result >= 0)
            result = give_due_map(s, texture, time_stamp);
        texture->map_due = result != SLUICE_SUCCESS;
        if (texture->map_due)
            s->due_maps[kept++] = s->due_maps[i];
    }
    s->due_map_count = kept;
    return result;
}

SluiceResult slc_feedback_read(SluiceVulkanStreamer *s)
{
    if (s->debug.mapEverything)
        return want_everything(s);
    slc_texture_requests_expire(s);
    struct slc_readback_slot *slot;
    while ((slot = slc_readback_oldest(&s->readback, s->completed_frame))) {
        SluiceResult result = read_slot(s, slot);
        if (result < 0)
            return result;
        slot->frame = 0;
    }
    return give_due_maps(s);
}

static bool takes_part(const SluiceVulkanStreamer *s, uint32_t index)
{
    return !s->info.feedbackInTurns || (s->turns[index / 32] >> index % 32 & 1);
}

/* Marks the textures that slc_feedback_record of this frame will resolve. */
static void choose_turns(SluiceVulkanStreamer *s)
{
    memset(s->turns, 0, slc_turns_size(s));
    uint32_t cursor = s->primary_cursor;
    for (uint32_t i = share_of_frame(s); i > 0; i--) {
        uint32_t index = next_primary(s);
        s->turns[index / 32] |= 1u << index % 32;
    }
    s->primary_cursor = cursor;
}

void slc_feedback_record_turns(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    if (!s->info.feedbackInTurns) {
        if (!s->buffers_cleared)
            s->vk.CmdFillBuffer(commands, s->feedback_turns.buffer, 0, VK_WHOLE_SIZE, 0xFFFFFFFFu);
        return;
    }
    choose_turns(s);
    const uint8_t *bytes = (const uint8_t *)s->turns;
    for (uint64_t done = 0, size = slc_turns_size(s); done < size; done += 65536) {
        uint64_t piece = size - done < 65536 ? size - done : 65536; /* most bytes of an update */
        s->vk.CmdUpdateBuffer(commands, s->feedback_turns.buffer, done, piece, bytes + done);
    }
}

static void list_items(SluiceVulkanStreamer *s, struct slc_readback_slot *slot, uint32_t share)
{
    slc_resolve_begin(&s->resolve, (uint32_t)(slot - s->readback.slots));
    slot->item_count = 0;
    slot->list_version = s->list_version;
    slot->list_first = s->primary_cursor;
    for (uint32_t i = 0; i < share; i++) {
        uint32_t index = next_primary(s);
        const struct slc_texture *texture = &s->textures[index];
        /* The next frame clears marks that an older texture left in the regions of a new one.
         * Textures that were added or removed since the frame began may have shifted the turns. */
        if (texture->added_frame == s->frame || !takes_part(s, index)) {
            slot->list_version = 0;
            continue;
        }
        if (!slc_resolve_add(&s->resolve, texture->region_first, texture->feedback.region_count,
                             texture->feedback_whole ? SLUICE_RESOLVE_WHOLE : 0))
            break; /* not reached: there is room for all textures */
        slot->items[slot->item_count++] = texture->id;
    }
    slot->list_end = s->primary_cursor;
    slot->segment_count = s->resolve.segment_count;
}

void slc_feedback_record(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    uint32_t share = share_of_frame(s);
    s->all_left -= slc_min_u32(s->all_left, s->share);
    if (share == 0 || s->debug.mapEverything)
        return;
    struct slc_readback_slot *slot =
        slc_readback_begin(&s->readback, s->slot, s->frame, s->time_stamp);
    slot->share_of_all = s->share_of_all;
    if (slot->list_version == s->list_version && slot->list_first == s->primary_cursor) {
        slc_resolve_resume(&s->resolve, (uint32_t)(slot - s->readback.slots), slot->item_count,
                           slot->segment_count);
        s->primary_cursor = slot->list_end;
    } else {
        list_items(s, slot, share);
    }
    if (slot->item_count)
        slc_resolve_record(&s->resolve, &s->vk, commands,
                           slc_readback_result_offset(&s->readback, slot),
                           slc_readback_data_offset(&s->readback, slot), s->readback.capacity);
}

void slc_feedback_abandon(SluiceVulkanStreamer *s, uint64_t frame)
{
    uint64_t oldest = UINT64_MAX;
    for (uint32_t i = 0; i < s->readback.slot_count; i++) {
        struct slc_readback_slot *slot = &s->readback.slots[i];
        if (slot->frame < frame)
            continue;
        if (slot->frame < oldest)
            s->primary_cursor = slot->list_first;
        if (slot->share_of_all) /* all textures are resolved again */
            s->all_left = s->primary_count;
        oldest = slot->frame < oldest ? slot->frame : oldest;
        slot->frame = 0;
    }
}
