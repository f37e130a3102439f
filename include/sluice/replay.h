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

/** Plays a recording of a manager call by call. */
typedef struct SluiceTracePlayer SluiceTracePlayer;

/** Settings of a trace player. A field of zero selects its default. */
typedef struct SluiceTracePlayerCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceTracePlayerCreateInfo).
    const void *pData;   ///< Whole "SLUICERT" recording. Required. Must outlive the player.
    size_t size;         ///< Bytes of the recording.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log;                       ///< Problems of the trace, with the byte offset.
    /** Events that the player's manager keeps, as sluiceSetTileEventCapacity. Default: none. */
    uint32_t tileEventCapacity;
} SluiceTracePlayerCreateInfo;

/** Calls of a recording, by the numbers of docs/replay.md. Later versions may add some. */
typedef enum SluiceTraceCallKind {
    SLUICE_TRACE_CALL_NONE = 0,                 ///< The recording ends here.
    SLUICE_TRACE_CALL_SET_CONFIG = 1,           ///< sluiceSetConfig
    SLUICE_TRACE_CALL_ADD_TEXTURE = 2,          ///< sluiceAddStreamedTexture
    SLUICE_TRACE_CALL_REMOVE_TEXTURE = 3,       ///< sluiceRemoveStreamedTexture
    SLUICE_TRACE_CALL_UPDATE_FEEDBACK = 4,      ///< sluiceUpdateWithSamplerFeedback
    SLUICE_TRACE_CALL_MATCH_PRIMARY = 5,        ///< sluiceMatchPrimaryTexture
    SLUICE_TRACE_CALL_SET_PRIMARY = 6,          ///< sluiceSetPrimaryTexture
    SLUICE_TRACE_CALL_GET_TILES_TO_MAP = 7,     ///< sluiceGetTilesToMap
    SLUICE_TRACE_CALL_UPDATE_MAPPING = 8,       ///< sluiceUpdateTilesMapping
    SLUICE_TRACE_CALL_REPORT_FAILED = 9,        ///< sluiceReportFailedTiles
    SLUICE_TRACE_CALL_RETRY_FAILED = 10,        ///< sluiceRetryFailedTiles
    SLUICE_TRACE_CALL_GET_GIVEN_UP = 11,        ///< sluiceGetGivenUpTiles
    SLUICE_TRACE_CALL_GET_TILES_TO_CANCEL = 12, ///< sluiceGetTilesToCancel
    SLUICE_TRACE_CALL_REPORT_CANCELED = 13,     ///< sluiceReportCanceledTiles
    SLUICE_TRACE_CALL_GET_TILES_TO_UNMAP = 14,  ///< sluiceGetTilesToUnmap
    SLUICE_TRACE_CALL_COMPLETE_RETIRE = 15,     ///< sluiceCompleteRetireValue
    SLUICE_TRACE_CALL_TRIM_STANDBY = 16,        ///< sluiceTrimStandbyTiles
    SLUICE_TRACE_CALL_DEFRAGMENT = 17,          ///< sluiceDefragmentTiles
    SLUICE_TRACE_CALL_RELEASE_HEAP = 18,        ///< sluiceReleaseHeap
    SLUICE_TRACE_CALL_GET_MINMIP_UPDATES = 19,  ///< sluiceGetMinMipUpdates
    SLUICE_TRACE_CALL_EVACUATE_HEAPS = 21,      ///< sluiceEvacuateHeaps
    SLUICE_TRACE_CALL_FORGET_TEXTURE = 22,      ///< sluiceForgetStreamedTexture
    SLUICE_TRACE_CALL_EVICT_TEXTURE = 23,       ///< sluiceEvictStreamedTexture
    SLUICE_TRACE_CALL_SET_UV_TRANSFORM = 24,    ///< sluiceSetUvTransform
    SLUICE_TRACE_CALL_SET_PRIORITY = 25         ///< sluiceSetTexturePriority
} SluiceTraceCallKind;

/** Recorded call. Fields that its kind lacks are 0. */
typedef struct SluiceTraceCall {
    uint32_t structSize; ///< sizeof(SluiceTraceCall).
    SluiceTraceCallKind kind;
    SluiceResult result;         ///< That the call had when it was recorded.
    SluiceTextureId textureId;   ///< Of added textures the id that they got.
    SluiceTextureId primaryId;   ///< MATCH_PRIMARY, SET_PRIMARY.
    bool hasTimeStamp;           ///< UPDATE_FEEDBACK, MATCH_PRIMARY, REPORT_FAILED.
    uint64_t timeStamp, timeout; ///< In the ticks of the recorded program.
    uint64_t retireValue;
    uint32_t tileCount; ///< Entries that a list call returned; tiles that an answer names.
    uint32_t feedbackWidth, feedbackHeight; ///< UPDATE_FEEDBACK: texels of the map.
    uint32_t heapCount;                     ///< GET_TILES_TO_MAP: heaps that were allocated.
    uint32_t refusedHeapCount;              ///< GET_TILES_TO_MAP: heaps that were refused.
    uint64_t offset;                        ///< Byte of the recording where it stands.
} SluiceTraceCall;

