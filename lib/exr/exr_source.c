#include <sluice/exr.h>

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "exr/decode.h"
#include "exr/exr_memory_budget.h"
#include "image/format_size.h"
#include "image/mip.h"
#include "platform/time_now.h"
#include "platform/thread.h"

#include <string.h>

/* Least time between attempts to decode an unchanged file that failed. */
#define TIME_BETWEEN_BUILDS UINT64_C(10000000000) /* nanoseconds */

struct exr_source {
    SluiceImageSource base;
    struct slc_exr_file file;
    SluiceImageInfo info;
    bool reads_chain;              ///< the file has no levels of its own
    uint64_t chain_size;           ///< bytes of the chain, during and after the build; 0: no chain
    uint64_t read_size;            ///< bytes that a read allocates
    SluiceExrMemoryBudget *budget; ///< NULL, or chain_size is reserved in it
    struct slc_mutex mutex;        ///< guards the fields below
    bool is_built;
    SluiceResult failure; ///< result of the last build, if a repeat now would fail, too
    struct slc_file_stamp failure_stamp; ///< file stamp at the failure
    uint64_t failure_time;
    struct slc_mip_chain chain;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    *info = ((struct exr_source *)base)->info;
    return SLUICE_SUCCESS;
}

/* Reads exactly the chunks that the target's rectangle touches. */
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
            .pitch = (size_t)info->width * sluiceGetFormatTexelSize(info->format),
        };
        result = read_chunks(&source->file, &target);
    }
    if (result == SLUICE_SUCCESS)
        result = slc_mip_chain_build(&source->chain, cb);
    if (result != SLUICE_SUCCESS)
        slc_mip_chain_finish(&source->chain, cb);
    return result;
}

/* Keeps a failure, so that repeated reads of tiles do not each decode the whole file. */
static void note_failure(struct exr_source *source, SluiceResult result)
{
    if (result != SLUICE_ERROR_CORRUPT_DATA && result != SLUICE_ERROR_UNSUPPORTED)
        return;
    source->failure = result;
    source->failure_stamp = slc_input_file_stamp(&source->file.input);
    source->failure_time = slc_monotonic_time();
}

/* Tells whether a retry may succeed: the file changed, or some time has passed. */
static bool may_be_well(const struct exr_source *source)
{
    struct slc_file_stamp stamp = slc_input_file_stamp(&source->file.input);
    return memcmp(&stamp, &source->failure_stamp, sizeof stamp) != 0 ||
           slc_monotonic_time() - source->failure_time >= TIME_BETWEEN_BUILDS;
}

/* Builds the chain in the first reader; others wait. The finished chain is constant. */
static SluiceResult ensure_chain(struct exr_source *source)
{
    slc_mutex_lock(&source->mutex);
    if (source->failure != SLUICE_SUCCESS && may_be_well(source))
        source->failure = SLUICE_SUCCESS;
    SluiceResult result = source->failure;
    if (!source->is_built && result == SLUICE_SUCCESS) {
        result = build_chain(source);
        source->is_built = result == SLUICE_SUCCESS;
        note_failure(source, result);
    }
    slc_mutex_unlock(&source->mutex);
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
    if (source->budget)
        slc_memory_budget_give_back(source->budget, source->chain_size);
    slc_exr_file_close(&source->file);
    slc_mutex_finish(&source->mutex);
    slc_free(&cb, source, 1, sizeof *source);
}

static const SluiceImageSourceInterface exr_interface = {sizeof exr_interface, get_info,
                                                         read_region, destroy};

static const char *const storage_names[] = {
    [SLC_EXR_SCANLINES] = "scanlines",
    [SLC_EXR_ONE_LEVEL] = "tiles without levels",
    [SLC_EXR_MIPMAP] = "tiles",
    [SLC_EXR_RIPMAP] = "tiles",
};

/* Returns OpenEXRCore's memory for a chunk: packed bytes, texels, and as much again for sorting. */
static uint64_t chunk_memory(const struct slc_exr_file *file)
{
    return 3 * (uint64_t)slc_min_u32(file->chunk_width, file->width) *
           slc_min_u32(file->chunk_height, file->height) * file->texel_size;
}

static uint64_t chain_memory(const struct exr_source *source)
{
    const SluiceImageInfo *info = &source->info;
    uint64_t size = slc_mip_chain_size(info->format, info->width, info->height);
    uint64_t meanwhile = slc_mip_rows_size(info->width);
    return size < UINT64_MAX - meanwhile ? size + meanwhile : UINT64_MAX;
}

