#include "store/store_writer.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/limits.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "image/info.h"
#include "store/resume.h"

#include <string.h>

static SluiceResult describe(const SluiceStoreCreateInfo *info, struct slc_store_header *header)
{
    const char *name = info->pSourceName ? info->pSourceName : "";
    size_t name_size = strlen(name);
    *header = (struct slc_store_header){
        .major = SLUICE_STORE_VERSION_MAJOR,
        .minor = SLUICE_STORE_VERSION_MINOR,
        .color_space = info->colorSpace,
        .meaning = info->meaning,
        .address_mode_u = info->addressModeU,
        .address_mode_v = info->addressModeV,
        .source_size = info->sourceSize,
        .source_time = info->sourceModifiedTimeNs,
        .settings_hash = info->settingsHash,
        .cube = info->cube,
        .compression_level = info->compressionLevel,
        .name_size = (uint32_t)name_size,
        .name = name,
    };
    const struct slc_limit limits[] = {
        {"width", info->width, 1, SLUICE_STORE_MAX_SIZE},
        {"height", info->height, 1, SLUICE_STORE_MAX_SIZE},
        {"arrayLayerCount", info->arrayLayerCount, 0, SLUICE_STORE_MAX_ARRAY_LAYERS},
        {"length of pSourceName", name_size, 0, SLUICE_STORE_MAX_SOURCE_NAME},
        {"colorSpace", (uint32_t)info->colorSpace, 0, SLUICE_STORE_COLOR_SPACE_ACESCG},
        {"meaning", (uint32_t)info->meaning, 0, SLUICE_STORE_MEANING_DATA},
        {"addressModeU", (uint32_t)info->addressModeU, 0,
         SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_BORDER},
        {"addressModeV", (uint32_t)info->addressModeV, 0,
         SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_BORDER},
        {"compressionLevel", info->compressionLevel, 0, SLUICE_STORE_MAX_COMPRESSION_LEVEL},
        {"flags", info->flags, 0, SLUICE_STORE_WRITER_RESUME},
    };
    SluiceResult result = slc_check_limits(&info->log, limits, sizeof limits / sizeof limits[0]);
    if (result == SLUICE_SUCCESS)
        result = slc_store_grid_init(&header->grid, info->width, info->height, info->format,
                                     slc_max_u32(1, info->arrayLayerCount));
    if (result != SLUICE_SUCCESS)
        return result;
    if (info->cube && info->width != info->height)
        return slc_log_refusal(&info->log,
                               "cube is set and width is %u, height %u; faces of cube "
                               "maps are square",
                               info->width, info->height);
    if (info->cube && header->grid.layer_count % SLC_CUBE_FACES)
        return slc_log_refusal(&info->log,
                               "cube is set and arrayLayerCount is %u; cube maps have "
                               "%u layers each",
                               header->grid.layer_count, SLC_CUBE_FACES);
    uint32_t levels = header->grid.layout.mipLevelCount;
    if (info->mipLevelCount == 0 || info->mipLevelCount == levels)
        return SLUICE_SUCCESS;
    return slc_log_refusal(&info->log, "mipLevelCount is %u; it must be 0 or %u",
                           info->mipLevelCount, levels);
}

/* Finds out whether the unfinished file has an equal create-info. */
static SluiceResult find_match(const SluiceStoreWriter *writer, bool *matches)
{
    unsigned char bytes[SLC_STORE_HEADER_SIZE];
    const struct slc_store_file *file = &writer->file;
    *matches = false;
    if (!writer->may_resume || file->size < writer->header.data_offset)
        return SLUICE_SUCCESS;
    SluiceResult result = slc_store_file_read(file, 0, bytes, sizeof bytes);
    if (result == SLUICE_SUCCESS)
        *matches = slc_store_header_matches(bytes, writer->header_bytes);
    return result;
}

static SluiceResult begin_anew(SluiceStoreWriter *writer)
{
    writer->end = writer->header.data_offset;
    SluiceResult result = slc_part_file_cut(&writer->part, 0);
    if (result == SLUICE_SUCCESS)
        result = slc_part_file_reserve(&writer->part, writer->header.data_offset);
    if (result == SLUICE_SUCCESS)
        result = slc_store_file_write(&writer->file, 0, writer->header_bytes,
                                      sizeof writer->header_bytes);
    return result;
}

