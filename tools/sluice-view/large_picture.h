/** A screenshot at twice the resolution of the window: the scene is drawn once more in one frame.
 */
#ifndef SLUICE_VIEW_LARGE_PICTURE_H
#define SLUICE_VIEW_LARGE_PICTURE_H

#include "frames.h"

struct large_picture {
    struct target target;
    struct gpu_buffer pixels;
    char path[4096]; ///< "": none is drawn
};

/** Prepares a picture of this size, which the next frame draws. False, with a line on stderr, if
 *  the device has no such images or no memory; nothing is left then. */
bool large_picture_begin(const struct gpu *gpu, uint32_t width, uint32_t height, const char *path,
                         struct large_picture *large);
/** Waits for the frame and writes the file. Nothing is left. */
bool large_picture_end(struct frames *frames, struct large_picture *large);
/** No frame may be in flight. A zeroed struct is fine. */
void large_picture_drop(const struct gpu *gpu, struct large_picture *large);

#endif /* SLUICE_VIEW_LARGE_PICTURE_H */
