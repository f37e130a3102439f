/** A screenshot at twice the resolution of the window. One frame draws the scene once more. */
#ifndef SLUICE_VIEW_LARGE_PICTURE_H
#define SLUICE_VIEW_LARGE_PICTURE_H

#include "frames.h"

struct large_picture {
    struct target target;
    struct gpu_buffer pixels;
    char path[4096]; ///< file to write; "": no screenshot is drawn
};

/** Prepares a screenshot, which the next frame draws. False, with a line on stderr, if the device
 * has no images of this size or no memory. Frees everything on failure. */
bool large_picture_begin(const struct gpu *gpu, uint32_t width, uint32_t height, const char *path,
                         struct large_picture *large);
/** Waits for the frame, writes the file, and frees everything. */
bool large_picture_end(struct frames *frames, struct large_picture *large);
/** Frees a screenshot without writing it. No frame may be in flight. A zeroed struct is allowed. */
void large_picture_drop(const struct gpu *gpu, struct large_picture *large);

#endif /* SLUICE_VIEW_LARGE_PICTURE_H */
