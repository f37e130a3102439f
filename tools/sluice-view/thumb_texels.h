/** Converts texels of any format to a small RGBA8 picture by a blit on the device. */
#ifndef SLUICE_VIEW_THUMB_TEXELS_H
#define SLUICE_VIEW_THUMB_TEXELS_H

#include "../common/gpu.h"

#include <sluice/image.h>

#define THUMBS_CELL 32u

/** A level of a texture in the format of its source. */
struct thumb_texels {
    SluiceFormat format;
    uint32_t width, height;
    uint8_t *bytes; ///< owned; rows of blocks without gaps. NULL: none
};

/** Returns true if the device can blit the format. Any thread. */
bool thumb_texels_fit(const struct gpu *gpu, SluiceFormat format);
/** Fills a cell, keeping the proportions of the texels. The rest of the cell is transparent. Waits
 * for the queue. Linear numbers become sRGB, a single channel becomes gray. False, with a line on
 *  stderr, on failure. */
bool thumb_texels_convert(const struct gpu *gpu, const struct thumb_texels *texels,
                          uint8_t cell[THUMBS_CELL][THUMBS_CELL][4]);
/** Frees the bytes. A zeroed struct is allowed. */
void thumb_texels_finish(struct thumb_texels *texels);

#endif /* SLUICE_VIEW_THUMB_TEXELS_H */
