#include "base/alloc.h"
#include "base/log.h"
#include "base/part_file.h"
#include "core/observer.h"
#include "replay/decisions.h"
#include "replay/record.h"

#include <sluice/replay.h>
#include <sluice/version.h>

#include <string.h>

struct SluiceRecorder {
    SluiceAllocationCallbacks cb;
    SluiceStreamedTextureManager *manager; ///< borrowed
    SluiceRecordWriter writer;
    SluiceResult result;    ///< the first thing that went wrong; nothing is written after it
    struct slc_bytes block; ///< records that are not written yet
    struct slc_bytes head;  ///< of that block
    uint64_t checksum;      ///< over all bytes written so far but checksums
    uint64_t hash;          ///< over all decisions so far
    uint64_t event_count;
    struct slc_part_file file; ///< Closed if the caller writes.
};

static void write_bytes(SluiceRecorder *recorder, const struct slc_bytes *bytes)
{
    if (bytes->failed)
        recorder->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (recorder->result == SLUICE_SUCCESS && bytes->size > 0)
        recorder->result =
            recorder->writer.pfnWrite(recorder->writer.pUserData, bytes->data, bytes->size);
}

static void write_header(SluiceRecorder *recorder)
{
    const SluiceStreamedTextureManagerCreateInfo *info = slc_manager_create_info(recorder->manager);
    struct slc_bytes *head = &recorder->head;
    slc_put_bytes(head, SLC_TRACE_MAGIC, 8);
    slc_put_u32(head, SLC_TRACE_VERSION);
    slc_put_u32(head, (uint32_t)SLUICE_VERSION_MAJOR << 22 | SLUICE_VERSION_MINOR << 12 |
                          SLUICE_VERSION_PATCH);
    slc_put_u32(head, info->heapTileCapacity);
    slc_put_u32(head, info->tileSize);
    slc_put_u32(head, info->alwaysMapPackedTiles ? SLC_TRACE_FLAG_PACKED : 0);
    slc_put_u32(head, 0);
    if (!head->failed)
        recorder->checksum = slc_hash_bytes(SLC_HASH_EMPTY, head->data, head->size);
    slc_put_u64(head, recorder->checksum);
    write_bytes(recorder, head);
}

static void write_block(SluiceRecorder *recorder)
{
    struct slc_bytes *head = &recorder->head, *block = &recorder->block;
    if (block->size > UINT32_MAX)
        recorder->result = SLUICE_ERROR_LIMIT_EXCEEDED;
    head->size = 0;
    slc_put_u32(head, (uint32_t)block->size);
    if (!head->failed && !block->failed) {
        recorder->checksum = slc_hash_bytes(recorder->checksum, head->data, head->size);
        recorder->checksum = slc_hash_bytes(recorder->checksum, block->data, block->size);
    }
    slc_put_u64(head, recorder->checksum);
    write_bytes(recorder, head);
    write_bytes(recorder, block);
    block->size = 0;
}

static void write_end(SluiceRecorder *recorder)
{
    struct slc_bytes *head = &recorder->head;
    head->size = 0;
    slc_put_u32(head, 0);
    slc_put_u64(head, recorder->event_count);
    slc_put_u64(head, recorder->hash);
    if (!head->failed)
        recorder->checksum = slc_hash_bytes(recorder->checksum, head->data, head->size);
    slc_put_u64(head, recorder->checksum);
    write_bytes(recorder, head);
}

static void notify(void *user, const SluiceStreamedTextureManager *manager,
                   const struct slc_call *call)
{
    SluiceRecorder *recorder = user;
    if (recorder->result != SLUICE_SUCCESS)
        return;
    recorder->hash = slc_hash_decisions(recorder->hash, manager, call);
    recorder->event_count += call->kind != SLC_CALL_HEAP_ANSWER;
    slc_put_record(&recorder->block, call, recorder->hash);
    /* A block never ends between a heap's answer and the call that asked for it. */
    if (recorder->block.failed ||
        (recorder->block.size >= SLC_TRACE_BLOCK_SIZE && call->kind != SLC_CALL_HEAP_ANSWER))
        write_block(recorder);
}

/** A manager may have been configured before: its trace begins with that. */
static void write_configuration(SluiceRecorder *recorder)
{
    static const SluiceStreamedTextureManagerConfig none;
    const SluiceStreamedTextureManagerConfig *config = slc_manager_config(recorder->manager);
    if (config->numExtraStandbyTiles != none.numExtraStandbyTiles ||
        config->maxHeapCount != none.maxHeapCount ||
        config->maxLoadAttempts != none.maxLoadAttempts || config->retryDelay != none.retryDelay ||
        config->missesToForget != none.missesToForget ||
        config->prefetchLevels != none.prefetchLevels)
        notify(recorder, recorder->manager,
               &(struct slc_call){.kind = SLC_CALL_SET_CONFIG, .config = config});
}

static void release(SluiceRecorder *recorder)
{
    SluiceAllocationCallbacks cb = recorder->cb;
    slc_bytes_finish(&recorder->block);
    slc_bytes_finish(&recorder->head);
    slc_free(&cb, recorder, 1, sizeof *recorder);
}

