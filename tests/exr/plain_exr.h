/** Reads OpenEXR files in the plainest way, as a second opinion: whole levels, all in memory. */
#ifndef TESTS_EXR_PLAIN_EXR_H
#define TESTS_EXR_PLAIN_EXR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** One channel of one level in the file's own type, [height][width]. */
struct plain_channel {
    char name[8];
    int bytes; ///< 2: half, 4: float or uint
    void *texels;
};

struct plain_level {
    uint32_t width, height;
    int channel_count;
    struct plain_channel channels[8];
};

/** Level (l, l) of a single-part file that is not deep; false if anything goes wrong. */
bool plain_exr_read(const char *path, int level, struct plain_level *out);
void plain_exr_free(struct plain_level *level);

/** The channel of that name, or NULL. */
const struct plain_channel *plain_exr_find(const struct plain_level *level, const char *name);

#endif /* TESTS_EXR_PLAIN_EXR_H */
