// What all draws of a frame are given, and which material. 112 bytes; stage_draw.c has the same struct.
layout(push_constant) uniform Push
{
    mat4 viewProjection;
    vec3 eye;
    uint material;
    uint view; // settings.h
    uint seed;
    float probability; // 0: no feedback
    float lodBias, anisotropy, tint;
    uint flags; // 1: borders of tiles; 2: with numbers
} push;
