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
 *
 * For paged residency, and shaders that serve all modes:
 *
 *     #define SLUICE_PAGED true                                // or false, or a constant_id constant
 *     #define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]     // uint, read
 *     #define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]   // sampler2DArray: SluiceVulkanPages
 *
 * where `pages` has SluiceVulkanPages.viewCount elements or fewer, if that many are ever used, and
 * GL_EXT_nonuniform_qualifier is enabled. Without the feature for it define SLUICE_PAGE_LOOP, as the
 * number of elements, and index without nonuniformEXT. Without SLUICE_PAGED nothing of this is
 * needed, and the shader is for the other modes alone.
 */
#ifndef SLUICE_BUFFERS_GLSL
#define SLUICE_BUFFERS_GLSL

#include "shared/texture_table.h"

#endif
