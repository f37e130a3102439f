#include "bake/copy.h"

#include "base/alloc.h"

#define TILE_SIZE 65536u

/* Tile that is being copied. */
struct slot {
    struct slc_job base;
    struct run *run;
    uint32_t layer, level, x, y;
    uint64_t turn; /* turn of the writer */
    bool is_busy;  /* guarded by the pool's mutex */
    char texels[TILE_SIZE];
};

struct run {
    struct slc_copy *copy;
    struct slot *slots;
    uint32_t slot_count;
    SluiceResult result; /* the first failure; guarded by the pool's mutex */
    uint64_t done, total;
};

static uint32_t count_slots(uint32_t thread_count)
{
    return 4 * (thread_count + 1);
}

uint64_t slc_copy_memory(const SluiceStoreLayout *layout, uint32_t thread_count)
{
    return count_slots(thread_count) * (uint64_t)sizeof(struct slot) + layout->tailSize;
}

/* Ends the tile's turn. `texels` NULL: without writing. */
static SluiceResult end_turn(const struct slot *slot, const void *texels, size_t pitch)
{
    const struct slc_copy *copy = slot->run->copy;
    return sluiceWriteStoreTileInTurn(copy->writer, slot->turn, copy->first_layer + slot->layer,
                                      slot->level, slot->x, slot->y, texels, pitch);
}

static SluiceResult copy_tile(struct slot *slot, bool *found, bool *has_ended)
{
    struct slc_copy *copy = slot->run->copy;
    SluiceImageRegion region;
    SluiceResult result = sluiceIsStoreTileWritten(copy->writer, copy->first_layer + slot->layer,
                                                   slot->level, slot->x, slot->y, found);
    if (result != SLUICE_SUCCESS || *found)
        return result;
    result = sluiceGetStoreTileRegion(&copy->layout, slot->level, slot->x, slot->y, &region);
    if (result != SLUICE_SUCCESS)
        return result;
    region.arrayLayer = slot->layer;
    size_t pitch = (size_t)sluiceGetFormatRegionSize(copy->layout.format, region.width, 1);
    result = sluiceReadImageRegion(copy->source, &region, slot->texels, pitch);
    if (result != SLUICE_SUCCESS)
        return result;
    *has_ended = true;
    return end_turn(slot, slot->texels, pitch);
}

static void run_slot(struct slc_job *base)
{
    struct slot *slot = (struct slot *)base;
    struct run *run = slot->run;
    bool found = false, has_ended = false;
    SluiceResult result = copy_tile(slot, &found, &has_ended);
    if (!has_ended)
        end_turn(slot, NULL, 0);
    slc_bake_jobs_lock(run->copy->jobs);
    if (run->result == SLUICE_SUCCESS)
        run->result = result;
    run->copy->found_tile_count += found;
    run->done++;
    slot->is_busy = false;
    slc_bake_jobs_unlock_and_wake(run->copy->jobs);
}

static bool has_free_slot(void *user)
{
    const struct run *run = user;
    for (uint32_t i = 0; i < run->slot_count; i++)
        if (!run->slots[i].is_busy)
            return true;
    return false;
}

static bool all_are_free(void *user)
{
    const struct run *run = user;
    for (uint32_t i = 0; i < run->slot_count; i++)
        if (run->slots[i].is_busy)
            return false;
    return true;
}

/* Waits for a slot and starts the tile in it. */
static SluiceResult start(struct run *run, uint32_t layer, uint32_t level, uint32_t x, uint32_t y)
{
    struct slc_copy *copy = run->copy;
    slc_bake_jobs_help_until(copy->jobs, has_free_slot, run);
    slc_bake_jobs_lock(copy->jobs);
    struct slot *slot = run->slots;
    while (slot->is_busy)
        slot++;
    SluiceResult result = run->result;
    slot->is_busy = result == SLUICE_SUCCESS;
    uint64_t done = run->done;
    slc_mutex_unlock(&copy->jobs->mutex);
    if (result != SLUICE_SUCCESS)
        return result;
    slot->run = run;
    slot->base.run = run_slot;
    slot->layer = layer;
    slot->level = level;
    slot->x = x;
    slot->y = y;
    slot->turn = (*copy->next_turn)++;
    slc_bake_jobs_submit(copy->jobs, &slot->base);
    if (x == 0 && copy->progress && !copy->progress(copy->user, done, run->total))
        return SLUICE_ERROR_CANCELED;
    return SLUICE_SUCCESS;
}

static SluiceResult copy_tail(struct slc_copy *copy, uint32_t layer, char *texels)
{
    const SluiceStoreLayout *layout = &copy->layout;
    const void *levels[SLUICE_STORE_MAX_MIP_LEVELS];
    bool found = false;
    SluiceResult result = sluiceIsStoreTileWritten(copy->writer, copy->first_layer + layer,
                                                   layout->tailFirstLevel, 0, 0, &found);
    slc_bake_jobs_lock(copy->jobs); /* tiles are still being copied */
    copy->found_tile_count += found;
    slc_mutex_unlock(&copy->jobs->mutex);
    for (uint32_t l = layout->tailFirstLevel; l < layout->mipLevelCount; l++) {
        SluiceImageRegion region;
        if (result == SLUICE_SUCCESS)
            result = sluiceGetStoreTileRegion(layout, l, 0, 0, &region);
        if (result != SLUICE_SUCCESS || found)
            return result;
        region.arrayLayer = layer;
        size_t pitch = (size_t)sluiceGetFormatRegionSize(layout->format, region.width, 1);
        result = sluiceReadImageRegion(copy->source, &region, texels, pitch);
        levels[l - layout->tailFirstLevel] = texels;
        texels += sluiceGetFormatRegionSize(layout->format, region.width, region.height);
    }
    return result == SLUICE_SUCCESS
               ? sluiceWriteStoreTail(copy->writer, copy->first_layer + layer, levels, NULL)
               : result;
}

static SluiceResult copy_layer(struct run *run, uint32_t layer, char *tail)
{
    const SluiceStoreLayout *layout = &run->copy->layout;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t l = 0; l < layout->tailFirstLevel; l++)
        for (uint32_t y = 0; y < layout->levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < layout->levelWidthInTiles[l] && result == SLUICE_SUCCESS; x++)
                result = start(run, layer, l, x, y);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_bake_jobs_help_until(run->copy->jobs, all_are_free, run); /* before the tail */
    return copy_tail(run->copy, layer, tail);
}

SluiceResult slc_copy_run(struct slc_copy *copy)
{
    const SluiceAllocationCallbacks *cb = &copy->allocator;
    struct run run = {.copy = copy, .slot_count = count_slots(copy->jobs->thread_count)};
    run.done = copy->layout.tileCount * copy->first_layer;
    run.total = copy->layout.tileCount * copy->all_layer_count;
    char *tail = slc_alloc(cb, copy->layout.tailSize, 1);
    run.slots = slc_alloc(cb, run.slot_count, sizeof *run.slots);
    SluiceResult result = tail && run.slots ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < run.slot_count && result == SLUICE_SUCCESS; i++)
        run.slots[i].is_busy = false;
    for (uint32_t layer = 0; layer < copy->layer_count && result == SLUICE_SUCCESS; layer++)
        result = copy_layer(&run, layer, tail);
    if (run.slots && tail)
        slc_bake_jobs_help_until(copy->jobs, all_are_free, &run);
    slc_free(cb, run.slots, run.slot_count, sizeof *run.slots);
    slc_free(cb, tail, copy->layout.tailSize, 1);
    return result == SLUICE_SUCCESS ? run.result : result;
}
