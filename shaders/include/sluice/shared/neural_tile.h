/* A rectangle of a mip that neural/produce.comp decodes, for C and GLSL. */
#ifndef SLUICE_SHARED_NEURAL_TILE_H
#define SLUICE_SHARED_NEURAL_TILE_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

/* Texels of a workgroup along either side: four blocks. */
#define SLUICE_NEURAL_GROUP 8u

/* Storage format of texels. */
#define SLUICE_NEURAL_STORE_RGBA8 0u
#define SLUICE_NEURAL_STORE_BC1 1u
#define SLUICE_NEURAL_STORE_BC4 2u
#define SLUICE_NEURAL_STORE_BC5 3u
#define SLUICE_NEURAL_STORE_BC7 4u
#define SLUICE_NEURAL_STORE_RGBA16F 5u

/* Values of a channel: bits 4 c to 4 c + 1 of `spaces` are the network's space, the next two the
 * stored one. */
#define SLUICE_NEURAL_SPACE_BITS 2u

struct SluiceNeuralTile {
    uint mip;
    uint x, y;          /* texel of the mip */
    uint width, height; /* texels */
    uint word;          /* where the first row begins in the output, in words of 32 bits */
    uint pitch;         /* words from a row of texels or blocks to the next */
    uint store;
    uint firstChannel, channelCount;
    uint spaces;
};
SLUICE_SHARED_SIZE(struct SluiceNeuralTile, 44)

#endif /* SLUICE_SHARED_NEURAL_TILE_H */
