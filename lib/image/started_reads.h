/** Reads that sources do asynchronously: from the start of their regions to the last completion. */
#ifndef SLC_IMAGE_STARTED_READS_H
#define SLC_IMAGE_STARTED_READS_H

#include "image/read_pool.h"
#include "image/shared_reads.h"

/** With the mutex held, which is given up meanwhile: starts the regions of a running read that are
 *  left. The read ends when its source has completed them. */
void slc_start_regions(SluiceTileLoader *loader, struct slc_read *read, const SluiceImageInfo *info,
                       uint64_t start_time);

/** With the mutex held, which is given up meanwhile: tells the source of a running read that was
 *  dropped. Regions that reads of other loaders wait for go on, unless this loader is destroyed:
 *  it waits for its source, and the others then read themselves. */
void slc_cancel_regions(SluiceTileLoader *loader, struct slc_read *read);
/** With the mutex held, which is given up meanwhile: a read that waited for the region has left. If
 *  it was the last one, and the reader of the region was dropped, tells the source. */
void slc_cancel_unwanted_region(const struct slc_shared_region *region);

#endif /* SLC_IMAGE_STARTED_READS_H */
