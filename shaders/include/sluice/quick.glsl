/*
 * Decides most samples with one load.
 *
 * A word of the MinMip buffer holds its region's texel and the largest texel of the regions around
 * it. A sample that reaches no further than those regions touches nothing coarser. Otherwise the
 * whole footprint is read, which costs several times as much.
 *
 * Members of the texture table are read one by one: a read of the whole entry would be hoisted
 * before the branch that few samples take.
 */
#ifndef SLUICE_QUICK_GLSL
#define SLUICE_QUICK_GLSL

#include "footprint.glsl"

/** Returns the equivalent coordinate inside the image, 0 to 1. 0 for NaN. */
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

/** Returns the region of a sample. If `uv` is not finite: any region. */
uvec2 sluiceQuickRegion(SluiceGrid grid, vec2 uv)
{
    vec2 at = uv - floor(uv);
    if ((grid.shape & SLUICE_SHAPE_REPEATS) == 0u) {
        uvec2 modes = sluiceAddressModes(grid);
        at = vec2(sluiceFoldCoordinate(uv.x, modes.x), sluiceFoldCoordinate(uv.y, modes.y));
    }
    return min(uvec2(at * grid.size) >> sluiceRegionShift(grid), grid.last);
}

/** Returns the square of the factor by which a LOD bias widens a sample. */
float sluiceBiasScale2(float lodBias)
{
    return lodBias <= 0.0 ? 1.0 : exp2(2.0 * sluiceClampLodBias(lodBias));
}

#endif
