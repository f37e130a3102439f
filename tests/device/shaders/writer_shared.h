/* Parameters of shaders that only write feedback, for C and GLSL. */
#ifndef WRITER_SHARED_H
#define WRITER_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define WRITER_COPY_WORDS 1u /* copies words of the feedback buffer instead of writing feedback */

struct WriterInput {
    float uv[2];
    float dx[2];
    float dy[2];
    float maxAnisotropy;
    uint tableIndex;
};
SLUICE_SHARED_SIZE(struct WriterInput, 32)

struct WriterParams {
    uint first; /* input, or word */
    uint count;
    uint flags;
    float coneAngle; /* ray tracer: radians per pixel */
};
SLUICE_SHARED_SIZE(struct WriterParams, 16)

#endif
