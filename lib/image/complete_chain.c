/*
 * Adds the levels that another source lacks. Levels that fit into memory are built once, from top
 * to bottom, and kept. Finer ones are filtered whenever they are read, block by block.
 */
#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "image/format_size.h"
#include "image/identity.h"
#include "image/info.h"
#include "image/mip.h"
#include "image/start_read.h"
#include "platform/thread.h"

#include <stdatomic.h>

/* Size of blocks that are filtered at once, which bounds the memory of any read. */
#define BLOCK_WIDTH 256u
#define BLOCK_HEIGHT 64u

/* Coarse levels of an array layer. */
struct layer {
    struct slc_mip_chain kept; ///< its level 0 is `first_kept` of the image
    uint32_t row_count;        ///< rows of its level 0 that are built
    atomic_bool is_built;      ///< `kept` is constant from then on
};

struct complete_source {
    SluiceImageSource base;
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    SluiceImageSource *inner;
    uint64_t max_memory;
    struct slc_mutex mutex; ///< guards opening and building
    atomic_bool is_open;    ///< the next four fields are constant once true
    SluiceImageInfo info;
    uint32_t inner_count; ///< levels of `inner`
    uint32_t first_kept;
    uint32_t layer_count;
    struct layer *layers; ///< owned
};

/* Chooses the first level that is kept in memory. */
static uint32_t choose_kept(const struct complete_source *source)
{
    const SluiceImageInfo *info = &source->info;
    uint32_t level = source->inner_count;
    while (level < info->mipLevelCount &&
           slc_mip_chain_size(info->format, slc_mip_size(info->width, level),
                              slc_mip_size(info->height, level)) >
               source->max_memory / source->layer_count)
        level++;
    return level;
}

static SluiceResult describe(struct complete_source *source)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetImageInfo(source->inner, &info);
    if (result == SLUICE_SUCCESS)
        result = slc_image_info_check(&info, SLC_LEVELS_ANY, &source->log);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t full = slc_mip_count(slc_max_u32(info.width, info.height));
    if (info.mipLevelCount < full && sluiceGetFormatTexelSize(info.format) == 0) {
        slc_log(&source->log, SLUICE_LOG_ERROR,
                "%s: has %u of %u levels of %s, and levels of compressed formats cannot be built; "
                "write it again with all of them",
                info.pName ? info.pName : "image", info.mipLevelCount, full,
                sluiceGetFormatName(info.format));
        return SLUICE_ERROR_UNSUPPORTED;
    }
    source->info = info;
    source->info.mipLevelCount = full;
    source->inner_count = info.mipLevelCount;
    source->layer_count = slc_max_u32(1, info.arrayLayerCount);
    source->first_kept = choose_kept(source);
    if (source->first_kept == full)
        return SLUICE_SUCCESS;
    source->layers = slc_calloc(&source->allocator, source->layer_count, sizeof *source->layers);
    return source->layers ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/* Opens the source. A failure is not kept: the next read tries again. */
static SluiceResult ensure_open(struct complete_source *source)
{
    SluiceResult result = SLUICE_SUCCESS;
    if (atomic_load_explicit(&source->is_open, memory_order_acquire))
        return result;
    slc_mutex_lock(&source->mutex);
    if (!atomic_load_explicit(&source->is_open, memory_order_relaxed)) {
        result = describe(source);
        atomic_store_explicit(&source->is_open, result == SLUICE_SUCCESS, memory_order_release);
    }
    slc_mutex_unlock(&source->mutex);
    return result;
}

static struct slc_mip_part part_of_level(const struct complete_source *source, uint32_t level)
{
    return (struct slc_mip_part){.level_width = slc_mip_size(source->info.width, level),
                                 .level_height = slc_mip_size(source->info.height, level)};
}

static SluiceResult filter_region(struct complete_source *source, const SluiceImageRegion *region,
                                  char *texels, size_t pitch, SluiceImageFault *fault);

