/*
 * Opening of images on worker threads. An image is opened by a read of one texel of the image
 * source "opener": the texel is the image's base color, and its memory is part of the image. So
 * opening is a read like others.
 */
#include "demand_vulkan/opening.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "demand/tail_place.h"
#include "image/convert.h"
#include "image/format_size.h"
#include "image/info.h"
#include "image/start_read.h"
#include "vulkan/sparse_layout.h"

#include <assert.h>
#include <string.h>

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    (void)source;
    *info = (SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                              .width = 1,
                              .height = 1,
                              .mipLevelCount = 1,
                              .format = SLUICE_FORMAT_R32G32B32A32_SFLOAT,
                              .pName = ""};
    return SLUICE_SUCCESS;
}

const char *slc_image_trouble(const SluiceDemandLoader *loader, const SluiceImageInfo *info,
                              uint32_t array_layer)
{
    const char *trouble = slc_image_info_trouble(info, SLC_LEVELS_TO_TAIL);
    if (trouble)
        return trouble;
    if (array_layer >= slc_max_u32(info->arrayLayerCount, 1))
        return "arrayLayer is not below its arrayLayerCount";
    if (!loader->usable[info->format])
        return "the device does not sample and filter its format";
    uint32_t tile_width = 0, tile_height = 0;
    SluiceFormatInfo format = {.structSize = sizeof format};
    (void)sluiceGetFormatInfo(info->format, &format);
    (void)sluiceGetStandardTileShape(info->format, &tile_width, &tile_height);
    if (slc_demand_regular_count(info->width, info->height, tile_width, tile_height) >=
        info->mipLevelCount)
        return format.blockWidth > 1
                   ? "mipLevelCount ends before a level fits into half a tile; write the file "
                     "again with all levels"
                   : "mipLevelCount ends before a level fits into half a tile; build the others "
                     "with sluiceCreateCompleteChainSource";
    if (format.blockWidth > 4) /* levels of a mip tail begin at multiples of 4 texels */
        return "its format has blocks larger than 4x4, which demand loading does not read";
    return NULL;
}

static SluiceResult open_source(struct slc_demand_image *image)
{
    if (!image->source) {
        SluiceImageSource *source = NULL;
        SluiceResult result = image->origin.pfnOpen(image->origin.pUserData, &source);
        if (result != SLUICE_SUCCESS)
            return result;
        if (!source)
            return SLUICE_ERROR_NULL_POINTER;
        image->source = source;
    }
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetImageInfo(image->source, &info);
    if (result != SLUICE_SUCCESS || image->info.width)
        return result;
    image->info = info;
    image->trouble = slc_image_trouble(image->loader, &image->info, image->origin.arrayLayer);
    return image->trouble ? SLUICE_ERROR_UNSUPPORTED : SLUICE_SUCCESS;
}

/* Computes the mean of the last level, from one texel per block. Full chains have one texel there.
 */
static void find_base_color(const SluiceImageInfo *info, const uint8_t *texels, uint32_t count,
                            float rgba[4])
{
    SluiceFormatInfo format = {.structSize = sizeof format};
    double sum[4] = {0};
    (void)sluiceGetFormatInfo(info->format, &format);
    for (uint32_t i = 0; i < count; i++) {
        slc_base_color(info->format, texels + (size_t)i * format.blockSize, rgba);
        for (uint32_t c = 0; c < 4; c++)
            sum[c] += rgba[c];
    }
    for (uint32_t c = 0; c < 4 && count > 1; c++)
        rgba[c] = (float)(sum[c] / count);
}

/* Last level of an image. It fits into half a tile in both directions. */
struct last_level {
    SluiceImageRegion region;
    size_t pitch, size; ///< bytes
    uint32_t block_count;
};

static struct last_level last_level_of(const struct slc_demand_image *image)
{
    const SluiceImageInfo *info = &image->info;
    SluiceFormatInfo format = {.structSize = sizeof format};
    (void)sluiceGetFormatInfo(info->format, &format);
    struct last_level last = {
        .region = {.mipLevel = info->mipLevelCount - 1, .arrayLayer = image->origin.arrayLayer}};
    last.region.width = slc_mip_size(info->width, last.region.mipLevel);
    last.region.height = slc_mip_size(info->height, last.region.mipLevel);
    last.pitch = (size_t)slc_format_row_size(&format, last.region.width);
    last.size = last.pitch * slc_format_row_count(&format, last.region.height);
    last.block_count = (uint32_t)(last.size / format.blockSize);
    return last;
}