static uint64_t to_mib(uint64_t size)
{
    return size / (1 << 20) + (size % (1 << 20) != 0);
}

static SluiceResult refuse_memory(const struct exr_source *source, uint64_t limit)
{
    const struct slc_exr_file *file = &source->file;
    /* Rounds the limit down and the need up, so that the message shows need > limit. */
    unsigned long long mib = limit >> 20, chunk = to_mib(source->read_size),
                       chain = to_mib(source->chain_size + source->read_size);
    if (source->read_size > limit)
        return slc_input_fail(&file->input, SLUICE_ERROR_LIMIT_EXCEEDED,
                              "decoding a chunk of %u x %u texels takes %llu MiB of memory; "
                              "maxMemorySize is %llu MiB; raise it, or write smaller tiles",
                              slc_min_u32(file->chunk_width, file->width),
                              slc_min_u32(file->chunk_height, file->height), chunk, mib);
    return slc_input_fail(&file->input, SLUICE_ERROR_LIMIT_EXCEEDED,
                          "is %u x %u texels in %s; the levels built of them take %llu MiB of "
                          "memory; maxMemorySize is %llu MiB; better bake the file once "
                          "(sluice-bake FILE -o DIR), or raise the limit",
                          file->width, file->height, storage_names[file->layout], chain, mib);
}

static SluiceResult reserve_memory(struct exr_source *source,
                                   const SluiceExrImageSourceCreateInfo *info)
{
    struct slc_exr_file *file = &source->file;
    uint64_t limit = info->maxMemorySize  ? info->maxMemorySize
                     : info->memoryBudget ? info->memoryBudget->max_size
                                          : SLUICE_EXR_DEFAULT_MEMORY_SIZE;
    source->read_size = chunk_memory(file);
    if (source->reads_chain)
        source->chain_size = chain_memory(source);
    if (source->read_size > limit || source->chain_size > limit - source->read_size)
        return refuse_memory(source, limit);
    if (!info->memoryBudget || source->chain_size == 0)
        return SLUICE_SUCCESS;
    if (!slc_memory_budget_take(info->memoryBudget, source->chain_size))
        return slc_input_fail(
            &file->input, SLUICE_ERROR_LIMIT_EXCEEDED,
            "is %u x %u texels in %s; the levels built of them take %llu MiB of memory; other "
            "files have taken %llu of the %llu MiB that they share; better bake the file once "
            "(sluice-bake FILE -o DIR), or raise the limit",
            file->width, file->height, storage_names[file->layout],
            (unsigned long long)to_mib(source->chain_size),
            (unsigned long long)to_mib(atomic_load(&info->memoryBudget->used_size)),
            (unsigned long long)to_mib(info->memoryBudget->max_size));
    source->budget = info->memoryBudget;
    return SLUICE_SUCCESS;
}

/* Checks that integer formats come from integer channels; integers are copied without conversion.
 */
static SluiceResult check_integers(const struct slc_exr_file *file, SluiceFormat format)
{
    if (!slc_format_is_integer(format))
        return SLUICE_SUCCESS;
    for (uint32_t i = 0; i < file->channel_count; i++)
        if (file->channels[i].type != EXR_PIXEL_UINT)
            return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                                  "has the channels %s, not all of them uint; %s needs uint "
                                  "channels, other files need a float format",
                                  file->channel_names, sluiceGetFormatName(format));
    return SLUICE_SUCCESS;
}

static SluiceResult describe(struct exr_source *source, SluiceFormat format, uint64_t max_size,
                             bool level_zero_alone)
{
    struct slc_exr_file *file = &source->file;
    if (format == SLUICE_FORMAT_UNDEFINED)
        format = slc_exr_natural_format(file);
    SluiceResult result = check_integers(file, format);
    if (result != SLUICE_SUCCESS)
        return result;
    source->info = (SluiceImageInfo){
        .structSize = sizeof(SluiceImageInfo),
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
    uint64_t size = (uint64_t)file->width * file->height * sluiceGetFormatTexelSize(format);
    if (size <= max_size)
        return SLUICE_SUCCESS;
    return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                          "is %u x %u texels, %llu bytes as %s; maxImageSize is %llu", file->width,
                          file->height, (unsigned long long)size, sluiceGetFormatName(format),
                          (unsigned long long)max_size);
}

