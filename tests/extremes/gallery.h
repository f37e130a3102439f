/** A streamer with a few visible textures, on a fake device that only records its calls. */
#ifndef TESTS_EXTREMES_GALLERY_H
#define TESTS_EXTREMES_GALLERY_H

#include "support/failing_allocator.h"
#include "vulkan/fake_vulkan.h"

/** Textures have 512 x 512 texels each, and GALLERY_TILES tiles in every mode; packed levels count
 * as one tile. */
enum { GALLERY_TEXTURES = 3, GALLERY_TILES = 16 + 4 };

struct gallery {
    struct fake_vulkan fake;
    struct failing_allocator memory;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource source, *array;
    SluiceVulkanTexture textures[GALLERY_TEXTURES], layers[2];
    uint64_t time;
    bool is_looked_at;
};

/** Creates the sources only. */
void gallery_init(struct gallery *g);
/** Destroys the streamer, checks that nothing of it is left, and destroys the sources. */
void gallery_finish(struct gallery *g);
/** Checks that nothing of the streamer is left on the device and in memory. */
void gallery_check_nothing_left(const struct gallery *g);

SluiceResult gallery_create(struct gallery *g, SluiceResidencyMode mode);
/** Adds a texture, or the array of two. The last texture follows the first. */
SluiceResult gallery_add(struct gallery *g, uint32_t texture);
SluiceResult gallery_add_array(struct gallery *g);
/** Runs a frame that completes as soon as it is recorded. */
SluiceResult gallery_frame(struct gallery *g);
SluiceVulkanStreamerStatistics gallery_statistics(const struct gallery *g);

#endif /* TESTS_EXTREMES_GALLERY_H */
