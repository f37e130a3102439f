#include "vulkan/load_stages.h"

#include "base/struct_size.h"
#include "core/observer.h"

void slc_load_stages_begin(SluiceVulkanStreamer *s)
{
    s->stages.requests[s->frame % SLC_STAGE_FRAMES] = slc_manager_next_request(s->manager);
    s->stages.first_frame = s->frame >= SLC_STAGE_FRAMES ? s->frame - SLC_STAGE_FRAMES + 1 : 1;
}

static uint32_t bucket_of(uint64_t frames)
{
    uint32_t bucket = 0;
    for (; frames > 0 && bucket + 1 < SLUICE_STAGE_BUCKET_COUNT; frames >>= 1)
        bucket++;
    return bucket;
}

static void add(SluiceLoadStageCounts *counts, uint64_t frames)
{
    counts->count++;
    counts->frameSum += frames;
    counts->frameMax = frames > counts->frameMax ? frames : counts->frameMax;
    counts->buckets[bucket_of(frames)]++;
}

void slc_load_stage_left(SluiceVulkanStreamer *s, SluiceLoadStage stage, uint64_t since)
{
    add(&s->stages.counts.stages[stage], s->frame - since);
}

/* Returns the frame that made a request: the last one that began at or before its number. */
static uint64_t frame_of(const SluiceVulkanStreamer *s, uint64_t request)
{
    uint64_t low = s->stages.first_frame, high = s->frame;
    while (low < high) {
        uint64_t middle = high - (high - low) / 2;
        if (s->stages.requests[middle % SLC_STAGE_FRAMES] <= request)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

void slc_load_stage_handed_out(SluiceVulkanStreamer *s, const SluiceTile *tile)
{
    uint64_t request = slc_manager_request_of(s->manager, tile);
    if (request != UINT64_MAX)
        slc_load_stage_left(s, SLUICE_LOAD_STAGE_QUEUE, frame_of(s, request));
}

void slc_load_stage_taken(SluiceVulkanStreamer *s, struct slc_unit *unit, const SluiceTile *tile)
{
    uint64_t request = slc_manager_request_of(s->manager, tile);
    if (request != UINT64_MAX)
        unit->requested_frame = frame_of(s, request);
}

void slc_load_stage_unit(SluiceVulkanStreamer *s, struct slc_unit *unit, SluiceLoadStage stage)
{
    bool counts = !unit->produced && !unit->published;
    if (counts)
        slc_load_stage_left(s, stage, unit->stage_frame);
    if (counts && stage == SLUICE_LOAD_STAGE_COPY && unit->requested_frame != UINT64_MAX)
        add(&s->stages.counts.whole, s->frame - unit->requested_frame);
    unit->stage_frame = s->frame;
}

SluiceResult sluiceGetVulkanLoadStages(const SluiceVulkanStreamer *streamer,
                                       SluiceVulkanLoadStages *pStages)
{
    if (!streamer || !pStages)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceVulkanLoadStages);
    SluiceResult result = slc_struct_check(type, pStages, &streamer->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceVulkanLoadStages stages = streamer->stages.counts;
    stages.structSize = sizeof stages;
    slc_struct_write(type, pStages, &stages);
    return SLUICE_SUCCESS;
}
