/** A streamer on a device that only takes notes, with a few textures that are looked at. */
#ifndef TESTS_EXTREMES_GALLERY_H
#define TESTS_EXTREMES_GALLERY_H

#include "support/failing_allocator.h"
#include "vulkan/fake_vulkan.h"

/** Of 512 x 512 texels each; GALLERY_TILES tiles in every mode, packed levels counted as one. */
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

/** Nothing is made but the sources. */
void gallery_init(struct gallery *g);
/** Destroys the streamer; nothing is left of it. Then the sources. */
void gallery_finish(struct gallery *g);
/** Nothing is left of the streamer on the device and in memory. */
void gallery_check_nothing_left(const struct gallery *g);

SluiceResult gallery_create(struct gallery *g, SluiceResidencyMode mode);
/** Textures, the last of them a follower of the first, or the array of two. */
SluiceResult gallery_add(struct gallery *g, uint32_t texture);
SluiceResult gallery_add_array(struct gallery *g);
/** A frame that is over when it is recorded. */
SluiceResult gallery_frame(struct gallery *g);
SluiceVulkanStreamerStatistics gallery_statistics(const struct gallery *g);

#endif /* TESTS_EXTREMES_GALLERY_H */
