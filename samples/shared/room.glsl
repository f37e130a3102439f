/* A room: floor (0), left and right wall (1, 2) and end (3), 4 wide, 2.5 high, 8 deep. */
#ifndef SHARED_ROOM_GLSL
#define SHARED_ROOM_GLSL

layout(push_constant) uniform Draw { uint surface, tableIndex, width, height; uint textures[4]; } draw;

const vec3 eye = vec3(0.0, 0.1, 1.0);
const float zoom = 1.1;

/* Returns the direction of a pixel, counted from the upper left. */
vec3 rayOf(vec2 pixel)
{
    vec2 ndc = pixel / vec2(draw.width, draw.height) * 2.0 - 1.0;
    return vec3(ndc.x * float(draw.width) / float(draw.height), -ndc.y, -zoom);
}

vec2 uvOf(uint surface, vec3 p)
{
    if (surface == 0)
        return vec2(p.x * 0.25 + 0.5, -p.z * 0.25);
    if (surface < 3)
        return vec2(-p.z * 0.25, (1.5 - p.y) * 0.4);
    return vec2(p.x * 0.25 + 0.5, (1.5 - p.y) * 0.4);
}

#endif
