#version 450

// Modes of ui_geometry.h.
const uint MODE_DIFFERENCE = 1;

layout(push_constant) uniform Push
{
    vec2 scale;
    uint mode;
} push;

layout(set = 0, binding = 0) uniform sampler2D picture;
layout(set = 1, binding = 0) uniform sampler2D otherPicture;

layout(location = 0) in vec2 fragUv;
layout(location = 1) in vec4 fragColor;
layout(location = 0) out vec4 outColor;

void main()
{
    vec4 texel = texture(picture, fragUv);
    if (push.mode == MODE_DIFFERENCE)
        outColor = vec4(abs(texel.rgb - texture(otherPicture, fragUv).rgb) * fragColor.a * 16.0, 1.0);
    else
        outColor = texel * fragColor;
}
