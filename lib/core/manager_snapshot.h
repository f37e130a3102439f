/** Snapshot of a manager: the beginning of recordings of a manager that is in use. */
#ifndef SLC_CORE_MANAGER_SNAPSHOT_H
#define SLC_CORE_MANAGER_SNAPSHOT_H

#include "base/snapshot_io.h"

#include <sluice/manager.h>

/** Writes the state. Changes nothing. Errors: io->result. */
void slc_snapshot_write(const SluiceStreamedTextureManager *manager, struct slc_snapshot_io *io);

/**
 * Reads a state into a new manager. Invalid states are refused. After an error, io->result, the
 * manager can only be destroyed. The heap allocator is not called for the heaps of the snapshot,
 * but is called when they are released.
 */
void slc_snapshot_read(SluiceStreamedTextureManager *manager, struct slc_snapshot_io *io);

#endif /* SLC_CORE_MANAGER_SNAPSHOT_H */
