/** Asynchronous reads of sources, from the start of regions to the last completion. */
#ifndef SLC_IMAGE_STARTED_READS_H
#define SLC_IMAGE_STARTED_READS_H

#include "image/read_pool.h"
#include "image/shared_reads.h"

/** Starts the remaining regions of a running read. The read ends when its source has completed
 * them. The mutex is held, but unlocked meanwhile. */
void slc_start_regions(SluiceTileLoader *loader, struct slc_read *read, const SluiceImageInfo *info,
                       uint64_t start_time);

/** Tells the source of a running read that the read was dropped. Regions for which reads of other
 *  loaders wait continue, unless this loader is destroyed: a destroyed loader waits for its source,
 *  and the other loaders then read for themselves. The mutex is held, but unlocked meanwhile. */
void slc_cancel_regions(SluiceTileLoader *loader, struct slc_read *read);
/** Tells the source that a region is unwanted, if no read waits for the region and its reader was
 *  dropped. Call it after a waiting read has left. The mutex is held, but unlocked meanwhile. */
void slc_cancel_unwanted_region(const struct slc_shared_region *region);

#endif /* SLC_IMAGE_STARTED_READS_H */
