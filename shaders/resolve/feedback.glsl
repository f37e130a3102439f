/* Four neighboring regions of a segment, for the passes that read feedback. */
#include "resolve.glsl"

/* One of the two is used, by the encoding; both begin with region 0. */
layout(std430, binding = 0) buffer FeedbackLevels { uvec4 quads[]; } feedbackLevels;
layout(std430, binding = 0) buffer FeedbackMasks { uvec2 quads[]; } feedbackMasks;
layout(std430, binding = 1) buffer Last { uint quads[]; } last;

struct SluiceQuad {
    uint index;  /* word of four regions in the buffers */
    uint levels; /* packed levels, written since the last resolve */
    uint before; /* packed levels of the last resolve */
};

/** Loads a quad. Regions beyond the segment's count are returned as unchanged. */
SluiceQuad sluiceLoadQuad(SluiceResolveSegment segment, uint place)
{
    SluiceQuad quad = SluiceQuad(segment.firstRegion / 4u + place, 0u, 0u);
    if (place * 4u >= segment.regionCount)
        return quad;
    uvec4 levels = encoding == SLUICE_FEEDBACK_MASKS
                       ? sluiceMaskLevels(feedbackMasks.quads[quad.index])
                       : feedbackLevels.quads[quad.index];
    uint valid = 0xFFFFFFFFu >> 8u * (4u - min(segment.regionCount - place * 4u, 4u));
    quad.before = last.quads[quad.index];
    quad.levels = sluicePackLevels(levels) & valid | quad.before & ~valid;
    return quad;
}

bvec4 sluiceChanged(SluiceQuad quad)
{
    return notEqual(sluiceUnpackLevels(quad.levels), sluiceUnpackLevels(quad.before));
}

#define SLUICE_QUADS_PER_WORD 8u
#define SLUICE_CHANGE_WORDS (SLUICE_RESOLVE_GROUP_SIZE / SLUICE_QUADS_PER_WORD)

/* A bit per region of the segment: one look at it replaces a scan step by step. */
shared uint changedRegions[SLUICE_CHANGE_WORDS];

/** Fills changedRegions; to be called by the whole workgroup, once. */
void sluiceShareChanges(SluiceQuad quad)
{
    uint at = gl_LocalInvocationIndex;
    if (at < SLUICE_CHANGE_WORDS)
        changedRegions[at] = 0u;
    barrier();
    uvec4 bits = uvec4(sluiceChanged(quad)) << uvec4(0u, 1u, 2u, 3u);
    uint mask = bits.x | bits.y | bits.z | bits.w;
    if (mask != 0u)
        atomicOr(changedRegions[at / SLUICE_QUADS_PER_WORD], mask << 4u * (at % SLUICE_QUADS_PER_WORD));
    barrier();
}

/** Returns the number of changed regions in the segment's first `quads` quads. */
uint sluiceCountChangesBefore(uint quads)
{
    uint word = quads / SLUICE_QUADS_PER_WORD, count = 0u;
    for (uint i = 0u; i < word; i++)
        count += uint(bitCount(changedRegions[i]));
    if (word < SLUICE_CHANGE_WORDS)
        count += uint(bitCount(changedRegions[word] & ((1u << 4u * (quads % SLUICE_QUADS_PER_WORD)) - 1u)));
    return count;
}
