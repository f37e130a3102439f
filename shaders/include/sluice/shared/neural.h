/*
 * Constants of a neural texture set as shaders see them: the structs of sluice/neural.h, which C
 * uses instead of this file.
 */
#ifndef SLUICE_SHARED_NEURAL_H
#define SLUICE_SHARED_NEURAL_H

#include "types.h"

#define SLUICE_NEURAL_COLOR_LINEAR 0
#define SLUICE_NEURAL_COLOR_SRGB 1
#define SLUICE_NEURAL_COLOR_HLG 2

struct SluiceNeuralSlice {
    uint dataOffset;
    uint gridSize;
    uint origin;
    uint sliceSize;
};

struct SluiceNeuralMipConstants {
    uint firstSlice;
    int lodCode;
    float positionLod;
    float positionScale;
};

struct SluiceNeuralConstants {
    uint schema;
    uint width, height;
    uint mipCount;
    uint channelCount;
    uint validChannels;
    uint inputCount;
    uint networkFeatures;
    uint highFeatures;
    uint highBits;
    uint lowFeatures;
    uint lowBits;
    uint firstMip;
    uint residentMipCount;
    uint reserved[2];
    SluiceNeuralMipConstants mips[16];
    SluiceNeuralSlice slices[16];
};

#endif
