#include "container/container_source.h"

#include "base/alloc.h"
#include "base/log.h"
#include "container/level_cache.h"
#include "image/byte_order.h"
#include "platform/thread.h"

#include <stdatomic.h>
#include <string.h>

struct container_source {
    SluiceImageSource base;
    struct slc_input_file file;
    SluiceFormat asked_format;
    SluiceResult (*read_header)(const struct slc_input_file *, struct slc_container_layout *);
    struct slc_mutex mutex; ///< held while opening
    atomic_bool is_open;    ///< true: the fields below are constant
    struct slc_container_layout layout;
    SluiceImageInfo info;
    struct slc_level_cache cache;
};

/* Bytes of a level: in memory, or in the file. */
struct level_bytes {
    const struct slc_input_file *file;
    const char *memory; ///< NULL: in the file
    uint64_t start;     ///< offset of the level in the file
};

static SluiceResult fetch(const struct level_bytes *from, uint64_t offset, void *bytes, size_t size)
{
    if (!from->memory)
        return slc_input_file_read(from->file, from->start + offset, bytes, size);
    memcpy(bytes, from->memory + offset, size);
    return SLUICE_SUCCESS;
}

static void change_texels(unsigned changes, const uint8_t *in, uint8_t *out, size_t count)
{
    unsigned red = changes & SLC_SWAP_RED_BLUE ? 2 : 0;
    uint8_t opaque = changes & SLC_MAKE_OPAQUE ? 255 : 0;
    for (size_t i = 0; i < count; i++, in += 4, out += 4) {
        out[0] = in[red];
        out[1] = in[1];
        out[2] = in[2 - red];
        out[3] = in[3] | opaque;
    }
}

/* Reads and changes texels piece by piece in a local buffer; the caller's memory may be slow to
 * read. */
static SluiceResult fetch_changed(const struct level_bytes *from, unsigned changes, uint64_t offset,
                                  uint8_t *texels, size_t size)
{
    uint8_t piece[4096];
    for (size_t done = 0; done < size;) {
        size_t step = size - done < sizeof piece ? size - done : sizeof piece;
        SluiceResult result = fetch(from, offset + done, piece, step);
        if (result != SLUICE_SUCCESS)
            return result;
        change_texels(changes, piece, texels + done, step / 4);
        done += step;
    }
    return SLUICE_SUCCESS;
}

/* Reads a region. After a failure, `*failed` is the offset in the level of the failed row. */
static SluiceResult fetch_region(const struct slc_container_layout *layout,
                                 const struct level_bytes *from, const SluiceImageRegion *region,
                                 char *texels, size_t row_pitch, uint64_t *failed)
{
    SluiceFormatInfo format = {.structSize = sizeof format};
    sluiceGetFormatInfo(layout->format, &format);
    uint64_t stride = slc_format_row_size(&format, slc_mip_size(layout->width, region->mipLevel));
    uint64_t offset = region->arrayLayer * layout->levels[region->mipLevel].layer_stride +
                      region->y / format.blockHeight * stride +
                      (uint64_t)(region->x / format.blockWidth) * format.blockSize;
    size_t size = (size_t)slc_format_row_size(&format, region->width);
    uint32_t rows = slc_format_row_count(&format, region->height);
    if (size == stride && size == row_pitch && size <= SIZE_MAX / rows) {
        size *= rows; /* rows are contiguous in both */
        rows = 1;
    }
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t y = 0; y < rows && result == SLUICE_SUCCESS; y++, offset += stride) {
        char *row = texels + y * row_pitch;
        *failed = offset;
        result = layout->changes
                     ? fetch_changed(from, layout->changes, offset, (uint8_t *)row, size)
                     : fetch(from, offset, row, size);
        if (result == SLUICE_SUCCESS)
            slc_exchange_file_order(layout->format, row, size);
    }
    return result;
}

static SluiceResult read_layout(struct container_source *source)
{
    struct slc_container_layout *layout = &source->layout;
    *layout = (struct slc_container_layout){0};
    SluiceResult result = source->read_header(&source->file, layout);
    if (result == SLUICE_SUCCESS)
        result = slc_level_cache_check(&source->cache, layout);
    if (result == SLUICE_SUCCESS)
        result = slc_layout_rename(layout, &source->file, source->asked_format);
    if (result != SLUICE_SUCCESS)
        return result;
    source->info = (SluiceImageInfo){
        .structSize = sizeof(SluiceImageInfo),
        .width = layout->width,
        .height = layout->height,
        .mipLevelCount = layout->level_count,
        .format = layout->format,
        .pName = source->file.path,
        .arrayLayerCount = layout->layer_count,
        .cube = layout->cube,
    };
    return SLUICE_SUCCESS;
}

