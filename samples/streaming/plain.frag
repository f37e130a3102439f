/* Shades frames, ceiling and benches, which have a color and no texture. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "gallery.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) flat in vec3 normal;
layout(location = 3) flat in vec3 tangent;
layout(location = 0) out vec4 outColor;

void main()
{
    vec3 color = toVec3(draw.color);
    if ((draw.flags & GALLERY_GLOWING) == 0u)
        color = lightSurface(color, position, normal, 0.0);
    outColor = vec4(develop(color), 1.0);
}
