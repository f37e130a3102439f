#include "bake/tiler.h"

#include "bake/blocks.h"
#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

static void plan(struct slc_tiler *tiler, const SluiceStoreLayout *layout,
                 SluiceFormat texel_format, bool reaches_around)
{
    size_t texel_size = sluiceGetFormatTexelSize(texel_format);
    *tiler = (struct slc_tiler){.layout = *layout, .texel_format = texel_format};
    uint32_t level_count = slc_min_u32(layout->mipLevelCount, SLUICE_STORE_MAX_MIP_LEVELS);
    for (uint32_t l = 0; l < level_count; l++) {
        struct slc_tiler_level *level = &tiler->levels[l];
        level->width = slc_mip_size(layout->width, l);
        level->height = slc_mip_size(layout->height, l);
        if (l < layout->tailFirstLevel) {
            level->band_count =
                slc_min_u32(layout->levelHeightInTiles[l], reaches_around && l > 0 ? 3 : 2);
        } else {
            level->tail_offset = tiler->tail_size;
            tiler->tail_size += (size_t)level->width * level->height * texel_size;
        }
    }
}

static size_t band_size(const struct slc_tiler *tiler, uint32_t l)
{
    const struct slc_tiler_level *level = &tiler->levels[l];
    return (size_t)level->width * slc_min_u32(tiler->layout.tileHeight, level->height) *
           sluiceGetFormatTexelSize(tiler->texel_format);
}

uint64_t slc_tiler_memory(const SluiceStoreLayout *layout, SluiceFormat texel_format,
                          bool reaches_around)
{
    struct slc_tiler tiler;
    plan(&tiler, layout, texel_format, reaches_around);
    uint64_t size = tiler.tail_size;
    for (uint32_t l = 0; l < layout->tailFirstLevel; l++)
        size += tiler.levels[l].band_count *
                (band_size(&tiler, l) +
                 (uint64_t)layout->levelWidthInTiles[l] * sizeof(struct slc_tile_job));
    return size;
}

static SluiceResult init_band(struct slc_tiler *tiler, struct slc_band *band, uint32_t l)
{
    uint32_t tile_count = tiler->layout.levelWidthInTiles[l];
    band->tiler = tiler;
    band->level = l;
    band->texels = slc_alloc(&tiler->allocator, band_size(tiler, l), 1);
    band->jobs = slc_alloc(&tiler->allocator, tile_count, sizeof *band->jobs);
    return band->texels && band->jobs ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

SluiceResult slc_tiler_init(struct slc_tiler *tiler, const SluiceAllocationCallbacks *cb,
                            struct slc_bake_jobs *jobs, const SluiceStoreLayout *layout,
                            SluiceFormat texel_format, bool reaches_around)
{
    plan(tiler, layout, texel_format, reaches_around);
    tiler->allocator = *cb;
    tiler->jobs = jobs;
    tiler->tail = slc_alloc(cb, tiler->tail_size, 1);
    SluiceResult result = tiler->tail ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t l = 0; l < layout->tailFirstLevel; l++)
        for (uint32_t b = 0; b < tiler->levels[l].band_count && result == SLUICE_SUCCESS; b++)
            result = init_band(tiler, &tiler->levels[l].bands[b], l);
    return result;
}

static bool all_is_written(void *user)
{
    const struct slc_tiler *tiler = user;
    for (uint32_t l = 0; l < tiler->layout.tailFirstLevel; l++)
        for (uint32_t b = 0; b < tiler->levels[l].band_count; b++)
            if (tiler->levels[l].bands[b].pending)
                return false;
    return true;
}

void slc_tiler_finish(struct slc_tiler *tiler)
{
    if (!tiler->jobs)
        return;
    slc_bake_jobs_help_until(tiler->jobs, all_is_written, tiler);
    for (uint32_t l = 0; l < tiler->layout.tailFirstLevel; l++)
        for (uint32_t b = 0; b < tiler->levels[l].band_count; b++) {
            struct slc_band *band = &tiler->levels[l].bands[b];
            slc_free(&tiler->allocator, band->texels, band_size(tiler, l), 1);
            slc_free(&tiler->allocator, band->jobs, tiler->layout.levelWidthInTiles[l],
                     sizeof *band->jobs);
        }
    slc_free(&tiler->allocator, tiler->tail, tiler->tail_size, 1);
    tiler->jobs = NULL;
}

