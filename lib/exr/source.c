#include <sluice/exr.h>

#include "base/alloc.h"
#include "base/checked.h"
#include "exr/decode.h"
#include "image/format.h"
#include "image/mip.h"

#include <pthread.h>
#include <string.h>

struct exr_source {
    SluiceImageSource base;
    struct slc_exr_file file;
    SluiceImageInfo info;
    bool reads_chain;      ///< the file has no levels of its own
    pthread_mutex_t mutex; ///< around what follows
    bool is_built;
    SluiceResult failure; ///< of building, where another attempt would fail again
    struct slc_mip_chain chain;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    *info = ((struct exr_source *)base)->info;
    return SLUICE_SUCCESS;
}

/* Every chunk that the target's rectangle touches, and no other. */
static SluiceResult read_chunks(struct slc_exr_file *file, const struct slc_exr_target *target)
{
    const SluiceImageRegion *region = &target->region;
    uint32_t x0 = region->x / file->chunk_width;
    uint32_t x1 = (region->x + region->width - 1) / file->chunk_width;
    uint32_t y0 = region->y / file->chunk_height;
    uint32_t y1 = (region->y + region->height - 1) / file->chunk_height;
    struct slc_exr_decoder decoder;
    slc_exr_decoder_init(&decoder, file);
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t y = y0; y <= y1 && result == SLUICE_SUCCESS; y++)
        for (uint32_t x = x0; x <= x1 && result == SLUICE_SUCCESS; x++) {
            struct slc_exr_chunk chunk;
            result = slc_exr_chunk_find(file, region->mipLevel, x, y, &chunk);
            if (result == SLUICE_SUCCESS)
                result = slc_exr_decode_chunk(&decoder, &chunk, target);
        }
    slc_exr_decoder_finish(&decoder);
    return result;
}

static SluiceResult build_chain(struct exr_source *source)
{
    const SluiceImageInfo *info = &source->info;
    const SluiceAllocationCallbacks *cb = &source->file.input.allocator;
    SluiceResult result =
        slc_mip_chain_init(&source->chain, cb, info->format, info->width, info->height);
    if (result == SLUICE_SUCCESS) {
        struct slc_exr_target target = {
            .format = info->format,
            .region = {0, 0, 0, info->width, info->height},
            .texels = source->chain.texels,
            .pitch = (size_t)info->width * sluiceFormatTexelSize(info->format),
        };
        result = read_chunks(&source->file, &target);
    }
    if (result == SLUICE_SUCCESS)
        result = slc_mip_chain_build(&source->chain, cb);
    if (result != SLUICE_SUCCESS)
        slc_mip_chain_finish(&source->chain, cb);
    return result;
}

/* The first reader builds while the others wait; afterwards the chain never changes. */
static SluiceResult ensure_chain(struct exr_source *source)
{
    pthread_mutex_lock(&source->mutex);
    SluiceResult result = source->failure;
    if (!source->is_built && result == SLUICE_SUCCESS) {
        result = build_chain(source);
        source->is_built = result == SLUICE_SUCCESS;
        if (result == SLUICE_ERROR_CORRUPT_DATA || result == SLUICE_ERROR_UNSUPPORTED)
            source->failure = result;
    }
    pthread_mutex_unlock(&source->mutex);
    return result;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct exr_source *source = (struct exr_source *)base;
    if (!source->reads_chain) {
        struct slc_exr_target target = {source->info.format, *region, texels, row_pitch};
        return read_chunks(&source->file, &target);
    }
    SluiceResult result = ensure_chain(source);
    if (result == SLUICE_SUCCESS)
        slc_mip_chain_read(&source->chain, region, texels, row_pitch);
    return result;
}

static void destroy(SluiceImageSource *base)
{
    struct exr_source *source = (struct exr_source *)base;
    SluiceAllocationCallbacks cb = source->file.input.allocator;
    slc_mip_chain_finish(&source->chain, &cb);
    slc_exr_file_close(&source->file);
    pthread_mutex_destroy(&source->mutex);
    slc_free(&cb, source, 1, sizeof *source);
}

static const SluiceImageSourceInterface exr_interface = {get_info, read_region, destroy};

static SluiceResult describe(struct exr_source *source, SluiceFormat format, uint64_t max_size,
                             bool level_zero_alone)
{
    struct slc_exr_file *file = &source->file;
    if (format == SLUICE_FORMAT_UNDEFINED)
        format = slc_exr_natural_format(file);
    source->info = (SluiceImageInfo){
        .width = file->width,
        .height = file->height,
        .mipLevelCount = slc_mip_count(slc_max_u32(file->width, file->height)),
        .format = format,
        .pName = file->input.path,
    };
    source->reads_chain = file->layout == SLC_EXR_SCANLINES || file->layout == SLC_EXR_ONE_LEVEL;
    if (level_zero_alone) {
        source->info.mipLevelCount = 1;
        source->reads_chain = false;
    }
    uint64_t size = (uint64_t)file->width * file->height * sluiceFormatTexelSize(format);
    if (size <= max_size)
        return SLUICE_SUCCESS;
    return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                          "is %u x %u texels, %llu bytes as %s; maxImageSize is %llu", file->width,
                          file->height, (unsigned long long)size, sluiceFormatString(format),
                          (unsigned long long)max_size);
}

SluiceResult sluiceCreateExrImageSource(const SluiceExrImageSourceCreateInfo *pInfo,
                                        SluiceImageSource **pSource)
{
    if (!pInfo || !pSource || !pInfo->pPath || !slc_allocator_is_valid(pInfo->pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    if (pInfo->format != SLUICE_FORMAT_UNDEFINED &&
        (sluiceFormatTexelSize(pInfo->format) == 0 || slc_format_is_packed(pInfo->format)))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    SluiceAllocationCallbacks cb = slc_allocator(pInfo->pAllocator);
    struct exr_source *source = slc_calloc(&cb, 1, sizeof *source);
    if (!source)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    source->base.pInterface = &exr_interface;
    pthread_mutex_init(&source->mutex, NULL);
    SluiceResult result = slc_exr_file_open(&source->file, pInfo->pPath, &cb, &pInfo->log);
    if (result == SLUICE_SUCCESS)
        result = describe(source, pInfo->format,
                          pInfo->maxImageSize ? pInfo->maxImageSize : (uint64_t)1 << 34,
                          pInfo->levelZeroAlone);
    if (result != SLUICE_SUCCESS) {
        destroy(&source->base);
        return result;
    }
    *pSource = &source->base;
    return SLUICE_SUCCESS;
}
