/* Requests levels region by region, in several textures at once, and counts missing ones. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "bench.glsl"

layout(local_size_x = 64) in;

/* The floor on which textures lie: meters. */
const float extent = 2.0;
const float spacing = 2.5;
const uint columns = 40u;
const float eyeHeight = 1.7;
const float farthest = 60.0;
const float focal = 960.0; /* pixels */

uint draw(uint id)
{
    return sluiceHash(uvec3(id, params.seed, 11u));
}

uint patchLevel(uvec2 region)
{
    bool inside = region.x < params.patchSize[0] && region.y < params.patchSize[1];
    return inside ? params.level - 1u : params.level;
}

uint randomLevel(uint id)
{
    float r = float(draw(id) >> 8u) / 16777216.0;
    return r < params.probability ? params.level + 1u : params.level;
}

/* Untouched where the camera does not look, or where no pixel of the region was selected. */
uint viewLevel(uint id, uint texture, vec2 uv, float regionExtent, float texelsPerMeter)
{
    vec2 at = vec2(texture % columns, texture / columns) * spacing + uv * extent -
              vec2(params.camera[0], params.camera[1]);
    float s = sin(params.cameraAngle), c = cos(params.cameraAngle);
    vec2 seen = vec2(c * at.x - s * at.y, s * at.x + c * at.y);
    if (seen.y < 0.5 || seen.y > farthest || abs(seen.x) > seen.y)
        return SLUICE_MIP_UNTOUCHED;
    float distance = length(vec2(seen.y, eyeHeight));
    float size = regionExtent * focal / distance;
    float pixels = size * size * eyeHeight / distance;
    float chance = 1.0 - pow(1.0 - min(params.probability, 0.999999), max(pixels, 1.0));
    if (float(draw(id) >> 8u) / 16777216.0 >= chance)
        return SLUICE_MIP_UNTOUCHED;
    return uint(max(log2(texelsPerMeter * distance / focal), 0.0));
}

/* 8x8 samples a region, not so near its edge that others are touched. */
void countMissing(uint tableIndex, uvec2 region, uint level)
{
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    vec2 derivative = vec2(exp2(float(level) + 0.5)) / vec2(entry.width, entry.height);
    uint nothing = 0u, coarser = 0u, levels = 0u;
    for (uint i = 0u; i < 64u; i++) {
        vec2 uv = (vec2(region) + (vec2(i & 7u, i >> 3u) + 1.5) / 10.0) /
                  vec2(params.width, params.height);
        SluiceSampling s = sluiceResolveSampling(tableIndex, uv, vec2(derivative.x, 0.0),
                                                 vec2(0.0, derivative.y), 0.0, 1.0);
        uint missing = sluiceMissingLevels(s);
        nothing += missing == SLUICE_MIP_UNTOUCHED ? 1u : 0u;
        coarser += missing > 0u ? 1u : 0u;
        levels += missing == SLUICE_MIP_UNTOUCHED ? 0u : missing;
    }
    atomicAdd(outputs[BENCH_COUNT_SAMPLES], 64u);
    atomicAdd(outputs[BENCH_COUNT_NOTHING], nothing);
    atomicAdd(outputs[BENCH_COUNT_COARSER], coarser);
    atomicAdd(outputs[BENCH_COUNT_LEVELS], levels);
}

void main()
{
    uint regionCount = params.width * params.height;
    uint id = gl_GlobalInvocationID.x;
    if (id >= regionCount * params.textureCount)
        return;
    uint tableIndex = tableIndices[id / regionCount];
    uvec2 region = uvec2(id % params.width, id % regionCount / params.width);
    if (params.kind == BENCH_WANTS_COUNT) {
        countMissing(tableIndex, region, patchLevel(region));
        return;
    }
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    uint level;
    if (params.kind == BENCH_WANTS_PATCH) {
        level = patchLevel(region);
    } else if (params.kind == BENCH_WANTS_RANDOM) {
        level = randomLevel(id);
    } else {
        vec2 uv = (vec2(region) + 0.5) / vec2(params.width, params.height);
        level = viewLevel(id, id / regionCount, uv, extent / float(params.width),
                          float(entry.width) / extent);
    }
    if (level != SLUICE_MIP_UNTOUCHED)
        sluiceMarkRegion(entry, region.x, region.y, level);
}
