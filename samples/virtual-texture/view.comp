/* Shows a part of the texture and writes feedback. Counts wrong texels on request. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_SET 0
#define SLUICE_PAGED true
#define SLUICE_TEXTURE_ARRAY SLUICE_TEXTURES_COMBINED
#include "sluice/bindings.glsl"
#include "sluice/sample.glsl"
#include "sluice/feedback.glsl"

#include "fractal_shared.h"
#include "fractal.glsl"

layout(local_size_x = FRACTAL_GROUP, local_size_y = FRACTAL_GROUP) in;
layout(std430, set = 1, binding = 0) writeonly buffer Pixels { uint pixels[]; };
layout(std430, set = 1, binding = 1) buffer Counts { FractalCounts counts; };
layout(push_constant) uniform Push { FractalView view; };

vec3 paletteColor(float steps)
{
    if (steps > 254.5)
        return vec3(0.0);
    return 0.5 + 0.5 * cos(6.2831853 * (sqrt(steps / 255.0) * 2.0 + vec3(0.55, 0.45, 0.3)));
}

/* Compares the texel shown here with the value of the function. */
void compareTexel(vec2 uv, vec2 dx, vec2 dy)
{
    SluiceSampling s = sluiceResolveSampling(view.tableIndex, uv, dx, dy, 0.0, 1.0);
    atomicMin(counts.finest, s.level);
    if (s.level > s.wantedLevel)
        atomicAdd(counts.coarse, 1u);
    uint bits = view.sizeLog2 - s.level;
    uvec2 texel = uvec2(uv * float(1u << bits));
    float value = sluiceTexelFetch(view.tableIndex, view.tableIndex, ivec2(texel), s.level).r;
    atomicAdd(counts.compared, 1u);
    if (uint(value * 255.0 + 0.5) != fractalSteps(bits, texel))
        atomicAdd(counts.wrong, 1u);
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= view.width || at.y >= view.height)
        return;
    vec2 pixel = vec2(at) + 0.5 - 0.5 * vec2(view.width, view.height);
    vec2 uv = vec2(view.centerX, view.centerY) + pixel * view.scale;
    vec2 dx = vec2(view.scale, 0.0), dy = vec2(0.0, view.scale);
    uint word = at.y * view.width + at.x;
    if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) {
        pixels[word] = packUnorm4x8(vec4(paletteColor(0.0), 1.0));
        return;
    }
    uint missing;
    float value =
        sluiceSampleGrad(view.tableIndex, view.tableIndex, uv, dx, dy, 0.0, 1.0, missing).r;
    sluiceWriteFeedback(view.tableIndex, uv, dx, dy, 0.0, 1.0);
    pixels[word] = packUnorm4x8(vec4(paletteColor(value * 255.0), 1.0));
    if (view.compares != 0u)
        compareTexel(uv, dx, dy);
}
