/* What the gallery's shaders and its program share; std430. */
#ifndef GALLERY_SHARED_H
#define GALLERY_SHARED_H

#include "sluice/shared/types.h"

#define GALLERY_NO_TEXTURE 0xffffffffu
#define GALLERY_LIGHTS_PER_DRAW 3

/* Storage buffers of set 2. */
#define GALLERY_BINDING_FRAME 0
#define GALLERY_BINDING_LIGHTS 1
#define GALLERY_BINDING_COUNTS 2
#define GALLERY_BINDING_REQUIRED 3 /* the pass of needs.frag writes its feedback here */
#define GALLERY_BINDING_COUNT 4

/* Draw flags. */
#define GALLERY_GRAY 1u    /* one channel, shown as gray */
#define GALLERY_PAINTED 2u /* has a relief, and varnish that shines */
#define GALLERY_GLOWING 4u /* not lit: gives light itself */

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
};
SLUICE_SHARED_SIZE(struct GalleryFrame, 128)

/* Push constants of one draw. */
struct GalleryDraw {
    uint colorTexture; /* texture table index */
    uint reliefTexture;
    uint reliefFeedback; /* 1: the relief writes feedback of its own */
    uint flags;
    uint lights[GALLERY_LIGHTS_PER_DRAW];
    float exposure;
    float color[3];
    float reliefScale; /* texels of relief that stand for its height */
};
SLUICE_SHARED_SIZE(struct GalleryDraw, 48)

/* What the counting pass finds. */
struct GalleryCounts {
    uint nonResident;   /* samples that would read what is not there */
    uint sampled;       /* pixels that sample */
    uint missingPixels; /* pixels coarser than wanted */
    uint missingLevels; /* levels that they miss together */
};
SLUICE_SHARED_SIZE(struct GalleryCounts, 16)

#endif
