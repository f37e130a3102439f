/* Pictures of share_texels.glsl, for C and GLSL. */
#ifndef SHARE_SHARED_H
#define SHARE_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define SHARE_PICTURE 64u   /* pixels in a row and column; groups are 8x8 */
#define SHARE_TEXTURE 32u   /* texels of level 0 */
#define SHARE_FLAG_MIXED 1u /* every second pixel is of another texture */

struct ShareParams {
    float left; /* uv of the first pixel's corner */
    float top;
    float step; /* uv per pixel */
    float lod;
    uint modeU;
    uint modeV;
    uint kernel;
    uint frame;
    uint levelCount;
    uint flags;
};
SLUICE_SHARED_SIZE(struct ShareParams, 40)

struct ShareOutput {
    float color[4]; /* the texture is 4 hashes; x: also of the key */
    uint decoded;
    uint exact;
    uint level;
    uint padding;
};
SLUICE_SHARED_SIZE(struct ShareOutput, 32)

#endif
