/** An image source that costs next to nothing: copies of one tile of noise. */
#ifndef BENCH_VULKAN_SOURCE_H
#define BENCH_VULKAN_SOURCE_H

#include <sluice/image.h>

struct free_source {
    SluiceImageSource base; ///< must be first
    SluiceImageInfo info;
};

/** Creates a source without memory of its own: square, with a full chain. Give each texture its own
 * source, because textures of one source share pages in paged mode and demand loading. */
void free_source_init(struct free_source *source, SluiceFormat format, uint32_t size);

#endif /* BENCH_VULKAN_SOURCE_H */