/** State of a trace player. */
typedef struct SluiceTracePlayerState {
    uint32_t structSize;           ///< sizeof(SluiceTracePlayerState).
    uint32_t formatVersion;        ///< Of the recording: 1 or 2.
    uint32_t libraryVersion;       ///< That recorded: major << 22, minor << 12, patch.
    uint32_t heapTileCapacity;     ///< Slots per heap.
    uint32_t tileSize;             ///< Bytes.
    bool alwaysMapPackedTiles;     ///< Packed tiles are loaded when their texture is added.
    uint64_t offset;               ///< Bytes of the recording that were read.
    uint64_t eventCount;           ///< Calls that were played.
    uint64_t decisionHash;         ///< Of these calls, as in SluiceReplayResult.
    uint64_t recordedHash;         ///< From the end mark. 0 before it was read.
    uint64_t divergedEvent;        ///< As in SluiceReplayResult.
    uint64_t divergedOffset;       ///< As in SluiceReplayResult.
    uint64_t errorOffset;          ///< As in SluiceReplayResult.
    uint32_t maxHeapCount;         ///< Of the configuration in force. 0: no limit.
    uint32_t targetHeapCount;      ///< Of the configuration in force. 0: none.
    uint32_t numExtraStandbyTiles; ///< Of the configuration in force.
} SluiceTracePlayerState;

/**
 * Creates a player with a manager of its own, in the state that the recording begins with. Plays
 * no call. A malicious trace can request much memory: limit it in pAllocator.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if only one
 *         of pAllocator's functions is set or tileEventCapacity is above SLUICE_MAX_TILE_EVENTS;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_UNSUPPORTED, with a log message, for newer
 *         versions, recordings of demand loading and feedback traces; SLUICE_ERROR_CORRUPT_DATA,
 *         with a log message.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateTracePlayer(const SluiceTracePlayerCreateInfo *pInfo,
                                                SluiceTracePlayer **pPlayer);

/** Destroys a player and its manager. NULL is allowed. Thread safety: external on `player`. */
SLUICE_API void sluiceDestroyTracePlayer(SluiceTracePlayer *player);

/**
 * Returns the call that sluicePlayTraceCall will make. SLUICE_TRACE_CALL_NONE: all were played and
 * the end mark is right.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a wrong
 *         structSize; SLUICE_ERROR_CORRUPT_DATA, with a log message, if the trace is damaged or cut
 *         off there; SLUICE_ERROR_OUT_OF_HOST_MEMORY. The calls before stay played after an error,
 *         and the error is returned again.
 * Thread safety: external on `player`.
 */
SLUICE_API SluiceResult sluiceGetNextTraceCall(SluiceTracePlayer *player, SluiceTraceCall *pCall);

/**
 * Makes the next recorded call. Decisions that differ from the recording are not an error: see
 * SluiceTracePlayerState::divergedEvent. Does nothing at the end of the recording.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_CORRUPT_DATA, with a log message;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY. The error is returned again.
 * Thread safety: external on `player`.
 */
SLUICE_API SluiceResult sluicePlayTraceCall(SluiceTracePlayer *player);

/**
 * Returns the manager that decides. Read it with the functions that take a const manager, and with
 * sluiceMarkTileEvents. Other calls make the replay decide differently. Valid until
 * sluiceReadTraceCheckpoint and sluiceDestroyTracePlayer.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER. Thread safety: external on `player`.
 */
SLUICE_API SluiceResult sluiceGetTracePlayerManager(SluiceTracePlayer *player,
                                                    SluiceStreamedTextureManager **pManager);

/**
 * Returns how far a player is.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a wrong
 *         structSize.
 * Thread safety: external on `player`.
 */
SLUICE_API SluiceResult sluiceGetTracePlayerState(const SluiceTracePlayer *player,
                                                  SluiceTracePlayerState *pState);

/**
 * Lists the textures that the manager has, in the order of their indices. Two-call idiom:
 * `*pIdCount` is the capacity of `pIds` on entry and the number written on return; if pIds is NULL,
 * it becomes the number of textures.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER. Returns SLUICE_INCOMPLETE if there are more.
 * Thread safety: external on `player`.
 */
SLUICE_API SluiceResult sluiceGetTracePlayerTextures(const SluiceTracePlayer *player,
                                                     uint32_t *pIdCount, SluiceTextureId *pIds);

/**
 * Writes the state between two calls: position, hash, and the snapshot of the manager, about as
 * many bytes as sluiceBeginRecording writes. Tile events are left out.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_OUT_OF_HOST_MEMORY; the error of a damaged trace;
 *         results of the writer.
 * Thread safety: external on `player`.
 */
SLUICE_API SluiceResult sluiceWriteTraceCheckpoint(SluiceTracePlayer *player,
                                                   const SluiceRecordWriter *pWriter);

/**
 * Goes to the state that sluiceWriteTraceCheckpoint wrote, with a new manager, which decides as the
 * old one did from there on. `pData` must come from a player of the same recording.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_CORRUPT_DATA,
 *         with a log message, for other bytes. Nothing has changed after an error.
 * Thread safety: external on `player`.
 */
SLUICE_API SluiceResult sluiceReadTraceCheckpoint(SluiceTracePlayer *player, const void *pData,
                                                  size_t size);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_REPLAY_H */
