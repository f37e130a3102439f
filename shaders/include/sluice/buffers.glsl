/*
 * Macros through which Sluice's files find their buffers. bindings.glsl defines them for the
 * descriptor set of a frame. Shaders with descriptors of their own define them:
 *
 *     #define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]  // SluiceTextureEntry, read
 *     #define SLUICE_MIN_MIP_WORD(i) minMip.words[i]           // uint, read
 *     #define SLUICE_FEEDBACK_WORD(i) feedback.words[i]        // uint, read and written
 *
 * The blocks are std430 storage buffers (sluiceGetVulkanBuffers). Only feedback.glsl needs
 * SLUICE_FEEDBACK_WORD; only sample.glsl and residency.glsl need SLUICE_MIN_MIP_WORD. You may
 * include "shared/texture_table.h" before you declare the blocks.
 *
 * For paged mode, and for shaders that serve all modes:
 *
 *     #define SLUICE_PAGED true                                // or false, or a constant_id constant
 *     #define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]     // uint, read
 *     #define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]   // sampler2DArray: SluiceVulkanPages
 *
 * `pages` has SluiceVulkanPages.viewCount elements, or fewer if no more are ever used.
 * GL_EXT_nonuniform_qualifier must be enabled. Without that device feature define SLUICE_PAGE_LOOP
 * as the number of elements, and index without nonuniformEXT. Without SLUICE_PAGED none of these is
 * needed; the shader then serves the other modes only.
 *
 * For streamers with pagedTextures, whose textures may be sparse, paged or dense:
 *
 *     #define SLUICE_PAGED true
 *     #define SLUICE_PAGED_PER_TEXTURE true                    // default: false
 *
 * Both may be constant_id constants.
 */
#ifndef SLUICE_BUFFERS_GLSL
#define SLUICE_BUFFERS_GLSL

#include "language.glsl"
#include "shared/texture_table.h"

/* True if the tiles of a texture are pages. `shape`: from the texture's table entry. */
#ifndef SLUICE_PAGED
#define SLUICE_HAS_PAGES(shape) false
#elif defined(SLUICE_PAGED_PER_TEXTURE)
#define SLUICE_HAS_PAGES(shape)                                                                    \
    (SLUICE_PAGED && (!SLUICE_PAGED_PER_TEXTURE || ((shape) & SLUICE_SHAPE_PAGED) != 0u))
#else
#define SLUICE_HAS_PAGES(shape) SLUICE_PAGED
#endif

#endif
