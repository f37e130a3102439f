/*
 * Replaces Zstandard for cross builds without its package. Compresses nothing, so that stores keep
 * every tile uncompressed, and decompresses nothing.
 */
#define ZSTD_STATIC_LINKING_ONLY
#include <zstd.h>
#include <zstd_errors.h>

#define FAILED ((size_t)-1)

static char nothing; /* target of all context pointers */

ZSTD_CCtx *ZSTD_createCCtx_advanced(ZSTD_customMem memory)
{
    (void)memory;
    return (void *)&nothing;
}

size_t ZSTD_freeCCtx(ZSTD_CCtx *context)
{
    (void)context;
    return 0;
}

size_t ZSTD_compressCCtx(ZSTD_CCtx *context, void *out, size_t capacity, const void *bytes,
                         size_t size, int level)
{
    (void)context, (void)out, (void)capacity, (void)bytes, (void)size, (void)level;
    return FAILED;
}

ZSTD_DCtx *ZSTD_createDCtx_advanced(ZSTD_customMem memory)
{
    (void)memory;
    return (void *)&nothing;
}

size_t ZSTD_freeDCtx(ZSTD_DCtx *context)
{
    (void)context;
    return 0;
}

unsigned long long ZSTD_getFrameContentSize(const void *bytes, size_t size)
{
    (void)bytes, (void)size;
    return ZSTD_CONTENTSIZE_ERROR;
}

size_t ZSTD_decompressDCtx(ZSTD_DCtx *context, void *out, size_t capacity, const void *bytes,
                           size_t size)
{
    (void)context, (void)out, (void)capacity, (void)bytes, (void)size;
    return FAILED;
}

size_t ZSTD_decompress(void *out, size_t capacity, const void *bytes, size_t size)
{
    (void)out, (void)capacity, (void)bytes, (void)size;
    return FAILED;
}

unsigned ZSTD_isError(size_t result)
{
    return result == FAILED;
}

ZSTD_ErrorCode ZSTD_getErrorCode(size_t result)
{
    return result == FAILED ? ZSTD_error_dstSize_tooSmall : ZSTD_error_no_error;
}

const char *ZSTD_getErrorName(size_t result)
{
    (void)result;
    return "there is no Zstandard in this build";
}
