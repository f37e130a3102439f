/*
 * What one load says about most samples.
 *
 * Beside its own texel a word of the MinMip buffer holds the largest one of the regions around: no
 * sample that reaches into no more than those can touch anything coarser. And a sample that stays
 * inside its region marks only that. Where neither is sure the whole footprint is walked, which says
 * the same and costs several times as much.
 *
 * Members of the texture table are read one by one here: the whole entry would be loaded before the
 * branch that most samples do not take.
 */
#ifndef SLUICE_QUICK_GLSL
#define SLUICE_QUICK_GLSL

#include "buffers.glsl"
#include "lod.glsl"

/* Beyond it nothing is quick. */
#define SLUICE_QUICK_BIAS 16.0

/** A coordinate inside the image: 0 to 1; 0 for NaN. */
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

/** Where a sample is, in texels of level 0; not >= 0 where `uv` is not finite. */
vec2 sluiceQuickTexel(uint tableIndex, vec2 uv, uint shape)
{
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
    if (!sluiceIsFinite(uv))
        return vec2(-1.0);
    if ((shape & SLUICE_QUICK_REPEATS) != 0u)
        return (uv - floor(uv)) * size;
    return vec2(sluiceFoldCoordinate(uv.x, SLUICE_TEXTURE_ENTRY(tableIndex).addressModeU),
                sluiceFoldCoordinate(uv.y, SLUICE_TEXTURE_ENTRY(tableIndex).addressModeV)) *
           size;
}

uvec2 sluiceQuickShift(uint shape)
{
    return uvec2(shape & 255u, (shape >> 8u) & 255u);
}

/** The region of such a place: one of the texture, whatever the place. */
uvec2 sluiceQuickRegion(uint tableIndex, vec2 texel, uint shape)
{
    return min(uvec2(texel) >> sluiceQuickShift(shape),
               uvec2(SLUICE_TEXTURE_ENTRY(tableIndex).regionLastX,
                     SLUICE_TEXTURE_ENTRY(tableIndex).regionLastY));
}

/** How much a LOD bias widens what a sample touches, squared. */
float sluiceBiasScale2(float lodBias)
{
    return lodBias <= 0.0 ? 1.0 : exp2(2.0 * sluiceClampLodBias(lodBias));
}

#endif
