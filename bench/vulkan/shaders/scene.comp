/* The scene by compute, with explicit derivatives: a pixel of the picture per thread. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "scene.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

/* 1 for a region that was sampled, 2 if it is not as sharp as it should be. */
void countRegion(Place p)
{
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(params.tableIndex);
    SluiceSampling s = sluiceResolveSampling(params.tableIndex, p.uv, p.dx, p.dy, 0.0, anisotropy);
    uvec2 regions = uvec2(entry.regionCountX, entry.regionCountY);
    uvec2 region = min(uvec2(fract(p.uv) * vec2(regions)), regions - 1u);
    atomicMax(outputs[region.y * regions.x + region.x], sluiceMissingLevels(s) > 0u ? 2u : 1u);
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height)
        return;
    Place p = scenePlace(vec2(pixel) + 0.5);
    if (counting) {
        countRegion(p);
    } else {
        vec4 color;
        uint missing;
        if (streamed)
            color = sluiceSampleGrad(streamedTexture, params.tableIndex, p.uv, p.dx, p.dy, 0.0,
                                     anisotropy, missing);
        else
            color = textureGrad(plainTexture, p.uv, p.dx, p.dy);
        picture[pixel.y * params.width + pixel.x] = packUnorm4x8(color);
    }
    writeSceneFeedback(pixel, p);
}
