#include "replay/recorder.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "replay/hash.h"

#include <sluice/version.h>

static void write_bytes(SluiceRecorder *recorder, const struct slc_bytes *bytes)
{
    if (bytes->failed)
        recorder->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (recorder->result == SLUICE_SUCCESS && bytes->size > 0)
        recorder->result =
            recorder->writer.pfnWrite(recorder->writer.pUserData, bytes->data, bytes->size);
}

void slc_recorder_write_header(SluiceRecorder *recorder, const char magic[8], uint32_t version,
                               const uint32_t words[SLC_TRACE_WORDS])
{
    struct slc_bytes *head = &recorder->head;
    slc_put_bytes(head, magic, 8);
    slc_put_u32(head, version);
    slc_put_u32(head, (uint32_t)SLUICE_VERSION_MAJOR << 22 | SLUICE_VERSION_MINOR << 12 |
                          SLUICE_VERSION_PATCH);
    for (int i = 0; i < SLC_TRACE_WORDS; i++)
        slc_put_u32(head, words[i]);
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

void slc_recorder_end_record(SluiceRecorder *recorder)
{
    if (recorder->block.failed || recorder->block.size >= SLC_TRACE_BLOCK_SIZE)
        write_block(recorder);
}

void slc_recorder_end_snapshot(SluiceRecorder *recorder)
{
    if (recorder->block.failed || recorder->block.size > 0)
        write_block(recorder);
    write_block(recorder); /* an empty block */
}

static void release(SluiceRecorder *recorder)
{
    SluiceAllocationCallbacks cb = recorder->cb;
    slc_bytes_finish(&recorder->block);
    slc_bytes_finish(&recorder->head);
    slc_free(&cb, recorder, 1, sizeof *recorder);
}

SluiceRecorder *slc_recorder_create(const SluiceAllocationCallbacks *cb, void *source,
                                    void (*stop)(void *source))
{
    SluiceRecorder *recorder = slc_calloc(cb, 1, sizeof *recorder);
    if (!recorder)
        return NULL;
    recorder->cb = *cb;
    recorder->source = source;
    recorder->stop = stop;
    recorder->hash = SLC_HASH_EMPTY;
    slc_bytes_init(&recorder->block, cb);
    slc_bytes_init(&recorder->head, cb);
    return recorder;
}

static SluiceResult write_to_file(void *user, const void *data, size_t size)
{
    SluiceRecorder *recorder = user;
    return slc_part_file_append(&recorder->file, data, size);
}

SluiceResult slc_recorder_read_info(const SluiceFileRecordingInfo *given, const char *refusal,
                                    SluiceFileRecordingInfo *info)
{
    *info = (SluiceFileRecordingInfo){.structSize = sizeof *info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceFileRecordingInfo), info, given, &given->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_allocator_is_valid(info->pAllocator))
        return slc_log_refusal(&info->log, "pAllocator lacks pfnAllocate or pfnFree");
    if (!refusal)
        return SLUICE_SUCCESS;
    return slc_log_refusal(&info->log, "%s: cannot record: %s", info->pPath, refusal);
}

SluiceResult slc_recorder_open_file(SluiceRecorder *recorder, const SluiceFileRecordingInfo *info)
{
    recorder->writer = (SluiceRecordWriter){recorder, write_to_file};
    SluiceResult result = slc_part_file_open(&recorder->file, info->pPath, SLC_PART_FILE_STREAM,
                                             &recorder->cb, &info->log);
    if (result == SLUICE_SUCCESS)
        return SLUICE_SUCCESS;
    slc_part_file_close(&recorder->file);
    release(recorder);
    return result == SLUICE_ERROR_FILE_NOT_FOUND ? SLUICE_ERROR_IO : result;
}

SluiceResult slc_recorder_begin(SluiceRecorder *recorder, SluiceRecorder **out)
{
    SluiceResult result = recorder->result;
    if (result != SLUICE_SUCCESS) {
        slc_part_file_finish(&recorder->file, false);
        release(recorder);
        return result;
    }
    *out = recorder;
    return SLUICE_SUCCESS;
}

/* Logs why the recording's file is lost. A failed write has logged its error already. */
static void log_loss(const SluiceRecorder *recorder)
{
    if (recorder->file.is_open && recorder->result != SLUICE_ERROR_IO)
        slc_log(&recorder->file.log, SLUICE_LOG_ERROR, "%s: the recording is lost: %s",
                recorder->file.target, sluiceGetResultName(recorder->result));
}

SluiceResult slc_recorder_end(SluiceRecorder *recorder)
{
    recorder->stop(recorder->source);
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
