/* Calls one function of sluice/ on many arguments. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "twins_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Calls { TwinCall calls[]; };
layout(push_constant) uniform Push { TwinParams params; };

uint at;

SluiceTextureEntry entryOfArguments();
#define SLUICE_TEXTURE_ENTRY(i) entryOfArguments()
#include "sluice/stochastic.glsl"
#include "sluice/footprint.glsl"

uint argument(uint i) { return calls[at].arguments[i]; }
float real(uint i) { return uintBitsToFloat(argument(i)); }
vec2 real2(uint i) { return vec2(real(i), real(i + 1u)); }
uvec3 range(uint i) { return uvec3(argument(i), argument(i + 1u), argument(i + 2u)); }

void result(uint i, uint value) { calls[at].results[i] = value; }
void result(uint i, float value) { result(i, floatBitsToUint(value)); }

/* Regions are given as log2 of their sizes. */
SluiceTextureEntry entryOfArguments()
{
    SluiceTextureEntry e;
    e.sizeX = float(argument(5u));
    e.sizeY = float(argument(6u));
    e.regionLastX = argument(9u) - 1u;
    e.regionLastY = argument(10u) - 1u;
    e.shape = argument(7u) | argument(8u) << SLUICE_SHAPE_HEIGHT_SHIFT |
              argument(11u) << SLUICE_SHAPE_MODE_U_SHIFT | argument(12u) << SLUICE_SHAPE_MODE_V_SHIFT |
              (argument(13u) != 0u ? SLUICE_SHAPE_UNEVEN : 0u);
    return e;
}

void results(uvec3 values)
{
    for (uint i = 0u; i < 3u; i++)
        result(i, values[i]);
}

void callLod()
{
    switch (params.function) {
    case TWIN_CLAMP_ANISOTROPY: result(0u, sluiceClampAnisotropy(real(0u))); break;
    case TWIN_CLAMP_LOD: result(0u, sluiceClampLod(real(0u))); break;
    case TWIN_CLAMP_LOD_BIAS: result(0u, sluiceClampLodBias(real(0u))); break;
    case TWIN_IS_FINITE: result(0u, sluiceIsFinite(real2(0u)) ? 1u : 0u); break;
    case TWIN_LOD_MARGIN: result(0u, sluiceLodMargin(real(0u))); break;
    case TWIN_COMPUTE_LODS: {
        vec2 lods = sluiceComputeLods(real2(0u), real2(2u), real(4u), real(5u));
        result(0u, lods.x);
        result(1u, lods.y);
        break;
    }
    case TWIN_COMPUTE_LOD:
        result(0u, sluiceComputeLod(real2(0u), real2(2u), real(4u), real(5u)));
        break;
    case TWIN_FINEST_LEVEL: result(0u, sluiceFinestLevel(real(0u), real(1u), argument(2u))); break;
    case TWIN_LOD_LIMIT: result(0u, sluiceLodLimit(argument(0u), real(1u))); break;
    case TWIN_SHOWN_LEVEL: result(0u, sluiceShownLevel(argument(0u))); break;
    case TWIN_COARSEST_LEVEL: result(0u, sluiceCoarsestLevel(real(0u), argument(1u))); break;
    case TWIN_FLOOR_LOG4: result(0u, sluiceFloorLog4(real(0u))); break;
    case TWIN_SQUARE_LODS: {
        SluiceSquares s = sluiceSquareLods(real2(0u), real2(2u), real(4u));
        result(0u, s.fine);
        result(1u, s.coarse);
        result(2u, s.widest);
        result(3u, s.sum);
        break;
    }
    case TWIN_QUICK_LEVELS:
        results(sluiceQuickLevels(SluiceSquares(real(0u), real(1u), real(2u), 0.0), real(3u), real(4u),
                                  argument(5u)));
        break;
    case TWIN_SAFE_LEVELS:
        results(sluiceSafeLevels(real2(0u), real2(2u), real2(4u), real(6u), real(7u), argument(8u)));
        break;
    }
}

void callFootprint()
{
    switch (params.function) {
    case TWIN_REGION_INDEX:
        result(0u, sluiceRegionIndex(real(0u), real(1u), argument(2u), argument(3u)));
        break;
    case TWIN_REGION_RANGE: {
        uvec2 r = sluiceRegionRange(real(0u), real(1u), real(2u), argument(3u), real(4u), argument(5u),
                                    argument(6u));
        result(0u, r.x);
        result(1u, r.y);
        break;
    }
    case TWIN_HALF_BOX: {
        vec2 box = sluiceHalfBox(real2(0u), real2(2u), real(4u), real(5u));
        result(0u, box.x);
        result(1u, box.y);
        break;
    }
    case TWIN_RANGE_STEP:
        result(0u, sluiceRangeStep(argument(0u), argument(1u), argument(2u), argument(3u)));
        break;
    case TWIN_NEXT_REGION:
        result(0u, sluiceNextRegion(argument(0u), argument(1u), argument(2u), argument(3u)));
        break;
    case TWIN_COMPUTE_FOOTPRINT: {
        SluiceFootprint f =
            sluiceComputeFootprint(sluiceReadGrid(0u), real2(0u), real2(2u), argument(4u));
        for (uint i = 0u; i < 2u; i++) {
            result(i, f.first[i]);
            result(2u + i, f.last[i]);
        }
        break;
    }
    }
}

void main()
{
    at = gl_GlobalInvocationID.x;
    if (at >= params.count)
        return;
    switch (params.function) {
    case TWIN_HASH: result(0u, sluiceHash(range(0u))); break;
    case TWIN_SELECT_RANDOM_QUAD:
        result(0u, sluiceSelectRandomQuad(range(0u).xy, argument(2u), real(3u)) ? 1u : 0u);
        break;
    case TWIN_SELECT_LATTICE:
        result(0u, sluiceSelectLattice(range(0u).xy, argument(2u)) ? 1u : 0u);
        break;
    case TWIN_SELECT_BLOCK:
        result(0u, sluiceSelectBlock(range(0u).xy, argument(2u)) ? 1u : 0u);
        break;
    default:
        if (params.function < TWIN_REGION_INDEX)
            callLod();
        else
            callFootprint();
    }
}
