#include "bake/picture.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "image/format_size.h"
#include "image/info.h"
#include "image/mip.h"

/* Rows of one read. Tiles of 128 rows are usual in files for textures. */
#define STRIP 128u
/* Limit in bytes for levels of integers in memory. Finer levels are picked at each read. */
#define PICKED_LEVELS_MEMORY ((uint64_t)64 << 20)

struct source_picture {
    struct slc_picture base;
    SluiceImageSource *source;
    bool owned;
    SluiceImageSource *chain; ///< owned; for integers: `source` with all levels
    SluiceFormat format;
    char *rows; ///< [STRIP][width]
    size_t pitch;
    uint32_t first, count;
};

static SluiceResult row(struct slc_picture *base, uint32_t y, const void **samples)
{
    struct source_picture *picture = (struct source_picture *)base;
    if (y >= picture->first + picture->count || y < picture->first) {
        uint32_t count = slc_min_u32(STRIP, base->height - y);
        SluiceImageRegion region = {0, 0, y, base->width, count, base->layer};
        SluiceResult result =
            sluiceReadImageRegion(picture->source, &region, picture->rows, picture->pitch);
        if (result != SLUICE_SUCCESS)
            return result;
        picture->first = y;
        picture->count = count;
    }
    *samples = picture->rows + (y - picture->first) * picture->pitch;
    return SLUICE_SUCCESS;
}

static SluiceResult rewind_picture(struct slc_picture *base)
{
    ((struct source_picture *)base)->count = 0;
    return SLUICE_SUCCESS;
}

static void close_picture(struct slc_picture *base)
{
    struct source_picture *picture = (struct source_picture *)base;
    SluiceAllocationCallbacks cb = base->allocator;
    sluiceDestroyImageSource(picture->chain);
    if (picture->owned)
        sluiceDestroyImageSource(picture->source);
    slc_free(&cb, picture->rows, STRIP * picture->pitch, 1);
    slc_free(&cb, picture, 1, sizeof *picture);
}

static const struct slc_picture_interface source_interface = {row, rewind_picture, close_picture};

/* Returns the sample type of a format. SLC_SAMPLE_TEXELS: the format is read as whole texels. */
static enum slc_sample find_sample(SluiceFormat format)
{
    if (slc_format_is_unorm16(format))
        return SLC_SAMPLE_U16;
    if (slc_format_is_half(format))
        return SLC_SAMPLE_F16;
    if (slc_format_is_snorm(format) || slc_format_is_packed(format))
        return SLC_SAMPLE_TEXELS;
    switch (format) {
    case SLUICE_FORMAT_R32_SFLOAT:
    case SLUICE_FORMAT_R32G32_SFLOAT:
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: return SLC_SAMPLE_F32;
    default: return SLC_SAMPLE_U8;
    }
}

/* Returns the bytes of all picked levels in memory. */
static uint64_t picked_size(const SluiceImageInfo *info)
{
    uint64_t size = slc_mip_chain_size(info->format, slc_mip_size(info->width, info->mipLevelCount),
                                       slc_mip_size(info->height, info->mipLevelCount));
    return size < PICKED_LEVELS_MEMORY / slc_max_u32(1, info->arrayLayerCount)
               ? size * slc_max_u32(1, info->arrayLayerCount)
               : PICKED_LEVELS_MEMORY;
}

static SluiceResult describe_integers(struct source_picture *picture, const SluiceImageInfo *info)
{
    SluiceCompleteChainSourceCreateInfo create = {.structSize = sizeof create,
                                                  .source = picture->source,
                                                  .maxMemorySize = PICKED_LEVELS_MEMORY,
                                                  .pAllocator = &picture->base.allocator,
                                                  .log = picture->base.log};
    SluiceResult result = sluiceCreateCompleteChainSource(&create, &picture->chain);
    picture->base.levels = picture->chain;
    picture->base.memory = (1 << 20) + picked_size(info);
    return result;
}

static SluiceResult describe(struct source_picture *picture, const SluiceImageInfo *info)
{
    struct slc_picture *base = &picture->base;
    SluiceFormatInfo format = {.structSize = sizeof format};
    SluiceResult result = slc_image_info_check(info, SLC_LEVELS_ANY, &base->log);
    if (result != SLUICE_SUCCESS)
        return result;
    result = sluiceGetFormatInfo(info->format, &format);
    if (result != SLUICE_SUCCESS)
        return result;
    base->width = info->width;
    base->height = info->height;
    base->layer_count = slc_max_u32(1, info->arrayLayerCount);
    base->cube = info->cube;
    base->channels = format.channelCount;
    base->alpha = format.channelCount == 4;
    base->premultiplied = true;
    base->srgb = info->format == SLUICE_FORMAT_R8G8B8A8_SRGB;
    picture->format = info->format;
    if (slc_format_is_compressed(&format)) {
        result = slc_image_info_check(info, SLC_LEVELS_ALL, &base->log);
        if (result != SLUICE_SUCCESS)
            return result;
        base->levels = picture->source;
        base->memory = 1 << 20;
        return SLUICE_SUCCESS;
    }
    if (slc_format_is_integer(info->format))
        return describe_integers(picture, info);
    base->sample = find_sample(info->format);
    base->texels = info->format;
    picture->pitch = (size_t)slc_format_row_size(&format, info->width);
    base->memory = STRIP * (uint64_t)picture->pitch;
    picture->rows = slc_alloc(&base->allocator, STRIP * picture->pitch, 1);
    return picture->rows ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

SluiceResult slc_picture_of_source(SluiceImageSource *source, bool owned, const char *name,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceLogCallback *log, struct slc_picture **opened)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    struct source_picture *picture = slc_calloc(cb, 1, sizeof *picture);
    if (!picture) {
        if (owned)
            sluiceDestroyImageSource(source);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    picture->base.implementation = &source_interface;
    picture->base.allocator = *cb;
    picture->base.log = *log;
    picture->base.name = name;
    picture->source = source;
    picture->owned = owned;
    SluiceResult result = sluiceGetImageInfo(source, &info);
    if (result == SLUICE_SUCCESS)
        result = describe(picture, &info);
    if (result != SLUICE_SUCCESS) {
        close_picture(&picture->base);
        return result;
    }
    *opened = &picture->base;
    return SLUICE_SUCCESS;
}
