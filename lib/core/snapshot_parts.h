/** Parts of a manager's snapshot. Lists are in their order; links and node numbers are made anew.
 */
#ifndef SLC_CORE_SNAPSHOT_PARTS_H
#define SLC_CORE_SNAPSHOT_PARTS_H

#include "base/snapshot_io.h"
#include "core/state.h"

/** Finds a texture of the snapshot. Returns NULL, with an error, if the index has none. */
struct slc_managed_texture *slc_snapshot_texture(slc_manager *m, struct slc_snapshot_io *io,
                                                 uint32_t index);

/* In the order of the snapshot: */
void slc_snapshot_textures(slc_manager *m, struct slc_snapshot_io *io);
void slc_snapshot_heaps(slc_manager *m, struct slc_snapshot_io *io);
void slc_snapshot_tiles(slc_manager *m, struct slc_snapshot_io *io);
void slc_snapshot_heap_order(slc_manager *m, struct slc_snapshot_io *io);
void slc_snapshot_histories(slc_manager *m, struct slc_snapshot_io *io);
void slc_snapshot_lists(slc_manager *m, struct slc_snapshot_io *io);

#endif /* SLC_CORE_SNAPSHOT_PARTS_H */
