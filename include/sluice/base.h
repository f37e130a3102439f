/**
 * What every Sluice header shares: results, memory and log callbacks, the export macro.
 *
 * Threading, for the whole library: an object is externally synchronised unless its header says
 * otherwise; calls that take a const handle may overlap each other. There are no mutable globals.
 */
#ifndef SLUICE_BASE_H
#define SLUICE_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define SLUICE_API
#else
#define SLUICE_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/**
 * What a call answers. As in VkResult: 0 is success, positive is news, negative is failure.
 * After a failure nothing has changed, unless the call says otherwise.
 */
typedef enum SluiceResult {
    SLUICE_SUCCESS = 0,
    /** There was more than the caller had room for. */
    SLUICE_INCOMPLETE = 1,
    /** The answer is not there yet; ask again. */
    SLUICE_NOT_READY = 2,
    /** Requests are left that no heap has room for; they stay queued. */
    SLUICE_BUDGET_REACHED = 3,

    SLUICE_ERROR_OUT_OF_HOST_MEMORY = -1,
    SLUICE_ERROR_OUT_OF_DEVICE_MEMORY = -2,
    /** A pointer that must not be NULL was. */
    SLUICE_ERROR_NULL_POINTER = -3,
    /** A value is outside the range its documentation gives. */
    SLUICE_ERROR_INVALID_ARGUMENT = -4,
    /** A heap of zero tiles, or a tile of zero bytes. */
    SLUICE_ERROR_ZERO_HEAP_CAPACITY = -5,
    /** A texture without any tile, or a tile, level or texture without any texel. */
    SLUICE_ERROR_ZERO_TILES = -6,
    /** Packed level and packed tile counts contradict each other or the level count. */
    SLUICE_ERROR_INVALID_PACKED_MIPS = -7,
    /** No texture ever had this id. */
    SLUICE_ERROR_UNKNOWN_TEXTURE = -8,
    /** The texture of this id was removed. */
    SLUICE_ERROR_STALE_TEXTURE = -9,
    /** A tile index beyond the texture's tiles. */
    SLUICE_ERROR_UNKNOWN_TILE = -10,
    /** The tile is not in a state in which this may be said of it. */
    SLUICE_ERROR_INVALID_TILE_STATE = -11,
    /** A time stamp or retire value lies before an earlier one. */
    SLUICE_ERROR_TIME_BACKWARDS = -12,
    /** A map or buffer has another size than the texture asks for. */
    SLUICE_ERROR_SIZE_MISMATCH = -13,
    SLUICE_ERROR_UNKNOWN_HEAP = -14,
    /** The heap still holds tiles. */
    SLUICE_ERROR_HEAP_IN_USE = -15,
    /** The texture has more tiles, or the manager more textures, than an index can count. */
    SLUICE_ERROR_LIMIT_EXCEEDED = -16,
    /** A file contradicts its own format; the log callback says where. */
    SLUICE_ERROR_CORRUPT_DATA = -17,
    /** Well-formed, but of a kind that Sluice does not handle; the log callback says which. */
    SLUICE_ERROR_UNSUPPORTED = -18,
    SLUICE_ERROR_FILE_NOT_FOUND = -19,
    /** The operating system could not read or write. */
    SLUICE_ERROR_IO = -20,
    SLUICE_ERROR_CANCELLED = -21,
    /** A Vulkan call failed; the log callback says which and with what VkResult. */
    SLUICE_ERROR_VULKAN = -22,
    SLUICE_ERROR_DEVICE_LOST = -23
} SluiceResult;

/** The enumerator's name, "SLUICE_RESULT_UNKNOWN" for others. Never NULL. Any thread. */
SLUICE_API const char *sluiceResultString(SluiceResult result);

/**
 * Host memory. Both functions may be called from any thread that the owning object is used on or
 * that it started. Where a create-info takes a pointer to this, NULL asks for malloc and free.
 */
typedef struct SluiceAllocationCallbacks {
    void *pUserData;
    /** `size` > 0 bytes at a multiple of `alignment` (a power of two), or NULL. */
    void *(*pfnAllocate)(void *pUserData, size_t size, size_t alignment);
    /** `size` is what was asked for. `pMemory` is never NULL. */
    void (*pfnFree)(void *pUserData, void *pMemory, size_t size);
} SluiceAllocationCallbacks;

typedef enum SluiceLogSeverity {
    SLUICE_LOG_INFO = 0,
    SLUICE_LOG_WARNING = 1,
    SLUICE_LOG_ERROR = 2
} SluiceLogSeverity;

/** Off when `pfnLog` is NULL. Called on the thread where it happened; may be several at once. */
typedef struct SluiceLogCallback {
    void *pUserData;
    /** `pMessage` is one line without a newline, valid during the call. */
    void (*pfnLog)(void *pUserData, SluiceLogSeverity severity, const char *pMessage);
} SluiceLogCallback;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_BASE_H */
