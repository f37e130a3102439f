/** Checks and copies what describes an image. */
#ifndef SLC_IMAGE_INFO_H
#define SLC_IMAGE_INFO_H

#include <sluice/image.h>

/**
 * Copies `given` with its name ("" for NULL); a level count of 0 becomes the full chain's.
 * Errors: INVALID_ARGUMENT for an empty or unknown format, a size of 0 or another level count than
 * the full chain's; UNSUPPORTED for compressed formats, which nothing here can encode,
 * and for arrays;
 * OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_image_info_init(const SluiceAllocationCallbacks *cb, const SluiceImageInfo *given,
                                 SluiceImageInfo *info);

/** Frees the name. */
void slc_image_info_finish(const SluiceAllocationCallbacks *cb, SluiceImageInfo *info);

#endif /* SLC_IMAGE_INFO_H */
