/** The state of an object in a recording that began while the object was in use. */
#ifndef SLC_REPLAY_SNAPSHOT_H
#define SLC_REPLAY_SNAPSHOT_H

#include "base/snapshot_io.h"
#include "replay/recorder.h"
#include "replay/replay.h"

/** Appends blocks with what `write` writes of `source`, and their end. An error is the recorder's.
 */
void slc_write_snapshot(SluiceRecorder *recorder,
                        void (*write)(const void *source, struct slc_snapshot_io *io),
                        const void *source);

/** Has `read` read into `target`. Errors: CORRUPT_DATA, logged; OUT_OF_HOST_MEMORY. */
SluiceResult slc_read_snapshot(struct slc_replay *replay, uint64_t *checksum,
                               void (*read)(void *target, struct slc_snapshot_io *io),
                               void *target);

#endif /* SLC_REPLAY_SNAPSHOT_H */
