#include "store/equal_chunks.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <stdlib.h>
#include <string.h>

static int compare_places(const void *a, const void *b)
{
    const struct slc_store_equal_chunk *x = a, *y = b;
    if (x->offset != y->offset)
        return x->offset < y->offset ? -1 : 1;
    return (x->size > y->size) - (x->size < y->size);
}

static int compare_numbers(const void *a, const void *b)
{
    const struct slc_store_equal_chunk *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

/* Lists all chunks of undamaged blocks. Returns the sum of their sizes. */
static uint64_t list_chunks(struct slc_store_equal_chunks *chunks,
                            const struct slc_store_header *header, const unsigned char *index)
{
    uint64_t sum = 0;
    uint32_t chunk_count = (uint32_t)header->grid.chunk_count;
    for (uint32_t number = 0; number < chunk_count; number++) {
        uint32_t block = number / SLC_STORE_BLOCK_ENTRIES;
        const unsigned char *bytes = index + (size_t)block * SLC_STORE_BLOCK_SIZE;
        if (number % SLC_STORE_BLOCK_ENTRIES == 0 &&
            !slc_store_block_is_sound(header, block, bytes)) {
            number += SLC_STORE_BLOCK_ENTRIES - 1;
            continue;
        }
        struct slc_store_entry entry = slc_store_entry_read(bytes + slc_store_entry_offset(number));
        chunks->at[chunks->count++] =
            (struct slc_store_equal_chunk){entry.offset, entry.size, number};
        sum += entry.size;
    }
    return sum;
}

/* Keeps the chunks that share their bytes with other chunks. */
static void keep_equal(struct slc_store_equal_chunks *chunks)
{
    struct slc_store_equal_chunk *at = chunks->at;
    uint32_t kept = 0, count = chunks->count;
    qsort(at, count, sizeof *at, compare_places);
    for (uint32_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && compare_places(&at[begin], &at[end]) == 0;)
            end++;
        for (uint32_t i = begin; end - begin > 1 && at[begin].offset > 0 && i < end; i++)
            at[kept++] = at[i];
    }
    chunks->count = kept;
    qsort(at, kept, sizeof *at, compare_numbers);
}

static void shrink(struct slc_store_equal_chunks *chunks, const SluiceAllocationCallbacks *cb)
{
    struct slc_store_equal_chunk *at = slc_alloc(cb, chunks->count, sizeof *at);
    if (!at)
        return;
    memcpy(at, chunks->at, chunks->count * sizeof *at);
    slc_free(cb, chunks->at, chunks->capacity, sizeof *at);
    chunks->at = at;
    chunks->capacity = chunks->count;
}

/* Reads the index. Failures are not logged here, but when a tile needs the index. */
static bool read_index(const struct slc_input_file *file, unsigned char *index, size_t size)
{
    return slc_input_file_read_some(file, slc_store_block_offset(0), index, size) == (int64_t)size;
}

void slc_store_equal_chunks_find(struct slc_store_equal_chunks *chunks,
                                 const struct slc_input_file *file,
                                 const struct slc_store_header *header)
{
    const SluiceAllocationCallbacks *cb = &file->allocator;
    *chunks = (struct slc_store_equal_chunks){0};
    if (header->compression_level == 0 || header->block_count > SLC_STORE_MAX_COMPARED_BLOCKS)
        return;
    size_t size = (size_t)header->block_count * SLC_STORE_BLOCK_SIZE;
    unsigned char *index = slc_alloc(cb, size, 1);
    chunks->capacity = (uint32_t)header->grid.chunk_count;
    chunks->at = slc_alloc(cb, chunks->capacity, sizeof *chunks->at);
    /* Without equal chunks the sizes in the index do not exceed the file. */
    if (index && chunks->at && read_index(file, index, size) &&
        list_chunks(chunks, header, index) > header->file_size - header->data_offset)
        keep_equal(chunks);
    else
        chunks->count = 0;
    slc_free(cb, index, size, 1);
    if (chunks->count > 0)
        shrink(chunks, cb);
    else
        slc_store_equal_chunks_finish(chunks, cb);
}

void slc_store_equal_chunks_finish(struct slc_store_equal_chunks *chunks,
                                   const SluiceAllocationCallbacks *cb)
{
    if (chunks->at)
        slc_free(cb, chunks->at, chunks->capacity, sizeof *chunks->at);
    *chunks = (struct slc_store_equal_chunks){0};
}

uint64_t slc_store_equal_chunks_get(const struct slc_store_equal_chunks *chunks, uint64_t number)
{
    uint32_t low = 0, high = chunks->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (chunks->at[middle].number < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low < chunks->count && chunks->at[low].number == number ? chunks->at[low].offset : 0;
}
