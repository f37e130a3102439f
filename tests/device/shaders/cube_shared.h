/* Inputs of the cube shader, for C and GLSL. Outputs are ProbeOutput. */
#ifndef CUBE_SHARED_H
#define CUBE_SHARED_H

#include "probe_shared.h"

/* Flags of ProbeParams, which has the table index of the first face of a cube. The bits from
 * CUBE_INDEX_SHIFT on are the number of the cube. */
#define CUBE_SAMPLE 1u
#define CUBE_FEEDBACK 2u
#define CUBE_FEEDBACK_LOD 4u
#define CUBE_FEEDBACK_QUAD 8u /* four pixels in one frame, or one pixel in four, by turns */
#define CUBE_CLEAR 16u        /* clears `count` words of feedback instead */
#define CUBE_WORDS 32u        /* copies feedback words instead */
#define CUBE_INDEX_SHIFT 16u

/* Its size is that of two ProbeInputs, because both lie in one buffer. */
struct CubeInput {
    float direction[3];
    float dx[3];
    float dy[3];
    float lodBias;
    float maxAnisotropy;
    float lod;   /* with CUBE_FEEDBACK_LOD */
    uint number; /* cube_numbers.comp: tableIndex of the first face */
    float unused[3];
};
SLUICE_SHARED_SIZE(struct CubeInput, 64)

#endif
