/** Sources that change another source's format: without sRGB for numbers, with sRGB for colors. */
#ifndef SLUICE_VIEW_LINEAR_SOURCE_H
#define SLUICE_VIEW_LINEAR_SOURCE_H

#include <sluice/image.h>

/** Creates a source without sRGB. Takes `source` on success. */
SluiceResult linear_source_create(SluiceImageSource *source, SluiceImageSource **linear);
/** Creates a source with sRGB, if the format has an sRGB variant. Takes `source` on success. */
SluiceResult linear_source_create_srgb(SluiceImageSource *source, SluiceImageSource **srgb);
/** Returns the wrapped source, or `source` itself if it is of another kind. */
SluiceImageSource *linear_source_inner(SluiceImageSource *source);

#endif /* SLUICE_VIEW_LINEAR_SOURCE_H */
