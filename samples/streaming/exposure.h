/** Exposure of a picture. */
#ifndef SAMPLES_STREAMING_EXPOSURE_H
#define SAMPLES_STREAMING_EXPOSURE_H

#include <sluice/image.h>

/**
 * Measures on a small level the factor that brings a picture to a middle brightness. It is 1 for
 * well-exposed pictures, and for formats whose texels are not examined (blocks, packed words).
 * Errors: those of reading; OUT_OF_HOST_MEMORY.
 */
SluiceResult exposure_measure(SluiceImageSource *source, const SluiceImageInfo *info,
                              float *exposure);

#endif /* SAMPLES_STREAMING_EXPOSURE_H */
