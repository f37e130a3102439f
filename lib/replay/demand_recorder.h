/** Recordings of demand loading. */
#ifndef SLC_REPLAY_DEMAND_RECORDER_H
#define SLC_REPLAY_DEMAND_RECORDER_H

#include "demand/page_residency.h"

#include <sluice/replay.h>

/**
 * Records a residency that was not used before (slc_residency_is_used). sluiceEndRecording ends it.
 * Errors: OUT_OF_HOST_MEMORY; errors of the writer.
 */
SluiceResult slc_begin_demand_recording(struct slc_demand_residency *residency,
                                        const SluiceRecordWriter *writer,
                                        const SluiceAllocationCallbacks *cb,
                                        SluiceRecorder **recorder);
/** Into a file. Errors: as slc_begin_demand_recording; NOT_READY, BUSY, IO. */
SluiceResult slc_begin_demand_file_recording(struct slc_demand_residency *residency,
                                             const SluiceFileRecordingInfo *info,
                                             SluiceRecorder **recorder);

#endif /* SLC_REPLAY_DEMAND_RECORDER_H */
