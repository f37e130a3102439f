/* The first pass of a scan of requests. */
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x_id = 0) in;

#include "compact.glsl"

void main()
{
    sluiceCompactSections();
}
