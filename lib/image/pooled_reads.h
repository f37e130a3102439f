/** Reads of the loaders of a SluiceReadPool: each region is read once, others wait or copy. */
#ifndef SLC_IMAGE_POOLED_READS_H
#define SLC_IMAGE_POOLED_READS_H

#include "image/read_pool.h"
#include "image/shared_reads.h"

/** Reads of the source go through the pool's regions: it is an image, and the pool has them. */
bool slc_reads_are_pooled(const SluiceTileLoader *loader, const SluiceImageSource *source);

/** Reads the texels of a region that the caller has claimed. Without the mutex. */
SluiceResult slc_read_shared_region(const struct slc_shared_region *shared,
                                    const SluiceImageInfo *info, SluiceImageFault *fault);

/* All with the mutex held. */

/** Reads or copies the regions of a running read that are left. The mutex is given up meanwhile.
 *  Success may leave regions that other reads are reading. */
void slc_read_pooled_regions(SluiceTileLoader *loader, struct slc_read *read,
                             const SluiceImageInfo *info, struct slc_read_outcome *outcome);

/** Returns how a region of a running read is delivered. */
enum slc_delivery slc_pooled_region_claim(SluiceTileLoader *loader, struct slc_read *read,
                                          const SluiceImageInfo *info, uint32_t region,
                                          struct slc_shared_region **shared);
/** Ends SLC_DELIVER_READ and SLC_DELIVER_COPY: copies the texels, if there are any, to the read.
 * The mutex is given up meanwhile. `fault`: of a read that failed. */
void slc_pooled_region_end(SluiceTileLoader *loader, struct slc_read *read, uint32_t region,
                           struct slc_shared_region *shared, enum slc_delivery delivery,
                           SluiceResult result, const SluiceImageFault *fault);
/** Counts a region that a source has delivered to a read alone. */
void slc_pooled_region_count(SluiceTileLoader *loader, const struct slc_read *read,
                             SluiceFormat format, uint32_t region);
/** True if a running read has regions that others read: it is put aside, and goes on by itself. */
bool slc_pooled_read_waits(SluiceTileLoader *loader, struct slc_read *read,
                           struct slc_read_outcome *outcome);
/** True if the read that a running read has waited for has failed: an attempt of both. */
bool slc_pooled_read_has_failed(struct slc_read *read, struct slc_read_outcome *outcome);
/** A read ends: it waits for no region and holds none. */
void slc_pooled_read_ends(SluiceTileLoader *loader, struct slc_read *read);

/** Without the mutex: texels of the source have changed, or it may be destroyed. Reads that begin
 *  later get none of the texels that are known now. */
void slc_loader_drop_texels(SluiceTileLoader *loader, const SluiceImageSource *source);

#endif /* SLC_IMAGE_POOLED_READS_H */
