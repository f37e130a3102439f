/* Calls one function of sluice/ on many arguments. Nothing that is called reads memory. */
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require

#include "sluice/shared/demand.h"
#include "sluice/shared/texture_table.h"
#include "numerics_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Calls { NumericsCall calls[]; };
layout(std430, binding = 1) buffer Words { uint words[]; } memory;
layout(std430, binding = 2) buffer Masks { SluiceDemandBlockMasks entries[]; } masks;
layout(binding = 3) uniform sampler2DArray pages[1];
layout(push_constant) uniform Push { NumericsParams params; };

SluiceTextureEntry entry;
SluiceDemandTexture demandTexture;

#define SLUICE_TEXTURE_ENTRY(i) entry
#define SLUICE_MIN_MIP_WORD(i) memory.words[i]
#define SLUICE_DEMAND_TEXTURE(i) demandTexture
#define SLUICE_DEMAND_LEVEL_WORD(i) memory.words[i]
#define SLUICE_DEMAND_DIRECTORY_WORD(i) memory.words[i]
#define SLUICE_DEMAND_BLOCK_WORD(i) memory.words[i]
#define SLUICE_DEMAND_MASKS(i) masks.entries[i]
#define SLUICE_DEMAND_REQUEST_WORD(i) memory.words[i]
#define SLUICE_DEMAND_SECTION_WORD(i) memory.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#include "sluice/stochastic.glsl"
#include "sluice/sample.glsl"
#include "sluice/demand.glsl"

uint at;

uint argument(uint i) { return calls[at].arguments[i]; }
float real(uint i) { return uintBitsToFloat(argument(i)); }
vec2 real2(uint i) { return vec2(real(i), real(i + 1u)); }

void result(uint i, uint value) { calls[at].results[i] = value; }
void result(uint i, int value) { calls[at].results[i] = uint(value); }
void result(uint i, float value) { result(i, floatBitsToUint(value)); }
void result(uint i, vec2 value) { result(i, value.x); result(i + 1u, value.y); }
void result(uint i, bool value) { result(i, value ? 1u : 0u); }

void results(uvec3 values)
{
    for (uint i = 0u; i < 3u; i++)
        result(i, values[i]);
}

void callLod()
{
    switch (params.function) {
    case NUMERICS_LODS:
        result(0u, sluiceComputeLods(real2(0u), real2(2u), real(4u), real(5u)));
        break;
    case NUMERICS_QUICK_LEVELS: {
        SluiceSquares squares = sluiceSquareLods(real2(0u), real2(2u), real(5u));
        results(sluiceQuickLevels(squares, real(4u), real(5u), argument(6u)));
        result(3u, squares.sum);
        break;
    }
    case NUMERICS_SAFE_LEVELS:
        results(sluiceSafeLevels(vec2(0.25, 0.75), real2(0u), real2(2u), real(4u), real(5u),
                                 argument(6u)));
        break;
    case NUMERICS_FLOOR_LOG4: result(0u, sluiceFloorLog4(real(0u))); break;
    case NUMERICS_ENDS:
        result(0u, sluiceFinestLevel(real(0u), real(1u), argument(2u)));
        result(1u, sluiceCoarsestLevel(real(0u), argument(2u)));
        break;
    case NUMERICS_SHOWN:
        result(0u, sluiceLodLimit(argument(0u), real(1u)));
        result(1u, sluiceShownLevel(argument(0u)));
        break;
    case NUMERICS_CLAMPS:
        result(0u, sluiceClampAnisotropy(real(0u)));
        result(1u, sluiceClampLod(real(0u)));
        result(2u, sluiceClampLodBias(real(0u)));
        result(3u, sluiceLodMargin(real(0u)));
        result(4u, sluiceIsFinite(vec2(real(0u), 1.0)));
        break;
    case NUMERICS_HALF_BOX: result(0u, sluiceHalfBox(real2(0u), real2(2u), real(4u), real(5u))); break;
    }
}

