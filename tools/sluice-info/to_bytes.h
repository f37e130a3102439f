/** Conversion of texels for PNG: sRGB bytes with alpha. */
#ifndef TOOLS_SLUICE_INFO_TO_BYTES_H
#define TOOLS_SLUICE_INFO_TO_BYTES_H

#include <sluice/image.h>

/** Returns true for formats of bytes and floats, false for packed and block-compressed ones. */
bool can_become_bytes(SluiceFormat format);

/**
 * Converts texels. Copies bytes; clamps floats to [0, 1] and encodes them as sRGB. One channel
 * becomes gray.
 */
void texels_to_bytes(SluiceFormat format, const void *texels, uint8_t *rgba, size_t count);

#endif /* TOOLS_SLUICE_INFO_TO_BYTES_H */
