#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "image/byte_order.h"
#include "store/store_writer.h"

#include <string.h>

static uint64_t entry_offset(uint64_t number)
{
    return slc_store_block_offset(number / SLC_STORE_BLOCK_ENTRIES) +
           slc_store_entry_offset(number);
}

SluiceResult slc_store_writer_entry(const SluiceStoreWriter *writer, uint64_t number,
                                    struct slc_store_entry *entry)
{
    unsigned char bytes[SLC_STORE_ENTRY_SIZE];
    SluiceResult result =
        slc_store_file_read(&writer->file, entry_offset(number), bytes, sizeof bytes);
    if (result == SLUICE_SUCCESS)
        *entry = slc_store_entry_read(bytes);
    return result;
}

SluiceResult slc_store_writer_seal(const SluiceStoreWriter *writer, uint64_t block,
                                   uint64_t *missing)
{
    unsigned char bytes[SLC_STORE_BLOCK_SIZE];
    const struct slc_store_file *file = &writer->file;
    uint64_t count = writer->header.grid.chunk_count;
    SluiceResult result =
        slc_store_file_read(file, slc_store_block_offset(block), bytes, sizeof bytes);
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t i = 0; i < SLC_STORE_BLOCK_ENTRIES; i++) {
        struct slc_store_entry entry = slc_store_entry_read(bytes + i * SLC_STORE_ENTRY_SIZE);
        *missing = block * SLC_STORE_BLOCK_ENTRIES + i;
        if (*missing < count && !slc_store_entry_is_written(&entry))
            return SLUICE_SUCCESS;
    }
    *missing = count;
    slc_store_block_seal(&writer->header, block, bytes);
    return slc_store_file_write(file, slc_store_block_offset(block), bytes, sizeof bytes);
}

static void free_bench(const SluiceAllocationCallbacks *cb, struct slc_store_bench *bench)
{
    slc_store_compressor_destroy(bench->compressor);
    slc_free(cb, bench, 1, sizeof *bench);
}

static void free_list(SluiceStoreWriter *writer, struct slc_store_bench **list)
{
    while (*list) {
        struct slc_store_bench *bench = *list;
        *list = bench->next;
        free_bench(&writer->allocator, bench);
    }
}

void slc_store_writer_free_benches(SluiceStoreWriter *writer)
{
    free_list(writer, &writer->idle);
    free_list(writer, &writer->waiting);
}

/* Makes `repeats` if the file is compressed, with the lock held. Returns false without host memory.
 */
static bool has_repeats(SluiceStoreWriter *writer)
{
    if (writer->header.compression_level && !writer->repeats)
        writer->repeats = slc_calloc(&writer->allocator, 1, sizeof *writer->repeats);
    return writer->header.compression_level == 0 || writer->repeats;
}