/* Writes the tile in the job's turn. With NULL texels, only ends the turn. */
static SluiceResult end_turn(const struct slc_tile_job *job, const void *texels, size_t pitch)
{
    const struct slc_tiler *tiler = job->band->tiler;
    return sluiceWriteStoreTileInTurn(tiler->writer, job->turn, tiler->layer, job->band->level,
                                      job->x, job->band->y, texels, pitch);
}

/* Writes an encoded tile. Ends the turn on success only. */
static SluiceResult write_encoded(const struct slc_tile_job *job, const SluiceImageRegion *region,
                                  const char *texels, size_t pitch, bool *has_ended)
{
    struct slc_tiler *tiler = job->band->tiler;
    SluiceFormat format = tiler->layout.format;
    *has_ended = format == tiler->texel_format;
    if (*has_ended)
        return end_turn(job, texels, pitch);
    size_t size = (size_t)sluiceGetFormatRegionSize(format, region->width, region->height);
    void *blocks = slc_alloc(&tiler->allocator, size, 1);
    if (!blocks)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result =
        slc_encode_blocks(&tiler->encoder, texels, pitch, region->width, region->height, blocks);
    *has_ended = result == SLUICE_SUCCESS;
    if (*has_ended)
        result = end_turn(job, blocks, (size_t)sluiceGetFormatRegionSize(format, region->width, 1));
    slc_free(&tiler->allocator, blocks, size, 1);
    return result;
}

static SluiceResult write_tile(const struct slc_tile_job *job, bool *found, bool *has_ended)
{
    struct slc_band *band = job->band;
    struct slc_tiler *tiler = band->tiler;
    SluiceImageRegion region;
    SluiceResult result =
        sluiceIsStoreTileWritten(tiler->writer, tiler->layer, band->level, job->x, band->y, found);
    if (result != SLUICE_SUCCESS || *found)
        return result;
    result = sluiceGetStoreTileRegion(&tiler->layout, band->level, job->x, band->y, &region);
    if (result != SLUICE_SUCCESS)
        return result;
    size_t texel_size = sluiceGetFormatTexelSize(tiler->texel_format);
    return write_encoded(job, &region, band->texels + region.x * texel_size,
                         tiler->levels[band->level].width * texel_size, has_ended);
}

static void run_tile_job(struct slc_job *base)
{
    struct slc_tile_job *job = (struct slc_tile_job *)base;
    struct slc_tiler *tiler = job->band->tiler;
    struct slc_bake_jobs *jobs = tiler->jobs;
    bool found = false, has_ended = false;
    SluiceResult result = slc_tiler_result(tiler);
    if (result == SLUICE_SUCCESS)
        result = write_tile(job, &found, &has_ended);
    if (!has_ended)
        end_turn(job, NULL, 0);
    slc_bake_jobs_lock(jobs);
    if (tiler->result == SLUICE_SUCCESS)
        tiler->result = result;
    tiler->found_tile_count += found;
    job->band->pending--;
    slc_bake_jobs_unlock_and_wake(jobs);
}

SluiceResult slc_tiler_result(struct slc_tiler *tiler)
{
    slc_bake_jobs_lock(tiler->jobs);
    SluiceResult result = tiler->result;
    slc_mutex_unlock(&tiler->jobs->mutex);
    return result;
}

static struct slc_band *find_open_band(struct slc_tiler_level *level, uint32_t y)
{
    for (uint32_t b = 0; b < level->band_count; b++)
        if (level->bands[b].is_open && level->bands[b].y == y)
            return &level->bands[b];
    return NULL;
}

static bool has_free_band(void *user)
{
    const struct slc_tiler_level *level = user;
    for (uint32_t b = 0; b < level->band_count; b++)
        if (!level->bands[b].is_open && level->bands[b].pending == 0)
            return true;
    return false;
}

