#include "store/resume.h"

#include "base/alloc.h"

#include <string.h>

struct resume {
    const struct slc_store_file *file;
    const struct slc_store_header *header;
    struct slc_store_resumed *resumed;
    unsigned char *chunk; ///< SLC_STORE_MAX_CHUNK_SIZE bytes
};

static bool is_empty(const struct slc_store_entry *entry)
{
    return entry->offset == 0 && entry->size == 0 && entry->checksum == 0;
}

static SluiceResult check_chunk(const struct resume *resume, uint64_t number,
                                const struct slc_store_entry *entry, bool *is_right)
{
    struct slc_store_place place = slc_store_chunk_place(&resume->header->grid, number);
    *is_right = false;
    if (slc_store_entry_defect(resume->header, resume->file->size, &place, entry))
        return SLUICE_SUCCESS;
    SluiceResult result =
        slc_store_file_read(resume->file, entry->offset, resume->chunk, entry->size);
    if (result == SLUICE_SUCCESS)
        *is_right = slc_store_chunk_checksum(resume->header, number, resume->chunk, entry->size) ==
                    entry->checksum;
    return result;
}

/* Adds the chunk in resume->chunk to the table. Chunks come by number, not in the order of writing:
 * of two chunks for one table entry, the chunk with the higher offset was written last. */
static void remember(const struct resume *resume, const struct slc_store_entry *entry)
{
    struct slc_store_repeats *repeats = resume->resumed->repeats;
    if (!repeats)
        return;
    const struct slc_store_repeat repeat = {slc_store_repeat_hash(resume->chunk, entry->size),
                                            entry->offset, entry->size};
    const struct slc_store_repeat *old = &repeats->at[repeat.hash % SLC_STORE_REPEATS];
    if (old->size == 0 || old->offset < repeat.offset)
        slc_store_repeats_add(repeats, &repeat);
}

/* Checks an entry. An entry of a chunk that does not exist is wrong, too. */
static SluiceResult check_entry(const struct resume *resume, uint64_t number, unsigned char *bytes,
                                bool *has_changed)
{
    struct slc_store_entry entry = slc_store_entry_read(bytes);
    if (is_empty(&entry))
        return SLUICE_SUCCESS;
    bool is_right = false;
    SluiceResult result = SLUICE_SUCCESS;
    if (number < resume->header->grid.chunk_count)
        result = check_chunk(resume, number, &entry, &is_right);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!is_right) {
        memset(bytes, 0, SLC_STORE_ENTRY_SIZE);
        *has_changed = true;
        return SLUICE_SUCCESS;
    }
    remember(resume, &entry);
    resume->resumed->chunk_count++;
    if (entry.offset + entry.size > resume->resumed->end)
        resume->resumed->end = entry.offset + entry.size;
    return SLUICE_SUCCESS;
}

static SluiceResult check_block(const struct resume *resume, uint64_t block)
{
    unsigned char bytes[SLC_STORE_BLOCK_SIZE];
    const struct slc_store_file *file = resume->file;
    uint64_t offset = slc_store_block_offset(block);
    bool has_changed = false;
    SluiceResult result = slc_store_file_read(file, offset, bytes, sizeof bytes);
    for (uint32_t i = 0; i < SLC_STORE_BLOCK_ENTRIES && result == SLUICE_SUCCESS; i++)
        result = check_entry(resume, block * SLC_STORE_BLOCK_ENTRIES + i,
                             bytes + i * SLC_STORE_ENTRY_SIZE, &has_changed);
    if (result == SLUICE_SUCCESS && has_changed)
        result = slc_store_file_write(file, offset, bytes, sizeof bytes);
    return result;
}

SluiceResult slc_store_resume(const struct slc_store_file *file,
                              const struct slc_store_header *header,
                              struct slc_store_resumed *resumed)
{
    const SluiceAllocationCallbacks *cb = &file->allocator;
    *resumed = (struct slc_store_resumed){.end = header->data_offset};
    struct resume resume = {file, header, resumed, slc_alloc(cb, SLC_STORE_MAX_CHUNK_SIZE, 1)};
    if (header->compression_level)
        resumed->repeats = slc_calloc(cb, 1, sizeof *resumed->repeats);
    SluiceResult result = resume.chunk && (resumed->repeats || !header->compression_level)
                              ? SLUICE_SUCCESS
                              : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t block = 0; block < header->block_count && result == SLUICE_SUCCESS; block++)
        result = check_block(&resume, block);
    slc_free(cb, resume.chunk, SLC_STORE_MAX_CHUNK_SIZE, 1);
    if (result != SLUICE_SUCCESS) {
        slc_free(cb, resumed->repeats, 1, sizeof *resumed->repeats);
        resumed->repeats = NULL;
    }
    return result;
}