SluiceResult slc_store_writer_take_bench(SluiceStoreWriter *writer, struct slc_store_bench **out)
{
    slc_mutex_lock(&writer->mutex);
    bool ready = has_repeats(writer);
    struct slc_store_bench *bench = ready ? writer->idle : NULL;
    if (bench)
        writer->idle = bench->next;
    slc_mutex_unlock(&writer->mutex);
    if (!ready)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (!bench) {
        bench = slc_alloc(&writer->allocator, 1, sizeof *bench);
        if (!bench)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        bench->compressor = NULL;
    }
    *out = bench;
    if (writer->header.compression_level == 0 || bench->compressor)
        return SLUICE_SUCCESS;
    bench->compressor = slc_store_compressor_create(&writer->allocator);
    if (bench->compressor)
        return SLUICE_SUCCESS;
    free_bench(&writer->allocator, bench);
    return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_store_writer_give_bench(SluiceStoreWriter *writer, struct slc_store_bench *bench)
{
    slc_mutex_lock(&writer->mutex);
    bench->next = writer->idle;
    writer->idle = bench;
    slc_mutex_unlock(&writer->mutex);
}

/* Takes an unused place in the file. Errors: those of the writer's state. */
static SluiceResult take_place(SluiceStoreWriter *writer, const struct slc_store_place *place,
                               struct slc_store_entry *entry)
{
    const struct slc_store_header *header = &writer->header;
    slc_mutex_lock(&writer->mutex);
    SluiceResult result = writer->state == SLC_STORE_WRITING ? SLUICE_SUCCESS : SLUICE_ERROR_IO;
    if (header->compression_level == 0) {
        entry->offset = header->data_offset + slc_store_chunk_offset(&header->grid, place);
    } else if (result == SLUICE_SUCCESS) {
        entry->offset = writer->end;
        writer->end += entry->size;
    }
    slc_mutex_unlock(&writer->mutex);
    return result;
}

/* Gives a place back, unless another chunk was placed behind it. */
static void return_place(SluiceStoreWriter *writer, const struct slc_store_entry *entry)
{
    slc_mutex_lock(&writer->mutex);
    if (writer->end == entry->offset + entry->size)
        writer->end = entry->offset;
    slc_mutex_unlock(&writer->mutex);
}

/* Writes an entry. The room of the index was reserved at the start. If the write still fails, half
 * an entry may be written, which only a complete read finds out. */
static SluiceResult write_entry(SluiceStoreWriter *writer, uint64_t number,
                                const struct slc_store_entry *entry)
{
    unsigned char bytes[SLC_STORE_ENTRY_SIZE];
    slc_store_entry_write(entry, bytes);
    SluiceResult result =
        slc_store_file_write(&writer->file, entry_offset(number), bytes, sizeof bytes);
    slc_mutex_lock(&writer->mutex);
    if (result == SLUICE_SUCCESS)
        writer->written_count++;
    else
        writer->state = SLC_STORE_BROKEN;
    slc_mutex_unlock(&writer->mutex);
    return result;
}

/* True if an earlier chunk has equal bytes; `entry` then has their place. False for uncompressed
 * files, whose chunks have fixed places. */
static bool find_repeat(SluiceStoreWriter *writer, uint64_t hash, const void *bytes,
                        struct slc_store_entry *entry)
{
    struct slc_store_repeat repeat = {.size = 0};
    slc_mutex_lock(&writer->mutex);
    const struct slc_store_repeat *found =
        slc_store_repeats_find(writer->repeats, hash, entry->size);
    if (found && writer->state == SLC_STORE_WRITING)
        repeat = *found;
    slc_mutex_unlock(&writer->mutex);
    if (repeat.size == 0 || !slc_store_repeat_is_equal(&writer->file, &repeat, bytes))
        return false;
    entry->offset = repeat.offset;
    return true;
}

static void note_repeat(SluiceStoreWriter *writer, uint64_t hash,
                        const struct slc_store_entry *entry)
{
    const struct slc_store_repeat repeat = {hash, entry->offset, entry->size};
    slc_mutex_lock(&writer->mutex);
    slc_store_repeats_add(writer->repeats, &repeat);
    slc_mutex_unlock(&writer->mutex);
}

SluiceResult slc_store_writer_write(SluiceStoreWriter *writer, const struct slc_store_bench *bench)
{
    uint64_t number = slc_store_chunk_number(&writer->header.grid, &bench->place);
    struct slc_store_entry entry = {
        .checksum = slc_store_chunk_checksum(&writer->header, number, bench->bytes, bench->size),
        .size = (uint32_t)bench->size,
    };
    bool compressed = writer->header.compression_level != 0;
    uint64_t hash = compressed ? slc_store_repeat_hash(bench->bytes, bench->size) : 0;
    if (compressed && find_repeat(writer, hash, bench->bytes, &entry))
        return write_entry(writer, number, &entry);
    SluiceResult result = take_place(writer, &bench->place, &entry);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_store_file_write(&writer->file, entry.offset, bench->bytes, bench->size);
    if (result != SLUICE_SUCCESS) {
        return_place(writer, &entry);
        return result;
    }
    if (compressed)
        note_repeat(writer, hash, &entry);
    return write_entry(writer, number, &entry);
}

/* Returns texels in the file's byte order: `texels` itself, or a copy in bench->texels. */
static const void *in_file_order(SluiceFormat format, struct slc_store_bench *bench,
                                 const void *texels, size_t size)
{
    if (!slc_file_order_differs(format))
        return texels;
    if (texels != bench->texels)
        memcpy(bench->texels, texels, size);
    slc_exchange_file_order(format, bench->texels, size);
    return bench->texels;
}

/* Compresses a chunk. `texels`: the whole chunk, in tight rows. */
static SluiceResult compress_chunk(SluiceStoreWriter *writer, const struct slc_store_place *place,
                                   const void *texels, struct slc_store_bench *bench)
{
    bench->place = *place;
    bench->size = slc_store_chunk_size(&writer->header.grid, place);
    texels = in_file_order(writer->header.grid.layout.format, bench, texels, bench->size);
    bench->bytes = texels;
    if (writer->header.compression_level == 0)
        return SLUICE_SUCCESS;
    size_t stored_size;
    SluiceResult result =
        slc_store_compress(bench->compressor, (int)writer->header.compression_level, texels,
                           bench->size, bench->stored, &stored_size);
    if (result == SLUICE_SUCCESS && stored_size > 0) {
        bench->bytes = bench->stored;
        bench->size = stored_size;
    }
    return result;
}

/* Copies `size` bytes of each of `rows` rows, `row_pitch` bytes apart, to tight rows. */
static void pack_rows(const void *texels, size_t row_pitch, size_t size, uint32_t rows,
                      unsigned char *packed)
{
    for (uint32_t row = 0; row < rows; row++)
        memcpy(packed + row * size, (const char *)texels + row * row_pitch, size);
}

static SluiceResult check_unwritten(SluiceStoreWriter *writer, const struct slc_store_place *place)
{
    slc_mutex_lock(&writer->mutex);
    bool is_finished = writer->state == SLC_STORE_FINISHED;
    slc_mutex_unlock(&writer->mutex);
    if (is_finished)
        return SLUICE_ERROR_INVALID_TILE_STATE;
    struct slc_store_entry entry;
    SluiceResult result =
        slc_store_writer_entry(writer, slc_store_chunk_number(&writer->header.grid, place), &entry);
    if (result != SLUICE_SUCCESS)
        return result;
    return slc_store_entry_is_written(&entry) ? SLUICE_ERROR_INVALID_TILE_STATE : SLUICE_SUCCESS;
}

SluiceResult slc_store_writer_check_tile(SluiceStoreWriter *writer, uint32_t layer, uint32_t level,
                                         uint32_t x, uint32_t y, size_t row_pitch,
                                         struct slc_store_place *place)
{
    const struct slc_store_grid *grid = &writer->header.grid;
    SluiceResult result = slc_store_writer_find(writer, layer, level, x, y, place);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_store_is_tail(grid, place))
        return slc_log_refusal(&writer->file.log,
                               "mipLevel is %u; levels from %u are the tail (sluiceWriteStoreTail)",
                               level, grid->layout.tailFirstLevel);
    SluiceImageRegion region = slc_store_chunk_region(grid, place);
    size_t row_size = slc_format_row_size(&grid->format, region.width);
    if (row_pitch < row_size)
        return slc_log_refusal(&writer->file.log, "rowPitch is %llu; it must be at least %llu",
                               (unsigned long long)row_pitch, (unsigned long long)row_size);
    return check_unwritten(writer, place);
}

