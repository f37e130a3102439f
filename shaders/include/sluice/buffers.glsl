/*
 * What an includer must define before the first of Sluice's files, because buffers are his:
 *
 *     #define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]  // SluiceTextureEntry, read
 *     #define SLUICE_MIN_MIP_WORD(i) minMip.words[i]           // uint, read
 *     #define SLUICE_FEEDBACK_WORD(i) feedback.words[i]        // uint, read and written
 *
 * The blocks are std430 storage buffers, see sluiceGetVulkanBuffers. SLUICE_FEEDBACK_WORD is needed
 * by feedback.glsl only, SLUICE_MIN_MIP_WORD by sample.glsl and residency.glsl. "shared/texture_table.h"
 * may be included before the blocks are declared.
 */
#ifndef SLUICE_BUFFERS_GLSL
#define SLUICE_BUFFERS_GLSL

#include "shared/texture_table.h"

#endif
