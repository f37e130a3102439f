/** The sRGB transfer function for 8-bit values, exact. */
#ifndef SLC_IMAGE_SRGB_H
#define SLC_IMAGE_SRGB_H

#include <stdint.h>

/** Linear light of each encoded value. */
extern const float slc_srgb_to_linear[256];

/** The nearest encoded value; clamps to [0, 1], NaN becomes 0. */
uint8_t slc_srgb_from_linear(float value);

#endif /* SLC_IMAGE_SRGB_H */
