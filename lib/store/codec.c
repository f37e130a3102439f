#include "store/codec.h"

#include "base/alloc.h"
#include "base/checked.h"

#define ZSTD_STATIC_LINKING_ONLY /* for contexts with an allocator; all shared builds export them  \
                                  */
#include <zstd.h>
#include <zstd_errors.h>

#include <stdalign.h>
#include <string.h>

/* Allocations for zstd store their size in front: the allocator is told sizes on free, zstd has
 * none. */
enum { PREFIX = alignof(max_align_t) };
_Static_assert(PREFIX >= sizeof(size_t), "the size fits in front");

static void *allocate(void *user, size_t size)
{
    size_t whole;
    if (!slc_add_size(size, PREFIX, &whole))
        return NULL;
    char *memory = slc_alloc(user, whole, 1);
    if (!memory)
        return NULL;
    memcpy(memory, &whole, sizeof whole);
    return memory + PREFIX;
}

static void deallocate(void *user, void *address)
{
    if (!address)
        return;
    char *memory = (char *)address - PREFIX;
    size_t whole;
    memcpy(&whole, memory, sizeof whole);
    slc_free(user, memory, whole, 1);
}

static ZSTD_customMem memory_of(const SluiceAllocationCallbacks *cb)
{
    return (ZSTD_customMem){allocate, deallocate, (void *)cb};
}

struct slc_store_compressor *slc_store_compressor_create(const SluiceAllocationCallbacks *cb)
{
    return (struct slc_store_compressor *)ZSTD_createCCtx_advanced(memory_of(cb));
}

void slc_store_compressor_destroy(struct slc_store_compressor *compressor)
{
    ZSTD_freeCCtx((ZSTD_CCtx *)compressor);
}

SluiceResult slc_store_compress(struct slc_store_compressor *compressor, int level,
                                const void *texels, size_t size, void *out, size_t *out_size)
{
    size_t got = ZSTD_compressCCtx((ZSTD_CCtx *)compressor, out, size - 1, texels, size, level);
    *out_size = ZSTD_isError(got) ? 0 : got;
    return ZSTD_getErrorCode(got) == ZSTD_error_memory_allocation ? SLUICE_ERROR_OUT_OF_HOST_MEMORY
                                                                  : SLUICE_SUCCESS;
}

struct slc_store_decompressor *slc_store_decompressor_create(const SluiceAllocationCallbacks *cb)
{
    return (struct slc_store_decompressor *)ZSTD_createDCtx_advanced(memory_of(cb));
}

void slc_store_decompressor_destroy(struct slc_store_decompressor *decompressor)
{
    ZSTD_freeDCtx((ZSTD_DCtx *)decompressor);
}

SluiceResult slc_store_decompress(struct slc_store_decompressor *decompressor, const void *bytes,
                                  size_t size, void *texels, size_t texel_size,
                                  const char **message)
{
    *message = "a tile does not decompress to the size of its texels";
    if (ZSTD_getFrameContentSize(bytes, size) != texel_size)
        return SLUICE_ERROR_CORRUPT_DATA;
    size_t got = ZSTD_decompressDCtx((ZSTD_DCtx *)decompressor, texels, texel_size, bytes, size);
    if (got == texel_size)
        return SLUICE_SUCCESS;
    if (ZSTD_getErrorCode(got) == ZSTD_error_memory_allocation)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (ZSTD_isError(got))
        *message = ZSTD_getErrorName(got);
    return SLUICE_ERROR_CORRUPT_DATA;
}
