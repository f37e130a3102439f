#include "replay/demand_recorder.h"

#include "base/alloc.h"
#include "demand/page_observer.h"
#include "demand/page_snapshot.h"
#include "replay/demand_record.h"
#include "replay/hash.h"
#include "replay/recorder.h"
#include "replay/snapshot.h"

static void notify(void *user, const struct slc_page_call *call)
{
    SluiceRecorder *recorder = user;
    bool answer = slc_page_call_is_answer(call->kind), given = call->kind == SLC_PAGE_CALL_GIVE;
    if (recorder->result != SLUICE_SUCCESS)
        return;
    recorder->hash = slc_hash_page_call(recorder->hash, call);
    recorder->event_count += !answer && !given;
    slc_put_demand_record(&recorder->block, call, recorder->hash, &recorder->last_page);
    /* A block never ends between an answer of memory and the request that asked for it. */
    if (!answer && !given)
        slc_recorder_end_record(recorder);
}

static void stop(void *residency)
{
    slc_residency_set_observer(residency, (struct slc_page_observer){NULL, NULL});
}

/* Records limits and memory of the classes, which were set after the residency's creation. */
static void write_classes(SluiceRecorder *recorder, const struct slc_demand_residency *residency,
                          uint32_t class_count)
{
    for (uint32_t i = 0; i < class_count; i++) {
        struct slc_page_call call = {.kind = SLC_PAGE_CALL_SET_CLASS, .class_index = (uint8_t)i};
        call.value = slc_residency_get_class(residency, i, &call.flag);
        if (call.flag || call.value != UINT64_MAX)
            notify(recorder, &call);
    }
}

static void write_state(const void *residency, struct slc_snapshot_io *io)
{
    slc_residency_write_snapshot(residency, io);
}

static SluiceResult begin(SluiceRecorder *recorder, struct slc_demand_residency *residency,
                          SluiceRecorder **out)
{
    struct slc_page_residency_create_info info;
    slc_residency_get_info(residency, &info);
    const uint32_t words[SLC_TRACE_WORDS] = {
        info.class_count, (info.no_eviction ? SLC_DEMAND_FLAG_NO_EVICTION : 0) |
                              (info.no_lod_bias ? SLC_DEMAND_FLAG_NO_LOD_BIAS : 0)};
    bool used = slc_residency_is_used(residency);
    slc_recorder_write_header(recorder, SLC_DEMAND_TRACE_MAGIC,
                              used ? SLC_DEMAND_TRACE_VERSION_SNAPSHOT : SLC_DEMAND_TRACE_VERSION,
                              words);
    if (used)
        slc_write_snapshot(recorder, write_state, residency);
    else
        write_classes(recorder, residency, info.class_count);
    SluiceResult result = slc_recorder_begin(recorder, out);
    if (result == SLUICE_SUCCESS)
        slc_residency_set_observer(residency, (struct slc_page_observer){recorder, notify});
    return result;
}

SluiceResult slc_begin_demand_recording(struct slc_demand_residency *residency,
                                        const SluiceRecordWriter *writer,
                                        const SluiceAllocationCallbacks *cb,
                                        SluiceRecorder **recorder)
{
    SluiceAllocationCallbacks allocator = slc_allocator(cb);
    SluiceRecorder *made = slc_recorder_create(&allocator, residency, stop);
    if (!made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    made->writer = *writer;
    return begin(made, residency, recorder);
}

SluiceResult slc_begin_demand_file_recording(struct slc_demand_residency *residency,
                                             const SluiceFileRecordingInfo *info,
                                             SluiceRecorder **recorder)
{
    SluiceAllocationCallbacks allocator = slc_allocator(info->pAllocator);
    SluiceRecorder *made = slc_recorder_create(&allocator, residency, stop);
    if (!made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = slc_recorder_open_file(made, info);
    return result == SLUICE_SUCCESS ? begin(made, residency, recorder) : result;
}
