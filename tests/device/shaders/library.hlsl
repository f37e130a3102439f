/*
 * All files of shaders/include/sluice that HLSL can include, in one shader, with the descriptor sets
 * of frames and launches. Compiled, not run. glslang's HLSL has neither non-uniform indices nor arrays
 * of unknown length or of buffers, so demand_bytes.glsl gets a macro of its own.
 */
#define SLUICE_FRAGMENT_SHADER
#define SLUICE_NON_UNIFORM(i) i
#define SLUICE_PAGE_LOOP 4
#define SLUICE_TEXTURE_COUNT 64
#define SLUICE_PAGED true
#define SLUICE_CUBIC true
#define SLUICE_FEEDBACK_IN_TURNS
#define SLUICE_FEEDBACK_QUERY
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#define SLUICE_DEMAND_SET 1
#include "sluice/bindings.glsl"
#include "sluice/demand_bindings.glsl"
#include "sluice/demand.glsl"
#include "sluice/demand_cubes.glsl"
#include "sluice/demand_grids.glsl"
#undef SLUICE_DEMAND_BYTE_WORD
#define SLUICE_DEMAND_BYTE_WORD(chunk, i) sluiceDemandLevelWords[i]
#include "sluice/demand_bytes.glsl"
#include "sluice/demand_jitter.glsl"
#include "sluice/feedback.glsl"
#include "sluice/feedback_cube.glsl"
#include "sluice/feedback_jitter.glsl"
#include "sluice/proxy.glsl"
#include "sluice/sample.glsl"
#include "sluice/sample_array.glsl"
#include "sluice/sample_cube.glsl"
#include "sluice/sample_integer.glsl"
#include "sluice/sample_stochastic.glsl"
#include "sluice/stochastic.glsl"
#include "sluice/udim.glsl"

[[vk::binding(0, 2)]] Texture2D tex;
[[vk::binding(0, 2)]] SamplerState texSampler;
[[vk::binding(1, 2)]] Texture2DArray layers;
[[vk::binding(1, 2)]] SamplerState layersSampler;
[[vk::binding(2, 2)]] Texture2D<uint4> numbers;
[[vk::binding(2, 2)]] SamplerState numbersSampler;
[[vk::binding(3, 2)]] Texture2D<int4> signedNumbers;
[[vk::binding(3, 2)]] SamplerState signedNumbersSampler;
[[vk::binding(4, 2)]] TextureCube cube;
[[vk::binding(4, 2)]] SamplerState cubeSampler;
[[vk::binding(5, 2)]] TextureCubeArray cubes;
[[vk::binding(5, 2)]] SamplerState cubesSampler;
struct Constants {
    uint tableIndex;
    uint seed;
};
[[vk::push_constant]] ConstantBuffer<Constants> constants;

float4 main(float4 position : SV_Position, float2 uv : TEXCOORD0) : SV_Target0
{
    uint missing, index = constants.tableIndex;
    bool resident;
    float2 dx = ddx(uv), dy = ddy(uv), random = sluiceRandomPair(uint3(position.xy, constants.seed));
    float4 color = sluiceSample(tex, texSampler, index, uv, 0.0, 8.0, missing);
    color += sluiceSample(index, index, uv, 0.0, 1.0, missing);
    sluiceWriteFeedbackQuery(tex, texSampler, index, uv, 0.0, 8.0, missing != 0u);
    if (sluiceSelectRandomFragmentQuad(position.xy, constants.seed, 1.0 / 16.0))
        sluiceWriteQuadFeedback(index, uv, dx, dy, 0.0, 8.0, uint2(position.xy), constants.seed);
    sluiceWriteJitteredFeedback(index, uv, dx, dy, 0.0, 1.0, SLUICE_JITTER_TENT);
    sluiceWriteFeedbackLod(index, uv, 1.5);
    color += sluiceSampleStochastic(index, index, uv, 0.5, SLUICE_PICK_GAUSSIAN, 0.7, true, random, missing);
    color += sluiceDemandGrad(index, sluiceDemandJitter(index, uv, dx, dy, SLUICE_JITTER_BOX, random), dx, dy, resident);
    SluiceUdimPart part = sluiceFindUdimPart(uint2(10u, 2u), float2(512.0, 512.0), uv, dx, dy, 0.0, 1.0, 1u);
    color += part.weight * sluiceSampleArray(layers, layersSampler, index, part.cell, part.uv, 0.0, 1.0, missing);
    color += float4(sluiceSampleUint(numbers, numbersSampler, index, uv, missing));
    color += float4(sluiceSampleInt(signedNumbers, signedNumbersSampler, index, uv, missing));
    float3 direction = float3(uv, 1.0), directionX = float3(dx, 0.0), directionY = float3(dy, 0.0);
    color += sluiceSampleCube(cube, cubeSampler, index, direction, 0.0, 4.0, missing);
    color += sluiceSampleCube(cubes, cubesSampler, 1u, index, direction, 0.0, 4.0, missing);
    color += sluiceSampleCube(index, index, direction, 0.0, 4.0, missing);
    sluiceWriteCubeFeedback(index, direction, directionX, directionY, 0.0, 4.0);
    sluiceWriteCubeQuadFeedback(index, direction, directionX, directionY, 0.0, 4.0, uint2(position.xy), constants.seed);
    sluiceWriteCubeFeedbackLod(index, direction, 2.0);
    color += sluiceDemandCubeGrad(index, 1u, direction, directionX, directionY, resident);
    color += sluiceDemandUdimGrad(index, uv, dx, dy, resident);
    color += sluiceDemandLayerGrad(index, 1u, uv, dx, dy, resident);
    color += sluiceDemandLayerLod(index, 1u, uv, 2.0, resident);
    SluiceDemandBytes bytes;
    if (sluiceMapBytesOrRequest(index, bytes))
        color.x += sluiceDemandFloat(bytes, 3u) + float(sluiceDemandByte(bytes, 5u));
    float t;
    uint face;
    if (sluiceIntersectProxyBox(float3(0.0, 0.0, 0.0), float3(1.0, 1.0, 1.0), color.rgb, float3(uv, 1.0), 0.0, 1.0, t, face))
        sluiceRequestGeometryProxy(4u, index);
    color.rgb += sluiceProxyFaceNormal(face) * t;
    return color;
}