static SluiceResult read_base_color(struct slc_demand_image *image)
{
    _Alignas(16) uint8_t texels[SLC_TILE_SIZE / 4];
    const struct last_level last = last_level_of(image);
    assert(last.size <= sizeof texels);
    SluiceResult result = sluiceReadImageRegion(image->source, &last.region, texels, last.pitch);
    if (result == SLUICE_SUCCESS)
        find_base_color(&image->info, texels, last.block_count, image->read_color);
    return result;
}

/* Notes the ticket of a started read, by which a cancel on any thread finds it. */
static void note_started(struct slc_demand_image *image, uint64_t ticket)
{
    SluiceDemandLoader *loader = image->loader;
    slc_mutex_lock(&loader->tickets.mutex);
    image->started_as = ticket;
    image->next_started = loader->first_started;
    loader->first_started = image;
    slc_mutex_unlock(&loader->tickets.mutex);
}

static void forget_started(struct slc_demand_image *image)
{
    SluiceDemandLoader *loader = image->loader;
    slc_mutex_lock(&loader->tickets.mutex);
    struct slc_demand_image **link = &loader->first_started;
    while (*link != image)
        link = &(*link)->next_started;
    *link = image->next_started;
    slc_mutex_unlock(&loader->tickets.mutex);
}

static void drop_last_level(struct slc_demand_image *image)
{
    if (!image->last_level)
        return;
    forget_started(image);
    slc_free(&image->loader->cb, image->last_level, last_level_of(image).size, 1);
    image->last_level = NULL;
}

/* Starts the read of the last level. Its token is the opener's, so the source completes that read.
 */
static SluiceResult start_base_color(struct slc_demand_image *image,
                                     const SluiceImageReadToken *token)
{
    const struct last_level last = last_level_of(image);
    if (!image->last_level) { /* otherwise kept from an earlier attempt with an equal ticket */
        image->last_level = slc_alloc(&image->loader->cb, last.size, 1);
        if (!image->last_level)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        note_started(image, token->ticket);
    }
    SluiceResult result = slc_start_read(image->source, &image->info, &last.region,
                                         image->last_level, last.pitch, token);
    if (result != SLUICE_SUCCESS)
        drop_last_level(image);
    return result;
}

void slc_image_end_opening(struct slc_demand_image *image, bool is_read)
{
    if (image->last_level && is_read)
        find_base_color(&image->info, image->last_level, last_level_of(image).block_count,
                        image->read_color);
    drop_last_level(image);
}

static struct slc_demand_image *image_of(void *texels)
{
    return (void *)((char *)texels - offsetof(struct slc_demand_image, read_color));
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    (void)source, (void)region, (void)row_pitch;
    struct slc_demand_image *image = image_of(texels);
    if (image->is_refused)
        return SLUICE_ERROR_UNSUPPORTED;
    SluiceResult result = open_source(image);
    return result == SLUICE_SUCCESS ? read_base_color(image) : result;
}

/* Starts a read. UNSUPPORTED: the caller uses read_region instead. */
static SluiceResult start_read(SluiceImageSource *source, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch, const SluiceImageReadToken *token)
{
    (void)source, (void)region, (void)row_pitch;
    struct slc_demand_image *image = image_of(texels);
    SluiceResult result = image->trouble ? SLUICE_ERROR_UNSUPPORTED : open_source(image);
    image->is_refused = result == SLUICE_ERROR_UNSUPPORTED;
    if (result != SLUICE_SUCCESS)
        return result;
    return slc_starts_reads(image->source) ? start_base_color(image, token)
                                           : SLUICE_ERROR_UNSUPPORTED;
}

/* Cancels a read. The image stays until the read is collected, which is after this call. */
static void cancel_read(SluiceImageSource *source, const SluiceImageRegion *region,
                        const SluiceImageReadToken *token)
{
    (void)region;
    SluiceDemandLoader *loader =
        (void *)((char *)source - offsetof(struct SluiceDemandLoader, opener));
    slc_mutex_lock(&loader->tickets.mutex);
    struct slc_demand_image *image = loader->first_started;
    while (image && image->started_as != token->ticket)
        image = image->next_started;
    slc_mutex_unlock(&loader->tickets.mutex);
    if (!image)
        return;
    const struct last_level last = last_level_of(image);
    slc_cancel_read(image->source, &last.region, token);
}

static void destroy(SluiceImageSource *source)
{
    (void)source;
}

static const SluiceImageSourceInterface interface = {.structSize = sizeof interface,
                                                     .pfnGetInfo = get_info,
                                                     .pfnReadRegion = read_region,
                                                     .pfnDestroy = destroy,
                                                     .pfnStartRead = start_read,
                                                     .pfnCancelRead = cancel_read};

void slc_image_opener_init(SluiceImageSource *opener)
{
    opener->pInterface = &interface;
}