/* Filters one block of a level from the next finer level, which is read or filtered itself. */
static SluiceResult filter_block(struct complete_source *source, const SluiceImageRegion *block,
                                 char *texels, size_t pitch, SluiceImageFault *fault)
{
    const SluiceAllocationCallbacks *cb = &source->allocator;
    struct slc_mip_part coarse = part_of_level(source, block->mipLevel);
    struct slc_mip_part fine = part_of_level(source, block->mipLevel - 1);
    struct slc_mip_rows rows = {0};
    coarse.x = block->x;
    coarse.y = block->y;
    coarse.width = block->width;
    coarse.height = block->height;
    coarse.texels = texels;
    coarse.pitch = pitch;
    slc_mip_part_cover(&coarse, &fine);
    const SluiceImageRegion covered = {.mipLevel = block->mipLevel - 1,
                                       .x = fine.x,
                                       .y = fine.y,
                                       .width = fine.width,
                                       .height = fine.height,
                                       .arrayLayer = block->arrayLayer};
    fine.pitch = fine.width * (size_t)sluiceGetFormatTexelSize(source->info.format);
    fine.texels = slc_alloc(cb, fine.height, fine.pitch);
    SluiceResult result =
        fine.texels ? slc_mip_rows_init(&rows, cb, fine.width) : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS)
        result = covered.mipLevel < source->inner_count
                     ? sluiceReadImageRegionLocated(source->inner, &covered, fine.texels,
                                                    fine.pitch, fault)
                     : filter_region(source, &covered, fine.texels, fine.pitch, fault);
    if (result == SLUICE_SUCCESS)
        slc_mip_filter(source->info.format, &fine, &coarse, &rows);
    slc_mip_rows_finish(&rows, cb);
    slc_free(cb, fine.texels, fine.height, fine.pitch);
    return result;
}

/* Filters a region. Recurses once per missing level that is not kept in memory. */
static SluiceResult filter_region(struct complete_source *source, const SluiceImageRegion *region,
                                  char *texels, size_t pitch, SluiceImageFault *fault)
{
    size_t texel_size = sluiceGetFormatTexelSize(source->info.format);
    SluiceImageRegion block = *region;
    for (uint32_t y = 0; y < region->height; y += BLOCK_HEIGHT)
        for (uint32_t x = 0; x < region->width; x += BLOCK_WIDTH) {
            block.x = region->x + x;
            block.y = region->y + y;
            block.width = slc_min_u32(BLOCK_WIDTH, region->width - x);
            block.height = slc_min_u32(BLOCK_HEIGHT, region->height - y);
            SluiceResult result =
                filter_block(source, &block, texels + y * pitch + x * texel_size, pitch, fault);
            if (result != SLUICE_SUCCESS)
                return result;
        }
    return SLUICE_SUCCESS;
}

/* Builds the kept levels of a layer. Rows built before a failure stay, and a later try goes on
 * there. */
static SluiceResult build_layer(struct complete_source *source, uint32_t index,
                                SluiceImageFault *fault)
{
    const SluiceAllocationCallbacks *cb = &source->allocator;
    struct layer *layer = &source->layers[index];
    struct slc_mip_part part = part_of_level(source, source->first_kept);
    SluiceResult result = SLUICE_SUCCESS;
    if (!layer->kept.texels)
        result = slc_mip_chain_init(&layer->kept, cb, source->info.format, part.level_width,
                                    part.level_height);
    size_t pitch = part.level_width * (size_t)sluiceGetFormatTexelSize(source->info.format);
    while (result == SLUICE_SUCCESS && layer->row_count < part.level_height) {
        const SluiceImageRegion strip = {
            .mipLevel = source->first_kept,
            .y = layer->row_count,
            .width = part.level_width,
            .height = slc_min_u32(BLOCK_HEIGHT, part.level_height - layer->row_count),
            .arrayLayer = index};
        result = filter_region(source, &strip, layer->kept.texels + strip.y * pitch, pitch, fault);
        if (result == SLUICE_SUCCESS)
            layer->row_count += strip.height;
    }
    return result == SLUICE_SUCCESS ? slc_mip_chain_build(&layer->kept, cb) : result;
}

