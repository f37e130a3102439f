/*
 * The regions of a texture that one sample may touch.
 *
 * A tile of level l stands over the regions whose index, shifted right by l, is its own. Level sizes
 * are rounded down, so on textures that do not halve evenly a tile begins up to one texel of its
 * level before its regions: the box around a sample reaches that much further down.
 *
 * Along an axis it suffices to look at one region of each tile of the finest level that is sampled,
 * and at the last region, which may be narrow. C twin: lib/vulkan/shader_twins.h.
 */
#ifndef SLUICE_FOOTPRINT_GLSL
#define SLUICE_FOOTPRINT_GLSL

#include "buffers.glsl"
#include "lod.glsl"

/* Texels of the coarser level: half a texel for the bilinear filter, and room for fixed-point uv. */
#define SLUICE_APRON 0.5625
#define SLUICE_APRON_UNEVEN 1.5625

/* More tiles than 64 along an axis are walked in longer steps, and some of them passed over: that
 * takes a LOD bias below -6 and anisotropy. */
#define SLUICE_FOOTPRINT_STEPS_LOG2 6

/**
 * Columns x and rows y, each from the first to the second region, and where the third is another,
 * the box wraps: on from 0 to the third.
 */
struct SluiceFootprint {
    uvec3 x;
    uvec3 y;
};

/** Region of a coordinate in [0, 1]; always below `regionCount`, also for NaN. */
uint sluiceRegionIndex(float coordinate, float regionsPerUnit, uint regionCount)
{
    float at = coordinate > 0.0 ? min(coordinate, 1.0) * regionsPerUnit : 0.0;
    return min(uint(at), regionCount - 1u);
}

/**
 * One axis: the regions from `below` before to `above` behind the coordinate, both in units of uv.
 */
uvec3 sluiceRegionRange(float coordinate, float below, float above, uint addressMode,
                        float regionsPerUnit, uint regionCount)
{
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT) {
        below = below < 0.5 ? below : 0.5; /* all of the image, and NaN */
        above = above < 0.5 ? above : 0.5;
        /* fract first: far from 0 the ends of the box would round to its middle */
        float middle = coordinate - floor(coordinate);
        middle = middle >= 0.0 ? min(middle, 1.0) : 0.0;
        float low = middle - below;
        float high = middle + above;
        bool wraps = low < 0.0 || high >= 1.0;
        uint first = sluiceRegionIndex(low < 0.0 ? low + 1.0 : low, regionsPerUnit, regionCount);
        uint last = sluiceRegionIndex(high >= 1.0 ? high - 1.0 : high, regionsPerUnit, regionCount);
        if (!wraps)
            return uvec3(first, last, last);
        return uvec3(last == regionCount - 1u ? 0u : first, regionCount - 1u, last);
    }
    float middle = coordinate;
    if (addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT) {
        middle = coordinate - 2.0 * floor(coordinate * 0.5);
        middle = middle > 1.0 ? 2.0 - middle : middle;
        below = above = max(below, above);
    } else if (addressMode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE) {
        middle = abs(coordinate);
        below = above = max(below, above);
    }
    /* the ends are clamped, not the middle: a box outside touches no more than the edge */
    uint first = sluiceRegionIndex(middle - below, regionsPerUnit, regionCount);
    uint last = sluiceRegionIndex(middle + above, regionsPerUnit, regionCount);
    last = max(first, last); /* NaN */
    return uvec3(first, last, last);
}

/**
 * Around `uv`, for samples of levels up to `coarsestLevel`; `halfBox` as sluiceHalfBox.
 */
SluiceFootprint sluiceComputeFootprint(SluiceTextureEntry entry, vec2 uv, vec2 halfBox,
                                       uint coarsestLevel)
{
    float below = (entry.flags & SLUICE_TEXTURE_FLAG_UNEVEN) != 0u ? SLUICE_APRON_UNEVEN : SLUICE_APRON;
    float texelX = 1.0 / float(max(entry.width >> coarsestLevel, 1u));
    float texelY = 1.0 / float(max(entry.height >> coarsestLevel, 1u));
    SluiceFootprint footprint;
    footprint.x = sluiceRegionRange(uv.x, below * texelX + halfBox.x, SLUICE_APRON * texelX + halfBox.x,
                                    entry.addressModeU,
                                    float(entry.width) / float(entry.regionWidth),
                                    entry.regionCountX);
    footprint.y = sluiceRegionRange(uv.y, below * texelY + halfBox.y, SLUICE_APRON * texelY + halfBox.y,
                                    entry.addressModeV,
                                    float(entry.height) / float(entry.regionHeight),
                                    entry.regionCountY);
    return footprint;
}

bool sluiceFootprintIsOneRegion(SluiceFootprint footprint)
{
    return all(equal(footprint.x.xx, footprint.x.yz)) && all(equal(footprint.y.xx, footprint.y.yz));
}

/** The step between regions of an axis that sees every tile of `level`, as a power of two. */
uint sluiceRangeShift(uvec3 range, uint level)
{
    int bits = findMSB(range.y - range.x + (range.z == range.y ? 0u : range.z)) + 1;
    return max(level, uint(max(bits - SLUICE_FOOTPRINT_STEPS_LOG2, 0)));
}

/* How many steps lead from one region to another, both included. */
uint sluiceCountSteps(uint distance, uint shift)
{
    return ((distance + (1u << shift) - 1u) >> shift) + 1u;
}

uint sluiceRangeSteps(uvec3 range, uint level)
{
    uint shift = sluiceRangeShift(range, level);
    uint count = sluiceCountSteps(range.y - range.x, shift);
    return range.z == range.y ? count : count + sluiceCountSteps(range.z, shift);
}

uint sluiceRangeRegion(uvec3 range, uint level, uint i)
{
    uint shift = sluiceRangeShift(range, level);
    uint count = sluiceCountSteps(range.y - range.x, shift);
    return i < count ? min(range.x + (i << shift), range.y) : min((i - count) << shift, range.z);
}

/**
 * How many columns and rows to look at so as to see every tile of `level`, the finest that is
 * sampled, and of coarser levels; and which regions those are.
 */
uvec2 sluiceFootprintSteps(SluiceFootprint footprint, uint level)
{
    return uvec2(sluiceRangeSteps(footprint.x, level), sluiceRangeSteps(footprint.y, level));
}

uvec2 sluiceFootprintRegion(SluiceFootprint footprint, uint level, uvec2 step)
{
    return uvec2(sluiceRangeRegion(footprint.x, level, step.x),
                 sluiceRangeRegion(footprint.y, level, step.y));
}

/**
 * Half the size of the box around the ellipse that the derivatives span, 0 without anisotropy:
 * whichever of its axes a device takes its samples along, they are inside. A positive LOD bias makes
 * it larger: some devices scale the footprint with it, and so do explicit derivatives that hold the
 * bias.
 */
vec2 sluiceHalfBox(vec2 dx, vec2 dy, float lodBias, float maxAnisotropy)
{
    if (!(maxAnisotropy > 1.0))
        return vec2(0.0);
    float scale = lodBias > 0.0 ? exp2(min(lodBias, SLUICE_LOD_LIMIT)) : 1.0;
    return 0.5 * scale * vec2(length(vec2(dx.x, dy.x)), length(vec2(dx.y, dy.y)));
}

#endif
