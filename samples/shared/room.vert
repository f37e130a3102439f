/* Draws one surface of the room. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "room.glsl"

layout(location = 0) out vec2 uv;

void main()
{
    const vec2 corners[6] = vec2[](vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(0, 1), vec2(1, 0), vec2(1, 1));
    vec2 at = corners[gl_VertexIndex];
    vec3 p = vec3(4.0 * at.x - 2.0, -1.0, -8.0 * at.y);
    if (draw.surface == 1 || draw.surface == 2)
        p = vec3(draw.surface == 1 ? -2.0 : 2.0, 1.5 - 2.5 * at.y, -8.0 * at.x);
    else if (draw.surface == 3)
        p = vec3(4.0 * at.x - 2.0, 1.5 - 2.5 * at.y, -8.0);
    uv = uvOf(draw.surface, p);
    vec3 q = p - eye;
    float aspect = float(draw.width) / float(draw.height);
    gl_Position = vec4(q.x * zoom / aspect, -q.y * zoom, -q.z - 0.1, -q.z);
}
