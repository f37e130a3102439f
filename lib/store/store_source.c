#include "base/alloc.h"
#include "base/checked.h"
#include "base/struct_size.h"
#include "image/format_size.h"
#include "store/reader.h"

#include <string.h>
#include <xxhash.h>

struct store_source {
    SluiceImageSource base;
    struct slc_store_reader reader;
    char name[SLUICE_STORE_MAX_SOURCE_NAME + 1]; ///< name of the source that was baked
};

/* Converts an address mode. Both enums have VkSamplerAddressMode's values, one of them plus 1. */
static SluiceImageAddressMode image_mode(SluiceStoreAddressMode mode)
{
    return (SluiceImageAddressMode)((int)mode + SLUICE_IMAGE_ADDRESS_MODE_REPEAT);
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    const struct slc_store_reader *reader = &((struct store_source *)base)->reader;
    const struct slc_store_grid *grid = &reader->header.grid;
    *info = (SluiceImageInfo){
        .structSize = sizeof(SluiceImageInfo),
        .width = grid->layout.width,
        .height = grid->layout.height,
        .mipLevelCount = grid->layout.mipLevelCount,
        .format = grid->layout.format,
        .pName = reader->file.path,
        .arrayLayerCount = grid->layer_count,
        .addressModeU = image_mode(reader->header.address_mode_u),
        .addressModeV = image_mode(reader->header.address_mode_v),
        .cube = reader->header.cube,
    };
    return SLUICE_SUCCESS;
}

/* Texels of a chunk or of a level of the tail, with their region of the level. */
struct patch {
    const unsigned char *texels; ///< tightly packed
    uint32_t x, y, width, height;
};

/* Copies the intersection of patch and region. */
static void copy_patch(const SluiceFormatInfo *format, const struct patch *patch,
                       const SluiceImageRegion *region, char *texels, size_t row_pitch)
{
    uint32_t x0 = slc_max_u32(patch->x, region->x), y0 = slc_max_u32(patch->y, region->y);
    uint32_t x1 = slc_min_u32(patch->x + patch->width, region->x + region->width);
    uint32_t y1 = slc_min_u32(patch->y + patch->height, region->y + region->height);
    size_t pitch = slc_format_row_size(format, patch->width);
    const unsigned char *from = patch->texels + (y0 - patch->y) / format->blockHeight * pitch +
                                slc_format_row_size(format, x0 - patch->x);
    char *to = texels + (y0 - region->y) / format->blockHeight * row_pitch +
               slc_format_row_size(format, x0 - region->x);
    size_t size = slc_format_row_size(format, x1 - x0);
    uint32_t rows = slc_format_row_count(format, y1 - y0);
    for (uint32_t row = 0; row < rows; row++)
        memcpy(to + row * row_pitch, from + row * pitch, size);
}

static SluiceResult read_from_tail(struct slc_store_reader *reader, const SluiceImageRegion *region,
                                   struct slc_store_read_bench *bench, char *texels,
                                   size_t row_pitch, struct slc_store_find *find)
{
    const struct slc_store_grid *grid = &reader->header.grid;
    struct slc_store_place place = {region->arrayLayer, grid->layout.tailFirstLevel, 0, 0};
    SluiceResult result = slc_store_read_chunk(reader, &place, bench, bench->texels, find);
    if (result != SLUICE_SUCCESS)
        return result;
    struct patch patch = {bench->texels + slc_store_tail_offset(grid, region->mipLevel), 0, 0,
                          slc_mip_size(grid->layout.width, region->mipLevel),
                          slc_mip_size(grid->layout.height, region->mipLevel)};
    copy_patch(&grid->format, &patch, region, texels, row_pitch);
    return SLUICE_SUCCESS;
}

/* Reads all tiles that the region touches. Tiles are read whole, because checksums are of whole
 * tiles. */
static SluiceResult read_from_tiles(struct slc_store_reader *reader,
                                    const SluiceImageRegion *region,
                                    struct slc_store_read_bench *bench, char *texels,
                                    size_t row_pitch, struct slc_store_find *find)
{
    const struct slc_store_grid *grid = &reader->header.grid;
    const SluiceStoreLayout *layout = &grid->layout;
    uint32_t x1 = (region->x + region->width - 1) / layout->tileWidth;
    uint32_t y1 = (region->y + region->height - 1) / layout->tileHeight;
    for (uint32_t y = region->y / layout->tileHeight; y <= y1; y++)
        for (uint32_t x = region->x / layout->tileWidth; x <= x1; x++) {
            struct slc_store_place place = {region->arrayLayer, region->mipLevel, x, y};
            SluiceResult result = slc_store_read_chunk(reader, &place, bench, bench->texels, find);
            if (result != SLUICE_SUCCESS)
                return result;
            SluiceImageRegion whole = slc_store_chunk_region(grid, &place);
            struct patch patch = {bench->texels, whole.x, whole.y, whole.width, whole.height};
            copy_patch(&grid->format, &patch, region, texels, row_pitch);
        }
    return SLUICE_SUCCESS;
}

static bool covers_tile(const struct slc_store_grid *grid, const SluiceImageRegion *region,
                        struct slc_store_place *place)
{
    *place = (struct slc_store_place){region->arrayLayer, region->mipLevel,
                                      region->x / grid->layout.tileWidth,
                                      region->y / grid->layout.tileHeight};
    SluiceImageRegion whole = slc_store_chunk_region(grid, place);
    return whole.x == region->x && whole.y == region->y && whole.width == region->width &&
           whole.height == region->height;
}