static bool is_made_of_channels(SluiceFormat format)
{
    if (format == SLUICE_FORMAT_UNDEFINED)
        return true;
    if (slc_format_is_integer(format))
        return format == SLUICE_FORMAT_R32_UINT || format == SLUICE_FORMAT_R32G32_UINT ||
               format == SLUICE_FORMAT_R32G32B32A32_UINT;
    return sluiceGetFormatTexelSize(format) != 0 && !slc_format_is_packed(format) &&
           !slc_format_is_snorm(format);
}

SluiceResult sluiceCreateExrImageSource(const SluiceExrImageSourceCreateInfo *pInfo,
                                        SluiceImageSource **pSource)
{
    if (!pInfo || !pSource)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceExrImageSourceCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceExrImageSourceCreateInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if ((!info.pPath && !info.pInput) || !slc_allocator_is_valid(info.pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    if (!is_made_of_channels(info.format))
        return slc_log_refusal(&info.log,
                               "format is %s (%d); block-compressed, packed and SNORM formats are "
                               "refused, and integers other than R32, R32G32 and R32G32B32A32_UINT",
                               sluiceGetFormatName(info.format), (int)info.format);
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    struct exr_source *source = slc_calloc(&cb, 1, sizeof *source);
    if (!source)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    source->base.pInterface = &exr_interface;
    slc_mutex_init(&source->mutex);
    struct slc_input_choice choice = {info.pPath, info.pInput, info.filePool};
    result = slc_exr_file_open(&source->file, &choice, &cb, &info.log);
    if (info.keepPrimaries && source->file.converts) {
        source->file.converts = false;
        source->file.is_foreign = true;
    }
    if (result == SLUICE_SUCCESS)
        result =
            describe(source, info.format, info.maxImageSize ? info.maxImageSize : (uint64_t)1 << 34,
                     info.levelZeroAlone);
    if (result == SLUICE_SUCCESS)
        result = reserve_memory(source, &info);
    if (result != SLUICE_SUCCESS) {
        destroy(&source->base);
        return result;
    }
    *pSource = &source->base;
    return SLUICE_SUCCESS;
}

static const char *compression_name(exr_compression_t compression)
{
    static const char *const names[] = {"NONE",  "RLE", "ZIPS", "ZIP",  "PIZ",
                                        "PXR24", "B44", "B44A", "DWAA", "DWAB"};
    size_t index = (size_t)compression;
    return index < sizeof names / sizeof names[0] ? names[index] : "unknown";
}

static SluiceExrStorage storage_of(enum slc_exr_layout layout)
{
    switch (layout) {
    case SLC_EXR_SCANLINES: return SLUICE_EXR_STORAGE_SCANLINES;
    case SLC_EXR_ONE_LEVEL: return SLUICE_EXR_STORAGE_TILES;
    case SLC_EXR_MIPMAP: return SLUICE_EXR_STORAGE_MIP_TILES;
    default: return SLUICE_EXR_STORAGE_RIP_TILES;
    }
}

SluiceResult sluiceGetExrInfo(SluiceImageSource *source, SluiceExrInfo *pInfo)
{
    if (!source || !pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    if (source->pInterface != &exr_interface)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    const struct exr_source *exr = (const struct exr_source *)source;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceExrInfo), pInfo, &exr->file.input.log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceExrInfo info = {
        .structSize = sizeof info,
        .storage = storage_of(exr->file.layout),
        .chunkWidth = exr->file.chunk_width,
        .chunkHeight = exr->file.chunk_height,
        .pCompression = compression_name(exr->file.compression),
        .pChannels = exr->file.channel_names,
        .chainSize = exr->chain_size,
        .readSize = exr->read_size,
        .hasChromaticities = exr->file.has_chromaticities,
        .convertsPrimaries = exr->file.converts,
        .foreignPrimaries = exr->file.is_foreign,
    };
    const struct slc_chromaticities *from = &exr->file.chromaticities;
    const double *const points[4] = {from->red, from->green, from->blue, from->white};
    for (int i = 0; i < 8; i++)
        info.chromaticities[i] = (float)points[i / 2][i % 2];
    slc_struct_write(SLC_STRUCT(SluiceExrInfo), pInfo, &info);
    return SLUICE_SUCCESS;
}
