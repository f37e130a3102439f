/* Data of the pixels of bindless.glsl. */
#ifndef BINDLESS_SHARED_H
#define BINDLESS_SHARED_H

#include "sluice/shared/types.h"

#define BINDLESS_SIZE 64 /* pixels along each side */
#define BINDLESS_GROUP 8 /* of the compute shader */
#define BINDLESS_MAX_TEXTURES 8

/* One that every pixel samples; others choose at random. */
#define BINDLESS_NO_TEXTURE 0xFFFFFFFFu

struct BindlessTexture {
    uint tableIndex;
    uint lastLevel;
    float maxAnisotropy;
    float scale; /* of uv: texels per pixel differ */
};
SLUICE_SHARED_SIZE(struct BindlessTexture, 16)

struct BindlessOutput {
    float color[4];
    float texel[4]; /* of the last level */
    uint missing;
    uint texture; /* that was chosen */
    uint padding[2];
};
SLUICE_SHARED_SIZE(struct BindlessOutput, 48)

struct BindlessParams {
    uint count; /* textures */
    uint seed;
    uint shift; /* pixels of a square of 1 << shift choose together */
    uint only;  /* place of the texture in `alone`, or BINDLESS_NO_TEXTURE */
};
SLUICE_SHARED_SIZE(struct BindlessParams, 16)

#endif
