/**
 * Images whose texels are all middle gray, for tests that never look at texels.
 *
 * They fill memory at once. A procedural source calls a function per texel, which took most of the
 * time of tests on the fake device.
 */
#ifndef TEST_SUPPORT_GRAY_SOURCE_H
#define TEST_SUPPORT_GRAY_SOURCE_H

#include <sluice/image.h>

/** RGBA8, named "gray", with all levels. sluiceDestroyImageSource destroys it. */
SluiceImageSource *gray_source(uint32_t width, uint32_t height);
/** Creates a source with the size, name and address modes of `info`. The format must be
 * uncompressed, with 8 bits. */
SluiceImageSource *gray_source_with(const SluiceImageInfo *info);

#endif /* TEST_SUPPORT_GRAY_SOURCE_H */
