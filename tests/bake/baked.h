/** Pictures in memory and in files, and stores that were baked of them. */
#ifndef TESTS_BAKE_BAKED_H
#define TESTS_BAKE_BAKED_H

#include <sluice/bake.h>
#include <sluice/store.h>

/** A folder of our own under the system's for temporary files. */
struct bake_folder {
    char path[64];
};

void bake_folder_init(struct bake_folder *folder);
/** Removes it with everything in it. */
void bake_folder_finish(struct bake_folder *folder);
/** The path of a file in it, in a buffer of the caller's; answers the buffer. */
const char *bake_folder_file(const struct bake_folder *folder, const char *name, char path[256]);

/** Level 0 alone, of texels that stay the caller's. */
struct plain_source {
    SluiceImageSource base;
    SluiceImageInfo info;
    const void *texels; ///< [height][width], tightly packed
};

void plain_source_init(struct plain_source *source, SluiceFormat format, uint32_t width,
                       uint32_t height, const void *texels);

/** A level of a store as RGBA floats, decoded as image.h says; [height][width][4], malloc'd. */
float *read_level(const char *path, uint32_t level, uint32_t *width, uint32_t *height);
/** A level's bytes as they are stored, malloc'd. */
void *read_bytes(const char *path, uint32_t level, size_t *size);

/** A picture file; `samples` are bytes or, with `wide`, 16-bit words, [height][width][channels]. */
void write_png(const char *path, const void *samples, uint32_t width, uint32_t height,
               uint32_t channels, bool wide);

/** Bakes with one thread and checks that it succeeds. */
void bake_source(SluiceImageSource *source, const char *path, const SluiceBakeSettings *settings);
void bake_picture_file(const char *input, const char *path, const SluiceBakeSettings *settings);

#endif /* TESTS_BAKE_BAKED_H */
