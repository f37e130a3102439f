/*
 * Pages of demand loading: looks one up, or asks for it. Textures are demand.glsl's, which includes
 * this; shaders that only use resources of their own need no more than this file.
 *
 * What an includer must define before, because buffers are his:
 *
 *     #define SLUICE_DEMAND_LEVEL_WORD(i) levels.words[i]         // uint, read
 *     #define SLUICE_DEMAND_DIRECTORY_WORD(i) directory.words[i]  // uint, read
 *     #define SLUICE_DEMAND_BLOCK_WORD(i) blocks.words[i]         // uint, read
 *     #define SLUICE_DEMAND_MASKS(i) masks.entries[i]             // SluiceDemandBlockMasks, read and written
 *     #define SLUICE_DEMAND_REQUEST_WORD(i) requests.words[i]     // uint, read and written
 *     #define SLUICE_DEMAND_SECTION_WORD(i) sections.words[i]     // uint, read and written
 *
 * The blocks are std430 storage buffers, see SluiceDemandBuffers; those that are read alone may be
 * declared readonly. "shared/demand.h" may be included before they are declared. Any stage; in
 * fragment shaders the feature fragmentStoresAndAtomics is needed, and vertexPipelineStoresAndAtomics
 * in those before.
 */
#ifndef SLUICE_DEMAND_PAGES_GLSL
#define SLUICE_DEMAND_PAGES_GLSL

#include "shared/demand.h"

/**
 * Asks for a page: sets its bit, and that of its section. A bit that is set already costs a load and
 * nothing more, so thousands of invocations may miss the same page.
 */
void sluiceRequestDemandPage(uint page)
{
    uint word = page / SLUICE_DEMAND_BLOCK_PAGES;
    uint bit = 1u << (page % SLUICE_DEMAND_BLOCK_PAGES);
    if ((SLUICE_DEMAND_REQUEST_WORD(word) & bit) != 0u ||
        (atomicOr(SLUICE_DEMAND_REQUEST_WORD(word), bit) & bit) != 0u)
        return; /* whoever set it sets that of the section */
    uint section = page / SLUICE_DEMAND_SECTION_PAGES;
    bit = 1u << (section % 32u);
    if ((SLUICE_DEMAND_SECTION_WORD(section / 32u) & bit) == 0u)
        atomicOr(SLUICE_DEMAND_SECTION_WORD(section / 32u), bit);
}

/**
 * Whether a page is resident; if so its word is word `at` of the blocks, and has been read. It counts
 * as used from now on.
 */
bool sluiceFindDemandPage(uint page, out uint at, out uint word)
{
    uint block = SLUICE_DEMAND_DIRECTORY_WORD(page / SLUICE_DEMAND_BLOCK_PAGES);
    uint index = page % SLUICE_DEMAND_BLOCK_PAGES;
    at = block * SLUICE_DEMAND_BLOCK_WORDS + index;
    word = SLUICE_PAGE_NONE;
    if (block == SLUICE_DEMAND_NO_BLOCK)
        return false;
    uint resident = SLUICE_DEMAND_MASKS(block).resident;
    uint used = SLUICE_DEMAND_MASKS(block).used;
    word = SLUICE_DEMAND_BLOCK_WORD(at);
    uint bit = 1u << index;
    if ((resident & bit) == 0u)
        return false;
    if ((used & bit) == 0u && SLUICE_DEMAND_LEVEL_WORD(SLUICE_DEMAND_PARAMETER_TRACKING) != 0u)
        atomicOr(SLUICE_DEMAND_MASKS(block).used, bit);
    return true;
}

/**
 * The value of a page of a resource: its low 32 bits, then its high ones. False where it is not
 * there; then it has been asked for, and `value` is 0. `page` is the resource's first page plus the
 * number of the page in it, which must be below pageCount.
 */
bool sluiceMapOrRequest(uint page, out uvec2 value)
{
    uint at, word;
    value = uvec2(0u);
    if (!sluiceFindDemandPage(page, at, word)) {
        sluiceRequestDemandPage(page);
        return false;
    }
    value = uvec2(word, SLUICE_DEMAND_BLOCK_WORD(at + SLUICE_DEMAND_BLOCK_PAGES));
    return true;
}

#endif
