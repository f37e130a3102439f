#include "view_needs.h"

bool view_needs_create(struct view *view)
{
    const struct view_request *request = &view->request;
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    sluiceGetVulkanBuffers(view->streamer, &buffers);
    if (!request->needs)
        return true;
    if (!needs_pass_create(request->gpu, &view->renderer, &buffers, VIEW_MAX_REGIONS,
                           view->texture_count, &view->needs))
        return false;
    for (uint32_t i = 0; i < VIEW_FRAMES_IN_FLIGHT; i++) {
        VkDescriptorSet set;
        if (!view_allocate_sets(view, view->renderer.frame_layout, 1, &set) ||
            !needs_slot_create(&view->needs, set, view->slots[i].frame.buffer,
                               &view->slots[i].needs))
            return false;
    }
    return true;
}

bool view_needs_begin(const struct view *view, struct needs *needs)
{
    return needs_begin(needs, view->manager, view->texture_ids, view->texture_count);
}

bool view_needs(struct view *view, uint32_t slot, struct needs *needs, struct needs_frame *frame)
{
    struct GalleryCounts counts;
    struct needs_words words = needs_pass_words(&view->needs, &view->slots[slot].needs, &counts);
    *frame = (struct needs_frame){.sampled_pixels = counts.sampled,
                                  .missing_pixels = counts.missingPixels};
    return needs_add_frame(needs, &words, frame);
}

static uint64_t packed_bytes(const SluiceStreamedTextureLayout *layout, SluiceFormat format)
{
    uint64_t size = 0;
    for (uint32_t level = layout->desc.regularMipCount; level < layout->desc.mipLevelCount;
         level++) {
        uint32_t width = layout->desc.width >> level, height = layout->desc.height >> level;
        size += sluiceGetFormatRegionSize(format, width ? width : 1, height ? height : 1);
    }
    return size;
}

struct view_reads view_reads(const struct view *view)
{
    const SluiceStreamedTextureManager *manager = view->manager;
    struct view_reads all = {0, 0};
    for (uint32_t i = 0; i < view->texture_count; i++) {
        SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
        SluiceImageInfo info = {.structSize = sizeof info};
        SluiceTileLoaderStatistics reads = {.structSize = sizeof reads};
        if (sluiceGetTextureLayout(manager, view->texture_ids[i].id, &layout) != SLUICE_SUCCESS ||
            sluiceGetImageInfo(view->sources[i], &info) != SLUICE_SUCCESS ||
            sluiceGetVulkanReadStatistics(view->streamer, view->sources[i], &reads) !=
                SLUICE_SUCCESS)
            continue;
        all.never += reads.readCount == 0;
        all.packed += reads.readCount > 0 && reads.byteCount <= packed_bytes(&layout, info.format);
    }
    return all;
}
