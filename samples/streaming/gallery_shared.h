/* What the gallery's shaders and its program share; std430. */
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

/* Storage buffers of set 3: those of a demand loader, then those of a neural set. */
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
#define GALLERY_PAINTED 2u /* has a relief, and varnish that shines */
#define GALLERY_GLOWING 4u /* not lit: gives light itself */
#define GALLERY_HDR 8u     /* a decoded picture whose values may be above 1 */

/* A lamp over a picture. */
struct GalleryLight {
    float position[3];
    float cosOuter; /* no light beyond this angle */
    float direction[3];
    float cosInner; /* full light within this angle */
};
SLUICE_SHARED_SIZE(struct GalleryLight, 32)

/* What changes from frame to frame. */
struct GalleryFrame {
    float viewProjection[16]; /* column by column */
    float eye[3];
    float feedbackProbability;
    float
        roomSize[3]; /* width, height, length; the room is centered in x, from 0 up, from 0 to -z */
    float lodBias;
    float maxAnisotropy;
    uint feedbackSeed;
    uint latticeFrame;   /* the lattice's step; GALLERY_NO_TEXTURE: random instead */
    uint highlight;      /* 1: tint what is coarser than wanted */
    float presentEye[3]; /* where the eye is; `eye` is where it will be, where that is drawn */
    float pixelScale;    /* width of the picture's pixels, in pixels of what is drawn */
    uint neuralPicks;    /* texels per pixel of pictures that the shader decodes */
};
SLUICE_SHARED_SIZE(struct GalleryFrame, 132)

/* Push constants of one draw. */
struct GalleryDraw {
    uint colorTexture;  /* texture table index; of a decoded picture its first channel in the set */
    uint reliefTexture; /* texture table index; of a decoded picture color spaces, 2 bits each */
    uint reliefFeedback; /* 1: the relief writes feedback of its own */
    uint flags;
    uint lights[GALLERY_LIGHTS_PER_DRAW];
    float exposure;
    float color[3];
    float reliefScale; /* texels of relief that stand for its height */
};
SLUICE_SHARED_SIZE(struct GalleryDraw, 48)

/* A neural set whose latents are pages. */
struct GalleryNeuralSet {
    SluiceNeuralPages pages;
    uint firstPage;
};
SLUICE_SHARED_SIZE(struct GalleryNeuralSet, 292)

/* What the counting pass finds. */
struct GalleryCounts {
    uint nonResident;   /* samples that would read what is not there */
    uint sampled;       /* pixels that sample */
    uint missingPixels; /* pixels coarser than wanted */
    uint missingLevels; /* levels that they miss together */
};
SLUICE_SHARED_SIZE(struct GalleryCounts, 16)

#endif
