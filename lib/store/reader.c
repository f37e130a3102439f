#include "store/reader.h"

#include "base/alloc.h"
#include "image/byte_order.h"
#include "store/codec.h"

#include <string.h>

static SluiceResult read_header(struct slc_store_reader *reader)
{
    const struct slc_input_file *file = &reader->file;
    if (file->size < SLC_STORE_HEADER_SIZE)
        return slc_input_fail_at(file, SLUICE_ERROR_CORRUPT_DATA, file->size,
                                 "is shorter than the header of a tile store");
    SluiceResult result =
        slc_input_file_read(file, 0, reader->header_bytes, sizeof reader->header_bytes);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t offset;
    const char *message;
    result = slc_store_header_read(&reader->header, reader->header_bytes, &offset, &message);
    uint32_t number;
    if (result != SLUICE_SUCCESS && slc_store_header_number(reader->header_bytes, offset, &number))
        return slc_input_fail(file, result, "at %u: %s; the number is %u", offset, message, number);
    if (result != SLUICE_SUCCESS)
        return slc_input_fail_at(file, result, offset, message);
    if (reader->header.file_size < file->size)
        return slc_input_fail_at(file, SLUICE_ERROR_CORRUPT_DATA, reader->header.file_size,
                                 "the file goes on behind its end");
    if (reader->header.file_size > file->size || reader->header.data_offset > file->size)
        return slc_input_fail_at(file, SLUICE_ERROR_CORRUPT_DATA, file->size,
                                 "the file is cut off here; copy it again");
    return SLUICE_SUCCESS;
}

SluiceResult slc_store_reader_open(struct slc_store_reader *reader,
                                   const SluiceStoreImageSourceCreateInfo *info)
{
    SluiceAllocationCallbacks cb = slc_allocator(info->pAllocator);
    *reader = (struct slc_store_reader){.pool = info->readPool,
                                        .checks_always = info->alwaysCheckRawTiles};
    struct slc_input_choice choice = {info->pPath, info->pInput, info->filePool};
    SluiceResult result = slc_input_file_init_choice(&reader->file, &choice, &cb, &info->log);
    if (result == SLUICE_SUCCESS)
        result = slc_input_file_open(&reader->file);
    if (result == SLUICE_SUCCESS)
        result = read_header(reader);
    if (result == SLUICE_SUCCESS && !reader->pool) {
        result = sluiceCreateStoreReadPool(info->pAllocator, &reader->own_pool);
        reader->pool = reader->own_pool;
    }
    if (result != SLUICE_SUCCESS)
        return result;
    slc_store_equal_chunks_find(&reader->equal, &reader->file, &reader->header);
    reader->has_mutex = slc_mutex_init(&reader->mutex);
    return reader->has_mutex ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_store_reader_close(struct slc_store_reader *reader)
{
    for (uint32_t i = 0; i < SLC_STORE_KEPT_BLOCKS; i++)
        slc_free(&reader->file.allocator, reader->kept[i].bytes, SLC_STORE_BLOCK_SIZE, 1);
    slc_store_equal_chunks_finish(&reader->equal, &reader->file.allocator);
    if (reader->has_mutex)
        slc_mutex_finish(&reader->mutex);
    sluiceDestroyStoreReadPool(reader->own_pool);
    slc_input_file_finish(&reader->file);
}

static bool find_in_kept(struct slc_store_reader *reader, uint64_t block,
                         struct slc_store_find *find)
{
    uint32_t i = (uint32_t)(block % SLC_STORE_KEPT_BLOCKS);
    slc_mutex_lock(&reader->mutex);
    bool is_kept = reader->kept[i].bytes && reader->kept[i].number == block;
    if (is_kept) {
        uint32_t entry = (uint32_t)(find->number % SLC_STORE_BLOCK_ENTRIES);
        find->entry =
            slc_store_entry_read(reader->kept[i].bytes + slc_store_entry_offset(find->number));
        find->is_checked = (reader->kept[i].checked[entry / 8] >> entry % 8 & 1) != 0;
    }
    slc_mutex_unlock(&reader->mutex);
    return is_kept;
}

/* Keeps a block. Without memory, the block is read again the next time. */
static void keep_block(struct slc_store_reader *reader, uint64_t block, const unsigned char *bytes)
{
    uint32_t i = (uint32_t)(block % SLC_STORE_KEPT_BLOCKS);
    slc_mutex_lock(&reader->mutex);
    if (!reader->kept[i].bytes)
        reader->kept[i].bytes = slc_alloc(&reader->file.allocator, SLC_STORE_BLOCK_SIZE, 1);
    if (reader->kept[i].bytes) {
        memcpy(reader->kept[i].bytes, bytes, SLC_STORE_BLOCK_SIZE);
        memset(reader->kept[i].checked, 0, sizeof reader->kept[i].checked);
        reader->kept[i].number = block;
    }
    slc_mutex_unlock(&reader->mutex);
}

static SluiceResult find_in_file(struct slc_store_reader *reader, uint64_t block,
                                 struct slc_store_find *find)
{
    unsigned char bytes[SLC_STORE_BLOCK_SIZE];
    find->offset = slc_store_block_offset(block);
    SluiceResult result = slc_input_file_read(&reader->file, find->offset, bytes, sizeof bytes);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_store_block_is_sound(&reader->header, block, bytes))
        return slc_input_fail_at(&reader->file, SLUICE_ERROR_CORRUPT_DATA, find->offset,
                                 "the checksum of a part of the index is wrong");
    find->entry = slc_store_entry_read(bytes + slc_store_entry_offset(find->number));
    keep_block(reader, block, bytes);
    return SLUICE_SUCCESS;
}

