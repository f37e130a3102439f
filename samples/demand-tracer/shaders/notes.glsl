/*
 * Which pages the paths of the finished picture have sampled, for --needs: a bit for each page, set when
 * it is looked up, as long as the path has missed nothing. A path goes the same way until it misses
 * something, launch after launch, so all that is noted is sampled by the path that is complete in the
 * end; what lies behind a miss may be seen only because of it. Nothing that the library reads is
 * changed: its own accesses to the page table say what it looks up.
 */
#ifndef TRACER_NOTES_GLSL
#define TRACER_NOTES_GLSL

layout(constant_id = TRACER_CONSTANT_NEEDS) const bool needs = false;

layout(std430, set = 1, binding = TRACER_BINDING_NEEDS) buffer NeededPages
{
    uint neededPages[]; /* a bit per page */
};

bool noting = false; /* the path has missed nothing */
uint noteGroupNow;   /* of 32 pages: which is looked up */

uint noteGroup(uint group)
{
    noteGroupNow = group;
    return group;
}

/** `at` is a place in the blocks, where each group of 32 pages has one. */
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
