/** Users of an image source: textures, and reads in progress. */
#ifndef SLC_VULKAN_SOURCE_USES_H
#define SLC_VULKAN_SOURCE_USES_H

#include "vulkan/streamer.h"

/** Lets the loader forget a source that no texture or read uses any more. */
void slc_source_left(SluiceVulkanStreamer *s, const SluiceImageSource *source);

#endif /* SLC_VULKAN_SOURCE_USES_H */