SluiceResult slc_store_find_chunk(struct slc_store_reader *reader, struct slc_store_find *find)
{
    find->number = slc_store_chunk_number(&reader->header.grid, &find->place);
    uint64_t block = find->number / SLC_STORE_BLOCK_ENTRIES;
    if (!find_in_kept(reader, block, find)) {
        SluiceResult result = find_in_file(reader, block, find);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    const char *defect = slc_store_entry_defect(&reader->header, reader->header.file_size,
                                                &find->place, &find->entry);
    find->offset = slc_store_block_offset(block) + slc_store_entry_offset(find->number);
    if (defect)
        return slc_input_fail_at(&reader->file, SLUICE_ERROR_CORRUPT_DATA, find->offset, defect);
    find->offset = find->entry.offset;
    return SLUICE_SUCCESS;
}

static void note_checked(struct slc_store_reader *reader, const struct slc_store_find *find)
{
    uint64_t block = find->number / SLC_STORE_BLOCK_ENTRIES;
    uint32_t i = (uint32_t)(block % SLC_STORE_KEPT_BLOCKS);
    uint32_t entry = (uint32_t)(find->number % SLC_STORE_BLOCK_ENTRIES);
    slc_mutex_lock(&reader->mutex);
    if (reader->kept[i].bytes && reader->kept[i].number == block)
        reader->kept[i].checked[entry / 8] |= (uint8_t)(1 << entry % 8);
    slc_mutex_unlock(&reader->mutex);
}

static SluiceResult read_stored(struct slc_store_reader *reader, const struct slc_store_find *find,
                                void *bytes)
{
    size_t size = find->entry.size;
    SluiceResult result = slc_input_file_read(&reader->file, find->offset, bytes, size);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_store_chunk_checksum(&reader->header, find->number, bytes, size) ==
        find->entry.checksum)
        return SLUICE_SUCCESS;
    return slc_input_fail_at(&reader->file, SLUICE_ERROR_CORRUPT_DATA, find->offset,
                             "the checksum of a tile is wrong");
}

static SluiceResult read_raw(struct slc_store_reader *reader, const struct slc_store_find *find,
                             void *texels)
{
    if (!reader->checks_always && find->is_checked)
        return slc_input_file_read(&reader->file, find->offset, texels, find->entry.size);
    SluiceResult result = read_stored(reader, find, texels);
    if (!reader->checks_always && result == SLUICE_SUCCESS)
        note_checked(reader, find);
    return result;
}

static SluiceResult read_compressed(struct slc_store_reader *reader,
                                    const struct slc_store_find *find,
                                    struct slc_store_read_bench *bench, void *texels,
                                    size_t texel_size)
{
    SluiceResult result = read_stored(reader, find, bench->stored);
    if (result != SLUICE_SUCCESS)
        return result;
    const char *message;
    struct slc_store_decompressor *decompressor = slc_store_read_decompressor(reader->pool, bench);
    if (!decompressor)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    result = slc_store_decompress(decompressor, bench->stored, find->entry.size, texels, texel_size,
                                  &message);
    if (result == SLUICE_ERROR_CORRUPT_DATA)
        slc_input_fail_at(&reader->file, result, find->offset, message);
    return result;
}

SluiceResult slc_store_read_chunk(struct slc_store_reader *reader,
                                  const struct slc_store_place *place,
                                  struct slc_store_read_bench *bench, void *texels,
                                  struct slc_store_find *find)
{
    *find = (struct slc_store_find){.place = *place};
    SluiceResult result = slc_store_find_chunk(reader, find);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t texel_size = slc_store_chunk_size(&reader->header.grid, place);
    result = find->entry.size == texel_size
                 ? read_raw(reader, find, texels)
                 : read_compressed(reader, find, bench, texels, texel_size);
    if (result == SLUICE_SUCCESS)
        slc_exchange_file_order(reader->header.grid.layout.format, texels, texel_size);
    return result;
}
