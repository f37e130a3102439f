#include "bake/levels.h"

#include "base/alloc.h"
#include "base/checked.h"

static SluiceResult on_row(void *user, uint32_t level, uint32_t y, const float *rgba)
{
    struct slc_baking *baking = user;
    uint32_t width = slc_mip_size(baking->picture->width, level);
    if (baking->counts) {
        slc_coverage_add(&baking->coverage, level, rgba, width);
        return SLUICE_SUCCESS;
    }
    void *texels = slc_tiler_begin_row(&baking->tiler, level, y);
    if (!texels)
        return slc_tiler_result(&baking->tiler);
    slc_write_texels(&baking->plan.rules, rgba, baking->alpha_scales[level], texels, width);
    slc_tiler_end_row(&baking->tiler, level, y);
    return SLUICE_SUCCESS;
}

static struct slc_pyramid_info pyramid_info(const struct slc_picture *picture,
                                            const struct slc_plan *plan, void *user)
{
    return (struct slc_pyramid_info){.width = picture->width,
                                     .height = picture->height,
                                     .filter = plan->settings.filter,
                                     .wrap_x = plan->settings.wrapX,
                                     .wrap_y = plan->settings.wrapY,
                                     .may_overflow = plan->rules.sample == SLC_SAMPLE_F32,
                                     .user = user,
                                     .row = on_row};
}

uint64_t slc_baking_memory(const struct slc_picture *picture, const struct slc_plan *plan,
                           const SluiceStoreLayout *layout)
{
    struct slc_pyramid_info info = pyramid_info(picture, plan, NULL);
    uint64_t size = slc_pyramid_memory(&info) + 4 * sizeof(float) * (uint64_t)picture->width;
    size += slc_tiler_memory(layout, plan->rules.format, plan->reaches_around);
    return size + (plan->threshold > 0.0f ? slc_coverage_memory(plan->level_count) : 0);
}

SluiceResult slc_baking_init(struct slc_baking *baking, struct slc_bake_jobs *jobs,
                             const SluiceStoreLayout *layout)
{
    const SluiceAllocationCallbacks *cb = &baking->allocator;
    const struct slc_plan *plan = &baking->plan;
    struct slc_pyramid_info info = pyramid_info(baking->picture, plan, baking);
    for (uint32_t level = 0; level < SLC_MAX_LEVELS; level++)
        baking->alpha_scales[level] = 1.0f;
    baking->row = slc_alloc(cb, 4 * (size_t)baking->picture->width, sizeof(float));
    SluiceResult result = baking->row ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS)
        result = slc_pyramid_init(&baking->pyramid, cb, &info);
    if (result == SLUICE_SUCCESS && plan->threshold > 0.0f)
        result = slc_coverage_init(&baking->coverage, cb, plan->level_count);
    if (result == SLUICE_SUCCESS)
        result = slc_tiler_init(&baking->tiler, cb, jobs, layout, plan->rules.format,
                                plan->reaches_around);
    return result;
}

void slc_baking_finish(struct slc_baking *baking)
{
    const SluiceAllocationCallbacks *cb = &baking->allocator;
    slc_tiler_finish(&baking->tiler);
    slc_coverage_finish(&baking->coverage, cb);
    slc_pyramid_finish(&baking->pyramid, cb);
    slc_free(cb, baking->row, 4 * (size_t)baking->picture->width, sizeof(float));
    baking->row = NULL;
}

static SluiceResult write_kept_row(struct slc_baking *baking, uint32_t y, const void *samples)
{
    void *texels = slc_tiler_begin_row(&baking->tiler, 0, y);
    if (!texels)
        return slc_tiler_result(&baking->tiler);
    slc_copy_samples(&baking->plan.rules, samples, texels, baking->picture->width);
    slc_tiler_end_row(&baking->tiler, 0, y);
    return SLUICE_SUCCESS;
}

static SluiceResult bake_row(struct slc_baking *baking, uint32_t y)
{
    struct slc_picture *picture = baking->picture;
    const struct slc_rules *rules = &baking->plan.rules;
    const void *samples;
    SluiceResult result = picture->implementation->row(picture, y, &samples);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_replaced counted_before = {0};
    slc_read_texels(rules, samples, baking->row, picture->width,
                    baking->counts ? &counted_before : &baking->replaced);
    if (slc_keeps_samples(rules) && !baking->counts)
        result = write_kept_row(baking, y, samples);
    else
        result = on_row(baking, 0, y, baking->row);
    return result == SLUICE_SUCCESS ? slc_pyramid_push(&baking->pyramid, baking->row) : result;
}

static SluiceResult bake_rows(struct slc_baking *baking)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t y = 0; y < baking->picture->height && result == SLUICE_SUCCESS; y++) {
        result = bake_row(baking, y);
        baking->done += baking->picture->width;
        if (result == SLUICE_SUCCESS && y % 16 == 0 && baking->progress &&
            !baking->progress(baking->user, baking->done, baking->total))
            result = SLUICE_ERROR_CANCELED;
    }
    return result;
}

static SluiceResult count_alpha(struct slc_baking *baking)
{
    baking->counts = true;
    SluiceResult result = bake_rows(baking);
    baking->counts = false;
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t level = 0; level < baking->plan.level_count; level++)
        baking->alpha_scales[level] =
            slc_coverage_scale(&baking->coverage, level, baking->plan.threshold);
    slc_pyramid_rewind(&baking->pyramid);
    return baking->picture->implementation->rewind(baking->picture);
}

SluiceResult slc_baking_run(struct slc_baking *baking, SluiceStoreWriter *writer)
{
    SluiceResult result = SLUICE_SUCCESS;
    uint64_t texels = (uint64_t)baking->picture->width * baking->picture->height;
    baking->tiler.writer = writer;
    baking->tiler.layer = baking->layer;
    baking->tiler.next_turn = baking->next_turn;
    baking->tiler.encoder = (struct slc_block_encoder){baking->plan.format,
                                                       baking->plan.settings.quality, baking->astc};
    texels = baking->plan.threshold > 0.0f ? 2 * texels : texels;
    baking->done = baking->layer * texels;
    baking->total = baking->layer_count * texels;
    if (baking->plan.threshold > 0.0f)
        result = count_alpha(baking);
    if (result == SLUICE_SUCCESS)
        result = bake_rows(baking);
    if (result == SLUICE_SUCCESS)
        result = slc_tiler_complete(&baking->tiler);
    return result;
}
