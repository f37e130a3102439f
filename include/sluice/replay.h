/**
 * Records all input of a manager or a demand loader and replays it. The same input gives the same
 * decisions on every machine. docs/replay.md specifies the format.
 */
#ifndef SLUICE_REPLAY_H
#define SLUICE_REPLAY_H

#include <sluice/manager.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceRecorder SluiceRecorder;

/**
 * Destination of a recording. Any result but SLUICE_SUCCESS ends the recording. The manager
 * continues, and sluiceEndRecording returns that result. Never grows.
 */
typedef struct SluiceRecordWriter {
    void *pUserData;
    SluiceResult (*pfnWrite)(void *pUserData, const void *pData, size_t size);
} SluiceRecordWriter;

/**
 * Starts to record a manager, at any time. If the manager was used before, its whole state is
 * written first, in pieces of 4 KiB: about 10 bytes per tile that is not FREE, 60 per texture, and
 * the maps that are still remembered. End the recording before you destroy the manager.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if the manager is being
 * recorded; SLUICE_ERROR_OUT_OF_HOST_MEMORY; errors of the writer. Thread safety: external on
 * `manager`. The recorder runs on the threads that call the manager.
 */
SLUICE_API SluiceResult sluiceBeginRecording(SluiceStreamedTextureManager *manager,
                                             const SluiceRecordWriter *pWriter,
                                             const SluiceAllocationCallbacks *pAllocator,
                                             SluiceRecorder **pRecorder);

/** Settings of a recording into a file. A field of zero selects its default. */
typedef struct SluiceFileRecordingInfo {
    uint32_t structSize;                         ///< sizeof(SluiceFileRecordingInfo).
    const char *pPath;                           ///< Required.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    /** Names a file that cannot be written, and why. Called until sluiceEndRecording returns. */
    SluiceLogCallback log;
} SluiceFileRecordingInfo;

/**
 * Starts to record a manager into a file.
 *
 * Writes `pPath` + ".sluice-part" and renames it when the recording ends: `pPath` is complete or,
 * after an error, unchanged. Two recordings cannot use the same path at the same time, even in
 * different processes. A .sluice-part file left by a killed process is overwritten.
 *
 * A pipe or character device is written directly. A folder, block device, read-only file or
 * symbolic link to a file at `pPath` is refused and kept.
 *
 * Returns SLUICE_NOT_READY, with nothing recorded, if no file descriptor is free. Close files and
 * call again.
 *
 * Errors: as sluiceBeginRecording; SLUICE_ERROR_BUSY if another writer has the file open;
 *         SLUICE_ERROR_IO.
 * Thread safety: external on `manager`.
 */
SLUICE_API SluiceResult sluiceBeginFileRecording(SluiceStreamedTextureManager *manager,
                                                 const SluiceFileRecordingInfo *pInfo,
                                                 SluiceRecorder **pRecorder);

/**
 * Calls sluiceBeginFileRecording without a log.
 *
 * Errors, thread safety: as sluiceBeginFileRecording.
 */
SLUICE_API SluiceResult sluiceBeginRecordingToFile(SluiceStreamedTextureManager *manager,
                                                   const char *pPath,
                                                   const SluiceAllocationCallbacks *pAllocator,
                                                   SluiceRecorder **pRecorder);

/**
 * Ends a recording of a manager or a demand loader: writes the end mark with the hash of all
 * decisions, and releases the recorder. NULL is allowed.
 *
 * Returns the first error since the recording began: SLUICE_ERROR_OUT_OF_HOST_MEMORY,
 * SLUICE_ERROR_IO, or the result of the writer.
 * Thread safety: external on the manager or the demand loader.
 */
SLUICE_API SluiceResult sluiceEndRecording(SluiceRecorder *recorder);

