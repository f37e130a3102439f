/* Settings that can change while a streamer runs. */
#include "vulkan/streamer.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/struct_size.h"
#include "core/observer.h"
#include "vulkan/create_checks.h"
#include "vulkan/shrink.h"

#include <stddef.h>

/* Arrays whose size depends on tilesPerFrame. */
struct tile_arrays {
    uint32_t tile_count;
    uint32_t *frame_units;
    VkBufferImageCopy *copies;
    SluiceTile *tiles;
    uint32_t *tile_indices;
};

static void tile_arrays_finish(const struct tile_arrays *arrays,
                               const SluiceAllocationCallbacks *cb)
{
    uint32_t count = arrays->tile_count;
    slc_free(cb, arrays->frame_units, count, sizeof *arrays->frame_units);
    slc_free(cb, arrays->copies, count * SLUICE_MAX_READ_REGIONS, sizeof *arrays->copies);
    slc_free(cb, arrays->tiles, count, sizeof *arrays->tiles);
    slc_free(cb, arrays->tile_indices, count, sizeof *arrays->tile_indices);
}

static SluiceResult tile_arrays_init(struct tile_arrays *arrays,
                                     const SluiceAllocationCallbacks *cb, uint32_t count)
{
    *arrays = (struct tile_arrays){
        .tile_count = count,
        .frame_units = slc_alloc(cb, count, sizeof *arrays->frame_units),
        .copies = slc_alloc(cb, count * SLUICE_MAX_READ_REGIONS, sizeof *arrays->copies),
        .tiles = slc_alloc(cb, count, sizeof *arrays->tiles),
        .tile_indices = slc_alloc(cb, count, sizeof *arrays->tile_indices)};
    if (arrays->frame_units && arrays->copies && arrays->tiles && arrays->tile_indices)
        return SLUICE_SUCCESS;
    tile_arrays_finish(arrays, cb);
    return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/* Replaces the arrays, which are empty between frames. */
static SluiceResult set_tiles_per_frame(SluiceVulkanStreamer *s, uint32_t count)
{
    if (count == s->info.tilesPerFrame)
        return SLUICE_SUCCESS;
    struct tile_arrays old = {s->info.tilesPerFrame, s->frame_units, s->copies, s->tiles,
                              s->tile_indices},
                       made;
    SluiceResult result = tile_arrays_init(&made, &s->cb, count);
    if (result != SLUICE_SUCCESS)
        return result;
    tile_arrays_finish(&old, &s->cb);
    s->frame_units = made.frame_units;
    s->copies = made.copies;
    s->tiles = made.tiles;
    s->tile_indices = made.tile_indices;
    s->copy_capacity = count * SLUICE_MAX_READ_REGIONS;
    s->info.tilesPerFrame = count;
    return SLUICE_SUCCESS;
}

void slc_settings_apply(SluiceVulkanStreamer *s)
{
    s->info.texturesPerFrame = s->next_textures_per_frame;
    s->info.framesPerRound = s->next_frames_per_round;
}

SluiceResult sluiceGetVulkanStreamerSettings(const SluiceVulkanStreamer *streamer,
                                             SluiceVulkanStreamerSettings *pSettings)
{
    if (!streamer || !pSettings)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceVulkanStreamerSettings);
    SluiceResult result = slc_struct_check(type, pSettings, &streamer->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceStreamedTextureManagerConfig *config = slc_manager_config(streamer->manager);
    SluiceVulkanStreamerSettings settings = {
        .structSize = sizeof settings,
        .texturesPerFrame = streamer->next_textures_per_frame,
        .tilesPerFrame = streamer->info.tilesPerFrame,
        .numExtraStandbyTiles = config->numExtraStandbyTiles,
        .maxHeapCount = config->maxHeapCount,
        .feedbackTimeoutTicks = streamer->info.feedbackTimeoutTicks,
        .residencyFadeTicks = streamer->info.residencyFadeTicks,
        .retryDelayTicks = config->retryDelayTicks,
        .givenUpRetryDelayTicks = config->givenUpRetryDelayTicks,
        .noEviction = config->noEviction,
        .noMipBias = config->noMipBias,
        .framesPerRound = streamer->next_frames_per_round,
        .holdLoads = streamer->hold_loads,
        .missesToExpire = config->missesToExpire,
        .prefetchLevels = config->prefetchLevels};
    slc_struct_write(type, pSettings, &settings);
    return SLUICE_SUCCESS;
}

static SluiceResult check(const SluiceVulkanStreamer *s,
                          const SluiceVulkanStreamerSettings *settings)
{
    const struct slc_limit limits[] = {
        {"texturesPerFrame", settings->texturesPerFrame, 1, s->most_textures_per_frame},
        {"tilesPerFrame", settings->tilesPerFrame, 1, SLC_MAX_TILES_PER_FRAME},
        {"residencyFadeTicks", settings->residencyFadeTicks, 0, SLC_MAX_FADE_TIME},
    };
    return slc_check_limits(&s->vk.log, limits, sizeof limits / sizeof limits[0]);
}

/* True if the struct has the fields of expiry. Older ones leave them to sluiceSetConfig. */
static bool has_expiry(uint32_t size)
{
    return size >= offsetof(SluiceVulkanStreamerSettings, prefetchLevels) + sizeof(uint32_t);
}

static SluiceResult set_config(SluiceVulkanStreamer *s,
                               const SluiceVulkanStreamerSettings *settings, bool with_expiry)
{
    SluiceStreamedTextureManagerConfig config = *slc_manager_config(s->manager);
    config.numExtraStandbyTiles = settings->numExtraStandbyTiles;
    config.maxHeapCount = settings->maxHeapCount;
    config.retryDelayTicks = settings->retryDelayTicks;
    config.givenUpRetryDelayTicks = settings->givenUpRetryDelayTicks;
    config.noEviction = settings->noEviction;
    config.noMipBias = settings->noMipBias;
    if (with_expiry) {
        config.missesToExpire = settings->missesToExpire;
        config.prefetchLevels = settings->prefetchLevels;
    }
    return slc_shrink_set_config(s, &config);
}

SluiceResult sluiceSetVulkanStreamerSettings(SluiceVulkanStreamer *streamer,
                                             const SluiceVulkanStreamerSettings *pSettings)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s || !pSettings)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceVulkanStreamerSettings settings;
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceVulkanStreamerSettings), &settings, pSettings, &s->vk.log);
    if (result == SLUICE_SUCCESS)
        result = check(s, &settings);
    if (result == SLUICE_SUCCESS) /* the only step that can fail comes first */
        result = set_tiles_per_frame(s, settings.tilesPerFrame);
    if (result == SLUICE_SUCCESS)
        result = set_config(s, &settings, has_expiry(pSettings->structSize));
    if (result != SLUICE_SUCCESS)
        return result;
    s->next_textures_per_frame = settings.texturesPerFrame;
    s->next_frames_per_round = settings.framesPerRound;
    s->hold_loads = settings.holdLoads;
    s->load_steps = settings.holdLoads ? s->load_steps : 0;
    s->info.feedbackTimeoutTicks = settings.feedbackTimeoutTicks;
    s->info.residencyFadeTicks = settings.residencyFadeTicks;
    s->fade_clock.time_per_level = settings.residencyFadeTicks;
    s->info.retryDelayTicks = settings.retryDelayTicks;
    s->info.givenUpRetryDelayTicks = settings.givenUpRetryDelayTicks;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceStepVulkanLoads(SluiceVulkanStreamer *streamer, uint32_t tileCount)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s)
        return SLUICE_ERROR_NULL_POINTER;
    if (s->hold_loads)
        s->load_steps += slc_min_u32(tileCount, UINT32_MAX - s->load_steps);
    return SLUICE_SUCCESS;
}
