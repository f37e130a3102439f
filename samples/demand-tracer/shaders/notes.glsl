/*
 * Notes the pages that paths of the finished picture sample, for --needs. Each page has a bit, set
 * when the page is looked up while the path has missed nothing.
 *
 * A path takes the same way in each launch until it misses something. So all noted pages are
 * sampled by the final, complete path. Pages beyond a miss may be looked up only because of the
 * miss, and are not noted. The library's buffers stay unchanged: the shader's own accesses to the
 * page table tell what it looks up.
 */
#ifndef TRACER_NOTES_GLSL
#define TRACER_NOTES_GLSL

layout(constant_id = TRACER_CONSTANT_NEEDS) const bool needs = false;

layout(std430, set = 1, binding = TRACER_BINDING_NEEDS) buffer NeededPages
{
    uint neededPages[]; /* a bit per page */
};

bool noting = false; /* true: the path has missed nothing */
uint noteGroupNow;   /* group of 32 pages that is looked up now */

uint noteGroup(uint group)
{
    noteGroupNow = group;
    return group;
}

/** Notes the page at index `at` of the blocks. Each group of 32 pages has a block. */
uint notePage(uint at)
{
    uint bit = 1u << (at % SLUICE_DEMAND_BLOCK_WORDS);
    if (needs && noting && (neededPages[noteGroupNow] & bit) == 0u)
        atomicOr(neededPages[noteGroupNow], bit);
    return at;
}

uint noteMiss(uint word)
{
    noting = false;
    return word;
}

#endif