/* Opens the file in the first thread; others wait. Tries again after a failure. */
static SluiceResult ensure_open(struct container_source *source)
{
    if (atomic_load_explicit(&source->is_open, memory_order_acquire))
        return SLUICE_SUCCESS;
    SluiceResult result = SLUICE_SUCCESS;
    slc_mutex_lock(&source->mutex);
    if (!atomic_load_explicit(&source->is_open, memory_order_relaxed)) {
        result = slc_input_file_open(&source->file);
        if (result == SLUICE_SUCCESS)
            result = read_layout(source);
        if (result == SLUICE_SUCCESS)
            atomic_store_explicit(&source->is_open, true, memory_order_release);
        else
            slc_input_file_close(&source->file);
    }
    slc_mutex_unlock(&source->mutex);
    return result;
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    struct container_source *source = (struct container_source *)base;
    SluiceResult result = ensure_open(source);
    if (result == SLUICE_SUCCESS)
        *info = source->info;
    return result;
}

/* Reads from a level that is decompressed as a whole. */
static SluiceResult read_from_cache(struct container_source *source, struct level_bytes *from,
                                    const SluiceImageRegion *region, void *texels, size_t row_pitch)
{
    uint64_t failed;
    SluiceResult result =
        slc_level_cache_acquire(&source->cache, &source->layout, region->mipLevel, &from->memory);
    if (result != SLUICE_SUCCESS)
        return result;
    result = fetch_region(&source->layout, from, region, texels, row_pitch, &failed);
    slc_level_cache_release(&source->cache, region->mipLevel);
    return result;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch, SluiceImageFault *fault)
{
    struct container_source *source = (struct container_source *)base;
    const struct slc_container_layout *layout = &source->layout;
    SluiceResult result = ensure_open(source);
    if (result != SLUICE_SUCCESS)
        return result;
    uint64_t failed = 0; /* bytes from the beginning of the level */
    struct level_bytes from = {.file = &source->file,
                               .start = layout->levels[region->mipLevel].offset};
    result = layout->levels_are_compressed
                 ? read_from_cache(source, &from, region, texels, row_pitch)
                 : fetch_region(layout, &from, region, texels, row_pitch, &failed);
    if (result == SLUICE_ERROR_IO || result == SLUICE_ERROR_CORRUPT_DATA)
        fault->offset = from.start + failed;
    return result;
}

static void destroy(SluiceImageSource *base)
{
    struct container_source *source = (struct container_source *)base;
    SluiceAllocationCallbacks cb = source->file.allocator;
    slc_level_cache_finish(&source->cache);
    slc_input_file_finish(&source->file);
    slc_mutex_finish(&source->mutex);
    slc_free(&cb, source, 1, sizeof *source);
}

static const SluiceImageSourceInterface container_interface = {.structSize =
                                                                   sizeof container_interface,
                                                               .pfnGetInfo = get_info,
                                                               .pfnDestroy = destroy,
                                                               .pfnReadRegionLocated = read_region};

SluiceResult slc_container_source_create(const struct slc_container_create_info *info,
                                         SluiceImageSource **source_out)
{
    if ((!info->choice.path && !info->choice.input) || !source_out ||
        !slc_allocator_is_valid(info->allocator))
        return SLUICE_ERROR_NULL_POINTER;
    if ((uint32_t)info->format >= SLUICE_FORMAT_COUNT)
        return slc_log_refusal(info->log, "format is %d; it must be from 0 to %d",
                               (int)info->format, SLUICE_FORMAT_COUNT - 1);
    SluiceAllocationCallbacks cb = slc_allocator(info->allocator);
    struct container_source *source = slc_calloc(&cb, 1, sizeof *source);
    if (!source)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    source->base.pInterface = &container_interface;
    source->asked_format = info->format;
    source->read_header = info->read_header;
    slc_mutex_init(&source->mutex);
    slc_level_cache_init(&source->cache, &source->file, info->max_cache_size);
    SluiceResult result = slc_input_file_init_choice(&source->file, &info->choice, &cb, info->log);
    if (result != SLUICE_SUCCESS) {
        destroy(&source->base);
        return result;
    }
    *source_out = &source->base;
    return SLUICE_SUCCESS;
}