/* True if the region is one whole tile in tight rows, which is read directly. */
static bool is_one_tile(const struct slc_store_grid *grid, const SluiceImageRegion *region,
                        size_t row_pitch, struct slc_store_place *place)
{
    return covers_tile(grid, region, place) &&
           (row_pitch == slc_format_row_size(&grid->format, region->width) ||
            slc_format_row_count(&grid->format, region->height) == 1);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch, SluiceImageFault *fault)
{
    struct slc_store_reader *reader = &((struct store_source *)base)->reader;
    const struct slc_store_grid *grid = &reader->header.grid;
    struct slc_store_read_bench *bench = slc_store_read_pool_take(reader->pool);
    if (!bench)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    struct slc_store_place place;
    struct slc_store_find find;
    SluiceResult result;
    if (region->mipLevel >= grid->layout.tailFirstLevel)
        result = read_from_tail(reader, region, bench, texels, row_pitch, &find);
    else if (is_one_tile(grid, region, row_pitch, &place))
        result = slc_store_read_chunk(reader, &place, bench, texels, &find);
    else
        result = read_from_tiles(reader, region, bench, texels, row_pitch, &find);
    slc_store_read_pool_give(reader->pool, bench);
    if (result == SLUICE_ERROR_IO || result == SLUICE_ERROR_CORRUPT_DATA)
        fault->offset = find.offset;
    return result;
}

static bool identify(SluiceImageSource *base, const SluiceImageRegion *region, uint64_t *identity)
{
    const struct slc_store_reader *reader = &((struct store_source *)base)->reader;
    const struct slc_store_grid *grid = &reader->header.grid;
    struct slc_store_place place;
    if (reader->equal.count == 0 || region->mipLevel >= grid->layout.tailFirstLevel ||
        !covers_tile(grid, region, &place))
        return false;
    *identity = slc_store_equal_chunks_get(&reader->equal, slc_store_chunk_number(grid, &place));
    return *identity != 0;
}

static void destroy(SluiceImageSource *base)
{
    struct store_source *source = (struct store_source *)base;
    SluiceAllocationCallbacks cb = source->reader.file.allocator;
    slc_store_reader_close(&source->reader);
    slc_free(&cb, source, 1, sizeof *source);
}

static const SluiceImageSourceInterface store_interface = {.structSize = sizeof store_interface,
                                                           .pfnGetInfo = get_info,
                                                           .pfnDestroy = destroy,
                                                           .pfnReadRegionLocated = read_region,
                                                           .pfnIdentifyRegion = identify};

SluiceResult sluiceCreateStoreImageSource(const SluiceStoreImageSourceCreateInfo *pInfo,
                                          SluiceImageSource **pSource)
{
    if (!pInfo || !pSource)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceStoreImageSourceCreateInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if ((!info.pPath && !info.pInput) || !slc_allocator_is_valid(info.pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    struct store_source *source = slc_calloc(&cb, 1, sizeof *source);
    if (!source)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    source->base.pInterface = &store_interface;
    result = slc_store_reader_open(&source->reader, &info);
    if (result != SLUICE_SUCCESS) {
        destroy(&source->base);
        return result;
    }
    const struct slc_store_header *header = &source->reader.header;
    memcpy(source->name, header->name, header->name_size);
    *pSource = &source->base;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetStoreInfo(SluiceImageSource *source, SluiceStoreInfo *pInfo)
{
    if (!source || !pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    if (source->pInterface != &store_interface)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    const struct slc_store_reader *reader = &((struct store_source *)source)->reader;
    const struct slc_store_header *header = &reader->header;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceStoreInfo), pInfo, &reader->file.log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceStoreInfo info = {
        .structSize = sizeof info,
        .versionMajor = header->major,
        .versionMinor = header->minor,
        .layout = header->grid.layout,
        .arrayLayerCount = header->grid.layer_count,
        .colorSpace = header->color_space,
        .meaning = header->meaning,
        .addressModeU = header->address_mode_u,
        .addressModeV = header->address_mode_v,
        .pSourceName = ((struct store_source *)source)->name,
        .sourceSize = header->source_size,
        .sourceModifiedTimeNs = header->source_time,
        .settingsHash = header->settings_hash,
        .compressionLevel = header->compression_level,
        .fileSize = header->file_size,
        .cube = header->cube,
    };
    slc_struct_write(SLC_STRUCT(SluiceStoreInfo), pInfo, &info);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceHashStore(SluiceImageSource *source, uint64_t *pHash)
{
    if (!source || !pHash)
        return SLUICE_ERROR_NULL_POINTER;
    if (source->pInterface != &store_interface)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    struct slc_store_reader *reader = &((struct store_source *)source)->reader;
    const struct slc_store_grid *grid = &reader->header.grid;
    unsigned char bytes[16] = {0}; /* hash of all chunks before, checksum of this chunk */
    SluiceResult result = SLUICE_SUCCESS;
    uint64_t hash = 0;
    for (uint64_t number = 0; number < grid->chunk_count && result == SLUICE_SUCCESS; number++) {
        struct slc_store_find find = {.place = slc_store_chunk_place(grid, number)};
        result = slc_store_find_chunk(reader, &find);
        for (uint32_t i = 0; i < 8; i++) {
            bytes[i] = (unsigned char)(hash >> 8 * i);
            bytes[8 + i] = (unsigned char)(find.entry.checksum >> 8 * i);
        }
        hash = XXH3_64bits(bytes, sizeof bytes);
    }
    if (result == SLUICE_SUCCESS)
        *pHash = hash;
    return result;
}