/* Builds a layer once. The first thread builds, others wait. */
static SluiceResult ensure_built(struct complete_source *source, uint32_t index,
                                 SluiceImageFault *fault)
{
    struct layer *layer = &source->layers[index];
    SluiceResult result = SLUICE_SUCCESS;
    if (atomic_load_explicit(&layer->is_built, memory_order_acquire))
        return result;
    slc_mutex_lock(&source->mutex);
    if (!atomic_load_explicit(&layer->is_built, memory_order_relaxed)) {
        result = build_layer(source, index, fault);
        atomic_store_explicit(&layer->is_built, result == SLUICE_SUCCESS, memory_order_release);
    }
    slc_mutex_unlock(&source->mutex);
    return result;
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    struct complete_source *source = (struct complete_source *)base;
    SluiceResult result = ensure_open(source);
    if (result == SLUICE_SUCCESS)
        *info = source->info;
    return result;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch, SluiceImageFault *fault)
{
    struct complete_source *source = (struct complete_source *)base;
    SluiceResult result = ensure_open(source);
    if (result != SLUICE_SUCCESS)
        return result;
    if (region->mipLevel < source->inner_count)
        return sluiceReadImageRegionLocated(source->inner, region, texels, row_pitch, fault);
    if (region->mipLevel < source->first_kept)
        return filter_region(source, region, texels, row_pitch, fault);
    result = ensure_built(source, region->arrayLayer, fault);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceImageRegion kept = *region;
    kept.mipLevel -= source->first_kept;
    slc_mip_chain_read(&source->layers[region->arrayLayer].kept, &kept, texels, row_pitch);
    return SLUICE_SUCCESS;
}

/* Starts a read. Levels that the source lacks are read at once: from memory, or by filtering. */
static SluiceResult start_read(SluiceImageSource *base, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch, const SluiceImageReadToken *token)
{
    struct complete_source *source = (struct complete_source *)base;
    SluiceResult result = ensure_open(source);
    if (result != SLUICE_SUCCESS)
        return result;
    return region->mipLevel < source->inner_count
               ? slc_start_read(source->inner, &source->info, region, texels, row_pitch, token)
               : SLUICE_ERROR_UNSUPPORTED;
}

static void cancel_read(SluiceImageSource *base, const SluiceImageRegion *region,
                        const SluiceImageReadToken *token)
{
    slc_cancel_read(((struct complete_source *)base)->inner, region, token);
}

static bool identify(SluiceImageSource *base, const SluiceImageRegion *region, uint64_t *identity)
{
    struct complete_source *source = (struct complete_source *)base;
    return atomic_load_explicit(&source->is_open, memory_order_acquire) &&
           region->mipLevel < source->inner_count &&
           slc_identify_region(source->inner, region, identity);
}

static void destroy(SluiceImageSource *base)
{
    struct complete_source *source = (struct complete_source *)base;
    SluiceAllocationCallbacks cb = source->allocator;
    for (uint32_t i = 0; source->layers && i < source->layer_count; i++)
        slc_mip_chain_finish(&source->layers[i].kept, &cb);
    slc_free(&cb, source->layers, source->layer_count, sizeof *source->layers);
    slc_mutex_finish(&source->mutex);
    slc_free(&cb, source, 1, sizeof *source);
}

static const SluiceImageSourceInterface complete_interface = {.structSize =
                                                                  sizeof complete_interface,
                                                              .pfnGetInfo = get_info,
                                                              .pfnDestroy = destroy,
                                                              .pfnReadRegionLocated = read_region,
                                                              .pfnIdentifyRegion = identify};

/* Interface for sources that start reads. */
static const SluiceImageSourceInterface starting_interface = {.structSize =
                                                                  sizeof starting_interface,
                                                              .pfnGetInfo = get_info,
                                                              .pfnDestroy = destroy,
                                                              .pfnReadRegionLocated = read_region,
                                                              .pfnIdentifyRegion = identify,
                                                              .pfnStartRead = start_read,
                                                              .pfnCancelRead = cancel_read};

SluiceResult sluiceCreateCompleteChainSource(const SluiceCompleteChainSourceCreateInfo *pInfo,
                                             SluiceImageSource **pSource)
{
    if (!pInfo || !pSource)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceCompleteChainSourceCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceCompleteChainSourceCreateInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!info.source || !slc_allocator_is_valid(info.pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    struct complete_source *source = slc_calloc(&cb, 1, sizeof *source);
    if (!source)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    bool starts = info.source->pInterface && slc_starts_reads(info.source);
    source->base.pInterface = starts ? &starting_interface : &complete_interface;
    source->allocator = cb;
    source->log = info.log;
    source->inner = info.source;
    source->max_memory =
        info.maxMemorySize ? info.maxMemorySize : SLUICE_COMPLETE_CHAIN_DEFAULT_MEMORY_SIZE;
    slc_mutex_init(&source->mutex);
    *pSource = &source->base;
    return SLUICE_SUCCESS;
}
