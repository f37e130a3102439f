/** A recording that begins while the manager is in use begins with its state. */
#ifndef SLC_CORE_MANAGER_SNAPSHOT_H
#define SLC_CORE_MANAGER_SNAPSHOT_H

#include "base/snapshot_io.h"

#include <sluice/manager.h>

/** Writes the state. Changes nothing. Errors: io->result. */
void slc_snapshot_write(const SluiceStreamedTextureManager *manager, struct slc_snapshot_io *io);

/**
 * Gives a new manager a state, which may be any: what no manager can have is refused. After an
 * error, io->result, the manager can only be destroyed. The heap allocator is not asked for the
 * heaps, but will be told of their release.
 */
void slc_snapshot_read(SluiceStreamedTextureManager *manager, struct slc_snapshot_io *io);

#endif /* SLC_CORE_MANAGER_SNAPSHOT_H */
