/*
 * Pages of a neural set as shaders see them: the structs of sluice/neural_pages.h, which C uses
 * instead of this file.
 */
#ifndef SLUICE_SHARED_NEURAL_PAGES_H
#define SLUICE_SHARED_NEURAL_PAGES_H

#include "neural.h"

struct SluiceNeuralPageGroup {
    uint firstMip;
    uint mipCount;
    uint firstPage;
    uint columns, rows;
    uint pageWidth, pageHeight;
    uint reserved;
};

struct SluiceNeuralPages {
    uint width, height;
    uint mipCount;
    uint channelCount;
    uint groupCount;
    uint pageCount;
    uint pageSize;
    uint reserved;
    SluiceNeuralPageGroup groups[8];
};

#endif
