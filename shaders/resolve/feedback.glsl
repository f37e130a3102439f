/* Four neighbouring regions of a segment, for the passes that read feedback. */
#include "resolve.glsl"

/* One of the two is used, by the encoding; both begin with region 0. */
layout(std430, binding = 0) buffer FeedbackLevels { uvec4 quads[]; } feedbackLevels;
layout(std430, binding = 0) buffer FeedbackMasks { uvec2 quads[]; } feedbackMasks;
layout(std430, binding = 1) buffer Last { uint quads[]; } last;

struct SluiceQuad {
    uint index;  /* of four regions, in the buffers */
    uint levels; /* packed, as written since the last resolve */
    uint before; /* as resolved last */
};

/** Regions beyond the segment's count, and they alone, look unchanged. */
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

uint sluiceCountChanges(SluiceQuad quad)
{
    uvec4 changed = uvec4(sluiceChanged(quad));
    return changed.x + changed.y + changed.z + changed.w;
}
