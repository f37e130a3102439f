/*
 * What one load says about most samples.
 *
 * Beside its own texel a word of the MinMip buffer holds the largest one of the regions around: no
 * sample that reaches into no more than those can touch anything coarser. Where that is not enough
 * the footprint itself is looked at, which costs several times as much.
 *
 * Members of the texture table are read one by one here: the whole entry would be loaded before the
 * branch that most samples do not take.
 */
#ifndef SLUICE_QUICK_GLSL
#define SLUICE_QUICK_GLSL

#include "footprint.glsl"

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

/** The region that a sample lies in; for `uv` that is not finite some region. */
uvec2 sluiceQuickRegion(SluiceGrid grid, vec2 uv)
{
    vec2 at = uv - floor(uv);
    if ((grid.shape & SLUICE_SHAPE_REPEATS) == 0u) {
        uvec2 modes = sluiceAddressModes(grid);
        at = vec2(sluiceFoldCoordinate(uv.x, modes.x), sluiceFoldCoordinate(uv.y, modes.y));
    }
    return min(uvec2(at * grid.size) >> sluiceRegionShift(grid), grid.last);
}

/** How much a LOD bias widens what a sample touches, squared. */
float sluiceBiasScale2(float lodBias)
{
    return lodBias <= 0.0 ? 1.0 : exp2(2.0 * sluiceClampLodBias(lodBias));
}

#endif
