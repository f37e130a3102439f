/*
 * What one load says about most samples.
 *
 * Beside its own texel a word of the MinMip buffer holds the largest one of the regions around: no
 * sample in a region that reaches into no more than those can touch anything coarser. And a sample
 * that stays inside its region marks only that. Where neither is sure the whole footprint is walked,
 * which says the same and costs several times as much. C twin: lib/vulkan/shader_twins.h.
 */
#ifndef SLUICE_QUICK_GLSL
#define SLUICE_QUICK_GLSL

#include "buffers.glsl"
#include "footprint.glsl"

/** A coordinate inside the image: 0 to 1, and something in between for what is not finite. */
float sluiceFoldCoordinate(float coordinate, uint addressMode)
{
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT)
        return coordinate - floor(coordinate);
    if (addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT) {
        coordinate -= 2.0 * floor(coordinate * 0.5);
        return coordinate > 1.0 ? 2.0 - coordinate : coordinate;
    }
    if (addressMode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE)
        coordinate = abs(coordinate);
    return coordinate > 0.0 ? min(coordinate, 1.0) : 0.0;
}

/** Where a sample is, in texels of level 0. */
vec2 sluiceFoldTexel(SluiceTextureEntry entry, vec2 uv)
{
    return vec2(sluiceFoldCoordinate(uv.x, entry.addressModeU) * float(entry.width),
                sluiceFoldCoordinate(uv.y, entry.addressModeV) * float(entry.height));
}

uvec2 sluiceRegionOfTexel(SluiceTextureEntry entry, vec2 texel)
{
    return min(uvec2(max(texel, vec2(0.0))) >> uvec2(entry.tileShift & 255u, entry.tileShift >> 8u),
               uvec2(entry.regionCountX, entry.regionCountY) - 1u);
}

/**
 * A bound for how far a sample reaches to each side, squared, in units of SLUICE_REACH texels of level
 * 0: half the ellipse that the derivatives span, and the filter on the coarsest level that they can
 * lead to. `dx` and `dy` in texels. NaN where they are not finite.
 */
float sluiceReach2(vec2 dx, vec2 dy, float lodBias)
{
    float scale = lodBias > 0.0 ? exp2(min(lodBias, SLUICE_LOD_LIMIT)) : 1.0;
    return (dot(dx, dx) + dot(dy, dy)) * scale * scale;
}

/** True if a sample surely touches one region, and which. */
bool sluiceStaysInRegion(SluiceTextureEntry entry, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                         out uvec2 region)
{
    region = uvec2(0u);
    float reach2 = sluiceReach2(dx, dy, lodBias);
    if (!(reach2 < entry.quickReach2) || !sluiceIsFinite(uv) ||
        (entry.flags & SLUICE_TEXTURE_FLAG_RAGGED) != 0u)
        return false;
    vec2 texel = sluiceFoldTexel(entry, uv);
    region = sluiceRegionOfTexel(entry, texel);
    vec2 inside = texel - vec2(region << uvec2(entry.tileShift & 255u, entry.tileShift >> 8u));
    float reach = SLUICE_REACH * sqrt(max(reach2, 1.0));
    vec2 left = vec2(entry.regionWidth, entry.regionHeight) - inside;
    return min(min(inside.x, inside.y), min(left.x, left.y)) > reach;
}

#endif
