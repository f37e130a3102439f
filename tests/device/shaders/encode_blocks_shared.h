/* Texels of a block, for C and GLSL. */
#ifndef ENCODE_BLOCKS_SHARED_H
#define ENCODE_BLOCKS_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define ENCODE_BC1 0u
#define ENCODE_BC4 1u
#define ENCODE_BC5 2u
#define ENCODE_BC7 3u
#define ENCODE_FORMATS 4u

struct EncodeInput {
    float rgba[64]; /* 16 texels in rows */
};
SLUICE_SHARED_SIZE(struct EncodeInput, 256)

#endif /* ENCODE_BLOCKS_SHARED_H */
