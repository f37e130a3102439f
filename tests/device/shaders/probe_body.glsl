/* Shared by probe.comp and probe.hlsl after their bindings: evaluates one input. */
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"
#if !defined(PROBE_CODES) || defined(SLUICE_HLSL)
#define SLUICE_NO_RESIDENCY_CODES
#endif
#include "sluice/residency.glsl"

void writeColor(uint at, vec4 color)
{
    for (uint i = 0u; i < 4u; i++)
        outputs[at].color[i] = color[i];
}

/* Bits of pixel and frame in uv, dx: what stochastic.glsl selects. */
void evaluateTwins(uint at, vec2 uv, vec2 dx, vec2 dy, float bias, float anisotropy)
{
    SluiceGrid grid = sluiceReadGrid(params.tableIndex);
    vec2 tx = dx * grid.size, ty = dy * grid.size;
    vec2 lods = sluiceComputeLods(tx, ty, bias, anisotropy);
    uint coarsest = sluiceCoarsestLevel(lods.y, sluiceMipCount(grid));
    SluiceFootprint f =
        sluiceComputeFootprint(grid, uv, sluiceHalfBox(tx, ty, bias, anisotropy), coarsest);
    outputs[at].lod = lods.x;
    outputs[at].wantedLevel =
        sluiceFinestLevel(lods.x, sluiceLodMargin(anisotropy), sluiceMipCount(grid));
    outputs[at].level = coarsest;
    for (uint i = 0u; i < 2u; i++) {
        outputs[at].footprint[i] = f.first[i];
        outputs[at].footprint[2u + i] = f.last[i];
    }
    uvec2 pixel = uvec2(at % 128u, at / 128u);
    outputs[at].missingLevels = sluiceHash(uvec3(pixel, floatBitsToUint(bias)));
    outputs[at].nonResident = (sluiceSelectRandomQuad(pixel, at / 7u, anisotropy) ? 1u : 0u) |
                              (sluiceSelectLattice(pixel, at / 5u) ? 2u : 0u);
}

vec4 sampleRow(vec2 uv, vec2 dx, vec2 dy, float lod, float anisotropy)
{
    #ifdef SLUICE_HLSL
    uint width, height;
    tex.GetDimensions(width, height);
    vec2 size = vec2(width, height);
#else
    vec2 size = vec2(textureSize(tex, 0));
#endif
    float x = length(dx * size), y = length(dy * size);
    float count = anisotropy > 1.0 ? clamp(ceil(max(x, y) / exp2(lod) - 0.01), 1.0, anisotropy) : 1.0;
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    for (float i = 0.0; i < count; i++)
        sum += SLUICE_TEXTURE_LOD(tex, SLUICE_SAMPLER_OF(tex), uv + (x >= y ? dx : dy) * ((i + 0.5) / count - 0.5), lod);
    return sum / count;
}

vec4 sampleGrad(vec2 uv, vec2 dx, vec2 dy, float minLod)
{
#ifdef SLUICE_MIN_LOD
    return SLUICE_TEXTURE_GRAD_CLAMP(tex, SLUICE_SAMPLER_OF(tex), uv, dx, dy, minLod);
#else
    return SLUICE_TEXTURE_GRAD(tex, SLUICE_SAMPLER_OF(tex), uv, dx, dy);
#endif
}

void probe(uint id)
{
    uint at = params.first + id;
    vec2 uv = vec2(inputs[at].uv[0], inputs[at].uv[1]);
    vec2 dx = vec2(inputs[at].dx[0], inputs[at].dx[1]);
    vec2 dy = vec2(inputs[at].dy[0], inputs[at].dy[1]);
    float bias = inputs[at].lodBias, anisotropy = inputs[at].maxAnisotropy;

    if ((params.flags & PROBE_WORDS) != 0u) {
        outputs[at].level = SLUICE_FEEDBACK_WORD(SLUICE_TEXTURE_ENTRY(params.tableIndex).feedbackOffset + id);
        return;
    }
    if ((params.flags & PROBE_TWINS) != 0u) {
        evaluateTwins(at, uv, dx, dy, bias, anisotropy);
        return;
    }
    if ((params.flags & PROBE_TRUTH) != 0u)
        writeColor(at, bias >= 0.0 ? sampleRow(uv, dx, dy, bias, anisotropy)
                                   : sampleGrad(uv, dx, dy, -1.0 - bias));
    if ((params.flags & PROBE_FETCH) != 0u)
        writeColor(at, sluiceTexelFetch(SLUICE_PASS_SAMPLER(tex), params.tableIndex, ivec2(uv), uint(bias)));
    if ((params.flags & PROBE_SAMPLE) != 0u) {
        uint missing;
        writeColor(at, sluiceSampleGrad(SLUICE_PASS_SAMPLER(tex), params.tableIndex, uv, dx, dy, bias, anisotropy, missing));
        SluiceSampling s = sluiceResolveSampling(params.tableIndex, uv, dx, dy, bias, anisotropy);
        outputs[at].missingLevels = missing;
        outputs[at].level = s.level;
        outputs[at].wantedLevel = s.wantedLevel;
        outputs[at].lod = s.lod;
        outputs[at].footprint[0] = floatBitsToUint(s.dx.x);
        outputs[at].footprint[1] = floatBitsToUint(s.dx.y);
        outputs[at].footprint[2] = floatBitsToUint(s.dy.x);
        outputs[at].footprint[3] = floatBitsToUint(s.dy.y);
        outputs[at].minLod = s.minLod;
    }
    if (cubic && (params.flags & PROBE_SLOPES) != 0u) {
        uint missing;
        vec4 du, dv;
        writeColor(at, sluiceSampleDerivatives(SLUICE_PASS_SAMPLER(tex), params.tableIndex, uv, dx, dy, bias, anisotropy, du, dv,
                                               missing));
        for (uint i = 0u; i < 3u; i++) {
            outputs[at].footprint[i] = floatBitsToUint(du[i]);
            outputs[at].footprint[3u + i] = floatBitsToUint(dv[i]);
        }
    }
    if ((params.flags & PROBE_RESIDENCY) != 0u)
        outputs[at].nonResident += sluiceCountNonResident(SLUICE_PASS_SAMPLER(nearestMipTex), params.tableIndex, uv, dx, dy,
                                                         bias, anisotropy);
    if ((params.flags & PROBE_FEEDBACK) != 0u)
        sluiceWriteFeedback(params.tableIndex, uv, dx, dy, bias, anisotropy);
}
