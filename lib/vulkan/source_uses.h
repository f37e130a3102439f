/** Who uses an image source: textures, and reads that are under way. */
#ifndef SLC_VULKAN_SOURCE_USES_H
#define SLC_VULKAN_SOURCE_USES_H

#include "vulkan/streamer.h"

/** A texture or a read has left the source: the loader forgets it if nothing uses it. */
void slc_source_left(SluiceVulkanStreamer *s, const SluiceImageSource *source);

#endif /* SLC_VULKAN_SOURCE_USES_H */
