/**
 * Types that every Sluice header shares: results, memory and log callbacks, the export macro.
 *
 * Thread safety of the whole library: external on each object, unless its header says otherwise.
 * Calls that take a const handle may run at the same time. There are no mutable globals.
 *
 * Structs that begin with `structSize` may get fields at their end in later versions. Set
 * structSize to the sizeof of the struct, and zero the fields that you do not set. This holds for
 * structs that Sluice reads and for structs that Sluice writes.
 * - Read: fields that the caller's struct does not have count as 0. A larger struct of a newer
 *   version is accepted if the fields that this version does not have are 0; otherwise the call
 *   returns SLUICE_ERROR_UNSUPPORTED.
 * - Written: at most structSize bytes. Fields that this version does not have become 0.
 * - The call returns SLUICE_ERROR_INVALID_ARGUMENT if structSize is 0, less than the first release
 *   had, or above 2^16. Nothing has changed then. The log, if there is one, names the struct.
 *
 * All other structs never grow.
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
 * Result of a call. Signs are those of VkResult: 0 is success, positive values are not errors,
 * negative values are errors. A call that returns an error has changed nothing, unless its comment
 * says otherwise.
 */
typedef enum SluiceResult {
    SLUICE_SUCCESS = 0,
    /** More results exist than the caller's array holds. */
    SLUICE_INCOMPLETE = 1,
    /** The result is not available yet. Call again. */
    SLUICE_NOT_READY = 2,
    /** Some requests found no free slot in any heap. They stay queued. */
    SLUICE_BUDGET_REACHED = 3,

    SLUICE_ERROR_OUT_OF_HOST_MEMORY = -1,
    SLUICE_ERROR_OUT_OF_DEVICE_MEMORY = -2,
    /** A required pointer is NULL. */
    SLUICE_ERROR_NULL_POINTER = -3,
    /** A value is outside its documented range. */
    SLUICE_ERROR_INVALID_ARGUMENT = -4,
    /** A heap has zero tiles, or a tile has zero bytes. */
    SLUICE_ERROR_ZERO_HEAP_CAPACITY = -5,
    /** A texture has no tile; or a tile, level or texture has no texel. */
    SLUICE_ERROR_ZERO_TILES = -6,
    /** The counts of packed levels and packed tiles contradict each other or the level count. */
    SLUICE_ERROR_INVALID_PACKED_MIPS = -7,
    /** No texture ever had this id. */
    SLUICE_ERROR_UNKNOWN_TEXTURE = -8,
    /** The texture with this id was removed. */
    SLUICE_ERROR_STALE_TEXTURE = -9,
    /** The tile index is not below the texture's tile count. */
    SLUICE_ERROR_UNKNOWN_TILE = -10,
    /** The tile's state does not allow this call. */
    SLUICE_ERROR_INVALID_TILE_STATE = -11,
    /** A time stamp or retire value is below an earlier one. */
    SLUICE_ERROR_TIME_BACKWARDS = -12,
    /** A map or buffer does not have the size that the texture requires. */
    SLUICE_ERROR_SIZE_MISMATCH = -13,
    /** No heap has this id. */
    SLUICE_ERROR_UNKNOWN_HEAP = -14,
    /** The heap still holds tiles. */
    SLUICE_ERROR_HEAP_IN_USE = -15,
    /** A count is beyond what an index or a documented limit allows, such as tiles per texture. */
    SLUICE_ERROR_LIMIT_EXCEEDED = -16,
    /** A file contradicts its own format. The log callback says where. */
    SLUICE_ERROR_CORRUPT_DATA = -17,
    /** The input is well-formed, but Sluice does not handle its kind. The log callback says why. */
    SLUICE_ERROR_UNSUPPORTED = -18,
    SLUICE_ERROR_FILE_NOT_FOUND = -19,
    /** The operating system failed to read or write. */
    SLUICE_ERROR_IO = -20,
    /** The work was canceled before it ended. */
    SLUICE_ERROR_CANCELED = -21,
    /** A Vulkan call failed. The log callback names the call and its VkResult. */
    SLUICE_ERROR_VULKAN = -22,
    /** A Vulkan call returned VK_ERROR_DEVICE_LOST. */
    SLUICE_ERROR_DEVICE_LOST = -23,
    /** Another writer has the file open. Nothing has changed. */
    SLUICE_ERROR_BUSY = -24
} SluiceResult;

/**
 * Returns the enumerator's name, or "SLUICE_RESULT_UNKNOWN" for other values. Never NULL.
 * Thread safety: any thread.
 */
SLUICE_API const char *sluiceGetResultName(SluiceResult result);

/**
 * Functions that allocate and free host memory. Sluice calls them on the threads that use the
 * owning object and on the threads that the object started. Wherever a create-info takes a pointer
 * to this struct, NULL means malloc and free. Never grows.
 */
typedef struct SluiceAllocationCallbacks {
    void *pUserData;
    /** Returns `size` > 0 bytes at a multiple of `alignment` (a power of two), or NULL. */
    void *(*pfnAllocate)(void *pUserData, size_t size, size_t alignment);
    /** Frees `pMemory`, which is never NULL. `size` is the size that was requested. */
    void (*pfnFree)(void *pUserData, void *pMemory, size_t size);
} SluiceAllocationCallbacks;

/** Severity of a log message. */
typedef enum SluiceLogSeverity {
    SLUICE_LOG_INFO = 0,
    SLUICE_LOG_WARNING = 1,
    SLUICE_LOG_ERROR = 2
} SluiceLogSeverity;

/**
 * Receives log messages. Off if `pfnLog` is NULL. Called on the thread that reports the message;
 * several threads may call at the same time. Never grows.
 */
typedef struct SluiceLogCallback {
    void *pUserData;
    /** `pMessage` is one line without a newline, valid during the call. */
    void (*pfnLog)(void *pUserData, SluiceLogSeverity severity, const char *pMessage);
} SluiceLogCallback;

/**
 * Runs jobs of Sluice on threads of the application, instead of threads that Sluice starts. Never
 * grows.
 *
 * Jobs read files and decompress texels: each may block for some milliseconds.
 */
typedef struct SluiceJobSystem {
    void *pUserData;
    /**
     * Arranges that `pfnRun(pJob)` is called exactly once, on any thread. The call may be made
     * before pfnSubmitJob returns, on the same thread; then the caller of Sluice waits for it.
     *
     * Returns SLUICE_SUCCESS, or an error to refuse the job: then pfnRun must not be called. No
     * work is lost: running jobs take the work, and the next call of the object submits a job
     * again.
     *
     * Called on threads that call Sluice and inside jobs, several at the same time. No lock of
     * Sluice is held. Must not call Sluice, except `pfnRun`.
     */
    SluiceResult (*pfnSubmitJob)(void *pUserData, void (*pfnRun)(void *pJob), void *pJob);
} SluiceJobSystem;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_BASE_H */
