/** Asynchronous reads of a source: pfnStartRead and pfnCancelRead, which it may lack. */
#ifndef SLC_IMAGE_START_READ_H
#define SLC_IMAGE_START_READ_H

#include <sluice/image.h>

/** True if the source can start reads. It must have an interface. */
bool slc_starts_reads(const SluiceImageSource *source);

/** Checks the region and starts a read. Errors: UNSUPPORTED if the source reads at once only. */
SluiceResult slc_start_read(SluiceImageSource *source, const SluiceImageInfo *info,
                            const SluiceImageRegion *region, void *texels, size_t row_pitch,
                            const SluiceImageReadToken *token);
/** Tells a source of a cancel, if it has pfnCancelRead. */
void slc_cancel_read(SluiceImageSource *source, const SluiceImageRegion *region,
                     const SluiceImageReadToken *token);

#endif /* SLC_IMAGE_START_READ_H */
