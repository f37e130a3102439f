/* Calls one function of sluice/ on many arguments. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "twins_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Calls { TwinCall calls[]; };
layout(push_constant) uniform Push { TwinParams params; };

#include "sluice/footprint.glsl"
#include "sluice/lod.glsl"
#include "sluice/stochastic.glsl"

uint at;

uint argument(uint i) { return calls[at].arguments[i]; }
float real(uint i) { return uintBitsToFloat(argument(i)); }
vec2 real2(uint i) { return vec2(real(i), real(i + 1u)); }
uvec3 range(uint i) { return uvec3(argument(i), argument(i + 1u), argument(i + 2u)); }

void result(uint i, uint value) { calls[at].results[i] = value; }
void result(uint i, float value) { result(i, floatBitsToUint(value)); }

SluiceTextureEntry entryOfArguments()
{
    SluiceTextureEntry e;
    e.width = argument(5u);
    e.height = argument(6u);
    e.regionWidth = argument(7u);
    e.regionHeight = argument(8u);
    e.regionCountX = argument(9u);
    e.regionCountY = argument(10u);
    e.addressModeU = argument(11u);
    e.addressModeV = argument(12u);
    e.flags = argument(13u);
    return e;
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
    }
}

void callFootprint()
{
    SluiceFootprint f = SluiceFootprint(range(0u), range(3u));
    uvec3 r = range(0u);
    vec2 box;
    switch (params.function) {
    case TWIN_REGION_INDEX: result(0u, sluiceRegionIndex(real(0u), real(1u), argument(2u))); break;
    case TWIN_REGION_RANGE:
        r = sluiceRegionRange(real(0u), real(1u), real(2u), argument(3u), real(4u), argument(5u));
        for (uint i = 0u; i < 3u; i++)
            result(i, r[i]);
        break;
    case TWIN_HALF_BOX:
        box = sluiceHalfBox(real2(0u), real2(2u), real(4u), real(5u));
        result(0u, box.x);
        result(1u, box.y);
        break;
    case TWIN_RANGE_SHIFT: result(0u, sluiceRangeShift(r, argument(3u))); break;
    case TWIN_COUNT_STEPS: result(0u, sluiceCountSteps(argument(0u), argument(3u))); break;
    case TWIN_RANGE_STEPS: result(0u, sluiceRangeSteps(r, argument(3u))); break;
    case TWIN_RANGE_REGION: result(0u, sluiceRangeRegion(r, argument(3u), argument(4u))); break;
    case TWIN_COMPUTE_FOOTPRINT:
        f = sluiceComputeFootprint(entryOfArguments(), real2(0u), real2(2u), argument(4u));
        for (uint i = 0u; i < 3u; i++) {
            result(i, f.x[i]);
            result(3u + i, f.y[i]);
        }
        break;
    case TWIN_IS_ONE_REGION: result(0u, sluiceFootprintIsOneRegion(f) ? 1u : 0u); break;
    case TWIN_FOOTPRINT_STEPS: {
        uvec2 steps = sluiceFootprintSteps(f, argument(6u));
        result(0u, steps.x);
        result(1u, steps.y);
        break;
    }
    case TWIN_FOOTPRINT_REGION: {
        uvec2 region = sluiceFootprintRegion(f, argument(6u), uvec2(argument(7u), argument(8u)));
        result(0u, region.x);
        result(1u, region.y);
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
    default:
        if (params.function < TWIN_REGION_INDEX)
            callLod();
        else
            callFootprint();
    }
}