SluiceGrid gridOfArguments()
{
    SluiceGrid grid;
    grid.size = vec2(real(4u), 1.0);
    grid.shape = argument(5u) | argument(3u) << SLUICE_SHAPE_MODE_U_SHIFT |
                 argument(7u) << SLUICE_SHAPE_MODE_V_SHIFT;
    if (argument(3u) == SLUICE_ADDRESS_MODE_REPEAT && argument(7u) == SLUICE_ADDRESS_MODE_REPEAT)
        grid.shape |= SLUICE_SHAPE_REPEATS;
    grid.last = uvec2(argument(6u), 0u);
    return grid;
}

void callRegions()
{
    uvec2 pixel = uvec2(argument(0u), argument(1u));
    vec2 fragCoord = real2(4u);
    switch (params.function) {
    case NUMERICS_REGION_RANGE: {
        uvec2 range = sluiceRegionRange(real(0u), real(1u), real(2u), argument(3u), real(4u),
                                        argument(5u), argument(6u));
        result(0u, range.x);
        result(1u, range.y);
        break;
    }
    case NUMERICS_QUICK_REGION:
        result(0u, sluiceQuickRegion(gridOfArguments(), vec2(real(0u), 0.5)).x);
        break;
    case NUMERICS_SELECT_RANDOM:
        result(0u, sluiceSelectRandomQuad(pixel, argument(2u), real(3u)));
        result(1u, sluiceSelectRandomFragmentQuad(fragCoord, argument(2u), real(3u)));
        break;
    case NUMERICS_SELECT_LATTICE:
        result(0u, sluiceSelectLattice(pixel, argument(2u)));
        result(1u, sluiceSelectFragmentLattice(fragCoord, argument(2u)));
        break;
    }
}

void callTaps()
{
    vec2 size = vec2(float(argument(4u)));
    SluicePagedTaps taps =
        sluicePlaceTaps(size, argument(5u), real2(0u), real2(2u), real(6u), real(7u));
    result(0u, taps.fine);
    result(1u, taps.coarse);
    result(2u, taps.fraction);
    result(3u, taps.count);
}

void callPages()
{
    int n = int(argument(2u));
    switch (params.function) {
    case NUMERICS_FOLD:
        result(0u, sluiceFoldOntoPages(real(0u), argument(1u), float(n)));
        result(1u, sluiceFoldCoordinate(real(0u), argument(1u)));
        result(2u, sluiceNearCoordinate(real(0u), argument(1u)));
        break;
    case NUMERICS_PAGE_AXIS: {
        SluicePageAxis axis = sluicePageAxis(real(0u), argument(1u), n);
        result(0u, axis.low);
        result(1u, axis.high);
        result(2u, axis.weight);
        float folded = sluiceFoldOntoPages(real(0u), argument(1u), float(n));
        result(3u, sluiceNearestPageAxis(folded, argument(1u), n).low);
        break;
    }
    case NUMERICS_TAPS: callTaps(); break;
    case NUMERICS_SPLINE: {
        SluiceFilterAxis axis = sluiceFilterAxis(real(0u), float(argument(1u)), true, false);
        result(0u, vec2(axis.at.x, axis.weight.x));
        result(2u, vec2(axis.at.y, axis.weight.y));
        break;
    }
    case NUMERICS_DEMAND_LOD:
        result(0u, sluiceDemandComputeLod(real2(0u), real2(2u), real(4u)));
        break;
    case NUMERICS_WIDEN: {
        vec2 dx = real2(0u), dy = real2(2u);
        sluiceWiden(dx, dy, vec2(real(4u)), real(5u));
        result(0u, dx);
        result(2u, dy);
        break;
    }
    }
}

void main()
{
    at = gl_GlobalInvocationID.x;
    if (at >= params.count)
        return;
    if (params.function < NUMERICS_LOD_COUNT)
        callLod();
    else if (params.function < NUMERICS_LOD_COUNT + NUMERICS_REGION_COUNT)
        callRegions();
    else
        callPages();
}