static SluiceResult go_on(SluiceStoreWriter *writer)
{
    struct slc_store_resumed resumed;
    SluiceResult result = slc_store_resume(&writer->file, &writer->header, &resumed);
    if (result != SLUICE_SUCCESS)
        return result;
    writer->end = resumed.end;
    writer->written_count = resumed.chunk_count;
    writer->repeats = resumed.repeats;
    slc_log(&writer->file.log, SLUICE_LOG_INFO, "%s: goes on with %llu of %llu tiles",
            writer->file.path, (unsigned long long)resumed.chunk_count,
            (unsigned long long)writer->header.grid.chunk_count);
    result = slc_part_file_cut(&writer->part, writer->end);
    if (result == SLUICE_SUCCESS) /* marks a finished file as unfinished */
        result = slc_store_file_write(&writer->file, 0, writer->header_bytes,
                                      sizeof writer->header_bytes);
    return result;
}

static SluiceResult begin(SluiceStoreWriter *writer, const SluiceStoreCreateInfo *info)
{
    SluiceResult result = slc_part_file_open(&writer->part, info->pPath,
                                             writer->may_resume ? SLC_PART_FILE_RESUME : 0,
                                             &writer->allocator, &info->log);
    bool matches = false;
    writer->file = (struct slc_store_file){.allocator = writer->allocator,
                                           .log = info->log,
                                           .path = writer->part.path,
                                           .descriptor = writer->part.descriptor,
                                           .size = writer->part.size};
    if (result == SLUICE_SUCCESS)
        result = find_match(writer, &matches);
    if (result == SLUICE_SUCCESS && matches) {
        result = go_on(writer);
    } else if (result == SLUICE_SUCCESS) {
        result = begin_anew(writer);
        if (result != SLUICE_SUCCESS)
            writer->may_resume = false; /* with what? */
    }
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_mutex_init(&writer->mutex))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    writer->has_mutex = slc_condition_init(&writer->turn_changed);
    if (!writer->has_mutex)
        slc_mutex_finish(&writer->mutex);
    return writer->has_mutex ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

