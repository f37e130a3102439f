#include "base/alloc.h"
#include "core/observer.h"
#include "replay/decisions.h"
#include "replay/record.h"
#include "replay/record_file.h"

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
    struct slc_record_file *file; ///< owned; NULL if the caller writes
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
    SluiceRecorder *recorder = slc_calloc(&cb, 1, sizeof *recorder);
    if (!recorder)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    recorder->cb = cb;
    recorder->manager = manager;
    recorder->writer = *pWriter;
    recorder->hash = SLC_HASH_EMPTY;
    slc_bytes_init(&recorder->block, &cb);
    slc_bytes_init(&recorder->head, &cb);
    write_header(recorder);
    write_configuration(recorder);
    if (recorder->result != SLUICE_SUCCESS) {
        SluiceResult result = recorder->result;
        release(recorder);
        return result;
    }
    slc_manager_set_observer(manager, (struct slc_observer){recorder, notify});
    *pRecorder = recorder;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceBeginRecordingToFile(SluiceStreamedTextureManager *manager, const char *pPath,
                                        const SluiceAllocationCallbacks *pAllocator,
                                        SluiceRecorder **pRecorder)
{
    if (pRecorder)
        *pRecorder = NULL;
    if (!manager || !pPath || !pRecorder)
        return SLUICE_ERROR_NULL_POINTER;
    /* Before the file is opened: the recorder that is there may be writing to this very one. */
    if (!slc_allocator_is_valid(pAllocator) || slc_manager_is_used(manager))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    SluiceAllocationCallbacks cb = slc_allocator(pAllocator);
    struct slc_record_file *file;
    SluiceResult result = slc_record_file_open(&cb, pPath, &file);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceRecordWriter writer = {file, slc_record_file_write};
    result = sluiceBeginRecording(manager, &writer, pAllocator, pRecorder);
    if (result == SLUICE_SUCCESS)
        (*pRecorder)->file = file;
    else
        slc_record_file_close(file, false);
    return result;
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
    SluiceResult closed = slc_record_file_close(recorder->file, result == SLUICE_SUCCESS);
    release(recorder);
    return result != SLUICE_SUCCESS ? result : closed;
}
