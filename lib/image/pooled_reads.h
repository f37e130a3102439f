/** Reads of the loaders of a SluiceReadPool: each region is read once, others wait or copy. */
#ifndef SLC_IMAGE_POOLED_READS_H
#define SLC_IMAGE_POOLED_READS_H

#include "image/read_pool.h"
#include "image/shared_reads.h"

/** True if reads of the source use the pool's regions: the source is an image, and the pool shares.
 */
bool slc_reads_are_pooled(const SluiceTileLoader *loader, const SluiceImageSource *source);

/** Reads the texels of a region that the caller has claimed. Without the mutex. */
SluiceResult slc_read_shared_region(const struct slc_shared_region *shared,
                                    const SluiceImageInfo *info, SluiceImageFault *fault);

/* All with the mutex held. */

/** Reads or copies the remaining regions of a running read. Releases the mutex in between. Success
 *  may leave regions that other reads are reading. */
void slc_read_pooled_regions(SluiceTileLoader *loader, struct slc_read *read,
                             const SluiceImageInfo *info, struct slc_read_outcome *outcome);

/** Returns how a region of a running read is delivered. */
enum slc_delivery slc_pooled_region_claim(SluiceTileLoader *loader, struct slc_read *read,
                                          const SluiceImageInfo *info, uint32_t region,
                                          struct slc_shared_region **shared);
/** Ends SLC_DELIVER_READ and SLC_DELIVER_COPY: copies the texels, if there are any, to the read.
 * Releases the mutex in between. `fault`: fault of a failed read. */
void slc_pooled_region_end(SluiceTileLoader *loader, struct slc_read *read, uint32_t region,
                           struct slc_shared_region *shared, enum slc_delivery delivery,
                           SluiceResult result, const SluiceImageFault *fault);
/** Counts a region that a source has delivered directly to one read. */
void slc_pooled_region_count(SluiceTileLoader *loader, const struct slc_read *read,
                             SluiceFormat format, uint32_t region);
/** Lets a running read wait if other reads are reading its regions. Returns whether it waits. */
bool slc_pooled_read_waits(SluiceTileLoader *loader, struct slc_read *read,
                           struct slc_read_outcome *outcome);
/** True if the read that a running read waited for has failed, which counts as an attempt of both.
 */
bool slc_pooled_read_has_failed(struct slc_read *read, struct slc_read_outcome *outcome);
/** Releases the region that an ending read holds or waits for. */
void slc_pooled_read_ends(SluiceTileLoader *loader, struct slc_read *read);

/** Drops the pool's texels of a source that has changed or may be destroyed. Later reads get new
 *  texels. Call it without the mutex. */
void slc_loader_drop_texels(SluiceTileLoader *loader, const SluiceImageSource *source);

#endif /* SLC_IMAGE_POOLED_READS_H */
