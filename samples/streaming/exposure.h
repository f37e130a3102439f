/** How brightly a picture is lit. */
#ifndef SAMPLES_STREAMING_EXPOSURE_H
#define SAMPLES_STREAMING_EXPOSURE_H

#include <sluice/image.h>

/**
 * The factor that brings a picture to a middle brightness, measured on a small level: 1 for
 * pictures that are well exposed, and for formats whose texels are not looked at (blocks, packed
 * words). Errors: what reading says; OUT_OF_HOST_MEMORY.
 */
SluiceResult exposure_measure(SluiceImageSource *source, const SluiceImageInfo *info,
                              float *exposure);

#endif /* SAMPLES_STREAMING_EXPOSURE_H */
