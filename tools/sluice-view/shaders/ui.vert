#version 450

layout(push_constant) uniform Push
{
    vec2 scale; // 2 / size of the picture
    uint mode;
} push;

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;

layout(location = 0) out vec2 fragUv;
layout(location = 1) out vec4 fragColor;

void main()
{
    fragUv = uv;
    fragColor = color;
    gl_Position = vec4(position * push.scale - 1.0, 0.0, 1.0);
}
