/* Structs and numbers that the gallery's program and shaders share. Layout: std430. */
#ifndef GALLERY_SHARED_H
#define GALLERY_SHARED_H

#include "sluice/shared/types.h"
#ifdef __STDC_VERSION__
#include <sluice/neural_pages.h>
#else
#include "sluice/shared/neural_pages.h"
#endif

#define GALLERY_NO_TEXTURE 0xffffffffu
#define GALLERY_LIGHTS_PER_DRAW 3

/* Storage buffers of set 2. */
#define GALLERY_BINDING_FRAME 0
#define GALLERY_BINDING_LIGHTS 1
#define GALLERY_BINDING_COUNTS 2
#define GALLERY_BINDING_REQUIRED 3 /* the pass of needs.frag writes its feedback here */
#define GALLERY_BINDING_COUNT 4

/* Storage buffers of set 3: first those of a demand loader, then those of a neural set. */
#define GALLERY_NEURAL_BINDING_LEVELS 0
#define GALLERY_NEURAL_BINDING_DIRECTORY 1
#define GALLERY_NEURAL_BINDING_BLOCKS 2
#define GALLERY_NEURAL_BINDING_MASKS 3
#define GALLERY_NEURAL_BINDING_REQUESTS 4
#define GALLERY_NEURAL_BINDING_SECTIONS 5
#define GALLERY_NEURAL_BINDING_SET 6
#define GALLERY_NEURAL_BINDING_WEIGHTS 7
#define GALLERY_NEURAL_BINDING_COUNT 8

/* Draw flags. */
#define GALLERY_GRAY 1u    /* one channel, shown as gray */
#define GALLERY_PAINTED 2u /* has a relief and shining varnish */
#define GALLERY_GLOWING 4u /* emits light; is not lit */
#define GALLERY_HDR 8u     /* a decoded picture whose values may be above 1 */

/* A lamp over a picture. */
struct GalleryLight {
    float position[3];
    float cosOuter; /* no light beyond this angle */
    float direction[3];
    float cosInner; /* full light within this angle */
};
SLUICE_SHARED_SIZE(struct GalleryLight, 32)

/* Values that change per frame. */
struct GalleryFrame {
    float viewProjection[16]; /* column by column */
    float eye[3];
    float feedbackProbability;
    float roomSize[3]; /* width, height, length; x is centered, y from 0, z from 0 to -length */
    float lodBias;
    float maxAnisotropy;
    uint feedbackSeed;
    uint latticeFrame;   /* step of the lattice; GALLERY_NO_TEXTURE: random feedback */
    uint highlight;      /* 1: tint pixels that are coarser than requested */
    float presentEye[3]; /* current eye; in the prediction pass, `eye` is the future one */
    float pixelScale;    /* width of the picture's pixels, in pixels that are drawn */
    uint neuralPicks;    /* texels per pixel of pictures that the shader decodes */
};
SLUICE_SHARED_SIZE(struct GalleryFrame, 132)

/* Push constants of one draw. */
struct GalleryDraw {
    uint colorTexture;   /* texture table index; decoded pictures: first channel in the set */
    uint reliefTexture;  /* texture table index; decoded pictures: color spaces, 2 bits each */
    uint reliefFeedback; /* 1: the relief writes feedback of its own */
    uint flags;
    uint lights[GALLERY_LIGHTS_PER_DRAW];
    float exposure;
    float color[3];
    float reliefScale; /* meters from the lowest to the highest relief */
};
SLUICE_SHARED_SIZE(struct GalleryDraw, 48)

/* A neural set whose latents are in pages. */
struct GalleryNeuralSet {
    SluiceNeuralPages pages;
    uint firstPage;
};
SLUICE_SHARED_SIZE(struct GalleryNeuralSet, 292)

/* Results of the counting pass. */
struct GalleryCounts {
    uint nonResident;   /* samples that would read a texel that is not resident */
    uint sampled;       /* pixels that sample a streamed texture */
    uint missingPixels; /* pixels coarser than requested */
    uint missingLevels; /* sum of levels that these pixels lack */
};
SLUICE_SHARED_SIZE(struct GalleryCounts, 16)

#endif
