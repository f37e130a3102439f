/** A source whose texels are numbers, or colors: the format of another source without sRGB, or with
 *  it. */
#ifndef SLUICE_VIEW_LINEAR_SOURCE_H
#define SLUICE_VIEW_LINEAR_SOURCE_H

#include <sluice/image.h>

/** Owns `source` from success on. */
SluiceResult linear_source_create(SluiceImageSource *source, SluiceImageSource **linear);
/** Texels are sRGB, where the format has such a twin. Owns `source` from success on. */
SluiceResult linear_source_create_srgb(SluiceImageSource *source, SluiceImageSource **srgb);
/** The source inside of a source of this kind; others are returned. */
SluiceImageSource *linear_source_inner(SluiceImageSource *source);

#endif /* SLUICE_VIEW_LINEAR_SOURCE_H */