SluiceResult slc_store_writer_compress(SluiceStoreWriter *writer,
                                       const struct slc_store_place *place, const void *texels,
                                       size_t row_pitch, struct slc_store_bench *bench)
{
    const struct slc_store_grid *grid = &writer->header.grid;
    SluiceImageRegion region = slc_store_chunk_region(grid, place);
    size_t row_size = slc_format_row_size(&grid->format, region.width);
    if (row_pitch != row_size) {
        pack_rows(texels, row_pitch, row_size, slc_format_row_count(&grid->format, region.height),
                  bench->texels);
        texels = bench->texels;
    }
    return compress_chunk(writer, place, texels, bench);
}

SluiceResult sluiceWriteStoreTile(SluiceStoreWriter *writer, uint32_t arrayLayer, uint32_t mipLevel,
                                  uint32_t tileX, uint32_t tileY, const void *pTexels,
                                  size_t rowPitch)
{
    if (!writer || !pTexels)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_store_place place;
    SluiceResult result =
        slc_store_writer_check_tile(writer, arrayLayer, mipLevel, tileX, tileY, rowPitch, &place);
    struct slc_store_bench *bench;
    if (result == SLUICE_SUCCESS)
        result = slc_store_writer_take_bench(writer, &bench);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_store_writer_compress(writer, &place, pTexels, rowPitch, bench);
    if (result == SLUICE_SUCCESS)
        result = slc_store_writer_write(writer, bench);
    slc_store_writer_give_bench(writer, bench);
    return result;
}

