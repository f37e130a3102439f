/* Data of the pixels of bindless.glsl. */
#ifndef BINDLESS_SHARED_H
#define BINDLESS_SHARED_H

#include "sluice/shared/types.h"

#define BINDLESS_SIZE 64 /* pixels along each side */
#define BINDLESS_GROUP 8 /* threads per axis of the compute shader */
#define BINDLESS_MAX_TEXTURES 8

/* Texture that every pixel samples. None: pixels choose at random. */
#define BINDLESS_NO_TEXTURE 0xFFFFFFFFu

struct BindlessTexture {
    uint tableIndex;
    uint lastLevel;
    float maxAnisotropy;
    float scale; /* scale of uv, so that texels per pixel differ */
};
SLUICE_SHARED_SIZE(struct BindlessTexture, 16)

struct BindlessOutput {
    float color[4];
    float texel[4]; /* texel of the last level */
    uint missing;
    uint texture; /* chosen texture */
    uint padding[2];
};
SLUICE_SHARED_SIZE(struct BindlessOutput, 48)

struct BindlessParams {
    uint count; /* textures */
    uint seed;
    uint shift; /* squares of 1 << shift pixels choose one texture */
    uint only;  /* index of the texture in `alone`, or BINDLESS_NO_TEXTURE */
};
SLUICE_SHARED_SIZE(struct BindlessParams, 16)

#endif
