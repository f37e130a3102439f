#include "replay/recorder.h"

#include "base/alloc.h"
#include "core/manager_snapshot.h"
#include "core/refusal.h"
#include "replay/decisions.h"
#include "replay/record.h"
#include "replay/snapshot.h"

static void write_header(SluiceRecorder *recorder, const SluiceStreamedTextureManager *manager,
                         uint32_t version)
{
    const SluiceStreamedTextureManagerCreateInfo *info = slc_manager_create_info(manager);
    const uint32_t words[SLC_TRACE_WORDS] = {info->heapTileCapacity, info->tileSize,
                                             info->alwaysMapPackedTiles ? SLC_TRACE_FLAG_PACKED : 0,
                                             0};
    slc_recorder_write_header(recorder, SLC_TRACE_MAGIC, version, words);
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
    if (call->kind != SLC_CALL_HEAP_ANSWER)
        slc_recorder_end_record(recorder);
}

/** Writes the manager's earlier configuration, which begins the trace. */
static void write_configuration(SluiceRecorder *recorder,
                                const SluiceStreamedTextureManager *manager)
{
    static const SluiceStreamedTextureManagerConfig none = {.structSize = sizeof none};
    const SluiceStreamedTextureManagerConfig *config = slc_manager_config(manager);
    if (config->numExtraStandbyTiles != none.numExtraStandbyTiles ||
        config->maxHeapCount != none.maxHeapCount ||
        config->maxLoadAttempts != none.maxLoadAttempts ||
        config->retryDelayTicks != none.retryDelayTicks ||
        config->missesToExpire != none.missesToExpire ||
        config->prefetchLevels != none.prefetchLevels ||
        config->givenUpRetryDelayTicks != none.givenUpRetryDelayTicks || config->targetHeapCount ||
        config->noEviction || config->noMipBias || config->separatePackedTiles)
        notify(recorder, manager,
               &(struct slc_call){.kind = SLC_CALL_SET_CONFIG, .config = config});
}

static void write_state(const void *manager, struct slc_snapshot_io *io)
{
    slc_snapshot_write(manager, io);
}

static void stop(void *manager)
{
    slc_manager_set_observer(manager, (struct slc_observer){NULL, NULL});
}

static SluiceResult begin(SluiceRecorder *recorder, SluiceStreamedTextureManager *manager,
                          SluiceRecorder **out)
{
    if (slc_manager_is_used(manager)) {
        write_header(recorder, manager, SLC_TRACE_VERSION_SNAPSHOT);
        slc_write_snapshot(recorder, write_state, manager);
    } else {
        write_header(recorder, manager, SLC_TRACE_VERSION);
        write_configuration(recorder, manager);
    }
    SluiceResult result = slc_recorder_begin(recorder, out);
    if (result == SLUICE_SUCCESS)
        slc_manager_set_observer(manager, (struct slc_observer){recorder, notify});
    return result;
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
    if (!slc_allocator_is_valid(pAllocator))
        return slc_refuse(manager, __func__, "pAllocator lacks pfnAllocate or pfnFree");
    if (slc_manager_is_observed(manager))
        return slc_refuse(manager, __func__, "the manager is being recorded already");

    SluiceAllocationCallbacks cb = slc_allocator(pAllocator);
    SluiceRecorder *recorder = slc_recorder_create(&cb, manager, stop);
    if (!recorder)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    recorder->writer = *pWriter;
    return begin(recorder, manager, pRecorder);
}

SluiceResult sluiceBeginFileRecording(SluiceStreamedTextureManager *manager,
                                      const SluiceFileRecordingInfo *pInfo,
                                      SluiceRecorder **pRecorder)
{
    if (pRecorder)
        *pRecorder = NULL;
    if (!manager || !pInfo || !pInfo->pPath || !pRecorder)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceFileRecordingInfo info;
    SluiceResult result = slc_recorder_read_info(
        pInfo, slc_manager_is_observed(manager) ? "the manager is being recorded already" : NULL,
        &info);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceRecorder *recorder = slc_recorder_create(&cb, manager, stop);
    if (!recorder)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    result = slc_recorder_open_file(recorder, &info);
    return result == SLUICE_SUCCESS ? begin(recorder, manager, pRecorder) : result;
}

SluiceResult sluiceBeginRecordingToFile(SluiceStreamedTextureManager *manager, const char *pPath,
                                        const SluiceAllocationCallbacks *pAllocator,
                                        SluiceRecorder **pRecorder)
{
    const SluiceFileRecordingInfo info = {
        .structSize = sizeof info, .pPath = pPath, .pAllocator = pAllocator};
    return sluiceBeginFileRecording(manager, &info, pRecorder);
}

SluiceResult sluiceEndRecording(SluiceRecorder *recorder)
{
    return recorder ? slc_recorder_end(recorder) : SLUICE_SUCCESS;
}
