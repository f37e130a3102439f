#version 460

layout(location = 0) out vec4 outColor;

void main()
{
    outColor = vec4(0.1, 0.75, 0.9, 1.0); // linear
}
