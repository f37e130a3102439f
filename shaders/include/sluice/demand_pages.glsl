/*
 * Pages of demand loading: looks up a page, or requests it. demand.glsl includes this file for
 * textures; shaders that use only resources of their own need no other file.
 *
 * Macros to define before this file. demand_bindings.glsl defines them for the descriptor set of a
 * launch. Shaders with other descriptors must define:
 *
 *     #define SLUICE_DEMAND_LEVEL_WORD(i) levels.words[i]         // uint, read
 *     #define SLUICE_DEMAND_DIRECTORY_WORD(i) directory.words[i]  // uint, read
 *     #define SLUICE_DEMAND_BLOCK_WORD(i) blocks.words[i]         // uint, read
 *     #define SLUICE_DEMAND_MASKS(i) masks.entries[i]             // SluiceDemandBlockMasks, read and written
 *     #define SLUICE_DEMAND_REQUEST_WORD(i) requests.words[i]     // uint, read and written
 *     #define SLUICE_DEMAND_SECTION_WORD(i) sections.words[i]     // uint, read and written
 *
 *     #define SLUICE_DEMAND_QUIET true  // optional, a bool: nothing is requested while it is true
 *
 * The blocks are std430 storage buffers (SluiceDemandBuffers). Blocks without writes may be readonly.
 * You may include "shared/demand.h" before their declaration. Any stage. Fragment shaders require the
 * feature fragmentStoresAndAtomics, earlier stages vertexPipelineStoresAndAtomics.
 */
#ifndef SLUICE_DEMAND_PAGES_GLSL
#define SLUICE_DEMAND_PAGES_GLSL

#include "language.glsl"
#include "shared/demand.h"

#ifndef SLUICE_DEMAND_QUIET
#define SLUICE_DEMAND_QUIET false
#endif

/**
 * Requests a page: sets its bit, and that of its section. If the bit is already set, this costs one
 * load, so thousands of invocations may miss the same page.
 */
void sluiceRequestDemandPage(uint page)
{
    uint word = page / SLUICE_DEMAND_BLOCK_PAGES;
    uint bit = 1u << (page % SLUICE_DEMAND_BLOCK_PAGES);
    if (SLUICE_DEMAND_QUIET || (SLUICE_DEMAND_REQUEST_WORD(word) & bit) != 0u)
        return;
    uint before;
    SLUICE_ATOMIC_OR_READ(SLUICE_DEMAND_REQUEST_WORD(word), bit, before);
    if ((before & bit) != 0u)
        return; /* the invocation that set the page's bit sets the section's bit */
    uint section = page / SLUICE_DEMAND_SECTION_PAGES;
    bit = 1u << (section % 32u);
    if ((SLUICE_DEMAND_SECTION_WORD(section / 32u) & bit) == 0u)
        SLUICE_ATOMIC_OR(SLUICE_DEMAND_SECTION_WORD(section / 32u), bit);
}

/**
 * Returns whether a page is resident, and marks it as used. If it is resident, `word` is its word
 * and `at` the index of that word in the blocks.
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
        SLUICE_ATOMIC_OR(SLUICE_DEMAND_MASKS(block).used, bit);
    return true;
}

/** Marks a page as used without looking it up: the tail of a texture whose color was enough. */
void sluiceMarkDemandPage(uint page)
{
    if (SLUICE_DEMAND_LEVEL_WORD(SLUICE_DEMAND_PARAMETER_TRACKING) == 0u)
        return;
    uint block = SLUICE_DEMAND_DIRECTORY_WORD(page / SLUICE_DEMAND_BLOCK_PAGES);
    uint bit = 1u << (page % SLUICE_DEMAND_BLOCK_PAGES);
    if (block != SLUICE_DEMAND_NO_BLOCK && (SLUICE_DEMAND_MASKS(block).used & bit) == 0u)
        SLUICE_ATOMIC_OR(SLUICE_DEMAND_MASKS(block).used, bit);
}

/**
 * Gets the value of a page of a resource: its low 32 bits, then its high 32 bits. Returns false if
 * the page is not resident; it is then requested, and `value` is 0.
 *
 * `page` is the resource's first page plus the page's index, which must be below pageCount.
 */
bool sluiceMapOrRequest(uint page, out uvec2 value)
{
    uint at, word;
    value = SLUICE_SPLAT(uvec2, 0u);
    if (!sluiceFindDemandPage(page, at, word)) {
        sluiceRequestDemandPage(page);
        return false;
    }
    value = uvec2(word, SLUICE_DEMAND_BLOCK_WORD(at + SLUICE_DEMAND_BLOCK_PAGES));
    return true;
}

#endif
