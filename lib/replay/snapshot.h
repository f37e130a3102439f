/** Snapshot: state of an object at the start of a recording that began during use. */
#ifndef SLC_REPLAY_SNAPSHOT_H
#define SLC_REPLAY_SNAPSHOT_H

#include "base/snapshot_io.h"
#include "replay/recorder.h"
#include "replay/replay.h"

/** Appends blocks with the state of `source` from `write`, and the end mark. Errors: in the
 * recorder.
 */
void slc_write_snapshot(SluiceRecorder *recorder,
                        void (*write)(const void *source, struct slc_snapshot_io *io),
                        const void *source);

/** Reads a snapshot into `target` with `read`. Errors: CORRUPT_DATA, logged; OUT_OF_HOST_MEMORY. */
SluiceResult slc_read_snapshot(struct slc_replay *replay, uint64_t *checksum,
                               void (*read)(void *target, struct slc_snapshot_io *io),
                               void *target);

#endif /* SLC_REPLAY_SNAPSHOT_H */
