/* Reload of textures whose source has changed, and replacement of sources. */
#include "base/checked.h"
#include "base/log.h"
#include "image/info.h"
#include "image/pooled_reads.h"
#include "vulkan/load_reloads.h"
#include "vulkan/remakes.h"
#include "vulkan/source_uses.h"
#include "vulkan/texture_rect.h"

static const char *name_of(const struct slc_texture *texture)
{
    return texture->info.pName ? texture->info.pName : "image";
}

/* Counts the tiles that may need a reload. Tiles being loaded count: they may be resident by then.
 */
static uint32_t most_reloads(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                             const struct slc_remake_area *area)
{
    const SluiceStreamedTextureDesc *desc = &texture->image.desc;
    SluiceTextureStatistics now = {.structSize = sizeof now};
    uint64_t count =
        slc_remake_count(area, desc->regularMipCount, desc->tileWidth, desc->tileHeight);
    sluiceGetTextureStatistics(s->manager, texture->id, &now);
    uint64_t most = (uint64_t)now.residentTileCount + s->info.maxLoadsInFlight + 1;
    return (uint32_t)(count < most ? count : most);
}

/* Reloads the changed tiles of a level. The rectangle may be halved beyond the edge of odd levels.
 */
static void change_level(SluiceVulkanStreamer *s, uint32_t index,
                         const struct slc_remake_area *area, uint32_t level)
{
    const struct slc_texture *texture = &s->textures[index];
    const SluiceStreamedTextureLayout *layout = &texture->layout;
    struct slc_remake_tiles t =
        slc_remake_tiles(area, level, layout->desc.tileWidth, layout->desc.tileHeight);
    uint32_t width = layout->levelWidthInTiles[level], height = layout->levelHeightInTiles[level];
    for (uint32_t y = t.y; y < slc_min_u32(t.end_y, height); y++)
        for (uint32_t x = t.x; x < slc_min_u32(t.end_x, width); x++)
            slc_reload_tile(s, index, layout->levelFirstTile[level] + y * width + x);
}

/* Retries failed loads, which may succeed after the change. */
static void retry_failed(SluiceVulkanStreamer *s, uint32_t index)
{
    SluiceTextureStatistics now = {.structSize = sizeof now};
    sluiceGetTextureStatistics(s->manager, s->textures[index].id, &now);
    if (now.failedTotal > 0)
        slc_streamer_check(s, sluiceRetryFailedTiles(s->manager, s->textures[index].id),
                           "sluiceRetryFailedTiles");
}

static void change(SluiceVulkanStreamer *s, uint32_t index, const struct slc_remake_area *area)
{
    uint32_t regular = s->textures[index].layout.desc.regularMipCount;
    for (uint32_t level = 0; level < regular; level++)
        change_level(s, index, area, level);
    if (slc_remake_meets_tail(area, regular))
        slc_reload_tail(s, index);
    retry_failed(s, index);
}

static SluiceResult find(const SluiceVulkanStreamer *s, SluiceTextureId id,
                         struct slc_texture **texture)
{
    SluiceResult result = slc_streamer_find(s, id, texture);
    if (result == SLUICE_SUCCESS && (*texture)->producer.pfn)
        return slc_log_refusal(&s->vk.log,
                               "%s: has a producer; only tiles of sources are read again: remove "
                               "the texture and add it",
                               name_of(*texture));
    return result;
}

SluiceResult sluiceInvalidateVulkanTexture(SluiceVulkanStreamer *streamer,
                                           SluiceTextureId textureId,
                                           const SluiceImageRegion *pRegion, uint32_t mipLevelCount)
{
    SluiceVulkanStreamer *s = streamer;
    struct slc_texture *texture;
    struct slc_remake_area area;
    if (!s)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = find(s, textureId, &texture);
    if (result == SLUICE_SUCCESS)
        result = slc_remake_area_read(&area, &texture->info, pRegion, mipLevelCount, __func__,
                                      &s->vk.log);
    if (result == SLUICE_SUCCESS)
        result = slc_reloads_reserve(s, most_reloads(s, texture, &area));
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t index = (uint32_t)(texture - s->textures);
    const struct slc_residency_interface *interface = texture->residency->interface;
    if (interface->drop_source)
        interface->drop_source(texture->residency, index);
    change(s, index, &area);
    slc_loader_drop_texels(s->loader, texture->source);
    return SLUICE_SUCCESS;
}

static uint32_t layers_of(const SluiceImageInfo *info)
{
    return slc_max_u32(1, info->arrayLayerCount);
}

static SluiceResult check_image(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                                SluiceImageInfo *info)
{
    const SluiceImageInfo *old = &texture->info;
    info->cube |= old->cube;
    if (info->width == old->width && info->height == old->height && info->format == old->format &&
        info->mipLevelCount == old->mipLevelCount && layers_of(info) == layers_of(old) &&
        info->cube == old->cube)
        return slc_image_info_check(info, SLC_LEVELS_TO_TAIL, &s->vk.log);
    return slc_log_refusal(
        &s->vk.log,
        "%s: the new source has %u x %u %s, %u levels, %u layers; the texture has %u x %u %s, %u "
        "levels, %u layers: remove the texture and add a new one",
        name_of(texture), info->width, info->height, sluiceGetFormatName(info->format),
        info->mipLevelCount, layers_of(info), old->width, old->height,
        sluiceGetFormatName(old->format), old->mipLevelCount, layers_of(old));
}

static void set_source(SluiceVulkanStreamer *s, uint32_t index, SluiceImageSource *source,
                       const SluiceImageInfo *info)
{
    struct slc_texture *texture = &s->textures[index];
    const struct slc_residency_interface *interface = texture->residency->interface;
    bool is_there = texture->presence == SLC_PRESENT;
    if (interface->leave_source && is_there)
        interface->leave_source(texture->residency, index);
    texture->source = source;
    texture->info = *info;
    if (interface->set_source && is_there)
        interface->set_source(texture->residency, index, source, texture->layer);
}

SluiceResult sluiceReplaceVulkanSource(SluiceVulkanStreamer *streamer, SluiceTextureId textureId,
                                       SluiceImageSource *source)
{
    SluiceVulkanStreamer *s = streamer;
    struct slc_texture *texture;
    struct slc_remake_area area;
    SluiceImageInfo info = {.structSize = sizeof info};
    if (!s || !source)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = find(s, textureId, &texture);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetImageInfo(source, &info);
    if (result == SLUICE_SUCCESS)
        result = check_image(s, texture, &info);
    if (result == SLUICE_SUCCESS)
        result = slc_remake_area_read(&area, &info, NULL, UINT32_MAX, __func__, &s->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    uint64_t most = 0;
    const uint32_t first = texture->first, count = texture->layer_count;
    for (uint32_t i = first; i < first + count; i++)
        most += most_reloads(s, &s->textures[i], &area);
    if (most > UINT32_MAX / 4)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    result = slc_reloads_reserve(s, (uint32_t)most);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceImageSource *before = texture->source;
    for (uint32_t i = first; i < first + count; i++) {
        set_source(s, i, source, &info);
        change(s, i, &area);
    }
    slc_loader_drop_texels(s->loader, before);
    slc_loader_drop_texels(s->loader, source);
    slc_source_left(s, before);
    return SLUICE_SUCCESS;
}
