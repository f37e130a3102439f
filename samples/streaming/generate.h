/** The gallery's own pictures: computed once, kept as OpenEXR files. */
#ifndef SAMPLES_STREAMING_GENERATE_H
#define SAMPLES_STREAMING_GENERATE_H

#include <sluice/image.h>

#include "patterns.h"

/** What a procedural source draws. Must outlive the source. */
struct pattern_image {
    const char *name;
    uint32_t width, height;
    pattern_fn pattern;
    uint32_t supersamples; ///< per axis below level 0, for patterns that do not filter themselves
};

/** Linear colors of `format`, full chain. */
SluiceResult pattern_create_source(const struct pattern_image *image, SluiceFormat format,
                                   SluiceImageSource **source);

#define GENERATED_COUNT 7

/** "$cache/gallery-2", or the user's cache folder for NULL. False if there is no such folder. */
bool generate_folder(const char *cache, uint32_t scale, char *path, size_t size);

/**
 * Makes what is missing of the set, with a progress bar; files are complete or absent, so what was
 * interrupted goes on. Writes the paths in hanging order.
 */
bool generate_pictures(const char *folder, uint32_t scale, uint32_t thread_count,
                       char paths[GENERATED_COUNT][4096]);

#endif /* SAMPLES_STREAMING_GENERATE_H */
