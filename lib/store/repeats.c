#include "store/repeats.h"

#include <string.h>
#include <xxhash.h>

#define PIECE 4096u /* bytes that are compared at a time */

uint64_t slc_store_repeat_hash(const void *bytes, size_t size)
{
    return XXH3_64bits(bytes, size);
}

const struct slc_store_repeat *slc_store_repeats_find(const struct slc_store_repeats *repeats,
                                                      uint64_t hash, size_t size)
{
    const struct slc_store_repeat *repeat = &repeats->at[hash % SLC_STORE_REPEATS];
    return repeat->hash == hash && repeat->size == size ? repeat : NULL;
}

void slc_store_repeats_add(struct slc_store_repeats *repeats, const struct slc_store_repeat *repeat)
{
    repeats->at[repeat->hash % SLC_STORE_REPEATS] = *repeat;
}

bool slc_store_repeat_is_equal(const struct slc_store_file *file,
                               const struct slc_store_repeat *repeat, const void *bytes)
{
    unsigned char piece[PIECE];
    for (uint32_t at = 0; at < repeat->size; at += PIECE) {
        uint32_t size = repeat->size - at < PIECE ? repeat->size - at : PIECE;
        if (slc_store_file_read(file, repeat->offset + at, piece, size) != SLUICE_SUCCESS ||
            memcmp(piece, (const char *)bytes + at, size) != 0)
            return false;
    }
    return true;
}
