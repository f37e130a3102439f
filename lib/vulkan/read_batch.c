#include "vulkan/read_batch.h"

#include "vulkan/load_arrivals.h"
#include "vulkan/load_reads.h"

SluiceResult slc_read_batch_submit(SluiceVulkanStreamer *s, struct slc_read_batch *batch)
{
    uint64_t tickets[SLC_BATCH_READS];
    uint32_t count = batch->count;
    batch->count = 0;
    SluiceResult read = sluiceSubmitTileReads(s->loader, count, batch->reads, tickets);
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < count; i++) {
        if (read == SLUICE_SUCCESS) {
            s->units[batch->units[i]].ticket = tickets[i];
            continue;
        }
        SluiceResult answered = slc_tile_back(s, batch->units[i], read);
        result = result < 0 ? result : answered;
    }
    return result;
}

SluiceResult slc_read_batch_add(SluiceVulkanStreamer *s, struct slc_read_batch *batch,
                                uint32_t index)
{
    uint32_t i = batch->count++;
    slc_fill_tile_read(s, index, &batch->reads[i], &batch->regions[i], &batch->texels[i]);
    batch->units[i] = index;
    s->units[index].state = SLC_UNIT_READING;
    return batch->count == SLC_BATCH_READS ? slc_read_batch_submit(s, batch) : SLUICE_SUCCESS;
}
