/** The state of a manager in a recording that began while the manager was in use. */
#ifndef SLC_REPLAY_SNAPSHOT_H
#define SLC_REPLAY_SNAPSHOT_H

#include "replay/recorder.h"
#include "replay/replay.h"

/** Appends blocks with the manager's state, and their end. An error is the recorder's. */
void slc_write_snapshot(SluiceRecorder *recorder, const SluiceStreamedTextureManager *manager);

/** Gives the player's manager the state. Errors: CORRUPT_DATA, logged; OUT_OF_HOST_MEMORY. */
SluiceResult slc_read_snapshot(struct slc_replay *replay, uint64_t *checksum);

#endif /* SLC_REPLAY_SNAPSHOT_H */
