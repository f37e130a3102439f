/* Traces the floor's reflections: one ray per floor pixel samples the texture that it hits. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_DEMAND_SET 0
#include "sluice/demand_bindings.glsl"
#include "sluice/demand.glsl"

#include "room.glsl"

layout(std430, set = 1, binding = 0) writeonly buffer Reflections { uint colors[]; } reflections;
layout(local_size_x = 8, local_size_y = 8) in;

/* Intersects the pixel's reflected ray with the plane of a surface. Returns the point and the
 * distance `t`. */
vec3 meet(uint surface, vec2 pixel, out float t)
{
    vec3 d = rayOf(pixel);
    vec3 floorPoint = eye + d * ((-1.0 - eye.y) / d.y);
    d.y = -d.y;
    if (surface == 3)
        t = (-8.0 - floorPoint.z) / d.z;
    else
        t = ((surface == 1 ? -2.0 : 2.0) - floorPoint.x) / d.x;
    return floorPoint + d * t;
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= draw.width || at.y >= draw.height)
        return;
    vec2 pixel = vec2(at) + 0.5;
    vec3 d = rayOf(pixel);
    vec3 p = eye + d * ((-1.0 - eye.y) / d.y);
    uint word = at.y * draw.width + at.x;
    reflections.colors[word] = 0u;
    if (d.y >= 0.0 || abs(p.x) > 2.0 || p.z < -8.0 || p.z > 0.0)
        return; /* not on the floor */
    float sideDistance, endDistance, unused;
    uint side = d.x < 0.0 ? 1u : 2u;
    vec3 onSide = meet(side, pixel, sideDistance), onEnd = meet(3u, pixel, endDistance);
    uint surface = sideDistance < endDistance ? side : 3u;
    vec3 hit = surface == 3u ? onEnd : onSide;
    if (hit.y > 1.5)
        return; /* above the walls */
    vec2 uv = uvOf(surface, hit);
    vec2 dx = uvOf(surface, meet(surface, pixel + vec2(1.0, 0.0), unused)) - uv;
    vec2 dy = uvOf(surface, meet(surface, pixel + vec2(0.0, 1.0), unused)) - uv;
    bool resident;
    vec4 color = sluiceDemandGrad(draw.textures[surface], uv, dx, dy, resident);
    float grazing = 1.0 - clamp(-normalize(d).y, 0.0, 1.0);
    float weight = resident ? 0.15 + 0.7 * grazing * grazing * grazing : 0.0;
    reflections.colors[word] = packUnorm4x8(vec4(color.rgb, weight));
}
