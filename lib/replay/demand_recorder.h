/** Recordings of demand loading. */
#ifndef SLC_REPLAY_DEMAND_RECORDER_H
#define SLC_REPLAY_DEMAND_RECORDER_H

#include "demand/page_residency.h"

#include <sluice/replay.h>

/**
 * Begins to record an unused residency (slc_residency_is_used). sluiceEndRecording ends the
 * recording. Errors: OUT_OF_HOST_MEMORY; errors of the writer.
 */
SluiceResult slc_begin_demand_recording(struct slc_demand_residency *residency,
                                        const SluiceRecordWriter *writer,
                                        const SluiceAllocationCallbacks *cb,
                                        SluiceRecorder **recorder);
/** Begins to record to a file. Errors: slc_begin_demand_recording's; NOT_READY, BUSY, IO. */
SluiceResult slc_begin_demand_file_recording(struct slc_demand_residency *residency,
                                             const SluiceFileRecordingInfo *info,
                                             SluiceRecorder **recorder);

#endif /* SLC_REPLAY_DEMAND_RECORDER_H */
