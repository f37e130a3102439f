/** Texels as a PNG shows them: sRGB bytes with alpha. */
#ifndef TOOLS_SLUICE_INFO_TO_BYTES_H
#define TOOLS_SLUICE_INFO_TO_BYTES_H

#include <sluice/image.h>

/** Bytes and floats can; packed and block-compressed texels cannot. */
bool can_become_bytes(SluiceFormat format);

/**
 * Bytes stay as they are, floats are clamped to [0, 1] and sRGB-encoded. One channel becomes gray.
 */
void texels_to_bytes(SluiceFormat format, const void *texels, uint8_t *rgba, size_t count);

#endif /* TOOLS_SLUICE_INFO_TO_BYTES_H */
