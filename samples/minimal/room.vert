/* Floor, walls and end of a corridor, seen by an eye that looks along -z. */
#version 450

layout(push_constant) uniform Draw { uint surface, tableIndex, frame; float aspect, eyeZ; } draw;
layout(location = 0) out vec2 uv;

void main()
{
    const vec2 corners[6] = vec2[](vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(0, 1), vec2(1, 0), vec2(1, 1));
    vec2 at = corners[gl_VertexIndex];
    vec3 p;
    if (draw.surface == 0) /* floor */
        p = vec3(4.0 * at.x - 2.0, -1.0, -8.0 * at.y);
    else if (draw.surface < 3) /* left and right wall */
        p = vec3(draw.surface == 1 ? -2.0 : 2.0, 1.5 - 2.5 * at.y, -8.0 * at.x);
    else /* the end */
        p = vec3(4.0 * at.x - 2.0, 1.5 - 2.5 * at.y, -8.0);
    uv = draw.surface == 0 ? at * vec2(1.0, 2.0) : at;
    float w = draw.eyeZ - p.z;
    gl_Position = vec4(p.x * 1.2 / draw.aspect, -p.y * 1.2, w - 0.1, w);
}