static SluiceRecorder *create(SluiceStreamedTextureManager *manager,
                              const SluiceAllocationCallbacks *cb)
{
    SluiceRecorder *recorder = slc_calloc(cb, 1, sizeof *recorder);
    if (!recorder)
        return NULL;
    recorder->cb = *cb;
    recorder->manager = manager;
    recorder->hash = SLC_HASH_EMPTY;
    slc_bytes_init(&recorder->block, cb);
    slc_bytes_init(&recorder->head, cb);
    return recorder;
}

/* On errors the recorder is gone, and so is the file that it has begun. */
static SluiceResult begin(SluiceRecorder *recorder, SluiceRecorder **out)
{
    write_header(recorder);
    write_configuration(recorder);
    SluiceResult result = recorder->result;
    if (result != SLUICE_SUCCESS) {
        slc_part_file_finish(&recorder->file, false);
        release(recorder);
        return result;
    }
    slc_manager_set_observer(recorder->manager, (struct slc_observer){recorder, notify});
    *out = recorder;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceBeginRecording(SluiceStreamedTextureManager *manager,
                                  const SluiceRecordWriter *pWriter,
                                  const SluiceAllocationCallbacks *pAllocator,
                                  SluiceRecorder **pRecorder)
{
    if (pRecorder)
        *pRecorder = NULL;
    if (!manager || !pWriter || !pWriter->pfnWrite || !pRecorder)
        return SLUICE_ERROR_NULL_POINTER;
    /* What a manager that was used before decides from is not in the trace. */
    if (!slc_allocator_is_valid(pAllocator) || slc_manager_is_used(manager))
        return SLUICE_ERROR_INVALID_ARGUMENT;

    SluiceAllocationCallbacks cb = slc_allocator(pAllocator);
    SluiceRecorder *recorder = create(manager, &cb);
    if (!recorder)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    recorder->writer = *pWriter;
    return begin(recorder, pRecorder);
}

static SluiceResult write_to_file(void *user, const void *data, size_t size)
{
    SluiceRecorder *recorder = user;
    return slc_part_file_append(&recorder->file, data, size);
}

static SluiceResult open_file(SluiceRecorder *recorder, const SluiceFileRecordingInfo *info)
{
    SluiceResult result = slc_part_file_open(&recorder->file, info->pPath, SLC_PART_FILE_STREAM,
                                             &recorder->cb, &info->log);
    return result == SLUICE_ERROR_FILE_NOT_FOUND ? SLUICE_ERROR_IO : result;
}

SluiceResult sluiceBeginFileRecording(SluiceStreamedTextureManager *manager,
                                      const SluiceFileRecordingInfo *pInfo,
                                      SluiceRecorder **pRecorder)
{
    if (pRecorder)
        *pRecorder = NULL;
    if (!manager || !pInfo || !pInfo->pPath || !pRecorder)
        return SLUICE_ERROR_NULL_POINTER;
    if (!slc_allocator_is_valid(pInfo->pAllocator))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (slc_manager_is_used(manager)) {
        slc_log(&pInfo->log, SLUICE_LOG_ERROR,
                "%s: cannot record: the manager was used before or is being recorded already",
                pInfo->pPath);
        return SLUICE_ERROR_INVALID_ARGUMENT;
    }
    SluiceAllocationCallbacks cb = slc_allocator(pInfo->pAllocator);
    SluiceRecorder *recorder = create(manager, &cb);
    if (!recorder)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    recorder->writer = (SluiceRecordWriter){recorder, write_to_file};
    SluiceResult result = open_file(recorder, pInfo);
    if (result == SLUICE_SUCCESS)
        return begin(recorder, pRecorder);
    slc_part_file_close(&recorder->file);
    release(recorder);
    return result;
}

SluiceResult sluiceBeginRecordingToFile(SluiceStreamedTextureManager *manager, const char *pPath,
                                        const SluiceAllocationCallbacks *pAllocator,
                                        SluiceRecorder **pRecorder)
{
    const SluiceFileRecordingInfo info = {.pPath = pPath, .pAllocator = pAllocator};
    return sluiceBeginFileRecording(manager, &info, pRecorder);
}

/* The file, and why its recording is lost; a failed write has said so itself. */
static void log_loss(const SluiceRecorder *recorder)
{
    if (recorder->file.is_open && recorder->result != SLUICE_ERROR_IO)
        slc_log(&recorder->file.log, SLUICE_LOG_ERROR, "%s: the recording is lost: %s",
                recorder->file.target, sluiceResultString(recorder->result));
}

SluiceResult sluiceEndRecording(SluiceRecorder *recorder)
{
    if (!recorder)
        return SLUICE_SUCCESS;
    slc_manager_set_observer(recorder->manager, (struct slc_observer){NULL, NULL});
    if (recorder->block.size > 0)
        write_block(recorder);
    write_end(recorder);
    SluiceResult result = recorder->result;
    if (result != SLUICE_SUCCESS)
        log_loss(recorder);
    SluiceResult closed = SLUICE_SUCCESS;
    if (recorder->file.is_open)
        closed = slc_part_file_finish(&recorder->file, result == SLUICE_SUCCESS);
    release(recorder);
    return result != SLUICE_SUCCESS ? result : closed;
}