SluiceResult sluiceCreateStoreWriter(const SluiceStoreCreateInfo *pInfo,
                                     SluiceStoreWriter **pWriter)
{
    if (!pInfo || !pWriter || !pInfo->pPath || !slc_allocator_is_valid(pInfo->pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceStoreCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceStoreCreateInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_store_header header;
    result = describe(&info, &header);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceStoreWriter *writer = slc_calloc(&cb, 1, sizeof *writer);
    if (!writer)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    writer->allocator = cb;
    writer->header = header;
    writer->may_resume = (info.flags & SLUICE_STORE_WRITER_RESUME) != 0;
    slc_store_header_write(&writer->header, writer->header_bytes);
    writer->header.name = NULL; /* the caller's string; from here on only in the bytes */
    result = begin(writer, &info);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyStoreWriter(writer);
        return result;
    }
    *pWriter = writer;
    return SLUICE_SUCCESS;
}

void sluiceDestroyStoreWriter(SluiceStoreWriter *writer)
{
    if (!writer)
        return;
    if (!writer->may_resume && writer->state != SLC_STORE_FINISHED)
        slc_part_file_remove(&writer->part);
    slc_part_file_close(&writer->part);
    slc_store_writer_free_benches(writer);
    slc_free(&writer->allocator, writer->repeats, 1, sizeof *writer->repeats);
    if (writer->has_mutex) {
        slc_condition_finish(&writer->turn_changed);
        slc_mutex_finish(&writer->mutex);
    }
    SluiceAllocationCallbacks cb = writer->allocator;
    slc_free(&cb, writer, 1, sizeof *writer);
}

SluiceResult sluiceGetStoreWriterLayout(const SluiceStoreWriter *writer, SluiceStoreLayout *pLayout)
{
    if (!writer || !pLayout)
        return SLUICE_ERROR_NULL_POINTER;
    *pLayout = writer->header.grid.layout;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetStoreProgress(SluiceStoreWriter *writer, uint64_t *pWrittenTileCount,
                                    uint64_t *pTileCount)
{
    if (!writer || !pWrittenTileCount || !pTileCount)
        return SLUICE_ERROR_NULL_POINTER;
    slc_mutex_lock(&writer->mutex);
    *pWrittenTileCount = writer->written_count;
    slc_mutex_unlock(&writer->mutex);
    *pTileCount = writer->header.grid.chunk_count;
    return SLUICE_SUCCESS;
}

SluiceResult slc_store_writer_find(const SluiceStoreWriter *writer, uint32_t layer, uint32_t level,
                                   uint32_t x, uint32_t y, struct slc_store_place *place)
{
    const struct slc_store_grid *grid = &writer->header.grid;
    const SluiceStoreLayout *layout = &grid->layout;
    if (slc_store_grid_find(grid, layer, level, x, y, place))
        return SLUICE_SUCCESS;
    const struct slc_limit limits[] = {
        {"arrayLayer", layer, 0, grid->layer_count - 1},
        {"mipLevel", level, 0, layout->mipLevelCount - 1},
    };
    SluiceResult result = slc_check_limits(&writer->file.log, limits, 2);
    if (result != SLUICE_SUCCESS)
        return result;
    return slc_log_refusal(&writer->file.log,
                           "tile %u, %u of level %u: the level has %u x %u tiles", x, y, level,
                           layout->levelWidthInTiles[level], layout->levelHeightInTiles[level]);
}

SluiceResult sluiceIsStoreTileWritten(SluiceStoreWriter *writer, uint32_t arrayLayer,
                                      uint32_t mipLevel, uint32_t tileX, uint32_t tileY,
                                      bool *pWritten)
{
    if (!writer || !pWritten)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_store_grid *grid = &writer->header.grid;
    struct slc_store_place place;
    SluiceResult result = slc_store_writer_find(writer, arrayLayer, mipLevel, tileX, tileY, &place);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_store_entry entry;
    result = slc_store_writer_entry(writer, slc_store_chunk_number(grid, &place), &entry);
    if (result == SLUICE_SUCCESS)
        *pWritten = slc_store_entry_is_written(&entry);
    return result;
}

/* Logs the first missing chunk. */
static SluiceResult refuse_unfinished(const SluiceStoreWriter *writer, uint64_t missing)
{
    const struct slc_store_grid *grid = &writer->header.grid;
    struct slc_store_place place = slc_store_chunk_place(grid, missing);
    slc_log(&writer->file.log, SLUICE_LOG_ERROR,
            "%s: cannot be finished: %llu of %llu tiles are written; the first that is missing: "
            "layer %u, level %u, x %u, y %u%s",
            writer->file.path, (unsigned long long)writer->written_count,
            (unsigned long long)grid->chunk_count, place.layer, place.level, place.x, place.y,
            slc_store_is_tail(grid, &place) ? " (the tail)" : "");
    return SLUICE_ERROR_INVALID_TILE_STATE;
}

static SluiceResult seal_index(const SluiceStoreWriter *writer)
{
    for (uint64_t block = 0; block < writer->header.block_count; block++) {
        uint64_t missing;
        SluiceResult result = slc_store_writer_seal(writer, block, &missing);
        if (result != SLUICE_SUCCESS)
            return result;
        if (missing < writer->header.grid.chunk_count)
            return refuse_unfinished(writer, missing);
    }
    return SLUICE_SUCCESS;
}

static SluiceResult seal_and_publish(SluiceStoreWriter *writer)
{
    struct slc_store_header header = writer->header;
    unsigned char bytes[SLC_STORE_HEADER_SIZE];
    header.name = (const char *)writer->header_bytes + SLC_STORE_NAME_OFFSET;
    header.file_size = writer->end;
    if (header.compression_level == 0)
        header.file_size = header.data_offset + header.grid.layer_size * header.grid.layer_count;
    slc_store_header_write(&header, bytes);
    SluiceResult result = slc_part_file_cut(&writer->part, header.file_size);
    if (result == SLUICE_SUCCESS)
        result = slc_store_file_write(&writer->file, 0, bytes, sizeof bytes);
    if (result == SLUICE_SUCCESS)
        result = slc_part_file_publish(&writer->part);
    return result;
}

SluiceResult sluiceFinishStore(SluiceStoreWriter *writer)
{
    if (!writer)
        return SLUICE_ERROR_NULL_POINTER;
    if (writer->state == SLC_STORE_FINISHED)
        return SLUICE_ERROR_INVALID_TILE_STATE;
    if (writer->state == SLC_STORE_BROKEN)
        return SLUICE_ERROR_IO;
    SluiceResult result = seal_index(writer);
    if (result != SLUICE_SUCCESS)
        return result;
    result = seal_and_publish(writer);
    /* After a disk error the contents are unknown until they are read again. */
    writer->state = result == SLUICE_SUCCESS ? SLC_STORE_FINISHED : SLC_STORE_BROKEN;
    return result;
}