/** Settings of a replay. A field of zero selects its default. */
typedef struct SluiceReplayInfo {
    uint32_t structSize; ///< sizeof(SluiceReplayInfo).
    /** Whole trace: a "SLUICERT" or "SLUICEDR" recording or an "SLTRACE1" feedback trace. */
    const void *pData;
    size_t size;                                 ///< Bytes of the trace.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log;                       ///< Problems of the trace, with the byte offset.
    void *pUserData;
    /** Receives each line of the text dump, without a newline. May be NULL. */
    void (*pfnLine)(void *pUserData, const char *pLine);
    /* For SLTRACE1 only, which has feedback but no frame loop: */
    uint32_t heapTileCapacity;     ///< Slots per heap, 1 to 2^20. Default: 256.
    uint32_t maxHeapCount;         ///< Default: no limit.
    uint32_t numExtraStandbyTiles; ///< Unwanted tiles that stay mapped. Default: 1024.
    bool noStandbyTiles;           ///< No tile stays. numExtraStandbyTiles must be 0.
    uint32_t tilesPerFrame;        ///< Most tiles answered per frame. Default: 256.
    uint32_t latency;              ///< Frames from hand-out to answer. Default: 2.
    bool noLatency;                ///< Answers in the frame of the hand-out. latency must be 0.
    uint64_t timeoutMicros;        ///< Microseconds. Default: 1 000 000.
    /* For all kinds: */
    /** File to record the replay into, like sluiceBeginFileRecording. May be NULL. */
    const char *pRecordPath;
    /** Receives the manager's statistics at the end. Zero for demand loading. May be NULL. */
    SluiceStreamedTextureStatistics *pStatistics;
} SluiceReplayInfo;

typedef enum SluiceTraceKind {
    SLUICE_TRACE_KIND_UNKNOWN = 0,
    SLUICE_TRACE_KIND_RECORDING = 1,       ///< "SLUICERT": calls of a manager.
    SLUICE_TRACE_KIND_FEEDBACK = 2,        ///< "SLTRACE1": feedback for a manager.
    SLUICE_TRACE_KIND_DEMAND_RECORDING = 3 ///< "SLUICEDR": calls of a demand loader.
} SluiceTraceKind;

/** Figures of a recording of demand loading. All classes of pages count together. Never grows. */
typedef struct SluiceDemandReplayStatistics {
    uint64_t launchCount;    ///< Launches that were processed.
    uint64_t useCount;       ///< Uses of resident pages by launches.
    uint64_t requestCount;   ///< Requests for pages.
    uint64_t loadCount;      ///< Requests that began a read.
    uint64_t refusalCount;   ///< Requests that were refused.
    uint64_t postponedCount; ///< Requests that found no place.
    uint64_t failureCount;   ///< Reads that failed.
    uint64_t evictedCount;   ///< Pages evicted, ever.
    uint64_t restoredCount;  ///< Pages restored without a read, ever.
    uint64_t residentCount;  ///< Pages resident at the end.
    uint64_t loadingCount;   ///< Pages being read at the end.
    uint64_t refusedCount;   ///< Pages refused at the end.
    float lodBias;           ///< In levels, at the end.
} SluiceDemandReplayStatistics;

/** Result of a replay. */
typedef struct SluiceReplayResult {
    uint32_t structSize;   ///< sizeof(SluiceReplayResult).
    uint64_t decisionHash; ///< Hash of every output of every call, in order.
    uint64_t recordedHash; ///< From the end mark. 0 if there is none.
    uint64_t eventCount;
    uint64_t errorOffset; ///< Byte offset of the defect, after SLUICE_ERROR_CORRUPT_DATA.
    /** First call, counted from 1, whose decisions differ from the recording. 0: none. */
    uint64_t divergedEvent;
    uint64_t divergedOffset; ///< Byte offset of that call in the trace.
    SluiceTraceKind kind;
    SluiceDemandReplayStatistics demand; ///< At the end. Zero for the other kinds.
} SluiceReplayResult;

/**
 * Replays a trace with a manager of its own, or with the residency of a demand loader.
 *
 * Decisions that differ from the recording are not an error: compare decisionHash with
 * recordedHash, and see divergedEvent. After an error `*pResult` holds the decisions made before
 * it. A malicious trace can request much memory: limit it in pAllocator.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if only one of pAllocator's
 *         functions is set, or for a value beside noStandbyTiles or noLatency;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_UNSUPPORTED for a newer version;
 *         SLUICE_ERROR_IO and SLUICE_ERROR_BUSY for pRecordPath; SLUICE_ERROR_CORRUPT_DATA for a
 *         truncated or damaged trace (errorOffset says where).
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceReplay(const SluiceReplayInfo *pInfo, SluiceReplayResult *pResult);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_REPLAY_H */
