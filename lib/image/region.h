/** Regions of images. */
#ifndef SLC_IMAGE_REGION_H
#define SLC_IMAGE_REGION_H

#include <sluice/image.h>

/** True if the image has the region, and its edges are edges of blocks or of the level. */
bool slc_region_is_valid(const SluiceImageRegion *region, const SluiceImageInfo *info);

#endif /* SLC_IMAGE_REGION_H */
