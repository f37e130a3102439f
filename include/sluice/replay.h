/**
 * Records everything that enters a manager and plays it back: same input, same decisions, on every
 * machine. The format is in docs/replay.md.
 */
#ifndef SLUICE_REPLAY_H
#define SLUICE_REPLAY_H

#include <sluice/manager.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceRecorder SluiceRecorder;

/**
 * Where the bytes of a recording go. Returning anything but SLUICE_SUCCESS ends the recording; the
 * manager goes on, and sluiceEndRecording returns that result.
 */
typedef struct SluiceRecordWriter {
    void *pUserData;
    SluiceResult (*pfnWrite)(void *pUserData, const void *pData, size_t size);
} SluiceRecordWriter;

/**
 * Starts to record a manager that has no textures and no heaps yet; it may be configured. The
 * recorder must be ended before the manager is destroyed.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT if the manager was used already or is being recorded;
 *         OUT_OF_HOST_MEMORY, and what the writer says.
 * Thread safety: a recorder works on the threads that call its manager; external on the manager.
 */
SLUICE_API SluiceResult sluiceBeginRecording(SluiceStreamedTextureManager *manager,
                                             const SluiceRecordWriter *pWriter,
                                             const SluiceAllocationCallbacks *pAllocator,
                                             SluiceRecorder **pRecorder);

/**
 * The same into a file, which is written as `pPath` with ".partial" appended and gets its name when
 * the recording ends: `pPath` is complete or, after an error, as it was before. A device or a pipe
 * is written to as it stands. Errors: also IO.
 */
SLUICE_API SluiceResult sluiceBeginRecordingToFile(SluiceStreamedTextureManager *manager,
                                                   const char *pPath,
                                                   const SluiceAllocationCallbacks *pAllocator,
                                                   SluiceRecorder **pRecorder);

/**
 * Writes the end mark with the hash over all decisions and releases the recorder. NULL is allowed.
 * Returns the first thing that went wrong since the recording began: OUT_OF_HOST_MEMORY, IO, or
 * what the writer said.
 */
SLUICE_API SluiceResult sluiceEndRecording(SluiceRecorder *recorder);

/** How to play a trace. Zero in any field asks for the default written beside it. */
typedef struct SluiceReplayInfo {
    const void *pData; ///< the whole trace: "SLUICERT" recordings, or "SLTRACE1" feedback traces
    size_t size;
    const SluiceAllocationCallbacks *pAllocator; ///< NULL: malloc and free
    SluiceLogCallback log; ///< what is wrong with a trace, with the byte offset
    void *pUserData;
    /** NULL, or called with each line of the text dump, without a newline. */
    void (*pfnLine)(void *pUserData, const char *pLine);
    /* For SLTRACE1 only, which has feedback but no frame loop: */
    uint32_t heapTileCapacity; ///< 0: 1024
    uint32_t maxHeapCount;     ///< 0: no cap
    uint32_t standbyTileCount; ///< numExtraStandbyTiles
    uint32_t tilesPerFrame;    ///< answered per frame at most; 0: 256
    uint32_t latency;          ///< frames from handed out to answered; 0: answered at once
    uint64_t timeoutMicros;    ///< 0: 1 000 000
    /* For both: */
    /** NULL, or a file to record what is played into, as sluiceBeginRecordingToFile does. */
    const char *pRecordPath;
} SluiceReplayInfo;

typedef struct SluiceReplayResult {
    uint64_t decisionHash; ///< over every output of every call, in order
    uint64_t recordedHash; ///< from the end mark; 0 if there is none
    uint64_t eventCount;
    uint64_t errorOffset; ///< byte offset of what is wrong, after CORRUPT_DATA
    SluiceStreamedTextureStatistics statistics; ///< at the end
    /** The first call, counted from 1, that was decided otherwise than recorded; 0: none. */
    uint64_t divergedEvent;
    uint64_t divergedOffset; ///< byte offset of that call in the trace
} SluiceReplayResult;

/**
 * Plays a trace against a manager of its own. A trace whose decisions come out otherwise than they
 * were recorded is no error: see decisionHash, recordedHash and divergedEvent.
 *
 * Errors: NULL_POINTER, INVALID_ARGUMENT if only one of pAllocator's functions is set,
 *         OUT_OF_HOST_MEMORY, UNSUPPORTED for a newer version, IO for pRecordPath; CORRUPT_DATA for
 *         a truncated or damaged trace: errorOffset says where. The decisions made before an error
 *         are in `*pResult`. A hostile trace can ask for a lot of memory: bound it in pAllocator.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceReplay(const SluiceReplayInfo *pInfo, SluiceReplayResult *pResult);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_REPLAY_H */
