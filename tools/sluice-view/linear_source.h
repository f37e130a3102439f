/** A source whose texels are numbers: the format of another source without its sRGB. */
#ifndef SLUICE_VIEW_LINEAR_SOURCE_H
#define SLUICE_VIEW_LINEAR_SOURCE_H

#include <sluice/image.h>

/** Owns `source` from success on. */
SluiceResult linear_source_create(SluiceImageSource *source, SluiceImageSource **linear);
/** The source inside of a linear source; others are returned. */
SluiceImageSource *linear_source_inner(SluiceImageSource *source);

#endif /* SLUICE_VIEW_LINEAR_SOURCE_H */