/* Rows of a level of the tail, in the memory of the caller. */
struct tail_level {
    size_t row_size, pitch;
    uint32_t rows;
};

static struct tail_level tail_level(const struct slc_store_grid *grid, uint32_t i,
                                    const size_t *pitches)
{
    uint32_t level = grid->layout.tailFirstLevel + i;
    size_t row_size = slc_format_row_size(&grid->format, slc_mip_size(grid->layout.width, level));
    return (struct tail_level){
        row_size, pitches ? pitches[i] : row_size,
        slc_format_row_count(&grid->format, slc_mip_size(grid->layout.height, level))};
}

static SluiceResult check_tail(const SluiceStoreWriter *writer, const void *const *levels,
                               const size_t *pitches)
{
    const struct slc_store_grid *grid = &writer->header.grid;
    uint32_t count = grid->layout.mipLevelCount - grid->layout.tailFirstLevel;
    for (uint32_t i = 0; i < count; i++) {
        if (!levels[i])
            return SLUICE_ERROR_NULL_POINTER;
        struct tail_level level = tail_level(grid, i, pitches);
        if (level.pitch < level.row_size)
            return slc_log_refusal(
                &writer->file.log, "pRowPitches[%u] is %llu; it must be at least %llu", i,
                (unsigned long long)level.pitch, (unsigned long long)level.row_size);
    }
    return SLUICE_SUCCESS;
}

SluiceResult sluiceWriteStoreTail(SluiceStoreWriter *writer, uint32_t arrayLayer,
                                  const void *const *ppLevels, const size_t *pRowPitches)
{
    if (!writer || !ppLevels)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_store_grid *grid = &writer->header.grid;
    uint32_t first = grid->layout.tailFirstLevel;
    struct slc_store_place place;
    SluiceResult result = slc_store_writer_find(writer, arrayLayer, first, 0, 0, &place);
    if (result == SLUICE_SUCCESS)
        result = check_tail(writer, ppLevels, pRowPitches);
    if (result == SLUICE_SUCCESS)
        result = check_unwritten(writer, &place);
    struct slc_store_bench *bench;
    if (result == SLUICE_SUCCESS)
        result = slc_store_writer_take_bench(writer, &bench);
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t i = 0; first + i < grid->layout.mipLevelCount; i++) {
        struct tail_level level = tail_level(grid, i, pRowPitches);
        pack_rows(ppLevels[i], level.pitch, level.row_size, level.rows,
                  bench->texels + slc_store_tail_offset(grid, first + i));
    }
    result = compress_chunk(writer, &place, bench->texels, bench);
    if (result == SLUICE_SUCCESS)
        result = slc_store_writer_write(writer, bench);
    slc_store_writer_give_bench(writer, bench);
    return result;
}
