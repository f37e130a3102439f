// What a draw of the scene is given. 112 bytes; stage.c has the same struct.
layout(push_constant) uniform Push
{
    mat4 viewProjection;
    vec4 color;
    uint tableIndex; // ~0: no texture
    uint view;       // settings.h
    uint seed;
    float probability; // 0: no feedback
    float lodBias, anisotropy, tint;
    uint flags; // 1: borders of tiles
} push;
