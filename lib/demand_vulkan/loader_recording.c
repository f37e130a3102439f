#include "demand/page_observer.h"
#include "demand_vulkan/loader.h"
#include "replay/demand_recorder.h"
#include "replay/recorder.h"

SluiceResult sluiceBeginDemandRecording(SluiceDemandLoader *loader,
                                        const SluiceFileRecordingInfo *pInfo,
                                        SluiceRecorder **pRecorder)
{
    if (pRecorder)
        *pRecorder = NULL;
    if (!loader || !pInfo || !pInfo->pPath || !pRecorder)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceFileRecordingInfo info;
    SluiceResult result = slc_recorder_read_info(pInfo,
                                                 slc_residency_observer(loader->residency).notify
                                                     ? "the demand loader is being recorded already"
                                                     : NULL,
                                                 &info);
    if (result != SLUICE_SUCCESS)
        return result;
    return slc_begin_demand_file_recording(loader->residency, &info, pRecorder);
}