static struct slc_band *open_band(struct slc_tiler *tiler, struct slc_tiler_level *level,
                                  uint32_t y)
{
    slc_bake_jobs_help_until(tiler->jobs, has_free_band, level);
    struct slc_band *band = level->bands;
    slc_bake_jobs_lock(tiler->jobs);
    while (band->is_open || band->pending)
        band++;
    slc_mutex_unlock(&tiler->jobs->mutex);
    band->is_open = true;
    band->y = y;
    band->row_count = 0;
    return band;
}

void *slc_tiler_begin_row(struct slc_tiler *tiler, uint32_t l, uint32_t y)
{
    struct slc_tiler_level *level = &tiler->levels[l];
    size_t pitch = level->width * (size_t)sluiceGetFormatTexelSize(tiler->texel_format);
    if (l >= tiler->layout.tailFirstLevel)
        return tiler->tail + level->tail_offset + y * pitch;
    uint32_t tile_height = tiler->layout.tileHeight;
    struct slc_band *band = find_open_band(level, y / tile_height);
    if (!band) {
        if (slc_tiler_result(tiler) != SLUICE_SUCCESS)
            return NULL;
        band = open_band(tiler, level, y / tile_height);
    }
    return band->texels + y % tile_height * pitch;
}

void slc_tiler_end_row(struct slc_tiler *tiler, uint32_t l, uint32_t y)
{
    if (l >= tiler->layout.tailFirstLevel)
        return;
    struct slc_tiler_level *level = &tiler->levels[l];
    uint32_t tile_height = tiler->layout.tileHeight;
    struct slc_band *band = find_open_band(level, y / tile_height);
    assert(band);
    band->row_count++;
    if (band->row_count < slc_min_u32(tile_height, level->height - band->y * tile_height))
        return;
    uint32_t tile_count = tiler->layout.levelWidthInTiles[l];
    slc_bake_jobs_lock(tiler->jobs);
    band->is_open = false;
    band->pending = tile_count;
    slc_mutex_unlock(&tiler->jobs->mutex);
    for (uint32_t x = 0; x < tile_count; x++) {
        band->jobs[x] = (struct slc_tile_job){
            .base.run = run_tile_job, .band = band, .x = x, .turn = (*tiler->next_turn)++};
        slc_bake_jobs_submit(tiler->jobs, &band->jobs[x].base);
    }
}

static SluiceResult encode_tail(struct slc_tiler *tiler, const void **levels, char *blocks)
{
    const SluiceStoreLayout *layout = &tiler->layout;
    size_t texel_size = sluiceGetFormatTexelSize(tiler->texel_format);
    for (uint32_t l = layout->tailFirstLevel; l < layout->mipLevelCount; l++) {
        const struct slc_tiler_level *level = &tiler->levels[l];
        const void *texels = tiler->tail + level->tail_offset;
        if (blocks) {
            SluiceResult result =
                slc_encode_blocks(&tiler->encoder, texels, level->width * texel_size, level->width,
                                  level->height, blocks);
            if (result != SLUICE_SUCCESS)
                return result;
            texels = blocks;
            blocks += sluiceGetFormatRegionSize(layout->format, level->width, level->height);
        }
        levels[l - layout->tailFirstLevel] = texels;
    }
    return sluiceWriteStoreTail(tiler->writer, tiler->layer, levels, NULL);
}

static SluiceResult write_tail(struct slc_tiler *tiler)
{
    const SluiceStoreLayout *layout = &tiler->layout;
    const void *levels[SLUICE_STORE_MAX_MIP_LEVELS];
    bool found = false;
    SluiceResult result =
        sluiceIsStoreTileWritten(tiler->writer, tiler->layer, layout->tailFirstLevel, 0, 0, &found);
    if (result != SLUICE_SUCCESS || found)
        return result;
    if (layout->format == tiler->texel_format)
        return encode_tail(tiler, levels, NULL);
    char *blocks = slc_alloc(&tiler->allocator, layout->tailSize, 1);
    if (!blocks)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    result = encode_tail(tiler, levels, blocks);
    slc_free(&tiler->allocator, blocks, layout->tailSize, 1);
    return result;
}

SluiceResult slc_tiler_complete(struct slc_tiler *tiler)
{
    slc_bake_jobs_help_until(tiler->jobs, all_is_written, tiler);
    SluiceResult result = slc_tiler_result(tiler);
    return result == SLUICE_SUCCESS ? write_tail(tiler) : result;
}
