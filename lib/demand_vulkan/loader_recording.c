#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "demand/page_observer.h"
#include "demand_vulkan/loader.h"
#include "replay/demand_recorder.h"

SluiceResult sluiceBeginDemandRecording(SluiceDemandLoader *loader,
                                        const SluiceFileRecordingInfo *pInfo,
                                        SluiceRecorder **pRecorder)
{
    if (pRecorder)
        *pRecorder = NULL;
    if (!loader || !pInfo || !pInfo->pPath || !pRecorder)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceFileRecordingInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceFileRecordingInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_allocator_is_valid(info.pAllocator))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (slc_residency_is_used(loader->residency)) {
        slc_log(&info.log, SLUICE_LOG_ERROR,
                "%s: cannot record: the demand loader was used before or is being recorded already",
                info.pPath);
        return SLUICE_ERROR_INVALID_ARGUMENT;
    }
    return slc_begin_demand_file_recording(loader->residency, &info, pRecorder);
}
