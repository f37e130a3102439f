/** Pictures of the gallery itself: generated once, kept as OpenEXR files. */
#ifndef SAMPLES_STREAMING_GENERATE_H
#define SAMPLES_STREAMING_GENERATE_H

#include <sluice/image.h>

#include "patterns.h"

/** Image that a procedural source draws. Must outlive the source. */
struct pattern_image {
    const char *name;
    uint32_t width, height;
    pattern_fn pattern;
    uint32_t supersamples; ///< per axis below level 0, for patterns that do not filter themselves
};

/** Creates a source with linear colors in `format` and a full mip chain. */
SluiceResult pattern_create_source(const struct pattern_image *image, SluiceFormat format,
                                   SluiceImageSource **source);

#define GENERATED_COUNT 7

/** Writes "$cache/gallery-2". `cache` NULL: the user's cache folder. Returns false if there is
 * none. */
bool generate_folder(const char *cache, uint32_t scale, char *path, size_t size);

/**
 * Generates missing pictures of the set, with a progress bar. Files are complete or absent, so an
 * interrupted run can be continued. Writes the paths in hanging order.
 */
bool generate_pictures(const char *folder, uint32_t scale, uint32_t thread_count,
                       char paths[GENERATED_COUNT][4096]);

#endif /* SAMPLES_STREAMING_GENERATE_H */
